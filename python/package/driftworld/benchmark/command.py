"""``driftworld benchmark``: the runner and the tables, for the command line."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from pathlib import Path
from typing import Any

from driftworld._files import write_whole
from driftworld._plain import json_or_word
from driftworld.benchmark.figure import figure
from driftworld.benchmark.runner import STALE, Cell, learners_by_name, make_learner, run_cells
from driftworld.benchmark.sequence import Sequence
from driftworld.benchmark.table import Results

#: Default estimates: core seconds per decision, and bytes on disk per finished cell.
_SECONDS, _BYTES = 0.0002, 400_000

_MINE = '''"""My learner."""

from driftworld.learners import PPO


class MyLearner(PPO):
    """PPO with all weights held near their initial values (L2-init, arXiv:2308.11958; its λ is half of this strength)."""

    name = "my_learner"

    def __init__(self, num_actions, num_envs, *, strength=0.0001, **options):
        super().__init__(num_actions, num_envs, **options)
        self.strength = strength
        self.initial = {name: weight.detach().clone() for name, weight in self.network.named_parameters()}

    def extra_loss(self):
        weights = self.network.named_parameters()
        return self.strength / 2 * sum((weight - self.initial[name]).square().sum() for name, weight in weights)

    def method_state(self):
        return {"initial": self.initial}

    def load_method_state(self, state):
        self.initial = state["initial"]
'''


def main(arguments: list[str]) -> int:
    """Runs the command; returns its exit code: 0, or 1 for wrong input."""
    parsed = _parser().parse_args(arguments)
    try:
        parsed.run(parsed)
    except (ValueError, OSError, ImportError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="driftworld benchmark", description="Compare continual learners in frozen sequences of tasks.")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    def command(name: str, run: Any, about: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=about, description=about)
        added.set_defaults(run=run)
        return added

    command("list", _list, "List the sequences and the learners.")
    running = command("run", _run, "Run cells: each learner with each seed. Finished cells are not run again, and killed ones resume.")
    running.add_argument("sequence", help="a name that `list` prints, or a file")
    running.add_argument("--learner", action="append", default=[], metavar="NAME", help="a name that `list` prints, or FILE.py:CLASS; repeatable")
    running.add_argument("--all", action="store_true", help="all learners of driftworld.learners that the sequence names")
    running.add_argument("--seed", action="append", type=int, default=[], metavar="S", help="a seed; repeatable")
    running.add_argument("--seeds", type=int, metavar="N", help="the seeds 0 to N - 1 [default: 1]")
    running.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="an argument of the learner, which makes a separate row; repeatable for several arguments")
    running.add_argument("--split", choices=["test", "validation"], default="test", help="validation: worlds for tuning")
    running.add_argument("-o", "--output", type=Path, default=Path("results"), metavar="DIR", help="output folder, which several machines may share [default: results]")
    running.add_argument("--jobs", type=int, default=1, metavar="N", help="processes, one core each [default: 1]")
    running.add_argument("--ray", metavar="ADDRESS", help="run on the nodes of a Ray cluster that share the folder")
    running.add_argument("--dry-run", action="store_true", help="list the unfinished cells and estimate their cost, but run nothing")
    table = command("table", _table, "Make the table of a sequence from the logs.")
    table.add_argument("results", type=Path, help="a folder of cells, such as results/mixed")
    table.add_argument("-o", "--output", type=Path, metavar="FILE", help="Markdown file to write; by default the table is printed")
    table.add_argument("--figure", type=Path, metavar="FILE", help="SVG file to write as well: each learner's performance after each task")
    table.add_argument("--sequence", help="name or file of the sequence, if the folder has a different name")
    checked = command("check", _check, "Check that a sequence still has the worlds and frames that it was frozen with.")
    checked.add_argument("sequence", nargs="?", help="its name or file; by default all sequences that come with Driftworld")
    scaffold = command("new", _new, "Write a file with a new learner, as a starting point.")
    scaffold.add_argument("name", help="such as my_learner")
    return parser


def _list(_: argparse.Namespace) -> None:
    for name in Sequence.names():
        sequence = Sequence.load(name)
        tasks = "1 task" if len(sequence.tasks) == 1 else f"{len(sequence.tasks)} tasks"
        print(f"{name}: {tasks}, {sequence.decisions:,} decisions each. {sequence.about}")
    try:
        print(f"learners: {', '.join(sorted(learners_by_name()))}")
    except ImportError as error:
        print(f"learners: {error}")


def _cells(parsed: argparse.Namespace) -> list[Cell]:
    sequence = Sequence.load(parsed.sequence)
    learners = [*parsed.learner, *([name for name in sequence.learners if name != "all"] if parsed.all else [])]
    if not learners:
        raise ValueError("found no learner, expected --learner NAME or --all")
    seeds = parsed.seed or list(range(1 if parsed.seeds is None else parsed.seeds))
    if not seeds or min(seeds) < 0:
        raise ValueError("found a negative seed or no seeds, expected --seed to be at least 0 and --seeds at least 1")
    if parsed.jobs < 1:
        raise ValueError(f"--jobs: found {parsed.jobs}, expected at least 1")
    words = [each.partition("=")[0] for each in parsed.set]
    if len(set(words)) < len(words):
        raise ValueError(f"--set: found {', '.join(parsed.set)}, expected each name once; run the command once for each value")
    given = tuple((name, json_or_word(text)) for name, _, text in (each.partition("=") for each in parsed.set))
    return [Cell(parsed.sequence, name, seed, parsed.split, given) for seed in seeds for name in dict.fromkeys(learners)]


def _run(parsed: argparse.Namespace) -> None:
    cells, sequence = _cells(parsed), Sequence.load(parsed.sequence)
    left = [cell for cell in cells if not (cell.folder(parsed.output) / "report.json").is_file()]
    decisions = sequence.decisions * len(sequence.tasks)
    hours = len(left) * decisions * _SECONDS / 3600
    # Errors in learners' arguments are reported before anything runs. A dry run needs no torch.
    with contextlib.suppress(ImportError) if parsed.dry_run else contextlib.nullcontext():
        for cell in {cell.learner: cell for cell in cells}.values():
            make_learner(cell, sequence, "sampled")
    print(
        f"{len(cells)} {'cell' if len(cells) == 1 else 'cells'} of {decisions:,} decisions, {len(cells) - len(left)} finished; about "
        f"{hours:.2g} core hours and {len(left) * _BYTES / 1e6:.2g} MB left",
        flush=True,
    )
    if parsed.dry_run:
        for cell in left:
            print(f"  {cell.folder(parsed.output)}")
        return

    def report_cell(cell: Cell, report: dict[str, Any] | None) -> None:
        running = f"another process is running it, or was killed less than {STALE:.0f} seconds ago: run this again later"
        print(f"  {cell.folder(parsed.output)}: ", end="")
        print(running if report is None else f"{report['seconds']:.0f} s of learning, digest {report['digest'][:12]}", flush=True)

    run_cells(cells, parsed.output, parsed.jobs, parsed.ray, report_cell)


def _table(parsed: argparse.Namespace) -> None:
    if not parsed.results.is_dir():
        raise ValueError(f"{parsed.results}: found no such folder, expected a folder of cells, such as results/mixed")
    name = parsed.results.resolve().name.removesuffix("-validation")
    if parsed.sequence is None and name not in Sequence.names():
        raise ValueError(f"{parsed.results}: found no sequence called {name!r}, expected --sequence with its name or file")
    results = Results(Sequence.load(parsed.sequence or name), parsed.results)
    link = None
    if parsed.figure is not None:
        write_whole(parsed.figure, figure(results).encode())
        link = Path(os.path.relpath(parsed.figure, (parsed.output or Path("page")).parent)).as_posix()
    page = results.markdown(link)
    if parsed.output is None:
        print(page, end="")
    else:
        write_whole(parsed.output, page.encode())


def _check(parsed: argparse.Namespace) -> None:
    names = [parsed.sequence] if parsed.sequence else Sequence.names()
    wrong = [sentence for name in names for sentence in Sequence.load(name).check()]
    if wrong:
        raise ValueError("\n".join(wrong))
    print(f"{', '.join(names)}: worlds and frames have not changed since the sequences were frozen")


def _new(parsed: argparse.Namespace) -> None:
    name = parsed.name
    if not name.isidentifier():
        raise ValueError(f"name: found {name!r}, expected letters, digits and underscores")
    path = Path(f"{name}.py")
    own = "".join(word.capitalize() for word in name.split("_"))
    with path.open("x", encoding="utf-8") as file:
        file.write(_MINE.replace("MyLearner", own).replace("my_learner", name))
    print(f"wrote {path}; try: driftworld benchmark run smoke --learner {path}:{own}")
