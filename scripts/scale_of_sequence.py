"""Measures the values of "scale" and "frozen" for the JSON file of a sequence of driftworld.benchmark.

    python scripts/scale_of_sequence.py mixed target/release/driftworld

The scale's 0 is the reward of random rows of the action table, and its 1 that of the planner, which knows the map and
acts in every time step; both in 500 worlds that no lifetime uses. A planner that holds its actions as long as the
learners do would not be a ceiling: they reached 113 % of it in moving_object#fast.
"""

from __future__ import annotations

import json
import subprocess
import sys

import driftworld
import numpy as np
from driftworld.benchmark import Sequence

WORLDS, SEED = 500, 77


def random(task: str, sequence: Sequence) -> float:
    """Mean reward of random rows of the action table."""
    envs = driftworld.DriftworldVectorEnv(task, WORLDS, **sequence.options)
    rng, earned, running = np.random.default_rng(SEED), np.zeros(WORLDS), np.ones(WORLDS, dtype=bool)
    envs.reset(seed=SEED)
    while running.any():
        _, rewards, terminated, truncated, _ = envs.step(rng.integers(len(sequence.options["actions"]), size=WORLDS))
        earned += rewards * running
        running &= ~(terminated | truncated)
    return float(earned.mean())


def planner(task: str, command: str) -> float:
    """Mean reward of the planner."""
    words = [command, "scales", task, "--worlds", str(WORLDS), "--seed", str(SEED), "--json"]
    output = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    (scale,) = output["scales"].values()
    return float(scale["ceiling"])


def main() -> None:
    """Prints both rewards."""
    sequence, command = Sequence.load(sys.argv[1]), sys.argv[2]
    tasks = list(dict.fromkeys(sequence.tasks))
    scale = {task: [round(random(task, sequence), 2), round(planner(task, command), 2)] for task in tasks}
    print(json.dumps({"scale": scale, "frozen": {task: sequence.prints(task) for task in tasks}}, indent=1))


if __name__ == "__main__":
    main()
