"""Compares MiniGrid, MiniWorld, ViZDoom, JAXenstein and Driftworld with the same PPO, and writes docs/comparison.md.

    python examples/python/comparison/compare.py all WHEEL       # everything below; resumes an interrupted call
    python examples/python/comparison/compare.py install WHEEL   # a Python environment for each system
    python examples/python/comparison/compare.py run             # three seeds of each task, except runs that have a log
    python examples/python/comparison/compare.py speed           # steps a second without a learner; the systems take turns
    python examples/python/comparison/compare.py page            # docs/comparison.md from the logs; --check only compares it

`scripts/dist.sh` makes WHEEL. Needs Python 3.10 or later and Linux; MiniWorld needs Mesa (Debian: libegl-mesa0
libgl1-mesa-dri libglu1-mesa). JAXenstein is in no package registry: it is left out unless --jaxenstein CHECKOUT, before the
command, names a checkout of its repository.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
LOGS, PAGE = HERE / "logs", ROOT / "docs/comparison.md"
SYSTEMS = ["minigrid", "miniworld", "vizdoom", "jaxenstein", "driftworld"]
SEEDS = range(3)
NUMBERS = ["no", "one", "two", "three", "four", "five"]
#: A task counts as learned when the share of successes in the last `WINDOW` episodes reaches `SCORE`.
SCORE, WINDOW = 0.8, 100


def tasks() -> dict[str, Any]:
    """The systems and their tasks, by log name."""
    return json.loads((HERE / "tasks.json").read_text(encoding="utf-8"))


# --- installing and running -------------------------------------------------------------------------------------------


class Systems:
    """The Python environments in a folder, and JAXenstein's checkout, if there is one."""

    def __init__(self, envs: Path, checkout: Path | None) -> None:
        self.envs, self.checkout = envs.resolve(), checkout.resolve() if checkout else None
        if self.checkout and not (self.checkout / "jaxenstein/__init__.py").is_file():
            raise SystemExit(f"--jaxenstein: found no jaxenstein/__init__.py in {checkout}, expected a checkout of JAXenstein's repository")
        self.names = [name for name in SYSTEMS if checkout or name != "jaxenstein"]

    def requested(self, kinds: list[str], only: list[str]) -> dict[str, str]:
        """The requested tasks (and rates) of the available systems, each with its system."""
        found = {name: task["system"] for kind in kinds for name, task in tasks()[kind].items() if not only or name in only}
        left = [name for name, system in found.items() if system not in self.names]
        if left:
            print(f"left out, without --jaxenstein CHECKOUT: {', '.join(left)}", flush=True)
        return {name: system for name, system in found.items() if name not in left}

    def python(self, system: str, core: int, *arguments: str) -> str:
        """Runs ``learn.py`` in a system's environment, on one core; returns its output."""
        program = [str(self.envs / system / "bin/python"), "-W", "ignore", str(HERE / "learn.py"), *arguments]
        paths = [str(self.checkout)] if system == "jaxenstein" else []
        variables = {**os.environ, "PYTHONPATH": os.pathsep.join([*paths, *filter(None, [os.environ.get("PYTHONPATH")])])}
        # ViZDoom leaves a settings file in its working directory.
        command = ["taskset", "-c", str(core), *program]
        done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=self.envs, env=variables)
        if done.returncode:
            raise SystemExit(f"{system}: found exit code {done.returncode} of {' '.join(program)}\n{done.stderr[-2000:]}")
        return done.stdout


def install(systems: Systems, wheel: Path, torch: Path | None, only: list[str], keep: bool) -> None:
    """Creates environments, and records the seconds that each took and its size.

    ``torch`` is a folder of packages that contains torch. With ``keep``, existing environments are kept, and only the
    wheel is installed again.
    """
    record = LOGS / "install.json"
    found = json.loads(record.read_text(encoding="utf-8")) if record.is_file() else {}
    for system in only or [*systems.names, *([] if torch else ["learner"])]:
        folder = systems.envs / system
        pip = [str(folder / "bin/python"), "-m", "pip", "install", "--quiet", "--no-cache-dir", "--disable-pip-version-check"]
        path_file = own_packages(folder) / "zz_learner.pth"
        if keep and path_file.is_file():
            if system == "driftworld":
                subprocess.run([*pip, "--force-reinstall", "--no-deps", str(wheel)], check=True)
            continue
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        before = size(folder)
        what = ["-r", str(HERE / f"requirements/{system}.txt"), *([str(wheel)] if system == "driftworld" else [])]
        start = time.perf_counter()
        subprocess.run([*pip, *what], check=True)
        seconds = time.perf_counter() - start
        found[system] = {"seconds": round(seconds, 1), "megabytes": round((size(folder) - before) / 1e6), "load": round(os.getloadavg()[0], 1)}
        print(system, found[system], flush=True)
        # Python searches these folders after the system's own packages, so the system's versions take precedence.
        others = [torch or own_packages(systems.envs / "learner"), own_packages(systems.envs / "driftworld")]
        path_file.write_text("".join(f"{each}\n" for each in others if system != "learner" and each != path_file.parent), encoding="utf-8")
    write(record, json.dumps({system: found[system] for system in SYSTEMS if system in found}, indent=1) + "\n")


