"""Fixtures for the tests with Python clients: the executable, a launcher, and the side channels."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from channels import Channels
from clients import Launcher

# The default folder of the original's example files, beside the checkout.
DEFAULT_REFERENCE = Path(__file__).parents[4] / "shared" / "reference"


@pytest.fixture(scope="session")
def executable() -> Path:
    """The executable under test."""
    path = os.environ.get("DRIFTWORLD_UNITY")
    if not path:
        pytest.fail("DRIFTWORLD_UNITY: not set, expected the path of a built driftworld-unity")
    return Path(path).resolve(strict=True)


@pytest.fixture
def launcher(executable: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Launcher]:
    """A launcher that starts clients in the test's own folder."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "application"
    folder.mkdir()
    launcher = Launcher(executable, folder)
    yield launcher
    launcher.end()


@pytest.fixture
def channels() -> Channels:
    """The three channels of one client."""
    return Channels()


@pytest.fixture(scope="session")
def reference() -> Path:
    """Example files of the original."""
    folder = Path(os.environ.get("DRIFTWORLD_REFERENCE") or DEFAULT_REFERENCE) / "l2explorer"
    if not folder.is_dir():
        pytest.skip(f"{folder} does not exist: set DRIFTWORLD_REFERENCE to the folder of the original's example files")
    return folder
