"""`driftworld.studio` serves the workbench and shows it in a notebook's frame."""

from __future__ import annotations

import json
import re
import urllib.request
from contextlib import closing
from pathlib import Path

import driftworld
import pytest
from driftworld import DriftworldError


@pytest.fixture(autouse=True)
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A page of one line."""
    (tmp_path / "index.html").write_text("<p>a page")
    monkeypatch.setenv("DRIFTWORLD_STUDIO", str(tmp_path))


def test_frame_shows_the_served_page_until_it_is_closed() -> None:
    with closing(driftworld.studio("find_objects#red", height=400)) as studio:
        assert studio.address.endswith("#/play/find_objects?variant=red")
        found = re.fullmatch(r'<iframe src="(.*?)" .*height="400".*></iframe>', studio._repr_html_())
        assert found and found[1] == studio.address
        assert urllib.request.urlopen(studio.address).read() == b"<p>a page"
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(studio.address)


def test_own_task_is_opened_in_the_editor(tmp_path: Path) -> None:
    path = tmp_path / "a task.json"
    path.write_text(json.dumps(driftworld.TaskSpec.load("maze").to_dict()))
    with closing(driftworld.studio(path)) as studio:
        assert "#/author/draft?file=task.json" in studio.address


@pytest.mark.parametrize("task", ["nosuch", "maze#nosuch", "--port"])
def test_unknown_tasks_are_errors(task: str) -> None:
    with pytest.raises(DriftworldError, match="nosuch|--port"):
        driftworld.studio(task)


def test_missing_page_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DRIFTWORLD_STUDIO", "no/such/folder")
    with pytest.raises(DriftworldError, match="no/such/folder"):
        driftworld.studio()
