"""Runs inside one system's environment: PPO learns one task and writes its log, or random actions measure the rate of steps.

    python learn.py learn TASK SEED LOG [DECISIONS]
    python learn.py speed TASK SECONDS

``compare.py`` starts it; every number that the page needs is in its output.
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
    """Processor seconds of this process and of all that it started, such as ViZDoom's engines."""
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
    """Learns for a budget of decisions. Writes a line for each rollout; the log gets its name when it is complete."""
    task = TASKS[name]
    envs = task.make(NUM_ENVS, SIZE)
    observations, infos = envs.reset(seed=1000 * (seed + 1))
    # torch loads triton if it is installed, and triton's LLVM crashes together with Mesa's, which renders MiniWorld.
    sys.modules["triton"] = None  # type: ignore[assignment]
    import torch
    from driftworld.learners import PPO, Settings
    from driftworld.vector_lifetimes import VectorTransition

    torch.set_num_threads(1)
    # The only setting that depends on the task: it scales a success to 1.
    settings = Settings(rollout=ROLLOUT, reward_scale=1.0 / task.pays)
    learner = PPO(int(envs.single_action_space.n), NUM_ENVS, seed=seed, size=SIZE, settings=settings)
    for env in range(NUM_ENVS):
        learner.begin(env, None, seed)
    learner.freeze(False)
    header = {
        "task": name, "name": task.name, "seed": seed, "decisions": decisions, "size": SIZE, "num_envs": NUM_ENVS,
        "actions": learner.num_actions, "frames": task.frames, "settings": {key: getattr(settings, key) for key in settings.__slots__},
        "versions": {each: importlib.metadata.version(each) for each in ("torch", "gymnasium", "numpy", "driftworld")},
        "machine": platform.machine(), "began": time.strftime("%Y-%m-%d", time.gmtime()), **getattr(envs, "facts", {}),
    }  # fmt: skip
    partial = log.with_suffix(".part")
    partial.parent.mkdir(parents=True, exist_ok=True)
    ended = np.zeros(NUM_ENVS, dtype=bool)
    outcomes, in_envs, steps = "", 0.0, 0
    start, start_processor = time.perf_counter(), processor_seconds()
    with partial.open("w", encoding="utf-8") as file:
        print(json.dumps(header), file=file)
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
                    "decisions": learner.decisions, "wall": round(time.perf_counter() - start, 2),
                    "processor": round(processor_seconds() - start_processor, 2), "in_envs": round(in_envs, 2),
                    "load": round(os.getloadavg()[0], 1), "episodes": outcomes,
                }  # fmt: skip
                print(json.dumps(row), file=file, flush=True)
                outcomes = ""
    envs.close()
    partial.rename(log)


def speed(name: str, seconds: float) -> None:
    """Takes random actions, or steps of an entry in ``RATES``, for this many processor seconds; prints the number of
    decisions, resets included.
    """
    work, facts = (RATES[name](), {}) if name in RATES else random_actions(name)
    work()
    count, processor, start, start_processor = 0, 0.0, time.perf_counter(), processor_seconds()
    while processor < seconds:
        count += work()
        processor = processor_seconds() - start_processor
    found = {"task": name, "decisions": count, "wall": round(time.perf_counter() - start, 2), "processor": round(processor, 2)}
    print(json.dumps({**found, "load": round(os.getloadavg()[0], 1), **facts}))


def random_actions(name: str) -> tuple[Callable[[], int], dict[str, Any]]:
    """A function that steps all environments of a task, and facts about its system."""
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
