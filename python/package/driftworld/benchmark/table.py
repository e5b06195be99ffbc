"""Tables of finished runs, made from the logs alone."""

from __future__ import annotations

import json
import tarfile
import tempfile
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from driftworld.benchmark.measures import Floats, Matrix, interquartile_mean, interval
from driftworld.benchmark.sequence import Sequence
from driftworld.logs import read_log

#: Share of the scale above which a task counts as learned.
LEARNED = 0.5


@dataclass(frozen=True)
class Run:
    """One finished cell.

    Attributes:
        folder: Its folder.
        report: The learner's report.
        sampled: Evaluations with sampled actions.
        greedy: Evaluations with the likeliest actions; the first row is the sampling policy's, before any learning.
        rewards: Rewards of the learning episodes, for each task.
    """

    folder: Path
    report: dict[str, Any]
    sampled: Matrix
    greedy: Matrix
    rewards: tuple[Floats, ...]

    @classmethod
    def read(cls, folder: Path, sequence: Sequence) -> Run:
        """Reads a cell from its report and its logs."""
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        with tempfile.TemporaryDirectory() as place:
            with tarfile.open(folder / "logs.tar.xz") as tar:
                tar.extractall(place, filter="data")
            evaluated, rewards, steps = _of_log(Path(place) / "sampled", sequence)
            greedy = [_of_log(log, sequence)[0][0] for log in sorted(Path(place).glob("greedy-*"))]
        curves = tuple(sequence.scaled(task, earned) for task, earned in zip(sequence.tasks, rewards, strict=True))
        return cls(
            folder=folder, report=report, sampled=Matrix(np.array(evaluated), curves, tuple(steps)),
            greedy=Matrix(np.array([evaluated[0], *greedy]), curves, tuple(steps)), rewards=tuple(rewards),
        )  # fmt: skip


def _of_log(log: Path, sequence: Sequence) -> tuple[list[Floats], list[Floats], list[Floats]]:
    """A matrix row for each evaluation block; rewards and lengths of episodes for each learning block."""
    columns = read_log(log).columns
    blocks, rewards = columns["block_num"], columns["reward"].astype(float)
    names = [sequence.logged(task) for task in sequence.tasks]
    evaluated, learned, steps = [], [], []
    for block in np.unique(blocks):
        here = blocks == block
        if columns["block_type"][here][0] == "train":
            learned.append(rewards[here])
            steps.append(columns["episode_step_count"][here].astype(float))
            continue
        means = [rewards[here & (columns["task_name"] == name)].mean() for name in names]
        evaluated.append(np.array([sequence.scaled(task, mean) for task, mean in zip(sequence.tasks, means, strict=True)]))
    return evaluated, learned, steps


