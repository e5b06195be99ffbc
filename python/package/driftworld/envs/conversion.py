"""Lets infos pass through Gymnasium's wrappers that convert arrays for another library, such as
``gymnasium.wrappers.vector.NumpyToTorch``.

Those wrappers also convert infos, but support neither strings nor object arrays, which are common in infos of vector
environments: they recurse endlessly or raise an error. This module extends Gymnasium's own conversion tables: strings
stay as they are, and object arrays stay object arrays with each object converted.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

import numpy as np

#: Gymnasium's conversion tables: since 1.2 one for all libraries, before that one from NumPy to each.
_TABLES = {
    "gymnasium.wrappers.array_conversion": "array_conversion",
    "gymnasium.wrappers.numpy_to_torch": "numpy_to_torch",
    "gymnasium.wrappers.jax_to_numpy": "numpy_to_jax",
}
_told: set[str] = set()


def teach_conversions() -> None:
    """Extends the tables of imported modules for values in infos. Called at resets, because the wrappers are imported
    before their first reset.
    """
    for module, name in _TABLES.items():
        if module in sys.modules and module not in _told:
            convert = getattr(sys.modules[module], name, None)
            # Since 1.2 the older names are plain functions.
            if hasattr(convert, "register"):
                _teach(convert)
            _told.add(module)


def _teach(convert: Any) -> None:
    of_numbers = convert.dispatch(np.ndarray)
    if of_numbers is convert.dispatch(object):
        of_numbers = convert.dispatch(Iterable)

    def array(value: Any, *target: Any, **more: Any) -> Any:
        if value.dtype != object:
            return of_numbers(value, *target, **more)
        converted = np.empty_like(value)
        for place, each in np.ndenumerate(value):
            converted[place] = None if each is None else convert(each, *target, **more)
        return converted

    def as_it_is(value: Any, *_target: Any, **_more: Any) -> Any:
        return value

    convert.register(np.ndarray, array)
    convert.register(str, as_it_is)
    if convert.dispatch(type(None)) is convert.dispatch(object):
        convert.register(type(None), as_it_is)
