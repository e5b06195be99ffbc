"""Prints how speed scales with the number of objects, wall corners, environments, threads, worlds in a matrix and rows in a log.

    python scripts/scaling.py [--seconds 0.3] [--rounds 5]

Needs the Python package. Each figure is the best of several rounds. In a round all sizes of a table take turns, so that a busy
moment of the machine affects all of them. Shares compare figures of the same table.
"""

from __future__ import annotations

import argparse
import math
import os
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import driftworld
import gymnasium
import numpy as np
from driftworld import DriftworldVectorEnv, LogWriter

FIND = "find_objects"
#: Colour, depth and reward classes, all as bytes.
BYTES = {"modalities": ("rgb", "depth", "segmentation"), "depth": "uint8"}
#: Environments in the tables of worlds.
FEW = 16

Workloads = dict[str, tuple[Callable[[], Any], int]]


def best(works: Workloads, seconds: float, rounds: int) -> dict[str, float]:
    """The best rate of each workload, in units per second. A workload is a function and its number of units per call."""
    rates = dict.fromkeys(works, 0.0)
    for work, _ in works.values():
        work()
    for _ in range(rounds):
        for name, (work, units) in works.items():
            done, start = 0, time.perf_counter()
            while (passed := time.perf_counter() - start) < seconds or done == 0:
                work()
                done += units
            rates[name] = max(rates[name], done / passed)
    return rates


def table(title: str, rates: dict[str, float], unit: str, base: str) -> None:
    """Prints the rates, and each as a share of one of them."""
    print(f"\n{title}\n{'':<34}{unit:>16}{'  share of ' + base:>36}")
    for name, rate in rates.items():
        print(f"{name:<34}{rate:>16,.0f}{rate / rates[base]:>36.2f}")


