"""Every Python block in README.md and on the pages of `docs/` runs unchanged. `tests/pages/` runs the other blocks.

The blocks of a page run one after another in one interpreter, as a reader would type them, in an empty folder. A
block that starts with ```` ```python learners ```` needs packages of gigabytes, and runs only with those, after the
blocks above it; one with ```` ```python by-hand ```` needs an ML-Agents client, which the stage `unity` has.
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
PAGES = [
    page
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    if BLOCK.search(page.read_text(encoding="utf-8"))
]


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


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("page", [page for page in PAGES if "```python\n" in page.read_text(encoding="utf-8")], ids=name)
def test_blocks_of_a_page_run(page: Path, tmp_path: Path) -> None:
    blocks = [text for large, text in BLOCK.findall(page.read_text(encoding="utf-8")) if not large]
    assert blocks
    run("\n".join(blocks), tmp_path)


def test_pages_with_python_are_found() -> None:
    assert {"README.md", "docs/python.md", "docs/how-to/python.md"} <= {name(page) for page in PAGES}


@pytest.mark.learners
@pytest.mark.parametrize(
    "page", [page for page in PAGES if "```python learners" in page.read_text(encoding="utf-8")], ids=name
)
def test_blocks_for_learners_run(page: Path, tmp_path: Path) -> None:
    pytest.importorskip("stable_baselines3", reason="the guide trains with it")
    blocks = [text for large, text in BLOCK.findall(page.read_text(encoding="utf-8")) if large]
    assert blocks
    run("\n".join(blocks), tmp_path)