@dataclass(frozen=True)
class Results:
    """All finished cells of a sequence.

    Args:
        sequence: The sequence.
        folder: The runner's output folder, such as ``results/mixed``.
    """

    sequence: Sequence
    folder: Path

    @cached_property
    def runs(self) -> dict[str, list[Run]]:
        """The finished runs by learner, in the order of seeds.

        Raises:
            ValueError: If there are no finished cells.
        """
        found: dict[str, list[Run]] = {}
        for report in sorted(self.folder.glob("*/*/report.json"), key=lambda path: (path.parts[-3], int(path.parts[-2]))):
            run = Run.read(report.parent, self.sequence)
            found.setdefault(run.report["label"], []).append(run)
        if not found:
            raise ValueError(f"{self.folder}: found no finished cell, expected LEARNER/SEED/report.json")
        return found

    def rows(self) -> list[dict[str, Any]]:
        """One row for each learner: every measure as ``(mean, low, high)``, the interquartile mean over seeds and its
        interval.
        """
        alone = {run.report["seed"]: run.sampled for run in self.runs.get("from_scratch", [])}
        measures: dict[str, Callable[[Run], float | None]] = {
            "performance": lambda run: run.sampled.performance(),
            "greedy": lambda run: run.greedy.performance(),
            "learned": lambda run: float(run.sampled.learned().mean()),
            "share": lambda run: float((run.sampled.learned() >= LEARNED).mean()),
            "forgetting": lambda run: run.sampled.forgetting(),
            "forward": lambda run: run.sampled.forward_transfer(alone[run.report["seed"]]) if run.report["seed"] in alone else None,
            "backward": lambda run: run.sampled.backward(),
            "seconds": lambda run: float(run.report["seconds"]),
            "memory": lambda run: float(run.report["memory_bytes"]),
        }  # fmt: skip
        rows = []
        for label, runs in self.runs.items():
            row: dict[str, Any] = {"learner": label, "seeds": len(runs), "pairs": sum(run.report["seed"] in alone for run in runs)}
            for name, measure in measures.items():
                values = [value for run in runs if (value := measure(run)) is not None and not np.isnan(value)]
                row[name] = (interquartile_mean(values), *interval(values)) if values else None
            rows.append(row)
        return sorted(rows, key=lambda row: -row["performance"][0])

    def markdown(self, figure: str | None = None) -> str:
        """A page with the table, a figure if a link is given, each task of each learner, and the limits of the
        results.
        """
        shown = ["", f"![]({figure})", "", _FIGURE] if figure else []
        runs = [run for runs in self.runs.values() for run in runs]
        hours = sum(run.report["seconds"] for run in runs) / 3600
        made = f"Made from the logs of {len(runs)} lifetimes, {hours:.1f} hours of learning on one core: `driftworld benchmark table`."
        parts = [*_head(self.sequence), "", *self._table(), *shown, "", *self._tasks(), "", *_FOOT.splitlines(), "", made, ""]
        return "\n".join(parts)

    def _table(self) -> list[str]:
        lines = [
            "| learner | seeds | performance | greedy | just learned | tasks learned | forgetting | forward transfer | backward transfer | processor s | MB |",
            "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
        ]
        for row in self.rows():
            cells = [_cell(row[name]) for name in ("performance", "greedy", "learned", "share", "forgetting", "forward", "backward")]
            if row["forward"] is not None and row["pairs"] < row["seeds"]:
                cells[5] += f", {row['pairs']} seeds"
            own = [f"{row['seconds'][0]:.0f}", f"{row['memory'][0] / 1e6:.1f}"]
            lines.append("| " + " | ".join([f"`{row['learner']}`", str(row["seeds"]), *cells, *own]) + " |")
        return lines

    def _tasks(self) -> list[str]:
        lines = [
            "Each task just after it was learned → at the end, the mean over seeds; in brackets, the number of seeds that learned it.",
            "",
            "| learner | " + " | ".join(f"`{task}`" for task in self.sequence.tasks) + " |",
            "|---|" + "--:|" * len(self.sequence.tasks),
        ]
        for label, runs in self.runs.items():
            learned, ends = np.array([run.sampled.learned() for run in runs]), np.array([run.sampled.values[-1] for run in runs])
            cells = [
                f"{100 * learned[:, i].mean():.0f} → {100 * ends[:, i].mean():.0f} ({(learned[:, i] >= LEARNED).sum()})" for i in range(learned.shape[1])
            ]
            lines.append(f"| `{label}` | " + " | ".join(cells) + " |")
        return lines


def _cell(value: tuple[float, float, float] | None) -> str:
    if value is None:
        return "–"
    mean, low, high = (round(100 * number) for number in value)
    # One seed has no interval.
    return f"{mean}" if value[0] == value[1] == value[2] else f"{mean} ({low} to {high})"


def _head(sequence: Sequence) -> list[str]:
    """The title, a description of the sequence, and the meaning of the columns."""
    title, about, *rest = _HEAD.format(sequence=sequence, share=LEARNED).split("\n\n")
    return "\n\n".join([title, textwrap.fill(about, 120), *rest]).splitlines()


_HEAD = """# Learners compared in the sequence `{sequence.name}`

{sequence.about} {sequence.decisions:,} decisions a task; after each task every task is evaluated in {sequence.evaluations} worlds that no
learner trains in. Numbers are per cent of the way from a random agent (0) to the planner (100), which knows the map and acts in every time
step. Each number is the interquartile mean over seeds of the mean over tasks, with the 95 % interval of a bootstrap over seeds in
brackets.

- *performance*: all tasks at the end, with actions sampled from the policy: the main result. *greedy*: the same with
  the likeliest actions.
- *just learned*: each task right after it was learned. *tasks learned*: the share of tasks that reached {share:.0%} by then.
- *forgetting*: just learned minus the end. *backward transfer*: the same with the opposite sign, without the last task.
- *forward transfer*: how much more was earned while learning than by `from_scratch` in the same worlds, as a share of what
  was left to gain (Continual World's measure, from learning episodes weighted by their length, one number a seed).
- *processor s*: processor seconds of acting while learning and of updates, on one core. *MB*: the learner's whole state."""

_FIGURE = """Mean of all tasks after each task, with sampled actions. Bold: interquartile mean; thin: each seed; grey: `finetuning`."""

_FOOT = """Limits: one sequence in one order, one network, one budget. Seeds vary worlds and learners together, and few seeds give wide
intervals: learners whose intervals overlap cannot be distinguished. Observations do not
name the task: contradictory tasks can only be distinguished by their surroundings. `packnet` knows the task, in
evaluations too, and some others know when a task begins (`borders` in `report.json`): compare only rows of the same kind."""
