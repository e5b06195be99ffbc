"""Trains PPO in the first variant of each family, and writes examples/families_learned.json, from which
scripts/families.py draws curves.

    nice python scripts/learn_families.py [NAME]... [--seeds 3] [--jobs 2]

Records for each seed the mean reward of episodes in ten equal parts of the training, weighted by their decisions, and
afterwards the mean reward and the success rate in 100 other worlds, with sampled actions. In the memory families,
recurrent PPO is trained too. Entries already in the file are not run again. Needs PyTorch.
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
from driftworld import Curriculum
from driftworld.logs import read_log

ROOT = Path(__file__).parents[1]
LEARNED, MEASURED = ROOT / "examples/families_learned.json", ROOT / "examples/families.json"
DECISIONS, NUM_ENVS, WORLDS, PARTS = 100_000, 64, 100, 10
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
OPTIONS: dict[str, Any] = {"modalities": "rgb", "size": 32, "actions": ACTIONS, "interact": False, "frame_skip": 5}
#: Settings of PPO that differ from its defaults; rewards are scaled so that the planner earns about 2.
SETTINGS: dict[str, dict[str, Any]] = {
    "ppo": {"annealing": DECISIONS},
    "recurrent_ppo": {"annealing": DECISIONS, "entropy": 0.02, "epochs": 3},
}


def learn(name: str, variant: str, learner: str, seed: int, scale: float) -> tuple[str, str, dict[str, Any]]:
    """Trains one seed of a learner in one family; returns the family, the learner, and the results."""
    import torch
    from driftworld.learners import PPO, RecurrentPPO, Settings

    torch.set_num_threads(1)
    blocks = [
        {"type": "learning", "regimes": [{"task": name, "variant": variant, "count": DECISIONS, "steps": DECISIONS, "seed": 2 * seed}]},
        {"type": "evaluation", "regimes": [{"task": name, "variant": variant, "count": WORLDS, "seed": 2 * seed + 1}]},
    ]
    plan = Curriculum.from_dict({"version": 1, "name": "one_family", "blocks": blocks})
    learner_class = {"ppo": PPO, "recurrent_ppo": RecurrentPPO}[learner]
    agent = learner_class(len(ACTIONS), NUM_ENVS, seed=seed, size=32, settings=Settings(**SETTINGS[learner], reward_scale=scale))
    with tempfile.TemporaryDirectory() as folder:
        plan.run_vector(agent, Path(folder) / "log", num_envs=NUM_ENVS, num_threads=1, check_frozen=False, **OPTIONS)
        columns = read_log(Path(folder) / "log").columns
    learning = columns["block_type"] == "train"
    rewards, steps = columns["reward"][learning].astype(float), columns["episode_step_count"][learning].astype(float)
    part = np.minimum((np.cumsum(steps) - steps / 2) * PARTS / steps.sum(), PARTS - 1).astype(int)
    curve = [float(np.average(rewards[part == k], weights=steps[part == k])) for k in range(PARTS)]
    found = {
        "seed": seed, "curve": [round(each, 2) for each in curve], "reward": round(float(columns["reward"][~learning].astype(float).mean()), 2),
        "success": round(float(columns["success"][~learning].astype(float).mean()), 2), "processor_seconds": round(agent.seconds),
    }  # fmt: skip
    return name, learner, found


def main() -> None:
    """Trains the learners and seeds that the file lacks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    measured = json.loads(MEASURED.read_text(encoding="utf-8"))
    learned = json.loads(LEARNED.read_text(encoding="utf-8")) if LEARNED.is_file() else {}
    memory = driftworld.task_groups()["memory"]
    pending = []
    for seed in range(arguments.seeds):
        for name in arguments.names or measured:
            for learner in ["ppo", "recurrent_ppo"] if name in memory else ["ppo"]:
                if all(run["seed"] != seed for run in learned.get(name, {}).get(learner, [])):
                    variant, scale = next(iter(measured[name].items()))
                    pending.append((name, variant, learner, seed, 2.0 / (scale["planner"] - scale["random"])))
    with ProcessPoolExecutor(arguments.jobs, mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        for done in as_completed([pool.submit(learn, *each) for each in pending]):
            name, learner, found = done.result()
            runs = [*learned.get(name, {}).get(learner, []), found]
            learned.setdefault(name, {})[learner] = sorted(runs, key=lambda run: run["seed"])
            ordered = {each: learned[each] for each in measured if each in learned}
            rows = re.sub(r"\{\s+\"seed\".*?\}", lambda run: " ".join(run[0].split()), json.dumps(ordered, indent=1), flags=re.DOTALL)
            LEARNED.write_text(rows + "\n", encoding="utf-8")
            print(name, learner, found["seed"], found["reward"], found["success"], flush=True)


if __name__ == "__main__":
    main()
