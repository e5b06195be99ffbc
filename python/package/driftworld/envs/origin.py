"""Sources of worlds: turns names, handles and documents into streams that the native batch draws from."""

from __future__ import annotations

import hashlib
import json
import numbers
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld._files import read_text

#: The largest seed of worlds: the maximum of the integer arrays in vector environments' infos.
MAX_SEED = 2**63 - 1


@dataclass(frozen=True, eq=False)
class OneVariant:
    """The worlds of one variant."""

    variant: _native.Variant

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """The worlds, for each environment."""
        return [_native.Stream.variants([self.variant])] * num_envs


@dataclass(frozen=True, eq=False)
class OneWorld:
    """The same world in every episode: its name and its JSON."""

    name: str
    text: str

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """The world, for each environment."""
        return [_native.Stream.world(self.name, self.text)] * num_envs


@dataclass(frozen=True, eq=False)
class DrawnWorld:
    """A drawn world, held by the native module."""

    world: _native.Stream

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """The world, for each environment."""
        return [self.world] * num_envs


@dataclass(frozen=True, eq=False)
class Drifting:
    """Worlds drifting from one variant to another; schedule and switch are JSON."""

    from_: _native.Variant
    to: _native.Variant
    schedule: str
    switch: str
    episodes: int

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """The worlds, for each environment."""
        stream = _native.Stream.drift(self.from_, self.to, self.schedule, self.switch, self.episodes)
        return [stream] * num_envs


@dataclass(frozen=True, eq=False)
class Queue:
    """Variants dealt out like cards, over and over: environment 0 takes the first, 1 the second, and so on.

    Attributes:
        variants: The distinct variants.
        order: The queue as indices into ``variants``, uint32.
    """

    variants: tuple[_native.Variant, ...]
    order: NDArray[np.uint32]

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """Each environment's share. All share the order, so a long one is stored once."""
        return _native.Stream.dealt(self.variants, self.order, num_envs)


@dataclass(frozen=True, eq=False)
class OwnQueue(Queue):
    """A queue of which each environment has a copy, starting with the first variant."""

    def streams(self, num_envs: int) -> list[_native.Stream]:
        """The whole queue, for each environment."""
        return _native.Stream.dealt(self.variants, self.order, 1) * num_envs


#: The source of an environment's worlds, as immutable values without the user's own objects.
Source = OneVariant | OneWorld | DrawnWorld | Drifting | Queue


class Home:
    """The task, or the single world, that an environment is made for.

    Args:
        task: A built-in name or a path, with or without ``#variant``; a task spec or a variant.
        world: The path of a world, its JSON, or a dictionary, in place of a task.
        variant: The variant to start with, instead of the one after ``#``: its name, or a handle.
    """

    def __init__(self, task: Any, world: Any, variant: Any) -> None:
        if (task is None) == (world is None):
            found = "neither task nor world" if task is None else "both task and world"
            raise ValueError(
                f'environment: found {found}, expected one of them, as in task="my_task.json#variant"'
            )
        self.task: _native.TaskSpec | None = None
        self.world: OneWorld | None = None
        self.first: _native.Variant | None = None
        self._known: dict[str, _native.Variant] = {}
        if world is not None:
            if variant is not None:
                raise ValueError("variant: found a variant as well as a world, expected none: a world has no variants")
            self.world = OneWorld(*world_text(world))
            return
        self.task, named = _task(task)
        self.first = named or self.task.variant()
        if variant is not None:
            self.first = self.variant(variant, "variant")

    def __getstate__(self) -> dict[str, Any]:
        # The cache can be rebuilt.
        return {**self.__dict__, "_known": {}}

    def labels(self, sources: Iterable[Source]) -> list[str]:
        """The ids of the variants that have a label: those of the task, then any others that the environment or the
        sources start with.
        """
        if self.task is None or self.first is None:
            return []
        begun = [source.variant.id for source in sources if isinstance(source, OneVariant)]
        return list(dict.fromkeys([*(variant.id for variant in self.task.variants), self.first.id, *begun]))

    def source(self) -> Source:
        """The worlds that the environment starts with."""
        if self.world is not None:
            return self.world
        assert self.first is not None, "a home has either a task or a world"
        return OneVariant(self.first)

    def sources(
        self, num_envs: int, variants: Sequence[Any] | None, drift: Mapping[str, Any] | None
    ) -> list[Source]:
        """The initial source of each environment: its entry in ``variants``, the drift, or the common source."""
        home = self.source() if drift is None else self.drift(drift)
        if variants is None:
            return [home] * num_envs
        return [home if name is None else OneVariant(self.variant(name, "variant")) for name in variants]

    def variant(self, name: Any, option: str) -> _native.Variant:
        """Finds a variant by a user's name for it: a name, ``task#variant`` of this or another task, or a handle."""
        handle = _handle(name)
        if handle is not None:
            return handle
        if not isinstance(name, str):
            raise TypeError(f"{option}: found {name!r}, expected the name of a variant")
        own = name
        if "#" in name:
            task, _, own = name.rpartition("#")
            if self.task is None or task != self.task.name:
                return _native.TaskSpec.load(task).variant(own)
        if self.task is None:
            raise ValueError(f"{option}: found {name!r} in an environment with a single world, expected none or task#variant")
        # A task is immutable, and finding a variant takes longer than a step of a short episode.
        if own not in self._known:
            self._known[own] = self.task.variant(own)
        return self._known[own]

    def queue(self, names: Iterable[Any]) -> Queue:
        """A queue from users' names of variants; each is looked up once, however often it occurs."""
        listed = list(names)
        places: dict[Any, int] = {}
        found: list[_native.Variant] = []
        order = np.empty(len(listed), dtype=np.uint32)
        for turn, name in enumerate(listed):
            # Handles are keyed by identity, not by content, which is long; the list keeps them alive, so ids are not
            # reused.
            key = name if isinstance(name, str) else id(name)
            place = places.get(key)
            if place is None:
                place = places[key] = len(found)
                found.append(self.variant(name, "variant"))
            order[turn] = place
        return Queue(tuple(found), order)

    def drift(self, drift: Mapping[str, Any]) -> Drifting:
        """The worlds drifting from the first variant to another."""
        if not isinstance(drift, Mapping):
            raise ValueError(f'drift: found {drift!r}, expected a dictionary, as in {{"to": "dusk", "episodes": 500}}')
        known = {"to", "episodes", "schedule", "switch"}
        unknown = sorted(set(drift) - known)
        if unknown or "to" not in drift or "episodes" not in drift:
            raise ValueError(
                f'drift: found {dict(drift)!r}, expected "to" and "episodes", and optionally "schedule" and "switch", as in '
                '{"to": "dusk", "episodes": 500, "schedule": "cosine"}'
            )
        if self.first is None:
            raise ValueError("drift: found a drift in an environment with a single world, expected none: a world has no variants")
        to = self.variant(drift["to"], "drift.to")
        schedule = json.dumps(drift.get("schedule", "linear"))
        switch = json.dumps(drift.get("switch", "at_point"))
        return Drifting(self.first, to, schedule, switch, _episodes(drift["episodes"]))


