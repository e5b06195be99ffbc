"""An environment for Syllabus (``syllabus-rl`` 0.7), whose curricula choose the variant of each episode.

    env = DriftworldTaskEnv(gymnasium.make("driftworld/FindObjects-v0"), {"red": 486.0, "blue": 486.0, "dusk": 450.0})
    replay = {"strategy": "value_l1", "replay_schedule": "fixed"}
    curriculum = CentralPrioritizedLevelReplay(env.task_space, num_processes=1, task_sampler_kwargs_dict=replay)
    shared = make_multiprocessing_curriculum(curriculum)
    env = GymnasiumSyncWrapper(env, env.task_space, shared.components)

Version 0.7 does not install ``matplotlib`` and ``scipy``, makes NumPy raise an error at each underflow, and needs the
schedule above. With NumPy 1.25, learning progress needs a subclass whose ``_sample_distribution`` is
``list(super()._sample_distribution())``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium

try:
    from syllabus.core import TaskWrapper
    from syllabus.task_space import DiscreteTaskSpace
except ImportError as error:
    raise ImportError(
        "driftworld.adapters.syllabus: found no syllabus, expected version 0.7; pip install syllabus-rl matplotlib scipy"
    ) from error

__all__ = ["DriftworldTaskEnv"]


class DriftworldTaskEnv(TaskWrapper):  # type: ignore[misc, unused-ignore] # Any where it is not installed.
    """An environment whose tasks are variants, by number. Each episode has one task; a change takes effect at the next
    reset.

    After each step ``info["task_completion"]`` is the episode's reward as a share of the ceiling, 0 to 1;
    ``info["task"]`` is the task. Learning progress needs ``continuous_progress=True``, otherwise only reaching the full
    ceiling counts.

    Args:
        env: From ``gymnasium.make``.
        ceilings: An expert's reward (``driftworld scales``) by variant name; the variants are the tasks, in this order.

    Attributes:
        task_space: The task space to pass to Syllabus's curricula.
        variants: The names of the tasks.

    Raises:
        ValueError: If there is no variant, or a ceiling is not above 0.
        TaskError: If a name is not that of a variant of the task.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], ceilings: Mapping[str, float]) -> None:
        super().__init__(env)
        if not ceilings or min(ceilings.values()) <= 0:
            raise ValueError(f"ceilings: found {dict(ceilings)!r}, expected numbers above 0, by variant name")
        for name in ceilings:
            env.unwrapped._members.checked({"variant": name}, many=False)  # type: ignore[attr-defined]
        self.variants, self.ceilings = list(ceilings), list(ceilings.values())
        # Numbers, because prioritized level replay makes an array of them.
        self.task_space = DiscreteTaskSpace(len(ceilings))
        self.task = self._next = 0
        self._earned = 0.0

    def reset(
        self, new_task: int | None = None, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode of ``new_task``, or of the task set last."""
        if new_task is not None:
            self.change_task(new_task)
        self.task, self._earned, self.task_completion = self._next, 0.0, 0.0
        observation, info = self.env.reset(seed=seed, options={**(options or {}), "variant": self.variants[self.task]})
        return observation, {**info, "task": self.task, "task_completion": 0.0}

    def change_task(self, new_task: int) -> None:
        """Sets the task of the next episode."""
        if new_task not in range(len(self.variants)):
            raise ValueError(f"task: found {new_task!r}, expected 0 to {len(self.variants) - 1}")
        self._next = int(new_task)

    def _task_completion(self, obs: Any, rew: Any, term: bool, trunc: bool, info: dict[str, Any]) -> float:
        self._earned += float(rew)
        return min(max(self._earned / self.ceilings[self.task], 0.0), 1.0)
