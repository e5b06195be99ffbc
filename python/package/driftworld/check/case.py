"""``Case``: makes each kind of environment that the rules compare, from a task and its options."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import gymnasium

#: Maximum number of steps of an episode: short, so that a check contains many ends and restarts.
SHORT_EPISODE = 9


@dataclass(frozen=True)
class Case:
    """A task with the options and the size of a check."""

    env_id: str
    options: dict[str, Any]
    num_envs: int
    steps: int
    seed: int

    def single(self, **more: Any) -> gymnasium.Env[Any, Any]:
        return gymnasium.make(self.env_id, disable_env_checker=True, **{**self.options, **more})

    def bare(self, **more: Any) -> gymnasium.Env[Any, Any]:
        """The single environment without Gymnasium's wrappers."""
        return self.single(**more).unwrapped

    def native(self, **more: Any) -> Any:
        options = {"max_episode_steps": SHORT_EPISODE, **self.options, **more}
        return gymnasium.make_vec(
            self.env_id, num_envs=self.num_envs, vectorization_mode="vector_entry_point", **options
        )

    def gymnasiums(self, mode: str, **vector_kwargs: Any) -> Any:
        """The same environments in Gymnasium's own vector loop: ``"sync"``, or ``"async"`` with a process for each."""
        options = {"max_episode_steps": SHORT_EPISODE, **self.options}
        return gymnasium.make_vec(
            self.env_id, num_envs=self.num_envs, vectorization_mode=mode, vector_kwargs=vector_kwargs, **options
        )

    def actions(self, space: gymnasium.Space[Any]) -> list[Any]:
        """Random actions, the same at every call."""
        space.seed(self.seed)
        return [space.sample() for _ in range(self.steps)]