def own_packages(environment: Path) -> Path:
    """The folder of a Python environment's packages, which need not exist yet."""
    return environment / f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"


def size(folder: Path) -> int:
    """Bytes of the files in a folder."""
    return sum(each.lstat().st_size for each in folder.rglob("*") if each.is_file())


def run(systems: Systems, cores: list[int], seeds: range, only: list[str], decisions: int | None, anew: bool) -> None:
    """Runs all seeds of all tasks that have no log, one at a time on each core."""
    requested = systems.requested(["tasks"], only)
    for log in [log_of(name, seed) for seed in seeds for name in requested if anew]:
        log.unlink(missing_ok=True)
    left = [(name, seed) for seed in seeds for name in requested if not log_of(name, seed).is_file()]

    def one(core: int) -> None:
        while left:
            name, seed = left.pop(0)
            start = time.perf_counter()
            rest = [str(decisions)] if decisions else []
            systems.python(requested[name], core, "learn", name, str(seed), str(log_of(name, seed)), *rest)
            print(f"{name}, seed {seed}: {time.perf_counter() - start:.0f} s", flush=True)

    with ThreadPoolExecutor(len(cores)) as pool:
        try:
            list(pool.map(one, cores))
        finally:
            # After an error or an interrupt, no core starts another run.
            left.clear()


def speed(systems: Systems, core: int, repeats: int, seconds: float, only: list[str], anew: bool) -> None:
    """Measures rates without a learner. The systems take turns, so that a busy moment affects all of them. Complete
    repeats are kept.
    """
    path, requested = LOGS / "speed.jsonl", systems.requested(["tasks", "rates"], only)
    old = [row for row in read(path) if not (anew and row["task"] in requested)] if path.is_file() else []
    for repeat in range(repeats):
        rows = [row for row in old if row["repeat"] == repeat]
        if not requested.keys() <= {row["task"] for row in rows}:
            for name, system in requested.items():
                printed = systems.python(system, core, "speed", name, str(seconds))
                rows = [row for row in rows if row["task"] != name] + [{"repeat": repeat, **json.loads(printed.splitlines()[-1])}]
                print(json.dumps(rows[-1]), flush=True)
        old = [row for row in old if row["repeat"] != repeat] + rows
        write(path, "".join(f"{json.dumps(row)}\n" for row in sorted(old, key=lambda row: row["repeat"])))


def log_of(name: str, seed: int) -> Path:
    """The path of a run's log."""
    return LOGS / name / f"{seed}.jsonl"


def write(path: Path, text: str) -> None:
    """Writes a file atomically."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.with_suffix(".part").write_text(text, encoding="utf-8")
    path.with_suffix(".part").rename(path)


# --- reading ----------------------------------------------------------------------------------------------------------


def read(path: Path) -> list[dict[str, Any]]:
    """The lines of a log."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def summary(name: str, seed: int) -> dict[str, Any]:
    """The results of a run."""
    head, *rows = read(log_of(name, seed))
    outcomes, reached = "", None
    for row in rows:
        outcomes += row["episodes"]
        if reached is None and len(outcomes) >= WINDOW and outcomes[-WINDOW:].count("1") >= SCORE * WINDOW:
            reached = row
    last = rows[-1]
    return {
        "first": share(outcomes[:WINDOW]), "last": share(outcomes[-WINDOW:]), "reached": reached, "loads": [row["load"] for row in rows],
        "rate": last["decisions"] / last["processor"],
        "head": head,
    }  # fmt: skip


def share(outcomes: str) -> float:
    """The share of successes among episodes."""
    return outcomes.count("1") / max(1, len(outcomes))


def rates(rows: Iterable[dict[str, Any]], name: str) -> list[float]:
    """Decisions per second of one core, for each repeat in order."""
    return [row["decisions"] / row["processor"] for row in sorted(rows, key=lambda row: row["repeat"]) if row["task"] == name]


# --- the page ---------------------------------------------------------------------------------------------------------


