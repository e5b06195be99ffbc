"""Screenshots: their contents, and file names that must not lead outside their folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from channels import Channels
from clients import Client, Launcher, Seen
from worlds import AHEAD, thing, world


@pytest.fixture
def client(launcher: Launcher, channels: Channels, tmp_path: Path) -> Client:
    """A client whose screenshots go into ``a/b/pictures``."""
    client = launcher.start("--screenshots", str(tmp_path / "a" / "b" / "pictures"), channels=channels.all)
    channels.reset.say("reset_environment", world(thing(0, 6, 1.0), thing(2, 8)))
    client.reset()
    return client


def files_in(folder: Path) -> set[str]:
    """All files below a folder, except the executable."""
    names = {str(path.relative_to(folder)) for path in folder.rglob("*") if not path.is_dir()}
    return names - {"application/l2explorer.x86_64"}


def pixels(path: Path) -> npt.NDArray[np.uint8]:
    with Image.open(path) as picture:
        assert (picture.format, picture.mode) == ("PNG", "RGB")
        return np.array(picture)


def seen_pixels(seen: Seen) -> npt.NDArray[np.uint8]:
    levels: npt.NDArray[np.uint8] = np.rint(seen.rgb * 255).astype(np.uint8)
    return levels


def test_a_screenshot_shows_what_the_agent_sees_when_it_is_requested(
    client: Client, channels: Channels, tmp_path: Path
) -> None:
    before = client.step(AHEAD).now
    token = channels.debug.say("save_screenshot", {"filename": "a.png", "upscale_factor": 1})
    after = client.step(AHEAD).now
    answer = channels.debug.answer(token)
    assert (answer["action"], answer["payload"]) == ("ok", None)
    picture = pixels(tmp_path / "a" / "b" / "pictures" / "a.png")
    assert (picture == seen_pixels(before)).all() and (picture != seen_pixels(after)).any()


@pytest.mark.parametrize("factor", [None, 1, 2, 5, 128])
def test_a_screenshot_is_upscaled_by_the_requested_factor(
    client: Client, channels: Channels, tmp_path: Path, factor: int | None
) -> None:
    payload = {"filename": "a.png"} if factor is None else {"filename": "a.png", "upscale_factor": factor}
    channels.debug.say("save_screenshot", payload)
    now = client.step().now
    picture = pixels(tmp_path / "a" / "b" / "pictures" / "a.png")
    side = 32 * (factor or 1)
    assert picture.shape == (side, side, 3)
    if factor == 5:
        differences = abs(picture[2::5, 2::5].astype(int) - seen_pixels(now))
        assert (differences[:16] == 0).all(), (
            "pixel centres stay in place: the sky, the walls and the objects"
        )
        assert differences.max() <= 8, "the ground's pattern is smoothed over the size of a pixel"


@pytest.mark.parametrize("factor", [0, -1, 1.5, 129, 1e300, "2", [1], True])
def test_invalid_upscale_factors_fail(client: Client, channels: Channels, tmp_path: Path, factor: object) -> None:
    token = channels.debug.say("save_screenshot", {"filename": "a.png", "upscale_factor": factor})
    client.step()
    answer = channels.debug.answer(token)
    assert answer["action"] == "error" and "expected a whole number from 1 to 128" in answer["payload"][0]
    assert files_in(tmp_path) == set()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("a.png", "a.png"),
        ("a", "a.png"),
        ("runs/7/a.png", "runs/7/a.png"),
        ("/a.png", "a.png"),
        ("../a.png", "a.png"),
        ("../../../../../../a.png", "a.png"),
        ("runs/../../a.png", "a.png"),
        ("..\\a.png", "a.png"),
        ("C:\\Users\\me\\a.png", "a.png"),
        ("\\\\server\\share\\a.png", "a.png"),
        ("C:a.png", "a.png"),
        ("~/a.png", "~/a.png"),
        ("$HOME/a.png", "$HOME/a.png"),
        ("http://example.org/a.png", "a.png"),
        ("bäume.png", "bäume.png"),
    ],
)
def test_a_screenshot_of_any_name_is_written_inside_the_folder(
    client: Client, channels: Channels, tmp_path: Path, name: str, expected: str
) -> None:
    token = channels.debug.say("save_screenshot", {"filename": name})
    client.step()
    assert channels.debug.answer(token)["action"] == "ok"
    assert files_in(tmp_path) == {f"a/b/pictures/{expected}"}


def test_an_absolute_path_is_written_inside_the_folder(
    client: Client, channels: Channels, tmp_path: Path
) -> None:
    (tmp_path / "mine.png").write_text("mine", encoding="utf-8")
    channels.debug.say("save_screenshot", {"filename": str(tmp_path / "mine.png")})
    client.step()
    assert (tmp_path / "mine.png").read_text(encoding="utf-8") == "mine"
    assert files_in(tmp_path) == {"mine.png", "a/b/pictures/mine.png"}


@pytest.mark.parametrize(
    "name", ["", ".", "..", "/", "a/", ".hidden", "a\0.png", "a\n.png", "a" * 300, "a/" * 2000 + "a"]
)
def test_an_invalid_name_is_refused(client: Client, channels: Channels, tmp_path: Path, name: str) -> None:
    token = channels.debug.say("save_screenshot", {"filename": name})
    client.step()
    answer = channels.debug.answer(token)
    assert answer["action"] == "error" and "filename" in answer["payload"][0]
    assert files_in(tmp_path) == set()


def test_links_are_not_followed(client: Client, channels: Channels, tmp_path: Path) -> None:
    outside, pictures = tmp_path / "outside", tmp_path / "a" / "b" / "pictures"
    outside.mkdir()
    (outside / "mine.png").write_text("mine", encoding="utf-8")
    pictures.mkdir(parents=True)
    (pictures / "out").symlink_to(outside)
    (pictures / "mine.png").symlink_to(outside / "mine.png")
    (pictures / "dangling.png").symlink_to(outside / "new.png")
    tokens = [
        channels.debug.say("save_screenshot", {"filename": name})
        for name in ("out/a.png", "mine.png", "dangling.png", "out/deep/a.png")
    ]
    client.step()
    answers = {message["req_token"]: message["action"] for message in channels.debug.take()}
    assert [answers[token] for token in tokens] == ["error", "ok", "ok", "error"]
    assert (outside / "mine.png").read_text(encoding="utf-8") == "mine"
    assert files_in(outside) == {"mine.png"}
    assert not (pictures / "mine.png").is_symlink() and not (pictures / "dangling.png").is_symlink()


def test_a_folder_is_not_replaced(client: Client, channels: Channels, tmp_path: Path) -> None:
    (tmp_path / "a" / "b" / "pictures" / "a.png").mkdir(parents=True)
    token = channels.debug.say("save_screenshot", {"filename": "a.png"})
    client.step()
    assert "is a folder" in channels.debug.answer(token)["payload"][0]


def test_default_folder_is_screenshots_in_the_working_directory(
    launcher: Launcher, channels: Channels, tmp_path: Path
) -> None:
    client = launcher.start(channels=channels.all)
    client.reset()
    assert not (tmp_path / "screenshots").exists(), "the folder is created for the first screenshot"
    channels.debug.say("save_screenshot", {"filename": "a.png"})
    client.step()
    assert files_in(tmp_path) == {"screenshots/a.png"}


def test_an_unwritable_folder_is_answered_by_an_error_and_the_session_continues(launcher: Launcher, channels: Channels) -> None:
    Path("taken").write_text("a file", encoding="utf-8")
    client = launcher.start("--screenshots", "taken", channels=channels.all)
    client.reset()
    token = channels.debug.say("save_screenshot", {"filename": "a.png"})
    client.step()
    assert channels.debug.answer(token)["action"] == "error"
    assert client.close() == 0
