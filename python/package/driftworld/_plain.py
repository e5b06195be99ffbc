"""NumPy's values and paths as JSON can say them. Documents that go to the native module are written with it."""

from __future__ import annotations

import os
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """What ``json.dumps`` writes instead of a value that it does not know.

    Raises:
        TypeError: If it is neither a number or an array of NumPy, nor a path.
    """
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    found = type(value).__name__
    raise TypeError(f"found a value of type {found}, expected what JSON can say: numbers, words, lists, dictionaries")
