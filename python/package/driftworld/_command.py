"""The ``driftworld`` command asked by the package: options become arguments, what it prints becomes an answer.

Running it as a program is in ``__main__.py``.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from driftworld import _native
from driftworld.errors import DriftworldError


def ask(
    subcommand: str,
    arguments: Iterable[str | os.PathLike[str]],
    options: Mapping[str, Any],
    refused: type[DriftworldError],
    *,
    stacklevel: int = 3,
) -> str:
    """What a subcommand prints. Its warnings become Python's.

    Args:
        subcommand: Such as ``"metrics"``.
        arguments: Those without a name.
        options: By name, with ``_`` for ``-``: ``None`` and ``False`` are left out, ``True`` is the bare flag, a list is several
            values, a tuple is one value with commas.
        refused: What is raised when the command fails, with the command's message, in which options are called as in Python, and
            with code, place and problems where the error behind it has them.
        stacklevel: Whose line warnings name: 3 for that of whoever called the caller.
    """
    argv = [subcommand, *(os.fspath(argument) for argument in arguments)]
    for name, value in options.items():
        flag = f"--{name.replace('_', '-')}"
        if value is None or value is False:
            continue
        if value is True:
            argv.append(flag)
        elif isinstance(value, list):
            argv.extend([flag, *(_word(item) for item in value)] if value else [])
        elif isinstance(value, tuple):
            argv.append(f"{flag}={','.join(_word(item) for item in value)}")
        else:
            argv.append(f"{flag}={_word(value)}")
    output, notes, refusal = _native.ask(argv)
    for note in notes:
        if note.startswith("warning: "):
            warnings.warn(_in_python(note.removeprefix("warning: ")), stacklevel=stacklevel)
    if refusal is not None:
        message, details = refusal
        raise refused(_in_python(message), **details)
    return output


def _word(value: Any) -> str:
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, (float, np.floating)):
        # In full: the command takes -1e-09 for an option.
        return np.format_float_positional(value, trim="-")
    return str(value)


def _in_python(text: str) -> str:
    """A text of the command, with ``--some-option`` called ``some_option``; within paths and names it stays."""
    return re.sub(r"(?<![\w./\\-])--([a-z][a-z0-9-]*)", lambda option: option[1].replace("-", "_"), text)
