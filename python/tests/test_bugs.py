"""The page of known bugs matches its table, and every test that it names exists."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def check(root: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(root / "scripts/bugs.py"), "--check"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_bugs_page_matches_its_table() -> None:
    done = check(ROOT)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("file", ["docs/bugs.json", "docs/bugs-you-know.md"])
def test_missing_test_or_changed_page_is_reported(tmp_path: Path, file: str) -> None:
    for each in ["python/tests", "tests", "env", "src", "curriculum", "metrics", "spec", "similarity", "generator", "report"]:
        (tmp_path / each).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / each).symlink_to(ROOT / each)
    for each in ["docs/bugs.json", "docs/bugs-you-know.md", "scripts/bugs.py"]:
        (tmp_path / each).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / each, tmp_path / each)
    assert check(tmp_path).returncode == 0
    text = (tmp_path / file).read_text(encoding="utf-8")
    (tmp_path / file).write_text(text.replace("test_log_resumes_where_it_stopped", "test_nobody_wrote"), encoding="utf-8")
    done = check(tmp_path)
    assert done.returncode == 1
    assert file in done.stderr
