"""Helpers for tests of learners: random steps, a tiny lifetime, and small learners."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from driftworld import Curriculum, VectorTransition

#: Straight ahead, two curves, two turns nearly on the spot.
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
OPTIONS: dict[str, Any] = {"modalities": "rgb", "actions": ACTIONS, "interact": False, "frame_skip": 5}
T_MAZE = str(ROOT / "examples" / "worlds" / "t_maze.json")
#: Small images and short episodes, for tests in which learning success does not matter.
TINY: dict[str, Any] = {"size": 8, "max_steps": 6}


def package() -> Any:
    """``driftworld.learners``, with torch on one thread; the test is skipped without torch."""
    pytest.importorskip("torch", reason="the learners are networks").set_num_threads(1)
    return importlib.import_module("driftworld.learners")


def small(kind: str = "PPO", **options: Any) -> Any:
    """A learner of four environments with images of 8 × 8 pixels and rollouts of 8 steps."""
    learners = package()
    extra = {"PackNet": {"max_tasks": 2, "task_decisions": 60}, "CLEAR": {"capacity": 6}}.get(kind, {})
    settings = learners.Settings(rollout=8, minibatch=16)
    learner_class = getattr(learners, kind) if isinstance(kind, str) else kind
    return learner_class(5, 4, **{"seed": 3, "size": 8, "settings": settings, **extra, **options})


def curriculum(*order: str, learn: int, evaluate: int = 4, task_label: str = "info") -> Curriculum:
    """Learning blocks of variants of the T-maze, each between evaluations of all variants."""

    def regime(variant: str, count: int, seed: int) -> dict[str, Any]:
        return {"task": T_MAZE, "variant": variant, "count": count, "seed": seed}

    evaluation = {"type": "evaluation", "regimes": [regime(name, evaluate, 1000) for name in dict.fromkeys(order)]}
    blocks = [evaluation]
    for place, name in enumerate(order):
        blocks += [{"type": "learning", "regimes": [regime(name, learn, place)]}, evaluation]
    return Curriculum.from_dict({"version": 1, "name": "tiny", "task_label": task_label, "blocks": blocks})


def run_lifetime(learner: Any, log: Path | None, *order: str, learn: int = 24, **options: Any) -> Any:
    """Runs a learner through a tiny lifetime; returns the learner."""
    plan_options = {name: options.pop(name) for name in ("evaluate", "task_label") if name in options}
    plan = curriculum(*order, learn=learn, **plan_options)
    plan.run_vector(learner, log, num_envs=learner.num_envs, num_threads=1, **{**OPTIONS, **TINY, **options})
    return learner


class Steps:
    """Feeds a learner with seeded random images and rewards."""

    def __init__(
        self, learner: Any, seed: int = 0, terminates: float = 0.1, truncates: float = 0.1, idles: float = 0.1, label: str | None = None
    ) -> None:  # fmt: skip
        self.learner, self.rng = learner, np.random.default_rng(seed)
        self.shares = terminates, truncates, idles
        self.seen = self.images()
        for env in range(learner.num_envs):
            learner.begin(env, label, env)

    def images(self) -> Any:
        shape = (self.learner.num_envs, self.learner.size, self.learner.size, 3)
        return self.rng.integers(0, 256, shape, dtype=np.uint8)

    def take(self, count: int) -> None:
        """Makes the learner act and learn ``count`` times."""
        for _ in range(count):
            actions = self.learner.act(self.seen, {})
            draws = self.rng.random((4, self.learner.num_envs))
            terminated, truncated, idle = (row < share for row, share in zip(draws, self.shares, strict=False))
            following = self.images()
            active = ~idle
            self.learner.learn(
                VectorTransition(
                    self.seen,
                    actions,
                    draws[3] * 100 * active,
                    terminated & active,
                    truncated & active,
                    following,
                    active,
                    {},
                )
            )
            # An ended episode is followed by the first image of the next.
            ended = (terminated | truncated) & active
            self.seen = np.where(ended[:, None, None, None], self.images(), following)
            for env in np.flatnonzero(ended).tolist():
                self.learner.begin(env, self.learner.task, int(self.rng.integers(2**32)))