def versions(systems: dict[str, str]) -> list[str]:
    """The peers with their installed versions."""
    lists = {key: (HERE / f"requirements/{key}.txt").read_text(encoding="utf-8").splitlines() for key in systems}
    found = {key: [line.partition("==")[2] for line in lines if line.startswith(f"{key}==")] for key, lines in lists.items()}
    return [f"{systems[key]} {own[0]}" for key, own in found.items() if own]


def joined(names: list[str]) -> str:
    """Names joined as in a sentence."""
    return " and ".join([", ".join(names[:-1]), names[-1]])


def spread(values: list[float], form: str) -> str:
    """The minimum and maximum of some numbers, or one number if both look the same."""
    ends = [format(each, form) for each in (min(values), max(values))]
    return ends[0] if ends[0] == ends[1] else f"{ends[0]} to {ends[1]}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """Markdown; all but the first two columns are numbers."""
    lines = [head, ["---" if column < 2 else "--:" for column in range(len(head))], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def rounded(rate: float) -> str:
    """A rate rounded to two digits, because further digits are not reproducible."""
    digits = len(str(int(rate))) - 2
    return f"{round(rate, -digits):,.0f}"


def page() -> str:
    """The page as Markdown."""
    named = tasks()
    runs = {name: [summary(name, seed) for seed in SEEDS if log_of(name, seed).is_file()] for name in named["tasks"]}
    runs = {name: found for name, found in runs.items() if found}
    measured = read(LOGS / "speed.jsonl")
    installed = json.loads((LOGS / "install.json").read_text(encoding="utf-8"))
    learned, alone, beside = [], [], []
    for name, found in runs.items():
        task, reached = named["tasks"][name], [run["reached"] for run in found if run["reached"]]
        label = named["systems"][task["system"]]
        learned.append([
            label, f"`{task['name']}`", str(len(found)), spread([100 * run["first"] for run in found], ".0f"),
            spread([100 * run["last"] for run in found], ".0f"), f"{len(reached)} of {len(found)}",
            spread([row["decisions"] / 1000 for row in reached], ".0f") if reached else "–",
            spread([row["processor"] / 60 for row in reached], ".2f") if reached else "–",
            rounded(rate := statistics.median(run["rate"] for run in found)),
            f"{100 * rate / statistics.median(own):.0f} %" if (own := rates(measured, name)) else "–",
        ])  # fmt: skip
    for name, task in named["tasks"].items():
        if not (own := rates(measured, name)):
            continue
        frames = task["frames"]
        alone.append([
            named["systems"][task["system"]], f"`{task['name']}`", rounded(statistics.median(own)),
            f"{rounded(min(own))} to {rounded(max(own))}", rounded(frames * statistics.median(own)),
        ])  # fmt: skip
    for peer, ours in named["pairs"]:
        if not (rates(measured, peer) and rates(measured, ours)):
            continue
        each = [b / a for a, b in zip(rates(measured, peer), rates(measured, ours), strict=True)]
        what = {**named["tasks"], **named["rates"]}
        beside.append([f"{named['systems'][what[peer]['system']]}, `{what[peer]['name']}`", f"`{what[ours]['name']}`",
                       f"{rounded(statistics.median(rates(measured, peer)))}", f"{rounded(statistics.median(rates(measured, ours)))}",
                       f"{statistics.median(each):.1f}", spread(each, ".1f")])  # fmt: skip
    loads = [load for found in runs.values() for run in found for load in run["loads"]]
    head = next(iter(runs.values()))[0]["head"]
    settings = ", ".join(f"{key} {value:g}" for key, value in head["settings"].items() if key != "reward_scale")
    missing = {name: len(SEEDS) - len(runs.get(name, [])) for name in named["tasks"]}
    unfinished = ", ".join(f"{count} of {name}" for name, count in missing.items() if count)
    heads = [run["head"] for found in runs.values() for run in found]
    compiled = [row["compiling"] for row in (*heads, *measured) if "compiling" in row]
    commits = [f"JAXenstein at commit {each}" for each in sorted({head["commit"] for head in heads if "commit" in head})]
    shown = {named["tasks"][name]["system"] for name in runs}
    texts = {
        "count": NUMBERS[len(shown)], "names": joined([label for key, label in named["systems"].items() if key in shown]),
        "benchmarks": "[Benchmarks](benchmarks.md)",  # A link relative to docs/, where the template is not.
        "compiled": f"in {spread(compiled, '.1f')} processor seconds" if compiled else "not measured here",
        "unfinished": f"**Not finished**: of {len(SEEDS)} seeds these are missing: {unfinished}. `compare.py run` runs them. " * bool(unfinished),
        "learned": table(
            ["system", "task", "seeds", "first 100, %", "last 100, %", "learned", "after, thousand decisions",
             "core minutes", "decisions a second", "environment's part"], learned),
        "alone": table(["system", "task", "decisions a second", "range", "steps of the engine a second"], alone),
        "beside": table(["peer", "ours", "peer's rate", "our rate", "ratio", "range of ratios"], beside),
        "installed": table(
            ["system", "requirements besides Python", "seconds", "load average", "MB on disk"],
            [[named["systems"][key], named["needs"][key], f"{each['seconds']:.0f}", f"{each['load']:.0f}", f"{each['megabytes']}"] for key, each in installed.items()]),
        "decisions": f"{head['decisions']:,}", "size": str(head["size"]), "num_envs": str(head["num_envs"]), "settings": settings,
        "load": spread(loads, ".0f"), "speed_load": spread([row["load"] for row in measured], ".0f"),
        "repeats": str(1 + max(row["repeat"] for row in measured)), "score": f"{100 * SCORE:.0f}", "window": str(WINDOW),
        "versions": ", ".join(
            f"{key} {' or '.join(sorted({each['versions'].get(key, '?') for each in heads}))}" for key in head["versions"]),
        "systems": ", ".join([*versions(named["systems"]), *commits]), "date": min(head["began"] for head in heads),
    }  # fmt: skip
    text = (HERE / "page.md").read_text(encoding="utf-8")
    for key, value in texts.items():
        text = text.replace("{" + key + "}", value.rstrip("\n"))
    return "\n\n".join(wrapped(part) for part in text.split("\n\n"))


def wrapped(part: str) -> str:
    """Wraps a paragraph at 120 characters; returns anything else unchanged."""
    is_paragraph = not part.startswith(("#", "|", "- ", "```"))
    end = "\n" if part.endswith("\n") else ""
    return textwrap.fill(part, 120, break_long_words=False, break_on_hyphens=False) + end if is_paragraph else part


def main() -> None:
    """Runs the command."""
    global LOGS, PAGE
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--envs", type=Path, default=ROOT / "target/comparison", help="folder of the Python environments")
    parser.add_argument("--jaxenstein", type=Path, metavar="CHECKOUT", help="a checkout of JAXenstein's repository; without it, JAXenstein is left out")
    parser.add_argument("--logs", type=Path, help="another folder for the logs and the page")
    building, working, running, measuring = (argparse.ArgumentParser(add_help=False) for _ in range(4))
    building.add_argument("wheel", type=Path)
    building.add_argument("--torch", type=Path, metavar="SITE_PACKAGES", help="an existing site-packages folder with torch, instead of installing torch")
    working.add_argument("--cores", default="0", help="cores to use, such as 0,1: one run at a time on each; rates are measured on the first")
    names = [*tasks()["tasks"], *tasks()["rates"]]
    working.add_argument("--only", action="append", default=[], choices=names, metavar="NAME", help=f"only this task or rate, repeatable: {', '.join(names)}")
    working.add_argument("--anew", action="store_true", help="remove the logs first; by default, logged runs are not repeated")
    running.add_argument("--seeds", type=int, default=len(SEEDS))
    running.add_argument("--decisions", type=int, help="a different budget, for a trial")
    measuring.add_argument("--repeats", type=int, default=3)
    measuring.add_argument("--seconds", type=float, default=2.0, help="processor seconds for each rate in each repeat")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("all", parents=[building, working, running, measuring])
    installing = commands.add_parser("install", parents=[building])
    installing.add_argument("--only", action="append", default=[], choices=[*SYSTEMS, "learner"], help="only this environment; repeatable")
    commands.add_parser("run", parents=[working, running])
    commands.add_parser("speed", parents=[working, measuring])
    commands.add_parser("page").add_argument("--check", action="store_true", help="fail if the page does not match the logs")
    given = parser.parse_args()
    if given.logs:
        LOGS, PAGE = given.logs.resolve(), given.logs.resolve() / "comparison.md"
    systems, everything = Systems(given.envs, given.jaxenstein), given.command == "all"
    if everything or given.command == "install":
        install(systems, given.wheel.resolve(), given.torch and given.torch.resolve(), [] if everything else given.only, keep=everything)
    if everything or given.command == "run":
        run(systems, [int(core) for core in given.cores.split(",")], range(given.seeds), given.only, given.decisions, given.anew)
    if everything or given.command == "speed":
        speed(systems, int(given.cores.split(",")[0]), given.repeats, given.seconds, given.only, given.anew)
    if given.command == "page" and given.check:
        if PAGE.read_text(encoding="utf-8") != page():
            raise SystemExit("docs/comparison.md: found a page that does not match the logs; run python examples/python/comparison/compare.py page")
    elif everything or given.command == "page":
        write(PAGE, page())


if __name__ == "__main__":
    main()
