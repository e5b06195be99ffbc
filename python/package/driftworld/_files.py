"""Reads and writes files: regular files only, up to a size limit, and atomically."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from driftworld import _native

#: The kinds of files; each has its own size limit (docs/limits.md).
FileKind = Literal["document", "library", "matrix"]


def read_bytes(path: str | os.PathLike[str], kind: FileKind = "document") -> bytes:
    """The bytes of a regular file. Devices, pipes and files above the limit are refused before anything is read.

    Raises:
        OSError: If the file does not exist or is not a regular file.
    """
    try:
        return _native.read_file(path, kind)
    except OSError as error:
        if error.errno is None:
            raise
        # Worded like the errors of Python's own functions.
        raise OSError(error.errno, os.strerror(error.errno), os.fspath(path)) from None


def read_text(path: str | os.PathLike[str], kind: FileKind = "document") -> str:
    """The text of a regular file, without a byte order mark.

    Raises:
        OSError: Like :func:`read_bytes`.
        UnicodeDecodeError: If it is not UTF-8.
    """
    return read_bytes(path, kind).decode("utf-8-sig")


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file atomically: writes a temporary file in its folder, which is created if missing, and renames it.
    The file keeps its mode, and a new one gets the mode that the umask leaves; devices and pipes are written directly.
    """
    try:
        _native.write_file(path, content)
    except OSError as error:
        # Worded like the errors of Python's own functions.
        error.filename = str(path)
        raise
