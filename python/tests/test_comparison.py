"""The page of the comparison with other systems matches its logs, and runs are summarised as the page describes."""

import importlib.util
import json
import shutil
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def compare(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    path = ROOT / "examples/python/comparison/compare.py"
    specification = importlib.util.spec_from_file_location("compare", path)
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    monkeypatch.setitem(sys.modules, "compare", module)
    specification.loader.exec_module(module)
    return module


def test_page_matches_the_logs(compare: ModuleType) -> None:
    assert compare.PAGE.read_text(encoding="utf-8") == compare.page()


def test_changed_page_is_reported(compare: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = tmp_path / "comparison.md"
    other.write_text(compare.page().replace("| MiniGrid |", "| MiniGird |"), encoding="utf-8")
    monkeypatch.setattr(compare, "PAGE", other)
    monkeypatch.setattr(sys, "argv", ["compare.py", "page", "--check"])
    with pytest.raises(SystemExit, match="found a page that does not match the logs"):
        compare.main()


def test_run_is_learned_after_80_successes_in_100_episodes(
    compare: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def row(decisions: int, episodes: str) -> str:
        return json.dumps({"decisions": decisions, "wall": 4.0, "processor": 2.0, "in_envs": 1.0, "load": 1.0, "episodes": episodes})

    rows = [json.dumps({"decisions": 40}), row(10, "1" * 99), row(20, "0" * 20), row(30, "0" + "1" * 81), row(40, "1" * 80 + "0" * 20)]
    monkeypatch.setattr(compare, "LOGS", tmp_path)
    (tmp_path / "room").mkdir()
    (tmp_path / "room/0.jsonl").write_text("\n".join(rows), encoding="utf-8")
    found = compare.summary("room", 0)
    # After 10 decisions 99 episodes have ended, after 20 there are 80 successes among the last hundred.
    assert found["reached"]["decisions"] == 20
    assert (found["first"], found["last"], found["rate"]) == (0.99, 0.8, 20.0)
    (tmp_path / "room/0.jsonl").write_text("\n".join([rows[0], row(20, "0" * 21 + "1" * 79)]), encoding="utf-8")
    assert compare.summary("room", 0)["reached"] is None


def test_log_names_its_task_and_seed(compare: ModuleType) -> None:
    logs = sorted(compare.LOGS.glob("*/*.jsonl"))
    assert logs
    for log in logs:
        head, *rows = compare.read(log)
        assert (head["task"], str(head["seed"])) == (log.parent.name, log.stem)
        assert head["task"] in compare.tasks()["tasks"]
        # The budget is spent, except for less than one rollout of all environments.
        assert rows[-1]["decisions"] > head["decisions"] - head["num_envs"] * head["settings"]["rollout"]


def test_page_without_jaxenstein_logs_has_four_systems_and_says_so(
    compare: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "five systems" in compare.page()
    shutil.copytree(compare.LOGS, tmp_path / "logs", ignore=shutil.ignore_patterns("jaxenstein-*"))
    monkeypatch.setattr(compare, "LOGS", tmp_path / "logs")
    found = " ".join(compare.page().split())
    assert "# One PPO in four systems" in found
    assert "3 of jaxenstein-simple, 3 of jaxenstein-house" in found
    assert "| JAXenstein | `simple` | 3 |" not in found


def test_run_and_speed_resume_where_they_stopped(
    compare: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[tuple[str, ...]] = []

    def python(_: object, system: str, core: int, *arguments: str) -> str:
        started.append(arguments[:3])
        if arguments[0] == "learn":
            Path(arguments[3]).parent.mkdir(exist_ok=True)
            Path(arguments[3]).touch()
        return json.dumps({"task": arguments[1], "decisions": 10, "processor": 1.0, "core": core, "system": system})

    monkeypatch.setattr(compare, "LOGS", tmp_path)
    monkeypatch.setattr(compare.Systems, "python", python)
    systems = compare.Systems(tmp_path, None)
    (tmp_path / "minigrid").mkdir()
    (tmp_path / "minigrid/0.jsonl").touch()
    for anew, count in ((False, 3), (False, 0), (True, 4)):
        started.clear()
        compare.run(systems, [0], range(2), ["minigrid", "miniworld", "jaxenstein-simple"], None, anew)
        # Of two seeds of two tasks: without a checkout of JAXenstein, its task is left out.
        assert len(started) == count
    for repeats, anew, count in ((1, False, 2), (3, False, 4), (3, False, 0), (3, True, 6)):
        started.clear()
        compare.speed(systems, 0, repeats, 1.0, ["minigrid", "miniworld"], anew)
        assert len(started) == count
    assert [row["repeat"] for row in compare.read(tmp_path / "speed.jsonl")] == [0, 0, 1, 1, 2, 2]


def test_folder_that_is_not_a_checkout_is_refused(compare: ModuleType, tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"--jaxenstein: found no jaxenstein/__init__\.py in .*, expected a checkout"):
        compare.Systems(tmp_path, tmp_path)
    (tmp_path / "jaxenstein").mkdir()
    (tmp_path / "jaxenstein/__init__.py").touch()
    assert "jaxenstein" in compare.Systems(tmp_path, tmp_path).names
