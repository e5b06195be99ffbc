"""Measures how well each task of a sequence is learned after each other task, by fine-tuning on all pairs.

A pair that ends at the random agent's rewards, or at the planner's, does not distinguish learners. Each task is
evaluated in 100 worlds. Finished pairs are not run again. Prints a table:

    python scripts/predecessors.py SEQUENCE RESULTS [--seed S] [--jobs N]
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import tempfile
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from driftworld.benchmark import Sequence
from driftworld.benchmark.runner import Cell, make_learner
from driftworld.curricula import Curriculum
from driftworld.logs import read_log

#: Number of worlds in which a task is evaluated.
WORLDS = 100


def measure(sequence: Sequence, results: Path, seed: int, before: str | None) -> None:
    """Writes the result of each task learned after the task `before`, or from scratch if that is `None`."""
    import torch

    torch.set_num_threads(1)
    file = results / f"{seed}-{before or 'nothing'}.json"
    found = json.loads(file.read_text()) if file.is_file() else {}
    with tempfile.TemporaryDirectory() as folder:
        trained = Path(folder) / "before.pt"
        for task in sequence.tasks:
            if task == before or task in found:
                continue
            if before is not None and not trained.is_file():
                learner = run_task(sequence, seed, [before], Path(folder) / "before")
                learner.save(trained)
            log = Path(folder) / sequence.logged(task)
            run_task(sequence, seed, [before, task] if before else [task], log, trained if before else None)
            columns = read_log(log).columns
            rewards = columns["reward"][(columns["block_type"] == "test") & (columns["task_name"] == sequence.logged(task))].astype(float)
            found[task] = round(float(sequence.scaled(task, rewards.mean())), 4)
            file.write_text(json.dumps(found, indent=1) + "\n")


def run_task(sequence: Sequence, seed: int, tasks: list[str], log: Path, checkpoint: Path | None = None):
    """Trains on the last of the tasks; the others only determine its worlds."""
    short = dataclasses.replace(sequence, tasks=tasks)
    scenario = short.curriculum(seed).scenario
    learning = [block for block in scenario["blocks"] if block["type"] == "learning"][-1]
    [evaluation] = [block for block in scenario["blocks"] if block["type"] == "evaluation"][-1:]
    learner = make_learner(Cell(sequence.name, "finetuning", seed), short, "sampled")
    if checkpoint is not None:
        learner.load(checkpoint)
    curriculum = Curriculum.from_dict({**scenario, "form": "custom", "blocks": [learning, evaluation]})
    curriculum.run_vector(learner, log, num_envs=sequence.num_envs, num_threads=1, **sequence.options)
    return learner


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence")
    parser.add_argument("results", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    sequence = dataclasses.replace(Sequence.load(arguments.sequence), evaluations=WORLDS)
    arguments.results.mkdir(parents=True, exist_ok=True)
    tasks = list(dict.fromkeys(sequence.tasks))
    with ProcessPoolExecutor(arguments.jobs, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        list(pool.map(partial(measure, sequence, arguments.results, arguments.seed), [None, *tasks]))
    print("| after | " + " | ".join(f"`{task}`" for task in tasks) + " |\n|---|" + "--:|" * len(tasks))
    for before in [None, *tasks]:
        found = json.loads((arguments.results / f"{arguments.seed}-{before or 'nothing'}.json").read_text(encoding="utf-8"))
        cells = [f"{100 * found[task]:.0f}" if task in found else "" for task in tasks]
        print(f"| {f'`{before}`' if before else 'nothing'} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
