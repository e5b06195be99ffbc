"""The native vector environment as PufferLib's ``PufferEnv`` (3.0): one object with many agents.

    import pufferlib.vector
    from driftworld.adapters.pufferlib import DriftworldPuffer

    environments = pufferlib.vector.make(DriftworldPuffer, env_kwargs={"num_envs": 64, "actions": "discrete"})

Observations must be one Box, so ``modalities`` names a single modality, ``"rgb"`` by default. PufferLib provides the
buffers, possibly in shared memory; the native batch's output is copied into them once a step.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

import driftworld  # noqa: F401 - registers the environments

try:
    from pufferlib import PufferEnv
except ImportError as error:
    raise ImportError(
        "driftworld.adapters.pufferlib: found no pufferlib, expected version 3; pip install pufferlib"
    ) from error

__all__ = ["DriftworldPuffer"]


class DriftworldPuffer(PufferEnv):  # type: ignore[misc, unused-ignore] # Any where it is not installed.
    """Environments that step together and reset themselves, like PufferLib's native ones.

    Each finished episode yields one info: ``episode_return``, ``episode_length`` and ``is_success`` (0.0 or 1.0), which
    PufferLib averages, and ``variant_id``.

    Args:
        env_id: Such as ``"driftworld/FindObjects-v0"``.
        num_envs: Number of agents, from 1.
        buf: PufferLib's buffers; ``None`` allocates them.
        seed: Used by the first reset if it is given none.
        **options: Options of the environment, such as ``variant`` or ``size``; a ``Dict`` of modalities is refused.

    Raises:
        ValueError: The observations are not one array.
    """

    def __init__(
        self,
        env_id: str = "driftworld/FindObjects-v0",
        num_envs: int = 1,
        buf: Any = None,
        seed: int | None = None,
        **options: Any,
    ) -> None:
        self.envs: Any = gymnasium.make_vec(
            env_id,
            num_envs=num_envs,
            vectorization_mode="vector_entry_point",
            **{"modalities": "rgb", **options, "info": "full", "autoreset_mode": "same_step", "copy": False},
        )
        self.single_observation_space = self.envs.single_observation_space
        self.single_action_space = self.envs.single_action_space
        self.num_agents = num_envs
        self._seed = seed
        self._variants: list[str] = []
        self._returns = np.zeros(num_envs)
        self._lengths = np.zeros(num_envs, dtype=np.int64)
        if not isinstance(self.single_observation_space, gymnasium.spaces.Box):
            raise ValueError(
                f'modalities: found {self.single_observation_space}, expected a single modality for PufferLib, such as modalities="rgb"'
            )
        super().__init__(buf)

    def reset(self, seed: int | None = None) -> tuple[npt.NDArray[Any], list[dict[str, Any]]]:
        """Starts new episodes in all environments, with the seeds of :func:`driftworld.spread_seeds`."""
        seed, self._seed = self._seed if seed is None else seed, None
        self.observations[:], info = self.envs.reset(seed=seed)
        self._variants = list(info["variant_id"])
        self.rewards[:] = 0
        self.terminals[:] = False
        self.truncations[:] = False
        self.masks[:] = True
        self._returns[:] = 0
        self._lengths[:] = 0
        return self.observations, []

    def step(
        self, actions: npt.NDArray[Any]
    ) -> tuple[npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[Any], list[dict[str, Any]]]:
        """Steps all environments; the returned arrays are PufferLib's buffers."""
        observations, rewards, terminated, truncated, info = self.envs.step(
            np.asarray(actions).reshape(self.envs.action_space.shape)
        )
        self.observations[:] = observations
        self.rewards[:] = rewards
        self.terminals[:] = terminated
        self.truncations[:] = truncated
        self._returns += rewards
        self._lengths += 1
        infos = [self._episode_info(int(index), info) for index in np.flatnonzero(terminated | truncated)]
        return self.observations, self.rewards, self.terminals, self.truncations, infos

    def _episode_info(self, index: int, batch_info: Any) -> dict[str, Any]:
        info = {
            "variant_id": self._variants[index],
            "episode_return": float(self._returns[index]),
            "episode_length": int(self._lengths[index]),
            "is_success": float(batch_info["final_info"]["is_success"][index]),
        }
        self._returns[index] = 0
        self._lengths[index] = 0
        self._variants[index] = batch_info["variant_id"][index]
        return info

    def render(self) -> Any:
        """A picture of the first environment, with ``render_mode="rgb_array"``."""
        pictures = self.envs.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """Marks the environments as closed; their memory is freed when nothing refers to them any more."""
        self.envs.close()
