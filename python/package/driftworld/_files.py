"""Files that appear whole or not at all. What is written is the callers'."""

from __future__ import annotations

from pathlib import Path

from driftworld import _native


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file under a temporary name in its folder, which is made where it is missing, and renames it. It gets the mode that the
    umask leaves to it, or keeps the one that it had; devices and pipes are written straight."""
    try:
        _native.write_file(path, content)
    except OSError as error:
        # As Python's own functions say it.
        error.filename = str(path)
        raise
