"""Devices, pipes and folders are refused by every function that reads a file."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import driftworld
import pytest
from driftworld import DistanceMatrix, DriftworldEnv, DriftworldVectorEnv

READERS: dict[str, Callable[[Path], Any]] = {
    "world": lambda path: DriftworldEnv(world=path),
    "worlds": lambda path: DriftworldVectorEnv(world=path, num_envs=2),
    "reset": lambda path: DriftworldEnv("find_objects", size=8).reset(options={"world": str(path)}),
    "assets": lambda path: DriftworldEnv("find_objects", assets=path),
    "distance": lambda path: driftworld.distance("find_objects#red", "find_objects#blue", by="worlds", assets=path),
    "sides": lambda path: driftworld.distance(path, path, by="worlds"),
    "validate": driftworld.validate,
    "libraries": lambda path: driftworld.validate("find_objects", assets=path),
    "scenario": driftworld.Curriculum.load,
    "matrix": lambda path: DistanceMatrix.load(path),
}
ENDINGS = {"matrix": [".csv", ".json"]}


@pytest.mark.skipif(os.name != "posix", reason="devices and pipes are POSIX's")
@pytest.mark.parametrize("kind", ["a device", "a named pipe", "a folder"])
@pytest.mark.parametrize("reader", READERS)
def test_only_regular_files_are_read(reader: str, kind: str, tmp_path: Path) -> None:
    for ending in ENDINGS.get(reader, [".json"]):
        path = tmp_path / f"file{ending}"
        if kind == "a device":
            path.symlink_to("/dev/zero")
        elif kind == "a named pipe":
            os.mkfifo(path)
        else:
            path.mkdir()
        with pytest.raises((OSError, driftworld.TaskError), match=f"found {kind}, expected a (regular file|task spec)"):
            READERS[reader](path)


def test_too_large_file_is_refused_before_reading(tmp_path: Path) -> None:
    path = tmp_path / "large.json"
    with path.open("wb") as file:
        file.truncate((64 << 20) + 1)
    for reader in ("world", "validate", "scenario"):
        with pytest.raises(OSError, match="found 67108865 bytes, expected at most 67108864"):
            READERS[reader](path)


def test_missing_file_is_named(tmp_path: Path) -> None:
    for reader in ("assets", "scenario", "matrix", "validate", "world"):
        with pytest.raises(FileNotFoundError, match="nothing.json"):
            READERS[reader](tmp_path / "nothing.json")
