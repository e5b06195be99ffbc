"""Converts values to JSON, for documents that are passed to the native module."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Mapping
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
        f"found a value of type {found}, expected one that JSON can represent: a number, string, list or dictionary"
    )


def json_or_word(text: str) -> Any:
    """The value of an option on the command line: JSON, or else the text itself."""
    try:
        return json.loads(text)
    except ValueError:
        return text


def described(value: Any) -> Any:
    """A setting as JSON: numbers, words, lists, mappings and dataclasses by value, any other object by the name of its
    class, and NaN and infinities as words.
    """
    if isinstance(value, (np.generic, np.ndarray, os.PathLike)):
        value = plain(value)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = dataclasses.asdict(value)
    if isinstance(value, Mapping):
        return {str(name): described(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [described(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value if isinstance(value, (str, int, float, type(None))) else type(value).__name__
