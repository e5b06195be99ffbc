"""Converts NumPy values and paths to JSON, for documents that are passed to the native module."""

from __future__ import annotations

import os
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """The ``default`` of ``json.dumps``: converts a value that it does not know.

    Raises:
        TypeError: If the value is neither a NumPy number or array nor a path.
    """
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    found = type(value).__name__
    raise TypeError(
        f"found a value of type {found}, expected what JSON can express: numbers, strings, lists, dictionaries"
    )
