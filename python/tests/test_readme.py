"""Every block of Python in README.md and in the guide runs as it stands. Blocks of other languages are run elsewhere.

The blocks of a page run one after the other in one interpreter, as a reader would type them, in an empty folder. One that begins
with ```` ```python learners ```` needs packages of gigabytes and runs with those.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```python( learners)?\n(.*?)^```", re.DOTALL | re.MULTILINE)
PAGES = [ROOT / "docs" / "python.md", ROOT / "README.md"]


def run(program: str, folder: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        env={**os.environ, "SDL_VIDEODRIVER": "dummy", "MINARI_DATASETS_PATH": str(folder / "minari")},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_blocks_of_a_page_run(page: Path, tmp_path: Path) -> None:
    blocks = [text for large, text in BLOCK.findall(page.read_text(encoding="utf-8")) if not large]
    if page.name == "python.md":
        assert len(blocks) >= 7
    if blocks:
        run("\n".join(blocks), tmp_path)


@pytest.mark.learners
def test_the_blocks_for_learners_run(tmp_path: Path) -> None:
    pytest.importorskip("stable_baselines3", reason="the guide trains with it")
    blocks = [text for large, text in BLOCK.findall(PAGES[0].read_text(encoding="utf-8")) if large]
    assert len(blocks) >= 2
    run("\n".join(blocks), tmp_path)
