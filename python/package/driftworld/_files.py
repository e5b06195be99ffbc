"""Files are read and written here: regular files only, up to a limit, and whole or not at all. What is in them is the callers'."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from driftworld import _native

#: What a file is read as; each has a limit of its own (docs/limits.md).
FileKind = Literal["document", "library", "matrix"]


def read_bytes(path: str | os.PathLike[str], kind: FileKind = "document") -> bytes:
    """The bytes of a regular file; devices, pipes and files above the limit are refused before any of them is read.

    Raises:
        OSError: If there is none, or something else.
    """
    try:
        return _native.read_file(path, kind)
    except OSError as error:
        if error.errno is None:
            raise
        # As Python's own functions say it.
        raise OSError(error.errno, os.strerror(error.errno), os.fspath(path)) from None


def read_text(path: str | os.PathLike[str], kind: FileKind = "document") -> str:
    """The text of a regular file, without a byte order mark.

    Raises:
        OSError: As :func:`read_bytes`.
        UnicodeDecodeError: If it is not UTF-8.
    """
    return read_bytes(path, kind).decode("utf-8-sig")


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file under a temporary name in its folder, which is made where it is missing, and renames it. It gets the mode that the
    umask leaves to it, or keeps the one that it had; devices and pipes are written straight."""
    try:
        _native.write_file(path, content)
    except OSError as error:
        # As Python's own functions say it.
        error.filename = str(path)
        raise
