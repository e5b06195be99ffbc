"""Compares MiniGrid, MiniWorld, ViZDoom and Driftworld under one PPO: installs them, runs them, and writes docs/comparison.md.

    python examples/python/comparison/compare.py install WHEEL   # an environment of Python for each system; WHEEL is of `scripts/dist.sh`
    python examples/python/comparison/compare.py run             # three seeds of each task; a run whose log is there is not repeated
    python examples/python/comparison/compare.py speed           # steps a second alone, the systems in turn
    python examples/python/comparison/compare.py page            # docs/comparison.md from the logs; with --check compares

Needs Python 3.10 or later and Linux; MiniWorld needs Mesa (Debian: libegl-mesa0 libgl1-mesa-dri libglu1-mesa).
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
SYSTEMS = ["minigrid", "miniworld", "vizdoom", "driftworld"]
SEEDS = range(3)
#: Successes among the last hundred episodes that count as learned.
SCORE, WINDOW = 0.8, 100


def tasks() -> dict[str, Any]:
    """The systems and their tasks, by the names of their logs."""
    return json.loads((HERE / "tasks.json").read_text(encoding="utf-8"))


# --- installing and running -------------------------------------------------------------------------------------------


def install(wheel: Path, envs: Path, torch: Path | None, only: list[str]) -> None:
    """Makes environments, and writes down how long each took and how large it is. ``torch`` is a folder of packages with torch."""
    noted = LOGS / "install.json"
    found = json.loads(noted.read_text(encoding="utf-8")) if noted.is_file() else {}
    for system in only or [*SYSTEMS, *([] if torch else ["learner"])]:
        folder = envs / system
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        before = size(folder)
        what = ["-r", str(HERE / f"requirements/{system}.txt"), *([str(wheel)] if system == "driftworld" else [])]
        began = time.perf_counter()
        pip = [str(folder / "bin/python"), "-m", "pip", "install", "--quiet", "--no-cache-dir", "--disable-pip-version-check"]
        subprocess.run([*pip, *what], check=True)
        seconds = time.perf_counter() - began
        found[system] = {"seconds": round(seconds, 1), "megabytes": round((size(folder) - before) / 1e6), "load": round(os.getloadavg()[0], 1)}
        print(system, found[system], flush=True)
        if system != "learner":
            # Looked into behind the system's own packages, whose versions come first.
            others = [torch or own_packages(envs / "learner"), own_packages(envs / "driftworld")]
            own = own_packages(folder)
            (own / "zz_learner.pth").write_text("".join(f"{each}\n" for each in others if each != own), encoding="utf-8")
    write(noted, json.dumps({system: found[system] for system in SYSTEMS if system in found}, indent=1) + "\n")


def own_packages(environment: Path) -> Path:
    """Where an environment of Python has its packages, made or not."""
    return environment / f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"


def size(folder: Path) -> int:
    """Bytes of the files in a folder."""
    return sum(each.lstat().st_size for each in folder.rglob("*") if each.is_file())


def python(envs: Path, system: str, core: int, *arguments: str) -> str:
    """What ``learn.py`` prints in the environment of a system, on one core."""
    program = [str(envs / system / "bin/python"), "-W", "ignore", str(HERE / "learn.py"), *arguments]
    # ViZDoom leaves a file of settings in the folder that it runs in.
    done = subprocess.run(["taskset", "-c", str(core), *program], check=False, capture_output=True, text=True, cwd=envs)
    if done.returncode:
        raise SystemExit(f"{system}: found exit code {done.returncode} of {' '.join(program)}\n{done.stderr[-2000:]}")
    return done.stdout


def run(envs: Path, cores: list[int]) -> None:
    """All seeds of all tasks whose logs are not there, one at a time on each core."""
    wanted = [(name, seed) for seed in SEEDS for name in tasks()["tasks"]]
    left = [(name, seed) for name, seed in wanted if not log_of(name, seed).is_file()]

    def one(core: int) -> None:
        while left:
            name, seed = left.pop(0)
            python(envs, tasks()["tasks"][name]["system"], core, "learn", name, str(seed), str(log_of(name, seed)))
            print(log_of(name, seed).relative_to(ROOT), flush=True)

    with ThreadPoolExecutor(len(cores)) as pool:
        list(pool.map(one, cores))


def speed(envs: Path, core: int, repeats: int, seconds: float) -> None:
    """Rates without a learner, the systems in turn, so that a busy moment falls on all of them."""
    rows = []
    systems = {name: task["system"] for name, task in tasks()["tasks"].items()}
    systems |= {name: rate["system"] for name, rate in tasks()["rates"].items()}
    for repeat in range(repeats):
        for name, system in systems.items():
            printed = python(envs, system, core, "speed", name, str(seconds))
            rows.append(json.dumps({"repeat": repeat, **json.loads(printed.splitlines()[-1])}))
            print(rows[-1], flush=True)
    write(LOGS / "speed.jsonl", "".join(f"{row}\n" for row in rows))


def log_of(name: str, seed: int) -> Path:
    """Where the log of a run is."""
    return LOGS / name / f"{seed}.jsonl"


def write(path: Path, text: str) -> None:
    """Writes a file whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.with_suffix(".part").write_text(text, encoding="utf-8")
    path.with_suffix(".part").rename(path)


# --- reading ----------------------------------------------------------------------------------------------------------