def _episodes(found: Any) -> int:
    if isinstance(found, bool) or not isinstance(found, numbers.Integral) or found < 1:
        raise ValueError(f"drift.episodes: found {found!r}, expected a whole number of at least 1")
    return int(found)


def _handle(value: Any) -> _native.Variant | None:
    """The native variant of a toolkit variant, or the value itself if it is native."""
    value = getattr(value, "_native", value)
    return value if isinstance(value, _native.Variant) else None


def _task(task: Any) -> tuple[_native.TaskSpec, _native.Variant | None]:
    """The task, and the variant after ``#`` in its name."""
    variant = _handle(task)
    if variant is not None:
        return variant.task, variant
    task = getattr(task, "_native", task)
    if isinstance(task, _native.TaskSpec):
        return task, None
    if isinstance(task, Mapping):
        return _native.TaskSpec.from_json("task", json.dumps(task)), None
    if isinstance(task, (str, os.PathLike)):
        name = os.fspath(task)
        spec = _native.TaskSpec.load(name)
        _, hash_sign, own = name.rpartition("#")
        return spec, spec.variant(own) if hash_sign else None
    raise TypeError(f"task: found {task!r}, expected a name, a path, a TaskSpec, a Variant, or a dictionary")


def world_text(world: Any) -> tuple[str, str]:
    """The name and the JSON of a world: from a path, JSON text, a dictionary, or a drawn world."""
    if isinstance(world, _native.Stream):
        return "world", world.text()
    if isinstance(world, Mapping):
        return "world", json.dumps(world)
    if isinstance(world, str) and world.lstrip().startswith("{"):
        return "world", world
    if isinstance(world, (str, os.PathLike)):
        path = Path(world)
        try:
            return str(path), read_text(path)
        except FileNotFoundError as error:
            raise FileNotFoundError(
                f"world: found no file {str(path)!r}, expected the path of a world, its JSON, or a dictionary"
            ) from error
    raise TypeError(f"world: found {type(world).__name__}, expected a path, JSON text or a dictionary")


def spread_seeds(seed: int, num_envs: int) -> list[int]:
    """The seeds of environments that step together: the first is the seed itself, the others are drawn from it.

    A seed of 2⁶³ or more is folded first, as by ``reset``. Seeds are not consecutive: environments under seeds s and s
    + 1 share no world. The first seeds do not depend on ``num_envs``.

    Args:
        seed: The common seed, a whole number of at least 0.
        num_envs: Number of environments, from 1.

    Returns:
        One seed for each environment, each 0 to 2⁶³ − 1.
    """
    first = folded_seed(seed)
    drawn = np.random.SeedSequence(first).generate_state(num_envs, np.uint64) >> np.uint64(1)
    return [first, *drawn[1:].tolist()]


def whole_number(found: Any, option: str = "seed") -> int:
    """A whole number of at least 0.

    Raises:
        TypeError, ValueError: For anything else.
    """
    try:
        number = int(found.__index__())
    except AttributeError:
        raise TypeError(f"{option}: found {found!r}, expected a whole number") from None
    if number < 0:
        raise ValueError(f"{option}: found {number}, expected a whole number of at least 0")
    return number


def folded_seed(seed: Any) -> int:
    """The seed used for worlds, from a Gymnasium seed, any whole number of at least 0.

    A seed below 2⁶³ is used as it is. A larger one becomes the first 8 bytes of the SHA-256 of its hexadecimal digits
    (ASCII, lower case), read as a big-endian number, without the highest bit.
    """
    number = whole_number(seed)
    if number <= MAX_SEED:
        return number
    print = hashlib.sha256(f"{number:x}".encode()).digest()
    return int.from_bytes(print[:8], "big") & MAX_SEED


def index_in_range(index: Any, option: str = "index") -> int:
    """Checks that a world index is in range."""
    number = whole_number(index, option)
    if number > MAX_SEED:
        raise ValueError(f"{option}: found {number}, expected a whole number in 0..{MAX_SEED}")
    return number
