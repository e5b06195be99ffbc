"""``Members``: the environments of a native batch with their spaces, observations and infos.

The common part of single and vector environments; ``single.py`` and ``vector.py`` add Gymnasium's interfaces.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from copy import copy
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from numpy.typing import NDArray

from driftworld import _native
from driftworld.envs import info
from driftworld.envs.options import Options, coverings, expect_same_spaces, images_among, widest_action
from driftworld.envs.origin import (
    DrawnWorld,
    Drifting,
    Home,
    OneVariant,
    OneWorld,
    OwnQueue,
    Queue,
    Source,
    folded_seed,
    index_in_range,
    world_text,
)
from driftworld.envs.spaces import action_space, label, observation_space

#: Rewards, terminated, truncated, success, and the environments in which something happened.
Stepped = tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_], list[int]]


class Prepared(NamedTuple):
    """The checked options of a reset: sources and streams, one for each environment, indices, and a world."""

    sources: list[Source] | None
    streams: list[_native.Stream] | None
    indices: list[int] | None
    world: _native.Stream | None


class Members:
    """The environments of a batch. It holds only copies of values, so later changes to the caller's objects do not affect it.

    Args:
        home: The task, or the one world.
        sources: Where the worlds of each environment come from.
        options: Options applied to the worlds.
        autoreset: ``"next_step"``, ``"same_step"`` or ``"disabled"``.
        num_threads: Threads that step and draw; 0 means one for each processor.
        max_episode_steps: A step limit in addition to the worlds' own.
        labels: The ids of the variants in the order of their labels; by default the task's, then the others of the
            sources.
    """

    def __init__(
        self,
        home: Home,
        sources: list[Source],
        options: Options,
        autoreset: str,
        num_threads: int,
        max_episode_steps: int | None = None,
        labels: list[str] | None = None,
    ) -> None:
        self.num_envs = len(sources)
        self._home = home
        self._made_with = (autoreset, num_threads, max_episode_steps)
        self._sources = list(sources)
        layouts = self._layouts(options, self._sources)
        options = options.shown(layouts)
        self._options = options
        home_layout = options.layouts(home.source().streams(1)[0])[0]
        self.layout = {**home_layout, "action": widest_action([home_layout, *layouts])}
        self._modalities: tuple[str, ...] = options.modalities or ()
        self._checked: set[str] = set()
        self._covering: set[str] = set()
        streams = self._streams(self._sources)
        self._labels = home.labels(sources) if labels is None else labels
        self._shows_label = options.task_label == "observation" and options.is_dict
        self.has_infos = options.has_infos
        self.label_in_info = options.task_label != "none" and not self._shows_label
        self.observation_space = observation_space(options, self.layout, len(self._labels))
        self.action_space = action_space(self.layout)
        self.batch = _native.Batch(
            streams,
            options.overrides,
            autoreset,
            num_threads,
            options.renderer,
            options.depth,
            list(options.libraries),
            json.dumps(images_among(self._modalities)),
            max_episode_steps,
        )
        self._is_discrete = isinstance(self.action_space, spaces.Discrete)
        self._views = self._arranged(self.batch.buffers())
        last = self.batch.final_buffers()
        self._final_views = None if last is None else self._arranged(last)
        self.has_seed = [False] * self.num_envs
        #: Which environments have been reset; the worlds of the others have not been chosen yet.
        self.has_begun = np.zeros(self.num_envs, dtype=np.bool_)
        self._names = [""] * self.num_envs

    def limited(self, spec: EnvSpec | None) -> EnvSpec | None:
        """Gymnasium's spec, with the step limit that options set for all worlds."""
        if spec is not None and self._options.max_steps:
            spec = copy(spec)
            limits = [limit for limit in (spec.max_episode_steps, self._options.max_steps) if limit]
            spec.max_episode_steps = min(limits)
        return spec

    def _arranged(self, buffers: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """The buffers in the order of the options."""
        buffers["state"] = buffers["state"].reshape(self.num_envs, -1)
        views = {kind: buffers[kind] for kind in self._modalities}
        if self._shows_label:
            views["task"] = _locked(np.zeros((self.num_envs, len(self._labels)), dtype=np.float32))
        return views

    def _layouts(self, options: Options, sources: list[Source]) -> list[dict[str, Any]]:
        """The layouts of the environments: one for each distinct variant."""
        variants: dict[str, _native.Variant] = {}
        others: dict[int, Source] = {}
        for source in sources:
            if isinstance(source, (OneVariant, Queue)):
                variants.update({variant.hash: variant for variant in _variants(source)})
            else:
                others[id(source)] = source
        streams = [source.streams(1)[0] for source in others.values()]
        streams += [_native.Stream.variants(list(variants.values()))] if variants else []
        return [layout for stream in streams for layout in options.layouts(stream)]

    def _streams(self, sources: list[Source]) -> list[_native.Stream]:
        """Each environment's worlds, after checking that they fit the spaces."""
        # A source shared by all environments is one object, and is checked once.
        streams: dict[int, list[_native.Stream]] = {}
        for source in sources:
            if id(source) not in streams:
                streams[id(source)] = source.streams(self.num_envs)
                self._check(source, streams[id(source)][0])
        return [streams[id(source)][env] for env, source in enumerate(sources)]

    def _check(self, source: Source, stream: _native.Stream) -> None:
        """Checks that the worlds of a source fit the spaces."""
        if isinstance(source, (OneVariant, Queue)):
            new = {variant.hash: variant for variant in _variants(source)}
            new = {hash: variant for hash, variant in new.items() if hash not in self._checked}
            streams = [_native.Stream.variants(list(new.values()))] if new else []
        else:
            new, streams = {}, [stream]
        for unseen in streams:
            for layout in self._options.layouts(unseen):
                expect_same_spaces(self.layout, layout, self._modalities)
        self._checked.update(new)
        self._warn_of_covered(list(new.values()) or list(_ends(source)))

    def _warn_of_covered(self, variants: Sequence[_native.Variant]) -> None:
        """Warns about options that hide differences between these variants, once for each option."""
        if not variants:
            return
        first = [] if self._home.first is None else [self._home.first]
        found = _native.covered([*first, *variants], self._options.overrides, self._options.images)
        for option, message in coverings(found).items():
            if option not in self._covering:
                self._covering.add(option)
                warnings.warn(message, stacklevel=2)

    def checked(self, options: Mapping[str, Any], *, many: bool, deals: bool = False) -> Prepared:
        """The options of a reset, checked before anything is changed.

        Args:
            options: As passed to ``reset``.
            many: Whether there may be one variant for each environment.
            deals: Whether a queue is dealt out among all environments; otherwise each has a copy of the queue.
        """
        known = ["variant", "index", "world", "queue", *(["variants"] if many else [])]
        unknown = [key for key in options if key not in known]
        if unknown:
            also = ", reset_mask" if many else ""
            raise ValueError(f"options: found {unknown[0]!r}, expected some of {', '.join(known)}{also}")
        if sum(options.get(key) is not None for key in ("variant", "variants", "queue")) > 1:
            raise ValueError("options: found several of variant, variants and queue, expected one of them")
        sources = self._new_sources(options, deals)
        streams = None if sources is None else self._streams(sources)
        world = options.get("world")
        given = None
        if world is not None:
            drawn = DrawnWorld(world) if isinstance(world, _native.Stream) else OneWorld(*world_text(world))
            given = self._streams([drawn])[0]
        return Prepared(sources, streams, self._indices(options.get("index")), given)

    def take(self, prepared: Prepared, env: int, seed: int | None) -> None:
        """Applies checked options, and a seed if given, to an environment's next episode."""
        if prepared.sources is not None and prepared.streams is not None:
            self.batch.stream(env, prepared.streams[env])
            self._sources[env] = prepared.sources[env]
        index = None if prepared.indices is None else prepared.indices[env]
        if seed is not None:
            self.batch.seed(env, folded_seed(seed), index or 0)
            self.has_seed[env] = True
        elif index is not None:
            self.batch.index(env, index)
        if prepared.world is not None:
            self.batch.give(env, prepared.world)

    def set_next(self, envs: Sequence[int], asked: Mapping[str, Any]) -> None:
        """Sets the next episode of these environments; nothing is changed if anything is wrong.

        Args:
            envs: The environments.
            asked: Options of a reset, each one value for all of them or a list with one for each; a queue applies to
                all.
        """
        queue = asked.get("queue")
        spread = {name: _each(name, value, len(envs)) for name, value in asked.items() if name != "queue"}
        indices = spread.pop("index", [None] * len(envs))
        prepared: dict[Any, Prepared] = {}
        chosen: list[Prepared] = []
        for place in range(len(envs)):
            options = {**{name: values[place] for name, values in spread.items()}, "queue": queue}
            # Handles and documents are keyed by identity: the lists keep them alive, so ids are not reused.
            key = tuple(one if isinstance(one, str) else id(one) for one in options.values())
            if key not in prepared:
                prepared[key] = self.checked(options, many=False)
            chosen.append(prepared[key])
        numbers = [None if index is None else index_in_range(index) for index in indices]
        for env, one, number in zip(envs, chosen, numbers, strict=True):
            self.take(one, env, None)
            if number is not None:
                self.batch.index(env, number)

    def _new_sources(self, options: Mapping[str, Any], deals: bool) -> list[Source] | None:
        if options.get("variant") is not None:
            return [OneVariant(self._home.variant(options["variant"], "variant"))] * self.num_envs
        if options.get("variants") is not None:
            variants = _listed(options["variants"], "variants")
            if len(variants) != self.num_envs:
                raise ValueError(f"variants: found {len(variants)}, expected {self.num_envs}, one for each environment")
            return [OneVariant(self._home.variant(variant, "variant")) for variant in variants]
        if options.get("queue") is not None:
            queue = self._home.queue(_listed(options["queue"], "queue"))
            return [queue if deals else OwnQueue(queue.variants, queue.order)] * self.num_envs
        return None

    def _indices(self, index: Any) -> list[int] | None:
        if index is None:
            return None
        if isinstance(index, (Sequence, np.ndarray)) and not isinstance(index, str):
            if len(index) != self.num_envs:
                raise ValueError(f"index: found {len(index)}, expected {self.num_envs}, one for each environment")
            return [index_in_range(one) for one in index]
        return [index_in_range(index)] * self.num_envs

    def recording(self, env: int) -> _native.RecordingHandle:
        """The recording of an environment's episode.

        Raises:
            RuntimeError: If it is not being recorded.
        """
        found = self.batch.recording(env)
        if found is None:
            raise RuntimeError("recording: found an environment that is not recording, expected a call of record() first")
        return found

    def origin(self, env: int) -> dict[str, Any]:
        """The origin of an environment's world."""
        return dict(zip(info.ORIGIN, self.batch.origin(env), strict=True))

    def reset_info(self, env: int) -> dict[str, Any]:
        """The info of a reset; also notes the environment's variant."""
        if not (self.has_infos or self._shows_label):
            return {}
        origin = self.origin(env)
        self._name(env, origin["variant_id"])
        if not self.has_infos:
            return {}
        if not self._options.names_variant:
            del origin["task_id"], origin["variant_id"]
        found = origin | info.of_step()
        if self.label_in_info:
            found["task_label"] = self.label_number(env)
        return found

    def ended_by(self, env: int) -> str | None:
        """What ended an environment's episode; None for a step limit, which may also be a wrapper's."""
        word = self.batch.ended_by(env)
        return None if word == "steps" else word

    def _name(self, env: int, variant: str) -> None:
        self._names[env] = variant
        if "task" in self._views:
            _write(self._views["task"], env, label(self._labels, variant))

    def label_number(self, env: int) -> int:
        """The number of an environment's variant among those of the task; −1 if it is not one of them."""
        name = self._names[env]
        return self._labels.index(name) if name in self._labels else -1

    def observation(self, env: int) -> Any:
        """A copy of an environment's observation."""
        return self._one(self._views, env)

    def final_observation(self, env: int) -> Any:
        """The last observation of the episode that ended in the last step."""
        assert self._final_views is not None, "only asked for with autoreset in the same step"
        return self._one(self._final_views, env)

    def note_finals(self, env: int) -> None:
        """Keeps the label of an ended episode for its last observation."""
        if self._final_views is not None and "task" in self._final_views:
            _write(self._final_views["task"], env, self._views["task"][env])

    def _one(self, views: dict[str, NDArray[Any]], env: int) -> Any:
        if not self._options.is_dict:
            return views[self._modalities[0]][env].copy()
        return {kind: view[env].copy() for kind, view in views.items()}

    def observations(self, copied: bool) -> Any:
        """All observations: copies, or read-only views of the batch's buffers."""
        if not self._options.is_dict:
            view = self._views[self._modalities[0]]
            return view.copy() if copied else view
        return {kind: view.copy() if copied else view[:] for kind, view in self._views.items()}

    def expect_form(self, out: Any) -> None:
        """Refuses arrays whose shape or type differs from that of the observations, and read-only ones."""
        views, arrays = (self._views, out) if self._options.is_dict else ({"": self._views[self._modalities[0]]}, {"": out})
        wanted = {kind: (view.shape, view.dtype.name) for kind, view in views.items()}
        if not isinstance(arrays, Mapping) or {kind: _form(array) for kind, array in arrays.items()} != wanted:
            locked = [kind or "the array" for kind, array in (arrays.items() if isinstance(arrays, Mapping) else ()) if _is_locked(array)]
            if locked:
                raise ValueError(f"out: found {', '.join(locked)} read-only, expected writable arrays; nothing was changed")
            expected = ", ".join(f"{kind or 'an array'} {name} {shape}" for kind, (shape, name) in wanted.items())
            raise ValueError(f"out: found arrays that do not match the observations, expected {expected}; nothing was changed")

    def write_into(self, out: Any) -> None:
        """Writes all observations into the given arrays."""
        if not self._options.is_dict:
            np.copyto(out, self._views[self._modalities[0]])
            return
        for kind, view in self._views.items():
            np.copyto(out[kind], view)

    def step_one(self, action: Any) -> tuple[float, bool, bool, bool, bool]:
        """Steps the only environment: reward, terminated, truncated, success, whether anything happened."""
        if self._is_discrete:
            return self.batch.step_one_by_row(self._row(action))
        numbers = np.asarray(action, dtype=np.float64)
        if numbers.shape != self.action_space.shape:
            raise ValueError(
                f"action: found shape {numbers.shape}, expected {self.action_space.shape}; nothing was changed"
            )
        return self.batch.step_one_by_numbers(numbers.tolist())

    def _row(self, action: Any) -> int:
        wanted = f"the number of a row, 0 to {self.layout['action']['n'] - 1}; nothing was changed"
        try:
            row = int(action.__index__())
        except (AttributeError, TypeError):
            raise ValueError(f"action: found {action!r}, expected {wanted}") from None
        if not _LEAST_ROW <= row <= _LAST_ROW:
            raise ValueError(f"action: found {row}, expected {wanted}")
        return row

    def step(self, actions: Any) -> Stepped:
        """Steps all environments: actions of shape ``(num_envs,)`` or ``(num_envs, numbers)``."""
        given = np.asarray(actions)
        wanted = (self.num_envs, *(self.action_space.shape or ()))
        if given.shape != wanted:
            raise ValueError(f"actions: found shape {given.shape}, expected {wanted}; nothing was changed")
        if self._is_discrete:
            if not np.issubdtype(given.dtype, np.integer):
                raise ValueError(f"actions: found {given.dtype}, expected whole numbers; nothing was changed")
            if given.dtype == np.uint64:
                given = np.minimum(given, _LAST_ROW)
            return self.batch.step_rows(np.ascontiguousarray(given, dtype=np.int64))
        return self.batch.step_numbers(np.ascontiguousarray(given, dtype=np.float64))

    def written(self) -> dict[str, Any]:
        """The state for copying and pickling: running worlds, and the sources of the next ones."""
        envs = range(self.num_envs)
        return {
            "made_with": (self._home, list(self._sources), self._options, *self._made_with, self._labels),
            "states": [self.batch.state(env) for env in envs],
            "steps": [self.batch.episode_steps(env) for env in envs],
            "places": [self.batch.place(env) for env in envs],
            "has_seed": list(self.has_seed),
            "has_begun": self.has_begun.copy(),
            "names": list(self._names),
        }

    @classmethod
    def again(cls, written: dict[str, Any]) -> Members:
        """Restores environments from :meth:`written`."""
        members = cls(*written["made_with"])
        for env in range(members.num_envs):
            members.batch.set_place(env, written["places"][env])
            members.batch.give(env, _native.Stream.world("state", written["states"][env]))
        members.batch.reset()
        members.has_seed, members.has_begun = written["has_seed"], written["has_begun"]
        for env, steps in enumerate(written["steps"]):
            members.batch.set_episode_steps(env, steps)
        for env, name in enumerate(written["names"]):
            members._name(env, name)
        return members


def _variants(source: OneVariant | Queue) -> Sequence[_native.Variant]:
    return source.variants if isinstance(source, Queue) else (source.variant,)


def _ends(source: Source) -> Sequence[_native.Variant]:
    return (source.from_, source.to) if isinstance(source, Drifting) else ()


#: Range of row numbers that a native batch accepts.
_LEAST_ROW, _LAST_ROW = -(2**63), 2**63 - 1


def _form(array: Any) -> tuple[tuple[int, ...], str] | None:
    """Shape and type of a writable array."""
    is_free = isinstance(array, np.ndarray) and array.flags.writeable
    return (array.shape, array.dtype.name) if is_free else None


def _is_locked(array: Any) -> bool:
    return isinstance(array, np.ndarray) and not array.flags.writeable


def _locked(array: NDArray[Any]) -> NDArray[Any]:
    """Makes an array read-only, so that no view of it can be made writable either."""
    array.flags.writeable = False
    return array


def _write(array: NDArray[Any], env: int, row: Any) -> None:
    """Writes into an array that is read-only for everyone else."""
    array.flags.writeable = True
    array[env] = row
    array.flags.writeable = False


def _each(option: str, value: Any, count: int) -> list[Any]:
    """One value for each of ``count`` environments: the same for all, or those of a list."""
    if isinstance(value, np.ndarray) and value.ndim == 1:
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        return [value] * count
    if len(value) != count:
        raise ValueError(f"{option}: found {len(value)}, expected {count}, one for each selected environment")
    return list(value)


def _listed(names: Any, option: str) -> list[Any]:
    if isinstance(names, np.ndarray) and names.ndim == 1:
        names = names.tolist()
    if isinstance(names, str) or not isinstance(names, Sequence) or len(names) == 0:
        raise ValueError(f"{option}: found {names!r}, expected a list of variants, at least one")
    return list(names)
