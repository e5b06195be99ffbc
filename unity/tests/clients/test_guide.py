"""Runs the Python example in docs/l2explorer.md unchanged."""

from __future__ import annotations

import importlib.metadata
import os
import re
import socket
import subprocess
import sys
from pathlib import Path

import pytest

GUIDE = Path(__file__).parents[3] / "docs" / "l2explorer.md"
BLOCK = re.compile(r"^```python(?: by-hand)?\n(.*?)^```", re.DOTALL | re.MULTILINE)


@pytest.mark.skipif(
    not importlib.metadata.version("mlagents-envs").startswith("0.16."),
    reason="the guide is written for 0.16; its comments say what differs in other versions",
)
def test_the_guides_example_runs(tmp_path: Path) -> None:
    """Runs the example as a reader would, with the two variables that the guide exports."""
    link = tmp_path / "l2explorer.x86_64"
    link.symlink_to(Path(os.environ["DRIFTWORLD_UNITY"]).resolve())
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        # The port is 5005 plus the worker's number.
        worker = free.getsockname()[1] - 5005
    blocks = BLOCK.findall(GUIDE.read_text(encoding="utf-8"))
    assert len(blocks) == 1
    done = subprocess.run(
        [sys.executable, "-c", blocks[0]],
        cwd=tmp_path,
        env={**os.environ, "L2EXPLORER_APP": str(link), "L2EXPLORER_WORKER_ID": str(worker)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "(1, 84, 84, 3)" in done.stdout
