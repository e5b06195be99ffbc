"""Makes Gymnasium's wrappers that convert arrays for another library, such as
``gymnasium.wrappers.vector.NumpyToTorch``, accept infos.

The wrappers also convert infos, but they support neither strings nor object arrays, which are common in infos of vector
environments: they recurse endlessly or raise an error. This module extends Gymnasium's conversion tables: strings are
left unchanged, and object arrays remain object arrays, with each object converted.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

import numpy as np

#: Gymnasium's conversion functions, by module: since 1.2 one for all libraries, before that one for each library.
_TABLES = {
    "gymnasium.wrappers.array_conversion": "array_conversion",
    "gymnasium.wrappers.numpy_to_torch": "numpy_to_torch",
    "gymnasium.wrappers.jax_to_numpy": "numpy_to_jax",
}
#: The modules whose function has been extended.
_extended: set[str] = set()


def teach_conversions() -> None:
    """Extends the conversion functions of modules that are imported by now. Called at resets, because a wrapper's module
    is imported before its first reset.
    """
    for module, name in _TABLES.items():
        if module in sys.modules and module not in _extended:
            convert = getattr(sys.modules[module], name, None)
            # Since 1.2 the older names are plain functions, which need no extension.
            if hasattr(convert, "register"):
                _extend(convert)
            _extended.add(module)


def _extend(convert: Any) -> None:
    convert_numbers = convert.dispatch(np.ndarray)
    if convert_numbers is convert.dispatch(object):
        convert_numbers = convert.dispatch(Iterable)

    def array(value: Any, *target: Any, **options: Any) -> Any:
        if value.dtype != object:
            return convert_numbers(value, *target, **options)
        converted = np.empty_like(value)
        for index, item in np.ndenumerate(value):
            converted[index] = None if item is None else convert(item, *target, **options)
        return converted

    def unchanged(value: Any, *_target: Any, **_options: Any) -> Any:
        return value

    convert.register(np.ndarray, array)
    convert.register(str, unchanged)
    if convert.dispatch(type(None)) is convert.dispatch(object):
        convert.register(type(None), unchanged)
