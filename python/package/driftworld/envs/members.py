"""``Members``: the environments of a native batch with their spaces, observations and infos.

Single and vector environments are both made of it; what Gymnasium wants of each is in ``single.py`` and ``vector.py``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import gcd
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from driftworld import _native
from driftworld.envs.options import Options, expect_same_spaces
from driftworld.envs.origin import Home, seed_in_range, world_text
from driftworld.envs.spaces import action_space, label, observation_space

#: What an environment takes its worlds from, as a user said it: ``home``, ``drift`` and what it says, or ``variants`` and which.
Source = tuple[str, Any]
#: Rewards, terminated, truncated, success, and the environments in which something happened.
Stepped = tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_], list[int]]


class Prepared(NamedTuple):
    """What a reset asks for: sources and streams, one for each environment, indices, and a world with its name."""

    sources: list[Source] | None
    streams: list[_native.Stream] | None
    indices: list[int] | None
    world: tuple[str, str] | None


class Members:
    """The environments of a batch.

    Args:
        num_envs: How many there are.
        task: A task, as environments take it.
        world: Or a world.
        variant: The variant that all begin with; ``None`` for the one that the task's name says.
        variants: Or the variant that each begins with.
        drift: Or the way to another variant.
        options: What is laid over the worlds.
        autoreset: ``"next_step"``, ``"same_step"`` or ``"disabled"``.
        num_threads: Threads that step and draw; 0 is one for each processor.
        max_episode_steps: A limit of steps that the worlds know nothing of.
    """

    def __init__(
        self,
        num_envs: int,
        task: Any,
        world: Any,
        variant: Any,
        variants: Sequence[Any] | None,
        drift: Mapping[str, Any] | None,
        options: Options,
        autoreset: str,
        num_threads: int,
        max_episode_steps: int | None = None,
    ) -> None:
        self.num_envs = num_envs
        self._options = options
        self._home = Home(task, world, variant)
        self.layout = options.layouts(self._home.stream())[0]
        self._checked: set[str] = set()
        kept = ("home", None) if drift is None else ("drift", drift)
        self._sources: list[Source] = [
            kept if name is None else ("variants", [name]) for name in variants or [None] * num_envs
        ]
        streams = self._streams(self._sources)
        self._labels = self._home.labels()
        self.label_in_info = options.task_label == "info"
        self.observation_space = observation_space(options, self.layout, len(self._labels))
        self.action_space = action_space(self.layout)
        self.batch = _native.Batch(
            streams,
            options.dress,
            autoreset,
            num_threads,
            options.renderer,
            options.depth,
            list(options.libraries),
            max_episode_steps,
        )
        self._is_discrete = isinstance(self.action_space, spaces.Discrete)
        self._views = self._arranged(self.batch.buffers())
        last = self.batch.final_buffers()
        self._final_views = None if last is None else self._arranged(last)
        self.has_seed = [False] * num_envs
        self._names = [""] * num_envs

    def _arranged(self, buffers: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """The buffers in the order of the options."""
        buffers["state"] = buffers["state"].reshape(self.num_envs, -1)
        views = {kind: buffers[kind] for kind in self._options.modalities}
        if self._options.task_label == "obs":
            views["task"] = np.zeros((self.num_envs, len(self._labels)), dtype=np.float32)
        return views

    def _stream(self, source: Source) -> _native.Stream:
        kind, said = source
        if kind == "variants":
            return self._stream_of([self._home.variant(name, "variant") for name in said])
        stream = self._home.stream() if kind == "home" else self._home.drift(said)
        self._check(stream)
        return stream

    def _set_source(self, env: int, source: Source) -> None:
        self.batch.stream(env, self._stream(source))
        self._sources[env] = source

    def _stream_of(self, variants: list[_native.Variant]) -> _native.Stream:
        """The worlds of these variants, after a look whether they fit into the spaces."""
        new = [variant for variant in variants if variant.hash not in self._checked]
        if new:
            self._check(_native.Stream.variants(new))
            self._checked.update(variant.hash for variant in new)
        return _native.Stream.variants(variants)

    def _check(self, stream: _native.Stream) -> None:
        for layout in self._options.layouts(stream):
            expect_same_spaces(self.layout, layout)

    def checked(self, options: Mapping[str, Any], *, many: bool) -> Prepared:
        """What the options of a reset ask for, looked through before anything is changed.

        Args:
            options: As users hand them to ``reset``.
            many: Whether there may be one variant for each environment.
        """
        known = ["variant", "index", "world", "queue", *(["variants"] if many else [])]
        unknown = [key for key in options if key not in known]
        if unknown:
            also = ", reset_mask" if many else ""
            raise ValueError(f"options: found {unknown[0]!r}, expected some of {', '.join(known)}{also}")
        if sum(options.get(key) is not None for key in ("variant", "variants", "queue")) > 1:
            raise ValueError("options: found several of variant, variants and queue, expected one of them")
        sources = self._new_sources(options)
        streams = None if sources is None else self._streams(sources)
        world = world_text(options["world"]) if options.get("world") is not None else None
        if world is not None:
            self._check(_native.Stream.world(*world))
        return Prepared(sources, streams, self._indices(options.get("index")), world)

    def _streams(self, sources: list[Source]) -> list[_native.Stream]:
        # Where all have the same, it is one object, and looked at once.
        made = {id(source): self._stream(source) for source in {id(source): source for source in sources}.values()}
        return [made[id(source)] for source in sources]

    def take(self, prepared: Prepared, env: int, seed: int | None) -> None:
        """Lets one environment do what was asked for with its next episode; with a seed, under it."""
        if prepared.sources is not None and prepared.streams is not None:
            self.batch.stream(env, prepared.streams[env])
            self._sources[env] = prepared.sources[env]
        index = None if prepared.indices is None else prepared.indices[env]
        if seed is not None:
            self.batch.seed(env, seed, index or 0)
            self.has_seed[env] = True
        elif index is not None:
            self.batch.index(env, index)
        if prepared.world is not None:
            self.batch.give(env, *prepared.world)

    def _new_sources(self, options: Mapping[str, Any]) -> list[Source] | None:
        if options.get("variant") is not None:
            return [("variants", [options["variant"]])] * self.num_envs
        if options.get("variants") is not None:
            variants = _listed(options["variants"], "variants")
            if len(variants) != self.num_envs:
                raise ValueError(f"variants: found {len(variants)}, expected {self.num_envs}, one for each environment")
            return [("variants", [variant]) for variant in variants]
        if options.get("queue") is not None:
            return [("variants", share) for share in dealt(_listed(options["queue"], "queue"), self.num_envs)]
        return None

    def _indices(self, index: Any) -> list[int] | None:
        if index is None:
            return None
        if isinstance(index, (Sequence, np.ndarray)) and not isinstance(index, str):
            if len(index) != self.num_envs:
                raise ValueError(f"index: found {len(index)}, expected {self.num_envs}, one for each environment")
            return [seed_in_range(one, "index") for one in index]
        return [seed_in_range(index, "index")] * self.num_envs

    def reset_info(self, env: int) -> dict[str, Any]:
        """What a reset says of an environment; notes in which variant it is."""
        task, variant, seed, index, world_hash = self.batch.origin(env)
        self._name(env, variant)
        info: dict[str, Any] = {
            "task_id": task,
            "variant_id": variant,
            "seed": seed,
            "index": index,
            "world_hash": world_hash,
            "events": (),
            "is_success": False,
        }
        if self.label_in_info:
            info["task_label"] = self.label_number(env)
        return info

    def _name(self, env: int, variant: str) -> None:
        self._names[env] = variant
        if "task" in self._views:
            self._views["task"][env] = label(self._labels, variant)

    def label_number(self, env: int) -> int:
        """The number of an environment's variant among those of the task; −1 for one that is not among them."""
        name = self._names[env]
        return self._labels.index(name) if name in self._labels else -1

    def observation(self, env: int) -> Any:
        """An environment's observation, in memory of its own."""
        return self._one(self._views, env)

    def final_observation(self, env: int) -> Any:
        """The last observation of the episode that ended in the last step."""
        assert self._final_views is not None, "only asked for with autoreset in the same step"
        return self._one(self._final_views, env)

    def note_finals(self, env: int) -> None:
        """Keeps the label of an episode that has ended for its last observation."""
        if self._final_views is not None and "task" in self._final_views:
            self._final_views["task"][env] = self._views["task"][env]

    def _one(self, views: dict[str, NDArray[Any]], env: int) -> Any:
        if not self._options.is_dict:
            return views[self._options.modalities[0]][env].copy()
        return {kind: view[env].copy() for kind, view in views.items()}

    def observations(self, copy: bool) -> Any:
        """All observations: views on the batch's buffers, or copies."""
        if not self._options.is_dict:
            view = self._views[self._options.modalities[0]]
            return view.copy() if copy else view
        return {kind: view.copy() if copy else view for kind, view in self._views.items()}

    def step_one(self, action: Any) -> tuple[float, bool, bool, bool, bool]:
        """A step of the only environment: reward, terminated, truncated, success, whether anything happened."""
        if self._is_discrete:
            return self.batch.step_one_by_row(self._row(action))
        numbers = np.asarray(action, dtype=np.float64)
        if numbers.shape != self.action_space.shape:
            raise ValueError(
                f"action: found shape {numbers.shape}, expected {self.action_space.shape}; nothing was changed"
            )
        return self.batch.step_one_by_numbers(numbers.tolist())

    @staticmethod
    def _row(action: Any) -> int:
        try:
            return int(action.__index__())
        except (AttributeError, TypeError):
            raise ValueError(
                f"action: found {action!r}, expected the number of a row of the table; nothing was changed"
            ) from None

    def step(self, actions: Any) -> Stepped:
        """A step of all: actions of shape ``(num_envs,)`` or ``(num_envs, numbers)``."""
        given = np.asarray(actions)
        wanted = (self.num_envs, *(self.action_space.shape or ()))
        if given.shape != wanted:
            raise ValueError(f"actions: found shape {given.shape}, expected {wanted}; nothing was changed")
        if self._is_discrete:
            if not np.issubdtype(given.dtype, np.integer):
                raise ValueError(f"actions: found {given.dtype}, expected whole numbers; nothing was changed")
            return self.batch.step_rows(np.ascontiguousarray(given, dtype=np.int64))
        return self.batch.step_numbers(np.ascontiguousarray(given, dtype=np.float64))

    def written(self) -> dict[str, Any]:
        """All that a copy has to be told: running worlds, and where their next ones come from."""
        envs = range(self.num_envs)
        return {
            "states": [self.batch.state(env) for env in envs],
            "steps": [self.batch.episode_steps(env) for env in envs],
            "places": [self.batch.place(env) for env in envs],
            "sources": list(self._sources),
            "has_seed": list(self.has_seed),
            "names": list(self._names),
        }

    def take_up(self, written: dict[str, Any]) -> None:
        """Goes on where another of the same options stood."""
        for env, source in enumerate(written["sources"]):
            if source != self._sources[env]:
                self._set_source(env, source)
            self.batch.set_place(env, written["places"][env])
            self.batch.give(env, "state", written["states"][env])
        self.batch.reset()
        self.has_seed = written["has_seed"]
        for env, steps in enumerate(written["steps"]):
            self.batch.set_episode_steps(env, steps)
        for env, name in enumerate(written["names"]):
            self._name(env, name)


def _listed(names: Any, option: str) -> list[Any]:
    if isinstance(names, str) or not isinstance(names, Sequence) or len(names) == 0:
        raise ValueError(f"{option}: found {names!r}, expected a list of variants, at least one")
    return list(names)


def dealt(queue: list[Any], num_envs: int) -> list[list[Any]]:
    """A queue dealt out like cards: environment 0 takes the first, 1 the second, and so on, over and over."""
    turns = len(queue) // gcd(len(queue), num_envs)
    return [[queue[(env + turn * num_envs) % len(queue)] for turn in range(turns)] for env in range(num_envs)]