def stepping(num_envs: int, threads: int, through_python: bool = True, **options: Any) -> tuple[Callable[[], Any], int]:
    """Steps of a batch, taken from Python or repeated within Rust."""
    where = {} if "world" in options else {"task": FIND}
    envs = DriftworldVectorEnv(num_envs=num_envs, num_threads=threads, copy=False, **where, **options)
    envs.reset(seed=0)
    envs.action_space.seed(0)
    actions = envs.action_space.sample()
    times = max(1, 256 // num_envs)
    if not through_python:
        envs.step(actions)
        return lambda: envs._members.batch.repeat(times), times * num_envs

    def work() -> None:
        for _ in range(times):
            envs.step(actions)

    return work, times * num_envs


def arena(num_objects: int = 20, corners: int = 0) -> dict[str, Any]:
    """A world of 100 × 100 m without time limit, with objects on a spiral and round walls of 12 corners each."""
    turn = math.pi * (3.0 - math.sqrt(5.0))
    object_positions = [(45.0 * math.sqrt((at + 0.5) / num_objects), at * turn) for at in range(num_objects)]
    ring = [math.tau * corner / 12 for corner in range(12)]
    num_walls = corners // 12
    wall_centres = [(47.0 * math.sqrt((at + 0.5) / max(num_walls, 1)), 1.0 + at * turn) for at in range(num_walls)]
    return {
        "version": 1,
        "max_steps": 0,
        "max_seconds": 0,
        "environment_params": {
            "map_size": [100.0, 100.0],
            "walls": [
                {"polygon": [[r * math.sin(a) + 0.4 * math.sin(c), r * math.cos(a) + 0.4 * math.cos(c)] for c in ring]}
                for r, a in wall_centres
            ],
        },
        "agent_params": {"coordinates": [0.0, 0.0], "actions": "normalized"},
        "objects": [
            {"class": "geometric", "model": "1", "coordinates": [r * math.sin(a), r * math.cos(a)], "color": [a % 1.0, 0.3, 0.6]}
            for r, a in object_positions
        ],
    }


def stepping_in(worlds: dict[str, dict[str, Any]]) -> Workloads:
    """Steps in each world, with colour images of 64 × 64, on one thread."""
    return {name: stepping(FEW, 1, world=world, size=64, modalities="rgb") for name, world in worlds.items()}


def write_log(folder: Path, rows: int) -> Path:
    """Writes a log of two tasks that are learned in turn and evaluated before and after each block."""
    path = folder / f"log-{rows}"
    rng = np.random.default_rng(0)
    with LogWriter(path, "reward", scenario_info={"scenario_type": "custom"}) as log:
        experience = 0
        for block in range(9):
            kind = "train" if block % 2 else "test"
            tasks = [("red_a", "blue_a")[block // 2 % 2]] if block % 2 else ["red_a", "blue_a"]
            for task in tasks:
                for _ in range(rows // 9 // len(tasks)):
                    reward = experience / rows + rng.normal()
                    log.write(block_num=block, exp_num=experience, block_type=kind, task_name=task, reward=reward)
                    experience += 1
    return path


def main(arguments: Sequence[str] | None = None) -> None:
    """Measures and prints every table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=0.3, help="length of a round of one figure (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=5, help="number of rounds, of which the best counts (default: %(default)s)")
    settings = parser.parse_args(arguments)
    if settings.seconds <= 0.0 or settings.rounds < 1:
        parser.error("expected --seconds above 0 and --rounds of at least 1")

    def measured(works: Workloads) -> dict[str, float]:
        return best(works, settings.seconds, settings.rounds)

    load = ", ".join(f"{one:.1f}" for one in os.getloadavg())
    print(f"driftworld {driftworld.__version__}, gymnasium {gymnasium.__version__}, {os.cpu_count()} processors, load {load}")
    size = (120, 160)
    table(
        "Steps at 160 × 120 in colour, depth and classes, all as bytes: 64 environments on one thread",
        measured({"in Rust": stepping(64, 1, False, size=size, **BYTES), "through Python": stepping(64, 1, size=size, **BYTES)}),
        "steps a second",
        "in Rust",
    )
    counts = {f"{n} on {t} thread{'s' * (t > 1)}": (n, t) for t in (1, 2) for n in (1, 16, 64, 256, 1024, 4096) if n >= t}
    works = {name: stepping(n, t, size=64, modalities="rgb") for name, (n, t) in counts.items()}
    table("Environments of find_objects in colour at 64 × 64, through Python", measured(works), "steps a second", "16 on 1 thread")
    objects = {f"{n} objects": arena(n) for n in (20, 100, 500, 2000)}
    table("Objects in an arena of 100 × 100 m", measured(stepping_in(objects)), "steps a second", "20 objects")
    corners = {f"{n} corners": arena(20, n) for n in (0, 120, 1200, 6000)}
    table("Corners of walls in the same arena, 20 objects", measured(stepping_in(corners)), "steps a second", "0 corners")
    variants = [f"{FIND}#{name}" for name in driftworld.TaskSpec.load(FIND).variant_names()]

    def matrix(worlds: int) -> tuple[Callable[[], Any], int]:
        pairs = len(variants) * (len(variants) - 1) // 2
        return lambda: driftworld.distance_matrix(variants, by="worlds", worlds=worlds), pairs * worlds

    works = {f"{n} worlds of each variant": matrix(n) for n in (4, 16, 64)}
    table(f"Pairs of worlds in a matrix of {len(variants)} variants", measured(works), "pairs a second", "4 worlds of each variant")
    with tempfile.TemporaryDirectory() as folder:

        def scoring(rows: int) -> tuple[Callable[[], Any], int]:
            path = write_log(Path(folder), rows)
            return lambda: driftworld.metrics(path), rows

        works = {f"{n:,} rows": scoring(n) for n in (900, 9_000, 90_000)}
        table("Rows of a log, read and scored", measured(works), "rows a second", "9,000 rows")


if __name__ == "__main__":
    main()
