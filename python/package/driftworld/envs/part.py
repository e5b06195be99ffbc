"""``Part``: one environment of a ``DriftworldVectorEnv``, for programs that need to access each separately."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from driftworld.envs.options import EnvOptions
from driftworld.envs.single import DriftworldEnv
from driftworld.recordings import Recording

if TYPE_CHECKING:
    from driftworld.envs.vector import DriftworldVectorEnv

#: Constructor options and other values that are fixed once an environment is made.
MADE_WITH = (
    *EnvOptions.__annotations__,
    *("task", "world", "variant", "variants", "render_mode", "render_size", "camera", "max_episode_steps", "num_threads"),
)
#: Constructor options of vector environments only.
_OF_MANY = ("num_envs", "vectorization_mode", "autoreset_mode", "copy", "num_threads", "max_episode_steps")


class Part(gymnasium.Env[Any, Any]):
    """One of the environments that step together. Behaves like a :class:`driftworld.DriftworldEnv`, except that it
    cannot step alone.

    Args:
        envs: The vector environment.
        index: Index of this environment.
    """

    metadata = DriftworldEnv.metadata

    def __init__(self, envs: DriftworldVectorEnv, index: int) -> None:
        self._envs, self._index = envs, index
        self.observation_space = copy.deepcopy(envs.single_observation_space)
        self.action_space = copy.deepcopy(envs.single_action_space)
        self.render_mode = envs.render_mode
        self.metadata = {**type(self).metadata, "render_fps": envs.metadata["render_fps"]}

    @property  # type: ignore[misc]
    def spec(self) -> EnvSpec | None:  # type: ignore[override]
        """The spec from which ``gymnasium.make`` makes one such environment."""
        spec = copy.deepcopy(self._envs.spec)
        if spec is not None:
            limit = spec.kwargs.get("max_episode_steps")
            spec.max_episode_steps = spec.max_episode_steps if limit in (None, -1) else limit
            spec.kwargs = {name: value for name, value in spec.kwargs.items() if name not in _OF_MANY}
        return spec

    @property  # type: ignore[misc]
    def np_random(self) -> np.random.Generator:  # type: ignore[override]
        """Its random generator."""
        return self._envs.np_random[self._index]

    @property
    def np_random_seed(self) -> int:  # type: ignore[override]
        """The seed of its random generator."""
        return self._envs.np_random_seed[self._index]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode here; the other environments continue."""
        return self._envs.reset_one(self._index, seed=seed, options=options)

    def set_next(self, *, variant: Any = None, index: int | None = None, world: Any = None, queue: Any = None) -> None:
        """Sets its next episode, like :meth:`DriftworldEnv.set_next`; the current one continues."""
        self._envs.set_next_one(self._index, variant=variant, index=index, world=world, queue=queue)

    def step(self, action: Any) -> Any:
        """Refused: the environments step together.

        Raises:
            RuntimeError: Always.
        """
        raise RuntimeError(f"step: found one of {self._envs.num_envs} environments, expected step(actions) of all at once")

    def close(self) -> None:
        """Refused: the environments are closed together.

        Raises:
            RuntimeError: Always.
        """
        raise RuntimeError(f"close: found one of {self._envs.num_envs} environments, expected close() of all at once")

    def render(self) -> NDArray[np.uint8] | None:  # type: ignore[override]
        """Its picture, uint8 (height, width, 3).

        Raises:
            gymnasium.error.ResetNeeded: Before its first reset.
        """
        if self.render_mode is None:
            gymnasium.logger.warn('render: found no render_mode, expected render_mode="rgb_array" when they are made')
            return None
        if not self._envs.has_begun[self._index]:
            raise ResetNeeded("render: found an environment that has not been reset, expected a call of reset() first")
        return self._envs.picture(self._index)

    def state(self) -> dict[str, Any]:
        """The current state of its world."""
        return self._envs.state(self._index)

    def origin(self) -> dict[str, Any]:
        """The origin of its world."""
        return self._envs.origin(self._index)

    def warnings(self) -> list[str]:
        """Warnings about its world."""
        return self._envs.warnings(self._index)

    def record(self, records: bool = True) -> None:
        """Starts or stops recording."""
        self._envs.record(records, self._index)

    def recording(self) -> Recording:
        """The recording of its episode so far."""
        return self._envs.recording(self._index)

    def get_keys_to_action(self) -> dict[tuple[str, ...], Any]:
        """Keyboard controls, as in :meth:`DriftworldEnv.get_keys_to_action`."""
        return self._envs.keys_to_action()

    def refuse_to_set(self, name: str, value: Any) -> None:
        """Refuses to set attributes that would have no effect.

        Raises:
            ValueError: For constructor options and built-in attributes.
        """
        if name in MADE_WITH:
            raise ValueError(
                f"set_attr({name!r}): found a constructor option, expected {name}={value!r} when the environments are made; "
                'set_options gives each its own variant or world, as in set_options({"variant": "red"})'
            )
        if hasattr(self, name) and name not in vars(self) or name in ("observation_space", "action_space", "metadata"):
            raise ValueError(
                f"set_attr({name!r}): found a built-in attribute, expected a name that environments do not use; set_options gives "
                "each its own variant or world"
            )
