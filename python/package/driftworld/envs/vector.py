"""``DriftworldVectorEnv``: many environments that step together in one call into Rust."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import deepcopy
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from driftworld import _native
from driftworld._literals import AutoresetName, CameraName
from driftworld.envs.autoreset import AutoresetMode, autoreset_mode_of
from driftworld.envs.conversion import teach_conversions
from driftworld.envs.info import OF_STEP
from driftworld.envs.members import Members, Prepared
from driftworld.envs.options import EnvOptions, Options, refuse_unknown, shows_options, whole
from driftworld.envs.origin import Home, spread_seeds, whole_number
from driftworld.envs.picture import Camera
from driftworld.envs.single import keys_to_action
from driftworld.errors import EnvError
from driftworld.recordings import Recording

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack

#: Capacity of a native batch.
MOST_ENVS = 65_536


class DriftworldVectorEnv(VectorEnv[Any, Any, Any]):
    """Environments that step together, without the GIL, into reused buffers.

    Each behaves like a :class:`DriftworldEnv` with the same options and seed, bit for bit.

    Observations, rewards, flags and infos are new arrays at each step, which the caller may keep and change. With
    ``copy=False``, **observations are views** of the batch's buffers: they are read-only, and the next step or reset
    overwrites the arrays that the last one returned. That saves a copy if an observation is no longer needed when the
    next arrives.

    Args:
        task: A task, as for :class:`DriftworldEnv`; so are all options that are not named here.
        num_envs: Number of environments, 1 to 65,536.
        variants: The first variant of each environment, instead of ``variant``.
        autoreset_mode: When the next episode starts after one has ended: ``"next_step"``, ``"same_step"``,
            ``"disabled"``, or one of Gymnasium's ``AutoresetMode``.
        copy: Whether observations are copies, as in Gymnasium's vector environments; otherwise they are read-only
            views.
        num_threads: Threads that step and draw, at most one for each environment and four for each processor; 0 is one
            for each processor.
        max_episode_steps: A step limit in addition to the worlds' own, like that of ``TimeLimit``; ``make_vec``
            passes it.

    Raises:
        SpecError, TaskError, ValueError: Like :class:`DriftworldEnv`.
        EnvError: If the observations would need more than 16 GiB, or more memory than there is.

    Only one thread may use it at a time.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __new__(cls, *args: Any, **options: Any) -> Self:
        """Refuses unknown options before Python does, to suggest the intended one."""
        refuse_unknown(cls, options)
        return super().__new__(cls)

    @shows_options
    def __init__(
        self,
        task: Any = None,
        num_envs: int = 1,
        *,
        world: Any = None,
        variant: Any = None,
        variants: Sequence[Any] | None = None,
        max_episode_steps: int | None = None,
        render_mode: Literal["rgb_array"] | None = None,
        render_size: tuple[int, int] = (480, 640),
        camera: CameraName = "agent",
        autoreset_mode: AutoresetName | AutoresetMode = "next_step",
        copy: bool = True,
        num_threads: int = 0,
        **options: Unpack[EnvOptions],
    ) -> None:
        refuse_unknown(DriftworldVectorEnv, options)
        drift = options.get("drift")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode: found {render_mode!r}, expected None or rgb_array")
        if isinstance(num_envs, bool) or not isinstance(num_envs, (int, np.integer)) or not 1 <= num_envs <= MOST_ENVS:
            raise ValueError(f"num_envs: found {num_envs!r}, expected a whole number in 1..{MOST_ENVS}")
        if variants is not None and variant is not None:
            raise ValueError("variants: found variant as well, expected only one of the two")
        if variants is not None and drift is not None:
            raise ValueError("variants: found drift as well, expected only one of the two")
        if variants is not None and (isinstance(variants, str) or len(variants) != num_envs):
            raise ValueError(f"variants: found {variants!r}, expected a list of {num_envs}, one for each environment")
        if not isinstance(copy, (bool, np.bool_)):
            raise ValueError(f"copy: found {copy!r}, expected True or False")
        mode = autoreset_mode_of(autoreset_mode)
        home = Home(task, world, variant)
        self._members = Members(
            home,
            home.sources(num_envs, variants, drift),
            Options.read(options),
            mode.name.lower(),
            whole("num_threads", num_threads) or 0,
            _limit(max_episode_steps),
        )
        self._mode = mode
        self._copy = copy
        self._camera = Camera(camera, render_size)
        self.num_envs = num_envs
        self._spec: EnvSpec | None = None
        self.render_mode = render_mode
        fps = 1.0 / self._members.layout["seconds_per_step"]
        self.metadata = {**type(self).metadata, "render_fps": max(1, round(fps)), "autoreset_mode": mode}
        self.single_observation_space = self._members.observation_space
        self.single_action_space = self._members.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator | None] = [None] * num_envs
        self._generator_seeds: list[int | None] = [None] * num_envs
        self._ended = np.zeros(num_envs, dtype=np.bool_)
        self._everyone = np.ones(num_envs, dtype=np.bool_)
        self._nothing = np.empty(num_envs, dtype=object)
        self._nothing.fill(())

    @property
    def spec(self) -> EnvSpec | None:  # type: ignore[override]
        """The spec of ``gymnasium.make_vec``; its ``max_episode_steps`` is the step limit set by the options."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = self._members.limited(spec)

    @property  # type: ignore[misc]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """The random generator of each environment; only used if an environment never had a seed."""
        return tuple(self._generator(env) for env in range(self.num_envs))

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """The seed of each environment's generator."""
        return tuple(self._generator_seed(env) for env in range(self.num_envs))

    def _generator(self, env: int) -> np.random.Generator:
        generator = self._generators[env]
        if generator is None:
            generator, self._generator_seeds[env] = seeding.np_random()
            self._generators[env] = generator
        return generator

    def _generator_seed(self, env: int) -> int:
        self._generator(env)
        seed = self._generator_seeds[env]
        return -1 if seed is None else seed

    def reset(  # type: ignore[override]
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode in every environment, or in some.

        Args:
            seed: One seed, from which :func:`driftworld.spread_seeds` derives those of the environments, the first of
                which uses the seed itself; or a list with a seed for each. ``None`` continues. (Gymnasium's own loops
                add 0, 1, 2 and so on, so that two seeds share worlds.)
            options: As for :meth:`DriftworldEnv.reset`, for all environments; and ``"variants"``, a variant for each;
                ``"index"`` may be a list; a ``"queue"`` is dealt out like cards, episode after episode;
                ``"reset_mask"``, bool (num_envs,), selects the environments to reset, and the others continue. With a
                mask, each selected environment gets a queue of its own, from its start.

        Returns:
            Observations and infos, as :class:`gymnasium.vector.SyncVectorEnv` has them.
        """
        teach_conversions()
        options = dict(options or {})
        mask = options.pop("reset_mask", None)
        if mask is not None:
            mask = self._mask(mask, "options['reset_mask']", at_least=1)
        seeds = self._seeds(seed)
        members = self._members
        prepared = members.checked(options, many=True, deals=mask is None)
        chosen = range(self.num_envs) if mask is None else np.flatnonzero(mask).tolist()
        self._begin(chosen, seeds, prepared, mask)
        infos: dict[str, Any] = {}
        for env in chosen:
            infos = self._add_info(infos, members.reset_info(env), env)
        return members.observations(self._copy), infos

    def reset_one(
        self, env: int, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode in one environment, like :meth:`DriftworldEnv.reset`; the others continue.

        Returns:
            Its first observation and its info, like a single environment's.
        """
        self._expect("reset_one", env)
        teach_conversions()
        members = self._members
        prepared = members.checked(options or {}, many=False)
        own = self._seeds([seed if one == env else None for one in range(self.num_envs)])[env]
        self._begin([env], [own] * self.num_envs, prepared, np.arange(self.num_envs) == env)
        # `reset_info` notes the label that the observation contains, so it comes first.
        info = members.reset_info(env)
        return members.observation(env), info

    def set_next(
        self, *, variant: Any = None, index: Any = None, world: Any = None, queue: Any = None, mask: Any = None
    ) -> None:
        """Sets the next episodes; the current ones continue. Autoreset starts the new ones as the current ones end.

        Args:
            variant: From the next episode on: a name or a :class:`driftworld.Variant` for all, or a list of them.
            index: The number of the next world, or a list. A reset with a ``seed`` still starts at world 0.
            world: A world for the next episode only, or a list: a path, JSON, a dictionary.
            queue: Instead of ``variant``: a list of variants, which each environment takes in turn, cycling.
            mask: Bool ``(num_envs,)``: the selected environments, by default all. Lists have one entry for each
                selected environment, ``None`` for no change.

        Raises:
            ValueError, TaskError, SpecError: Like :meth:`reset`; nothing is changed then.
        """
        chosen = range(self.num_envs) if mask is None else np.flatnonzero(self._mask(mask, "mask")).tolist()
        self._members.set_next(chosen, {"variant": variant, "index": index, "world": world, "queue": queue})

    def check_next(self, **asked: Any) -> None:
        """Checks arguments like :meth:`set_next` for one environment, without changing anything."""
        self._members.checked(asked, many=False)

    def set_next_one(self, env: int, **asked: Any) -> None:
        """Like :meth:`set_next`, for one environment, with the arguments of :meth:`DriftworldEnv.set_next`."""
        self._expect("set_next", env)
        self._members.set_next([env], asked)

    def _begin(
        self, chosen: Sequence[int], seeds: list[int | None], prepared: Prepared, mask: NDArray[np.bool_] | None
    ) -> None:
        """Starts episodes in the chosen environments, which are those of the mask."""
        members = self._members
        # Cleared until the reset completes: Ctrl-C may interrupt it.
        members.has_begun[chosen] = False
        for env in chosen:
            own = seeds[env]
            if own is not None:
                self._generators[env], self._generator_seeds[env] = seeding.np_random(own)
            elif not members.has_seed[env]:
                own = int(self._generator(env).integers(2**32))
            members.take(prepared, env, own)
        try:
            members.batch.reset(mask)
        except EnvError:
            # One environment has no world: the others have started, and the next step tries again.
            members.has_begun[chosen] = True
            raise
        members.has_begun[chosen] = True
        self._ended[chosen] = False

    def _expect(self, method: str, env: int) -> None:
        if not 0 <= env < self.num_envs:
            raise IndexError(f"{method}: found environment {env}, expected 0 to {self.num_envs - 1}")

    def _mask(self, mask: Any, option: str, at_least: int = 0) -> NDArray[np.bool_]:
        is_mask = isinstance(mask, np.ndarray) and mask.dtype == np.bool_ and mask.shape == (self.num_envs,)
        if not is_mask or mask.sum() < at_least:
            also = " with at least one True" if at_least else ""
            raise ValueError(f"{option}: found {mask!r}, expected a bool array of shape ({self.num_envs},){also}")
        chosen: NDArray[np.bool_] = mask
        return chosen

    def _seeds(self, seed: Any) -> list[int | None]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, (int, np.integer)):
            return [int(seed), *spread_seeds(int(seed), self.num_envs)[1:]]
        if isinstance(seed, str) or not isinstance(seed, Iterable):
            raise ValueError(f"seed: found {seed!r}, expected a whole number, or a list of them")
        seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: found {len(seeds)} seeds, expected {self.num_envs}, one for each environment")
        return [None if one is None else whole_number(one) for one in seeds]

    def step(
        self, actions: Any, *, out: Any = None
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Executes one action of every agent.

        With ``"next_step"``, an environment whose episode has ended starts the next one: its action is ignored, its
        reward is 0, and its observation is the first. With ``"same_step"`` it does so at once: ``info["final_obs"]``
        and ``info["final_info"]`` hold the last observation and info of the old episode.

        Args:
            actions: ``(num_envs,)`` rows, or ``(num_envs, numbers)``.
            out: The caller's own arrays, in the form of observations, such as a row of a learner's buffer: observations
                are written directly into them and returned.

        Returns:
            Observations; rewards float64, terminated and truncated bool, each ``(num_envs,)``; infos.

        Raises:
            EnvError: For an invalid action, or with ``"disabled"`` after the end of an episode; nothing is changed
                then.
            gymnasium.error.ResetNeeded: If an environment has not been reset yet.
        """
        members = self._members
        if not members.has_begun.all():
            waiting = np.flatnonzero(~members.has_begun).tolist()
            found = "no reset" if len(waiting) == self.num_envs else f"no reset of environments {_some(waiting)}"
            raise ResetNeeded(f"step: found {found}, expected reset() before the first step, and again after an interrupted reset")
        if out is not None:
            members.expect_form(out)
        rewards, terminated, truncated, success, eventful = members.step(actions)
        ended = terminated | truncated
        begun = self._ended if self._mode == AutoresetMode.NEXT_STEP else ended
        infos: dict[str, Any] = {}
        if members.has_infos:
            infos = self._infos(success, eventful)
            for env in np.flatnonzero(ended).tolist():
                infos["ended_by"][env] = members.ended_by(env)
        if self._mode != AutoresetMode.DISABLED and begun.any():
            for env in np.flatnonzero(begun).tolist():
                self._add_beginning(infos, env)
        self._ended = ended
        if out is None:
            return members.observations(self._copy), rewards, terminated, truncated, infos
        members.write_into(out)
        return out, rewards, terminated, truncated, infos

    def _infos(self, success: NDArray[np.bool_], eventful: list[int]) -> dict[str, Any]:
        """The infos of a step, for every environment."""
        events = self._nothing.copy()
        for env in eventful:
            events[env] = self._members.batch.events(env)
        infos = {
            "events": events,
            "_events": self._everyone.copy(),
            "is_success": success,
            "_is_success": self._everyone.copy(),
            "ended_by": np.full(self.num_envs, None, dtype=object),
            "_ended_by": self._everyone.copy(),
        }
        if self._members.label_in_info:
            infos["task_label"] = np.array([self._members.label_number(env) for env in range(self.num_envs)])
            infos["_task_label"] = self._everyone.copy()
        return infos

    def _add_beginning(self, infos: dict[str, Any], env: int) -> None:
        """Adds the info of an episode that started in this step, and the final info of the one before."""
        members = self._members
        if self._mode == AutoresetMode.SAME_STEP:
            members.note_finals(env)
            final = {key: infos[key][env] for key in OF_STEP if key in infos}
            final = {key: value.item() if isinstance(value, np.generic) else value for key, value in final.items()}
            for key in ("final_obs", "_final_obs", *(("final_info", "_final_info") if members.has_infos else ())):
                if key not in infos:
                    infos[key] = self._empty(key)
            infos["final_obs"][env] = members.final_observation(env)
            infos["_final_obs"][env] = True
            if members.has_infos:
                infos["final_info"] = self._add_info(infos["final_info"], final, env)
                infos["_final_info"][env] = True
        self._add_info(infos, members.reset_info(env), env)

    def _empty(self, key: str) -> Any:
        if key == "final_info":
            return {}
        return (
            np.full(self.num_envs, None, dtype=object)
            if key == "final_obs"
            else np.zeros(self.num_envs, dtype=np.bool_)
        )

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:  # type: ignore[override]
        """An image of each environment, uint8 (height, width, 3); ``None`` without a render mode.

        Raises:
            gymnasium.error.ResetNeeded: If an environment has not been reset yet.
        """
        if self.render_mode is None:
            return None
        if not self._members.has_begun.all():
            raise ResetNeeded("render: found environments that have not been reset, expected a call of reset() first")
        return tuple(self._camera.picture(self._members.batch, env) for env in range(self.num_envs))

    @property
    def has_begun(self) -> NDArray[np.bool_]:
        """Which environments have been reset, bool ``(num_envs,)``."""
        return self._members.has_begun.copy()

    def picture(self, env: int) -> NDArray[np.uint8]:
        """An image of one environment, as in :meth:`render`."""
        self._expect("picture", env)
        return self._camera.picture(self._members.batch, env)

    def keys_to_action(self) -> dict[tuple[str, ...], Any]:
        """Keyboard controls, as in :meth:`DriftworldEnv.get_keys_to_action`."""
        return keys_to_action(self.single_action_space, self._members.layout)

    def warnings(self, env: int) -> list[str]:
        """Suspicious parts of an environment's world, as in :meth:`DriftworldEnv.warnings`."""
        self._expect("warnings", env)
        return self._members.batch.warnings(env)

    def state(self, env: int) -> dict[str, Any]:
        """The current world of an environment, as a document."""
        self._expect("state", env)
        return _native.parsed(self._members.batch.state(env))

    def origin(self, env: int) -> dict[str, Any]:
        """The origin of an environment's world, as in :meth:`DriftworldEnv.origin`."""
        self._expect("origin", env)
        return self._members.origin(env)

    def record(self, records: bool = True, env: int | None = None) -> None:
        """Starts or stops recording in an environment, or in all; :meth:`recording` returns the result."""
        if env is not None:
            self._expect("record", env)
        self._members.batch.record(records, env)

    def recording(self, env: int) -> Recording:
        """The recording of an environment's episode so far. Before the episode's first step, it is that of the previous
        episode; with the autoreset mode ``"same_step"``, this includes the time right after the step that ended it.

        Raises:
            IndexError: If there is no such environment.
            RuntimeError: Unless :meth:`record` was called.
        """
        self._expect("recording", env)
        return Recording(self._members.recording(env))

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Calls a method for each environment: ``state``, ``origin``, ``recording`` and ``warnings`` are per
        environment, anything else is the same for all.
        """
        name = {"observation_space": "single_observation_space", "action_space": "single_action_space"}.get(name, name)
        if name in ("state", "origin", "recording", "warnings"):
            return tuple(getattr(self, name)(env) for env in range(self.num_envs))
        if name == "render":
            return self.render() or (None,) * self.num_envs
        value = getattr(self, name)
        return (value(*args, **kwargs) if callable(value) else value,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """An attribute, for each environment."""
        return self.call(name)

    def __getstate__(self) -> dict[str, Any]:
        kept = {name: value for name, value in self.__dict__.items() if name != "_members"}
        # Copied even for a shallow copy: otherwise both copies would share and change them.
        for name in ("_generators", "_generator_seeds", "_ended"):
            kept[name] = deepcopy(kept[name])
        return {"kept": kept, "members": self._members.written()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Bypasses `__init__`: a subclass has its own, with unknown arguments.
        self.__dict__.update(state["kept"])
        self._members = Members.again(state["members"])


def _some(numbers: list[int]) -> str:
    """The first of the numbers, as text."""
    return ", ".join(map(str, numbers[:5])) + (f" and {len(numbers) - 5} more" if len(numbers) > 5 else "")


def _limit(steps: Any) -> int | None:
    """A step limit as for Gymnasium's ``TimeLimit``; −1 means no limit, as for ``gymnasium.make``."""
    if steps is None or steps == -1:
        return None
    found = whole("max_episode_steps", steps)
    if not found:
        raise ValueError(f"max_episode_steps: found {steps!r}, expected a whole number of at least 1, or -1 for no limit")
    return found
