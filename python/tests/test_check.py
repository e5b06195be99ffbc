"""`python -m driftworld.check` passes correct environments, finds faults, and returns an exit status."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import driftworld
import gymnasium
import numpy as np
import pytest
from driftworld import check as checks
from driftworld._equality import first_difference
from driftworld.check import __main__ as command
from driftworld.envs import DriftworldEnv, DriftworldVectorEnv


def failed(report: checks.Report) -> list[str]:
    return [finding.rule for finding in report.findings if finding.outcome == "failed"]


def test_each_built_in_task_keeps_the_contract(env_id: str) -> None:
    report = checks.check(env_id, steps=25, processes=False, size=40)
    assert report.ok, str(report)
    assert "all rules passed" in str(report)


def test_processes_keep_the_contract() -> None:
    report = checks.check("find_objects#red", steps=20, size=40, modalities=["rgb"])
    assert report.ok, str(report)
    assert [each.outcome for each in report.findings if "AsyncVectorEnv" in each.rule] == ["passed"]


def test_only_the_window_check_needs_pygame(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygame", None)
    report = checks.check("get_to_goal", steps=20, processes=False, size=40, modalities="rgb")
    assert report.ok, str(report)
    outcomes = {finding.rule: finding.outcome for finding in report.findings}
    assert outcomes["Gymnasium's check_env, without a warning"] == "passed"
    assert [outcome for rule, outcome in outcomes.items() if "window" in rule] == ["skipped"]


def test_blank_window_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygame", reason="windows are pygame's")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    render = DriftworldEnv.render
    report = checks.check("get_to_goal", steps=5, processes=False, size=40, modalities="rgb")
    assert [each.outcome for each in report.findings if "window" in each.rule] == ["passed"]
    monkeypatch.setattr(DriftworldEnv, "render", lambda self: render(self) or "a picture")
    assert 'opens a window with render_mode="human"' in failed(
        checks.check("get_to_goal", steps=5, processes=False, size=40, modalities="rgb")
    )


def test_custom_tasks_and_worlds_are_checked(task_file: Path, world_file: Path) -> None:
    for name in (f"{task_file}#landmarks", str(task_file), str(world_file)):
        report = checks.check(name, steps=20, processes=False, size=40)
        assert report.ok, str(report)


def test_reward_that_differs_in_the_batch_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    step = DriftworldVectorEnv.step

    def generous(self: Any, actions: Any) -> Any:
        observations, rewards, *rest = step(self, actions)
        return observations, rewards + 1e-12, *rest

    monkeypatch.setattr(DriftworldVectorEnv, "step", generous)
    found = failed(checks.check("find_objects", steps=5, processes=False, size=40))
    assert "a single environment matches the batch, bit for bit" in found
    assert "matches SyncVectorEnv, bit for bit" in found


def test_ignored_seed_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    reset = DriftworldEnv.reset

    def forgetful(self: Any, *, seed: int | None = None, options: Any = None) -> Any:
        return reset(
            self, seed=None if seed is None else seed + np.random.default_rng().integers(1, 1000), options=options
        )

    monkeypatch.setattr(DriftworldEnv, "reset", forgetful)
    found = failed(checks.check("find_objects", steps=5, processes=False, size=40))
    assert "Gymnasium's check_env, without a warning" in found
    assert "same seed, same sequence of worlds" in found


def test_final_observation_of_the_next_episode_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    if not hasattr(gymnasium.vector, "AutoresetMode"):
        pytest.skip("Gymnasium 1.0 has no final observations to compare with")
    from driftworld.envs.members import Members

    monkeypatch.setattr(Members, "final_observation", Members.observation)
    assert failed(checks.check("find_objects", steps=20, processes=False, size=40)) == [
        "autoreset in the same step, with the final observation"
    ]


def test_incomplete_state_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    state = DriftworldEnv.state

    def forgetful(self: DriftworldEnv) -> dict[str, Any]:
        # Without progress and seeds, wandering objects draw a different goal.
        world = state(self)
        del world["progress"]
        for thing in world["objects"]:
            thing.pop("seed", None)
        return world

    monkeypatch.setattr(DriftworldEnv, "state", forgetful)
    assert failed(checks.check("moving_object", steps=20, processes=False, size=40)) == [
        "continues from state(), bit for bit"
    ]


def test_command_prints_table_or_json_and_exits_with_0(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        "find_objects#red",
        "--no-processes",
        "--steps",
        "5",
        "--option",
        "size=40",
        "--option",
        "depth=uint8",
    ]
    assert command.main(arguments) == 0
    printed = capsys.readouterr().out
    assert "find_objects#red\n  passed   Gymnasium's check_env" in printed
    assert command.main([*arguments, "--json"]) == 0
    (report,) = json.loads(capsys.readouterr().out)
    assert (report["ok"], report["task"]) == (True, "find_objects#red")
    assert report["versions"]["driftworld"] == driftworld.__version__


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["find_object"], "find_object"),
        (["no/such/file.json"], "no/such/file.json"),
        (["find_objects#rde"], "rde"),
        (["driftworld/Nowhere-v0"], "Nowhere"),
        (["find_objects", "--option", "depth=float16"], "depth: found 'float16'"),
    ],
    ids=str,
)
def test_impossible_environment_fails_with_reason(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main(arguments) == 1
    printed = capsys.readouterr().out
    assert "failed   can be made" in printed
    assert message in printed


@pytest.mark.parametrize(
    "arguments",
    [[], ["find_objects", "--steps", "0"], ["find_objects", "--option", "size"], ["find_objects", "--nonsense"]],
    ids=str,
)
def test_invalid_arguments_exit_with_2(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(arguments)
    assert ended.value.code == 2


def test_counts_below_1_are_refused() -> None:
    with pytest.raises(ValueError, match="num_envs, steps: found 0 and 5"):
        checks.check("find_objects", num_envs=0, steps=5)


@pytest.mark.parametrize(
    "left, right, difference",
    [
        (1.0, 1.0, None),
        (float("nan"), float("nan"), None),
        (1, 1.0, "x: 1 (int) against 1.0 (float)"),
        (True, np.True_, "x: True (bool) against np.True_ (bool)"),
        (np.zeros(2, np.uint8), np.zeros(2, np.int16), "x: uint8 (2,) against int16 (2,)"),
        (np.array([[1, 2], [3, 4]]), np.array([[1, 2], [5, 6]]), "x[1, 0]: 3 against 5 (2 of 4 differ)"),
        (np.array([0.0]), np.array([-0.0]), "x[0]: 0.0 against -0.0 (1 of 1 differ)"),
        ({"a": (1, [2])}, {"a": (1, [3])}, "x['a'][1][0]: 2 against 3"),
        ({"a": 1}, {"b": 1}, "x: only the left one has a"),
        (np.array([None, "a"], dtype=object), np.array([None, "b"], dtype=object), "x[1]: 'a' against 'b'"),
    ],
    ids=str,
)
def test_first_difference_is_reported_with_its_position(left: Any, right: Any, difference: str | None) -> None:
    assert first_difference(left, right, "x") == difference
