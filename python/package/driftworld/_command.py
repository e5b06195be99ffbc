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
    """A text of the command as Python says it.

    ``--some-option`` is ``some_option``, but within paths and names; what is wrong with a value is said as everywhere else; and no
    word is left that only the command line or the library in Rust has a meaning for.
    """
    text = re.sub(r"\b[A-Z]\w*::(?=[a-z])", "", text)
    text = re.sub(r"(?<![\w./\\-])--([a-z][a-z0-9-]*)", lambda option: option[1].replace("-", "_"), text)
    # Where both were named, they are one now.
    text = re.sub(r"\b(\w+) or \1\b", r"\1", text)
    wrong = _WRONG_VALUE.match(text)
    if wrong is not None:
        return f"{wrong['option']}: found {wrong['found']!r}, expected {_expected(wrong)}"
    missing = _MISSING.match(text)
    if missing is not None:
        names = ", ".join(line.split()[0] for line in missing[1].splitlines() if line.strip())
        return f"options: found no {names}, expected it beside those that were given"
    return _PLACEHOLDER.sub("", text)


#: How the command says that the value of an option is wrong, and that one is missing.
_WRONG_VALUE = re.compile(
    r"invalid value '(?P<found>.*)' for '(?P<option>\w+)[^']*'(?::\s*(?P<reason>[^\n]*))?(?:\s*\[possible values: (?P<known>[^\]]*)\])?",
    re.DOTALL,
)
_MISSING = re.compile(r"the following required arguments were not provided:\n((?:  .*\n?)+)")
_PLACEHOLDER = re.compile(r" ?<[A-Z][A-Z_]*>(?:\.\.\.)?")
#: What parsers of numbers say.
_NO_NUMBER = {
    "invalid digit found in string": "a whole number from 0 on",
    "number too large to fit in target type": "a smaller number",
    "number too small to fit in target type": "a larger number",
    "cannot parse integer from empty string": "a whole number",
    "invalid float literal": "a number",
}


def _expected(wrong: re.Match[str]) -> str:
    """What is expected in place of a wrong value."""
    if wrong["known"] is not None:
        return f"one of {wrong['known']}"
    reason = wrong["reason"] or "another value"
    within = re.search(r"is not in (\S+)", reason)
    if within is not None:
        return f"a whole number in {within[1]}"
    _, said, expected = reason.partition("expected ")
    return expected if said else _NO_NUMBER.get(reason, f"another: {reason}")
