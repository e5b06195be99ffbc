"""Prints the CPU time per decision of a learner, in microseconds, with 64 environments of 32 × 32 pixels and one thread.

    nice python scripts/learners.py                    # PPO
    nice python scripts/learners.py PPO EWC CLEAR      # some learners, one after another
    nice python scripts/learners.py --quick            # only checks that it runs

Each row has the total for `Curriculum.run_vector` on find_objects#huddle, the learner's share, and the remainder: the
environments and the loop. Only learning blocks are timed; nothing is evaluated. Needs PyTorch.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import torch
from driftworld import Curriculum, learners

ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
NUM_ENVS, EXPERIENCES = 64, 512
OPTIONS: dict[str, Any] = {
    "modalities": "rgb", "size": 32, "actions": ACTIONS, "interact": False, "frame_skip": 5, "max_steps": 60,
}  # fmt: skip
#: Required arguments of learners.
REQUIRED: dict[str, dict[str, Any]] = {"PackNet": {"max_tasks": 2, "task_decisions": 10_000}}


def main() -> None:
    """Runs each learner through two learning blocks: the first is a warm-up, the second is measured."""
    torch.set_num_threads(1)
    names = [name for name in sys.argv[1:] if name != "--quick"]
    count = EXPERIENCES if "--quick" not in sys.argv else NUM_ENVS
    print("| learner | µs per decision | acting and learning | environments and loop |\n|---|--:|--:|--:|")
    for name in names or ["PPO"]:
        learner = getattr(learners, name)(len(ACTIONS), NUM_ENVS, **REQUIRED.get(name, {}))
        marks: list[tuple[float, float, int]] = []
        for variant in ("red", "huddle"):
            block = {
                "type": "learning",
                "regimes": [{"task": "find_objects", "variant": variant, "count": count, "seed": 1}],
            }
            plan = Curriculum.from_dict({"version": 1, "name": "cost", "task_label": "info", "blocks": [block]})
            marks.append((time.process_time(), learner.seconds, learner.decisions))
            plan.run_vector(learner, num_envs=NUM_ENVS, num_threads=1, check_frozen=False, **OPTIONS)
        marks.append((time.process_time(), learner.seconds, learner.decisions))
        seconds, learner_seconds, decisions = (after - before for before, after in zip(marks[1], marks[2], strict=True))
        total, learner_share = 1e6 * seconds / decisions, 1e6 * learner_seconds / decisions
        print(f"| {learner.name} | {total:.0f} | {learner_share:.0f} | {total - learner_share:.0f} |", flush=True)


if __name__ == "__main__":
    main()
