"""Compares two results of environments bit by bit, and names the first difference.

Stricter than ``numpy.array_equal``: types and shapes count as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def first_difference(left: Any, right: Any, place: str = "") -> str | None:
    """The first difference between two values, as ``place: left against right``; ``None`` if they are equal to the last
    bit.

    Args:
        left: Numbers, strings, arrays, or mappings and sequences of these, nested to any depth.
        right: The value to compare with.
        place: How the result refers to the values.
    """
    if isinstance(left, Mapping) and isinstance(right, Mapping):
        return _of_mappings(left, right, place)
    if isinstance(left, np.ndarray) and isinstance(right, np.ndarray):
        return _of_arrays(left, right, place)
    if isinstance(left, (tuple, list)) and isinstance(right, (tuple, list)):
        return _of_sequences(left, right, place)
    if type(left) is not type(right):
        return f"{place}: {_shown(left)} ({type(left).__name__}) against {_shown(right)} ({type(right).__name__})"
    is_same = bool(left == right) or (_is_nan(left) and _is_nan(right))
    return None if is_same else f"{place}: {_shown(left)} against {_shown(right)}"


def _is_nan(value: Any) -> bool:
    return isinstance(value, (float, np.floating)) and bool(np.isnan(value))


def _of_mappings(left: Mapping[Any, Any], right: Mapping[Any, Any], place: str) -> str | None:
    for names, which in ((left.keys() - right.keys(), "left"), (right.keys() - left.keys(), "right")):
        if names:
            return f"{place}: only the {which} one has {', '.join(sorted(map(str, names)))}"
    for name in left:
        difference = first_difference(left[name], right[name], f"{place}[{name!r}]")
        if difference is not None:
            return difference
    return None


def _of_sequences(left: tuple[Any, ...] | list[Any], right: tuple[Any, ...] | list[Any], place: str) -> str | None:
    if len(left) != len(right):
        return f"{place}: {len(left)} entries against {len(right)}"
    for index, (one, other) in enumerate(zip(left, right, strict=True)):
        difference = first_difference(one, other, f"{place}[{index}]")
        if difference is not None:
            return difference
    return None


def _of_arrays(left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], place: str) -> str | None:
    if left.dtype != right.dtype or left.shape != right.shape:
        return f"{place}: {left.dtype} {left.shape} against {right.dtype} {right.shape}"
    if left.dtype == object:
        return _of_sequences(left.ravel().tolist(), right.ravel().tolist(), place)
    # Compares bytes: NaNs with the same bits are equal, and 0.0 differs from -0.0.
    if left.tobytes() == right.tobytes():
        return None
    flat_left, flat_right = left.ravel(), right.ravel()
    differs = np.array([one.tobytes() != other.tobytes() for one, other in zip(flat_left, flat_right, strict=True)])
    index = int(np.argmax(differs))
    where = tuple(int(part) for part in np.unravel_index(index, left.shape))
    return f"{place}{list(where)}: {flat_left[index]} against {flat_right[index]} ({int(differs.sum())} of {left.size} differ)"


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