def read(path: Path) -> list[dict[str, Any]]:
    """The lines of a log."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def summary(name: str, seed: int) -> dict[str, Any]:
    """What a run came to."""
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
    """Successes among episodes."""
    return outcomes.count("1") / max(1, len(outcomes))


def rates(rows: Iterable[dict[str, Any]], name: str) -> list[float]:
    """Decisions in a second of one core, of each repeat in order."""
    return [row["decisions"] / row["processor"] for row in sorted(rows, key=lambda row: row["repeat"]) if row["task"] == name]


# --- the page ---------------------------------------------------------------------------------------------------------


def versions(systems: dict[str, str]) -> list[str]:
    """The peers with the versions that are installed."""
    lists = {key: (HERE / f"requirements/{key}.txt").read_text(encoding="utf-8").splitlines() for key in systems}
    found = {key: [line.partition("==")[2] for line in lines if line.startswith(f"{key}==")] for key, lines in lists.items()}
    return [f"{systems[key]} {own[0]}" for key, own in found.items() if own]


def spread(values: list[float], form: str) -> str:
    """The least and the largest of some numbers, or both in one if they look alike."""
    ends = [format(each, form) for each in (min(values), max(values))]
    return ends[0] if ends[0] == ends[1] else f"{ends[0]} to {ends[1]}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """Markdown; all but the first two columns are numbers."""
    lines = [head, ["---" if column < 2 else "--:" for column in range(len(head))], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def rounded(rate: float) -> str:
    """A rate to two digits: more of them do not repeat."""
    digits = len(str(int(rate))) - 2
    return f"{round(rate, -digits):,.0f}"


def page() -> str:
    """The page."""
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
            f"{100 * rate / statistics.median(rates(measured, name)):.0f} %",
        ])  # fmt: skip
    for name, task in named["tasks"].items():
        own = rates(measured, name)
        frames = task["frames"]
        alone.append([
            named["systems"][task["system"]], f"`{task['name']}`", rounded(statistics.median(own)),
            f"{rounded(min(own))} to {rounded(max(own))}", rounded(frames * statistics.median(own)),
        ])  # fmt: skip
    for peer, ours in named["pairs"]:
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
    texts = {
        "unfinished": f"**Not finished**: of {len(SEEDS)} seeds these are missing: {unfinished}. `compare.py run` runs them. " * bool(unfinished),
        "learned": table(
            ["system", "task", "seeds", "first 100, %", "last 100, %", "learned", "after, thousand decisions",
             "minutes of a core", "decisions a second", "environment's part"], learned),
        "alone": table(["system", "task", "decisions a second", "range", "steps of the engine a second"], alone),
        "beside": table(["peer", "ours", "peer's rate", "our rate", "ratio", "range of ratios"], beside),
        "installed": table(
            ["system", "what it needs beside Python", "seconds", "load average", "MB on disk"],
            [[named["systems"][key], named["needs"][key], f"{each['seconds']:.0f}", f"{each['load']:.0f}", f"{each['megabytes']}"] for key, each in installed.items()]),
        "decisions": f"{head['decisions']:,}", "size": str(head["size"]), "num_envs": str(head["num_envs"]), "settings": settings,
        "load": spread(loads, ".0f"), "speed_load": spread([row["load"] for row in measured], ".0f"),
        "repeats": str(1 + max(row["repeat"] for row in measured)), "score": f"{100 * SCORE:.0f}", "window": str(WINDOW),
        "versions": ", ".join(f"{key} {value}" for key, value in head["versions"].items()),
        "systems": ", ".join(versions(named["systems"])), "date": min(run["head"]["began"] for found in runs.values() for run in found),
    }  # fmt: skip
    text = (HERE / "page.md").read_text(encoding="utf-8")
    for key, value in texts.items():
        text = text.replace("{" + key + "}", value.rstrip("\n"))
    return "\n\n".join(wrapped(part) for part in text.split("\n\n"))


def wrapped(part: str) -> str:
    """A paragraph in lines of at most 120 letters; anything else as it is."""
    is_paragraph = not part.startswith(("#", "|", "- ", "```"))
    end = "\n" if part.endswith("\n") else ""
    return textwrap.fill(part, 120, break_long_words=False, break_on_hyphens=False) + end if is_paragraph else part


def main() -> None:
    """Runs the command."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--envs", type=Path, default=ROOT / "target/comparison", help="where the environments of Python are")
    commands = parser.add_subparsers(dest="command", required=True)
    installing = commands.add_parser("install")
    installing.add_argument("wheel", type=Path)
    installing.add_argument("--only", action="append", default=[], choices=[*SYSTEMS, "learner"], help="one environment alone; repeatable")
    installing.add_argument("--torch", type=Path, metavar="SITE_PACKAGES", help="packages with torch that are there already, in place of new ones")
    commands.add_parser("run").add_argument("--cores", default="0", help="such as 0,1: a run at a time on each")
    fast = commands.add_parser("speed")
    fast.add_argument("--core", type=int, default=0)
    fast.add_argument("--repeats", type=int, default=3)
    fast.add_argument("--seconds", type=float, default=2.0, help="of the processor, for each rate in each repeat")
    commands.add_parser("page").add_argument("--check", action="store_true", help="fail if the page is not that of the logs")
    given = parser.parse_args()
    given.envs = given.envs.resolve()
    if given.command == "install":
        install(given.wheel.resolve(), given.envs, given.torch, given.only)
    elif given.command == "run":
        run(given.envs, [int(core) for core in given.cores.split(",")])
    elif given.command == "speed":
        speed(given.envs, given.core, given.repeats, given.seconds)
    elif given.check and PAGE.read_text(encoding="utf-8") != page():
        raise SystemExit("docs/comparison.md: found another page than that of the logs; run python examples/python/comparison/compare.py page")
    elif not given.check:
        write(PAGE, page())


if __name__ == "__main__":
    main()
