"""Checks that a frozen agent behaves identically when evaluations of a block are repeated."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from driftworld.errors import CurriculumError

if TYPE_CHECKING:
    from driftworld.curricula import Experience


class Trace:
    """An agent's observations and actions in one evaluation: a hash for each step."""

    def __init__(self) -> None:
        self.steps: list[bytes] = []
        self._seen = b""

    def see(self, observation: Any) -> None:
        """Adds the observation before a step; called before the agent can write into it."""
        self._seen = _print_of(observation)

    def do(self, action: Any) -> None:
        """Adds the action."""
        self.steps.append(self._seen + _print_of(action))


class Frozenness:
    """Checks that an agent behaves identically when evaluations of a block are repeated."""

    def __init__(self) -> None:
        self._first: dict[int, Trace] = {}
        self._repeated: Sequence[int] = ()

    def begin_block(self, repeated: Sequence[int]) -> None:
        """Forgets the previous block; ``repeated`` experiences are run twice."""
        self._first.clear()
        self._repeated = repeated

    def trace(self, number: int) -> Trace | None:
        """The trace for recording an experience; ``None`` if it is never repeated."""
        return Trace() if number in self._repeated else None

    def expect_same(self, now: Experience, trace: Trace | None) -> None:
        """Compares an experience with its first run, if this is the repetition.

        Raises:
            CurriculumError: If the agent behaved differently; names the first such step.
        """
        if trace is None:
            return
        first = self._first.setdefault(now.number, trace)
        if first.steps == trace.steps:
            return
        pairs = enumerate(zip(first.steps, trace.steps, strict=False), start=1)
        step = next((number for number, (one, other) in pairs if one != other), min(len(first.steps), len(trace.steps)) + 1)
        raise CurriculumError(
            f"block {now.block}: found a different action in step {step} of experience {now.number} ({now.variant}) when this evaluation was "
            "run once more, expected the same: evaluations change the agent, or its random numbers are not drawn from the seed that "
            "begin() gets. While frozen, keep separate running statistics, memories and counters, and use your own generators instead "
            "of NumPy's, torch's or Python's global ones; check_frozen=False runs without this check",
            code="curriculum/not-frozen",
        )


def _print_of(value: Any) -> bytes:
    """A hash of an observation or an action."""
    print = hashlib.blake2b(digest_size=8)
    if isinstance(value, Mapping):
        for name in sorted(value):
            print.update(str(name).encode() + _print_of(value[name]))
    else:
        array = np.ascontiguousarray(value)
        print.update(f"{array.dtype.str} {array.shape}".encode())
        print.update(array.tobytes() if array.dtype != object else repr(value).encode())
    return print.digest()
