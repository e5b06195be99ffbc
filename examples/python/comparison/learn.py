"""Runs inside one system's environment: PPO learns one task and writes its log, or random actions measure the rate of steps.

    python learn.py learn TASK SEED LOG [DECISIONS]
    python learn.py speed TASK SECONDS

``compare.py`` starts it; every number that the page needs is in what it writes.
"""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from systems import RATES, TASKS

SIZE, NUM_ENVS, ROLLOUT, DECISIONS = 32, 16, 128, 60_000


def processor_seconds() -> float:
    """Of this process and of all that it started, such as ViZDoom's engines."""
    tick, total, left = os.sysconf("SC_CLK_TCK"), time.process_time(), [os.getpid()]
    while left:
        parent = left.pop()
        for children in Path(f"/proc/{parent}/task").glob("*/children"):
            for child in children.read_text().split():
                user, system = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()[11:13]
                total += (int(user) + int(system)) / tick
                left.append(int(child))
    return total


def learn(name: str, seed: int, log: Path, decisions: int) -> None:
    """The budget once. A line for each rollout; the file has its name only when it is whole."""
    task = TASKS[name]
    envs = task.make(NUM_ENVS, SIZE)
    observations, infos = envs.reset(seed=1000 * (seed + 1))
    # torch loads it if it is there, and its LLVM crashes beside the one of Mesa, which draws MiniWorld.
    sys.modules["triton"] = None  # type: ignore[assignment]
    import torch
    from driftworld.learners import PPO, Settings
    from driftworld.vector_lifetimes import VectorTransition

    torch.set_num_threads(1)
    # The one number that is a task's: with it a success pays 1 everywhere.
    settings = Settings(rollout=ROLLOUT, reward_scale=1.0 / task.pays)
    learner = PPO(int(envs.single_action_space.n), NUM_ENVS, seed=seed, size=SIZE, settings=settings)
    for env in range(NUM_ENVS):
        learner.begin(env, None, seed)
    learner.freeze(False)
    said = {
        "task": name, "name": task.name, "seed": seed, "decisions": decisions, "size": SIZE, "num_envs": NUM_ENVS,
        "actions": learner.num_actions, "frames": task.frames, "settings": {key: getattr(settings, key) for key in settings.__slots__},
        "versions": {each: importlib.metadata.version(each) for each in ("torch", "gymnasium", "numpy", "driftworld")},
        "machine": platform.machine(), "began": time.strftime("%Y-%m-%d", time.gmtime()), **getattr(envs, "facts", {}),
    }  # fmt: skip
    partial = log.with_suffix(".part")
    partial.parent.mkdir(parents=True, exist_ok=True)
    ended = np.zeros(NUM_ENVS, dtype=bool)
    outcomes, in_envs, steps = "", 0.0, 0
    began, began_processor = time.perf_counter(), processor_seconds()
    with partial.open("w", encoding="utf-8") as file:
        print(json.dumps(said), file=file)
        while learner.decisions < decisions:
            actions = learner.act(observations, infos)
            before = time.perf_counter()
            following, rewards, terminated, truncated, infos = envs.step(actions)
            in_envs += time.perf_counter() - before
            learner.learn(VectorTransition(observations, actions, rewards, terminated, truncated, following, ~ended, infos))
            ended = terminated | truncated
            outcomes += "".join("01"[int(reward > task.pays / 2)] for reward in rewards[ended])
            observations, steps = following, steps + 1
            if steps % ROLLOUT == 0:
                row = {
                    "decisions": learner.decisions, "wall": round(time.perf_counter() - began, 2),
                    "processor": round(processor_seconds() - began_processor, 2), "in_envs": round(in_envs, 2),
                    "load": round(os.getloadavg()[0], 1), "episodes": outcomes,
                }  # fmt: skip
                print(json.dumps(row), file=file, flush=True)
                outcomes = ""
    envs.close()
    partial.rename(log)


def speed(name: str, seconds: float) -> None:
    """Random actions for so many seconds of the processor, or a rate of ``RATES``; prints how many decisions they were, resets included."""
    work, facts = (RATES[name](), {}) if name in RATES else random_actions(name)
    work()
    count, processor, began, began_processor = 0, 0.0, time.perf_counter(), processor_seconds()
    while processor < seconds:
        count += work()
        processor = processor_seconds() - began_processor
    found = {"task": name, "decisions": count, "wall": round(time.perf_counter() - began, 2), "processor": round(processor, 2)}
    print(json.dumps({**found, "load": round(os.getloadavg()[0], 1), **facts}))


def random_actions(name: str) -> tuple[Callable[[], int], dict[str, Any]]:
    """Steps of all environments of a task, and what its system says of itself."""
    envs = TASKS[name].make(NUM_ENVS, SIZE)
    envs.reset(seed=0)
    table = np.random.default_rng(0).integers(int(envs.single_action_space.n), size=(16, NUM_ENVS))

    def work() -> int:
        for actions in table:
            envs.step(actions)
        return len(table) * NUM_ENVS

    return work, getattr(envs, "facts", {})


if __name__ == "__main__":
    what, name, *rest = sys.argv[1:]
    if what == "learn":
        learn(name, int(rest[0]), Path(rest[1]), int(rest[2]) if len(rest) > 2 else DECISIONS)
    else:
        speed(name, float(rest[0]))
