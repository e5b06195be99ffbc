"""Provides the native vector environment as Stable-Baselines3's ``VecEnv``.

    from driftworld.adapters.sb3 import make_vec_env
    from stable_baselines3 import PPO

    PPO("CnnPolicy", make_vec_env("driftworld/FindObjects-v0", num_envs=16, seed=0, modalities="rgb", actions="discrete")).learn(100_000)

``Agent`` works the other way round: it runs a Stable-Baselines3 model through a Driftworld curriculum.

Observations are copies, because Stable-Baselines3 keeps the last one while the next is computed. ``DummyVecEnv`` works
without this adapter, but steps one environment at a time.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, cast

import gymnasium
import numpy as np
import numpy.typing as npt

import driftworld
from driftworld.envs.part import Part

try:
    from stable_baselines3.common.vec_env import VecEnv, VecMonitor
except ImportError as error:
    raise ImportError(
        'driftworld.adapters.sb3: found no stable_baselines3, expected version 2.4 or later; pip install "stable-baselines3>=2.4"'
    ) from error

from driftworld.adapters.sb3_agent import Agent

__all__ = ["Agent", "DriftworldVecEnv", "make_vec_env"]


def make_vec_env(
    env_id: str,
    num_envs: int = 1,
    seed: int | None = None,
    *,
    monitor_dir: str | None = None,
    **options: Any,
) -> VecEnv:
    """Makes environments that step together, as a ``VecEnv``.

    Args:
        env_id: Such as ``"driftworld/FindObjects-v0"``.
        num_envs: Number of environments, from 1.
        seed: The seed from which :func:`driftworld.spread_seeds` derives the worlds; ``None`` draws a random seed.
        monitor_dir: A folder for ``monitor.csv``, which lists the returns of all episodes; ``None`` writes no file. In
            both cases ``info["episode"]`` has return and length, so that Stable-Baselines3 prints ``ep_rew_mean``.
        **options: Options of the environment, such as ``variant``, ``modalities`` or ``num_threads``;
            ``autoreset_mode`` and ``copy`` are fixed.

    Returns:
        A :class:`DriftworldVecEnv` wrapped in ``VecMonitor``.
    """
    environments = DriftworldVecEnv(env_id, num_envs, **options)
    environments.seed(seed)
    return _Monitor(environments, monitor_dir)


class DriftworldVecEnv(VecEnv):  # type: ignore[misc, unused-ignore] # Any where it is not installed.
    """The native vector environment behind Stable-Baselines3's interface.

    When an episode ends, the step returns the next episode's first observation, as Stable-Baselines3 expects; ``info``
    then has ``"terminal_observation"`` and ``"TimeLimit.truncated"``, and its other entries belong to the step itself.
    ``get_attr``, ``set_attr`` and ``env_method`` work on each environment, as in ``DummyVecEnv``; calls that would have
    no effect are rejected.

    Args:
        env_id: Such as ``"driftworld/FindObjects-v0"``.
        num_envs: Number of environments, from 1.
        **options: Options of the environment.

    Attributes:
        envs: The underlying Gymnasium vector environment; stepping it directly would put Stable-Baselines3 out of sync.
    """

    def __init__(self, env_id: str, num_envs: int = 1, **options: Any) -> None:
        refused = sorted({"autoreset_mode", "copy"} & options.keys())
        if refused:
            raise ValueError(
                f"{refused[0]}: found it among the options, expected none: Stable-Baselines3 needs same_step and copies"
            )
        self.envs: Any = gymnasium.make_vec(
            env_id,
            num_envs=num_envs,
            vectorization_mode="vector_entry_point",
            autoreset_mode="same_step",
            copy=True,
            **options,
        )
        self._native = cast(driftworld.DriftworldVectorEnv, self.envs.unwrapped)
        self._parts = [Part(self._native, index) for index in range(num_envs)]
        self._actions: npt.NDArray[Any] | None = None
        super().__init__(num_envs, self.envs.single_observation_space, self.envs.single_action_space)

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """Sets the seeds of the next reset, by :func:`driftworld.spread_seeds`; ``None`` draws a random seed. Returns
        each environment's seed.
        """
        if seed is None:
            seed = int(np.random.randint(0, np.iinfo(np.int32).max))
        self._seeds: list[int | None] = list(driftworld.spread_seeds(seed, self.num_envs))
        return self._seeds

    def set_options(self, options: Sequence[dict[str, Any]] | dict[str, Any] | None = None) -> None:
        """Sets the options of each environment from its next episode on; also works during ``learn``.

        Args:
            options: Options of a single environment's reset: one dictionary for all, or a list with one for each, such
                as ``[{"variant": "red"}, {"variant": "blue"}]``. The next :meth:`reset` applies them too.
        """
        if options is not None and not isinstance(options, dict) and len(options) != self.num_envs:
            raise ValueError(f"set_options: found a list of {len(options)}, expected one dictionary, or a list of {self.num_envs}")
        super().set_options(cast(Any, options))
        groups = self._groups()
        try:
            for wanted, _ in groups:
                unknown = sorted(wanted.keys() - _NEXT_OPTIONS)
                if unknown:
                    raise ValueError(f"set_options: found {unknown[0]!r}, expected some of {', '.join(_NEXT_OPTIONS)}")
                # Check all options before any environment is changed.
                self._native.check_next(**wanted)
        except Exception:
            self._reset_options()
            raise
        for wanted, mask in groups:
            self.envs.set_next(**wanted, mask=mask)

    def reset(self) -> Any:
        """Starts new episodes in all environments, with the seeds and options set before; each is used only once.

        Returns:
            The first observations, ``(num_envs, …)``.
        """
        observations: Any = None
        try:
            for options, mask in self._groups():
                seeds = [seed if is_in else None for seed, is_in in zip(self._seeds, mask, strict=True)]
                # The mask is passed even if it selects all environments: then each has its own queue, like a single environment.
                wanted: dict[str, Any] = {**options, "reset_mask": mask}
                observations, vector_info = self.envs.reset(
                    seed=seeds if any(seed is not None for seed in seeds) else None, options=wanted
                )
                for index in np.flatnonzero(mask):
                    self.reset_infos[index] = _info_of(vector_info, int(index))
        finally:
            # Also after an error, so that invalid options are not applied again.
            self._reset_seeds()
            self._reset_options()
        return observations

    def _groups(self) -> list[tuple[dict[str, Any], npt.NDArray[np.bool_]]]:
        """The distinct options, each with a mask of the environments that have them."""
        groups: list[tuple[dict[str, Any], npt.NDArray[np.bool_]]] = []
        for index, options in enumerate(self._options):
            mask = next((mask for known, mask in groups if known == options), None)
            if mask is None:
                mask = np.zeros(self.num_envs, dtype=np.bool_)
                groups.append((options, mask))
            mask[index] = True
        return groups

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        """Stores the actions, ``(num_envs, …)``, for :meth:`step_wait`."""
        self._actions = actions

    def step_wait(self) -> tuple[Any, npt.NDArray[np.float32], npt.NDArray[np.bool_], list[dict[str, Any]]]:
        """Steps all environments; returns observations, rewards (float32), dones, and one info for each."""
        if self._actions is None:
            raise RuntimeError("step_wait: found no actions, expected a call of step_async first; or call step(actions)")
        observations, rewards, terminated, truncated, vector_info = self.envs.step(self._actions)
        self._actions = None
        dones = np.logical_or(terminated, truncated)
        infos: list[dict[str, Any]] = []
        for index in range(self.num_envs):
            info = _info_of(vector_info, index)
            if dones[index]:
                info.pop("final_obs", None)
                last = info.pop("final_info", {})
                self.reset_infos[index] = info
                info = {**last, "terminal_observation": vector_info["final_obs"][index]}
            info["TimeLimit.truncated"] = bool(truncated[index] and not terminated[index])
            infos.append(info)
        return observations, np.asarray(rewards, dtype=np.float32), dones, infos

    def close(self) -> None:
        """Marks the environments as closed; may be called repeatedly. Their memory is freed once nothing refers to them."""
        self.envs.close()

    def get_images(self) -> Sequence[npt.NDArray[np.uint8] | None]:
        """A picture of each environment; ``None`` for each unless ``render_mode="rgb_array"``."""
        pictures = self.envs.render()
        return list(pictures) if pictures is not None else [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: int | Iterable[int] | None = None) -> list[Any]:
        """An attribute of each of these environments, as in ``DummyVecEnv``.

        Raises:
            AttributeError: If there is no such attribute.
        """
        return [part.get_wrapper_attr(attr_name) for part in self._select(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: int | Iterable[int] | None = None) -> None:
        """Sets a user-defined attribute in each of these environments, for :meth:`get_attr`.

        Raises:
            ValueError: For a constructor option or a built-in attribute, because setting it would have no effect.
        """
        chosen = self._select(indices)
        for part in chosen:
            part.refuse_to_set(attr_name, value)
        for part in chosen:
            setattr(part, attr_name, value)

    def env_method(
        self,
        method_name: str,
        *method_args: Any,
        indices: int | Iterable[int] | None = None,
        **method_kwargs: Any,
    ) -> list[Any]:
        """Calls a method of each of these environments, as in ``DummyVecEnv``.

        ``"reset"`` starts an episode in these environments only; the next step returns the remaining results.

        Raises:
            AttributeError: If there is no such method.
            RuntimeError: For ``"step"``, and for ``"close"`` of only some environments: they step and close together.
        """
        chosen = self._select(indices)
        if method_name == "close" and {id(part) for part in chosen} == {id(part) for part in self._parts}:
            self.close()
            return [None for _ in chosen]
        return [part.get_wrapper_attr(method_name)(*method_args, **method_kwargs) for part in chosen]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: int | Iterable[int] | None = None) -> list[bool]:
        """Always False: native environments have no wrappers."""
        return [False for _ in self._select(indices)]

    def _select(self, indices: int | Iterable[int] | None) -> list[Part]:
        """The selected environments; negative numbers count from the last."""
        return [self._parts[index] for index in self._get_indices(indices)]


#: The options that an environment accepts for its next episode.
_NEXT_OPTIONS = ("variant", "index", "world", "queue")


class _Monitor(VecMonitor):  # type: ignore[misc, unused-ignore] # Any where it is not installed.
    """A ``VecMonitor`` that also clears returns and lengths of environments that :meth:`env_method` resets."""

    def env_method(
        self,
        method_name: str,
        *method_args: Any,
        indices: int | Iterable[int] | None = None,
        **method_kwargs: Any,
    ) -> list[Any]:
        """Like :meth:`DriftworldVecEnv.env_method`."""
        results: list[Any] = self.venv.env_method(method_name, *method_args, indices=indices, **method_kwargs)
        if method_name == "reset":
            chosen = list(self._get_indices(indices))
            self.episode_returns[chosen] = 0
            self.episode_lengths[chosen] = 0
        return results


def _info_of(vector_info: Mapping[str, Any], index: int) -> dict[str, Any]:
    """One environment's part of a vector environment's infos."""
    info: dict[str, Any] = {}
    for name, values in vector_info.items():
        mask = vector_info.get(f"_{name}")
        # Masks are skipped too, because they have no masks of their own.
        if mask is None or not mask[index]:
            continue
        value = _info_of(values, index) if isinstance(values, Mapping) else values[index]
        info[name] = value.item() if isinstance(value, np.generic) else value
    return info
