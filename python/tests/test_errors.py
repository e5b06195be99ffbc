"""Every exception has the message, code and position of the native error."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import driftworld
import pytest
from driftworld import Curriculum, DriftworldError, TaskSpec

CROWDED: dict[str, Any] = {
    "name": "crowded",
    "groups": [
        {
            "name": "rocks",
            "count": 50,
            "placement": {"disc": {"center": [0, 0], "radius": 2}},
            "object": {"class": "cube", "scale": 4},
        }
    ],
}


def unknown_key() -> Any:
    return TaskSpec.from_json("mine.json", '{\n  "name": "x",\n  "paramters": {}\n}')


def invalid_json() -> Any:
    return TaskSpec.from_json("mine.json", '{\n  "name": }')


def unknown_task() -> Any:
    return TaskSpec.load("find_object")


def no_free_place() -> Any:
    return TaskSpec.from_dict(CROWDED).sample()


def different_tasks() -> Any:
    return driftworld.Drift(driftworld.variant("find_objects#red"), driftworld.variant("get_to_goal#plain"))


def unknown_method() -> Any:
    return driftworld.order("find_objects", "nearby")


def step_after_end() -> Any:
    env = driftworld.DriftworldEnv("find_objects", modalities="rgb", size=16, max_steps=1)
    env.reset(seed=0)
    env.step(env.action_space.sample())
    return env.step(env.action_space.sample())


def missing_log() -> Any:
    return driftworld.read_log("nowhere")


def unknown_experience() -> Any:
    return Curriculum.design("find_objects#red").experience(10**6)


CASES: list[tuple[Callable[[], Any], type[DriftworldError], type[Exception], str]] = [
    (unknown_key, driftworld.SpecError, ValueError, "spec/unknown-key"),
    (invalid_json, driftworld.SpecError, ValueError, "spec/syntax"),
    (unknown_task, driftworld.TaskError, LookupError, "task/unknown"),
    (no_free_place, driftworld.GeneratorError, Exception, "generator/no-place"),
    (different_tasks, driftworld.GeneratorError, Exception, "generator/different-tasks"),
    (unknown_method, driftworld.SimilarityError, Exception, "similarity/unknown-method"),
    (step_after_end, driftworld.EnvError, Exception, "env/ended"),
    (missing_log, driftworld.MetricsError, Exception, "metrics/not-a-directory"),
    (unknown_experience, driftworld.CurriculumError, Exception, "curriculum/no-such-experience"),
]


@pytest.mark.parametrize(("wrong", "kind", "base", "code"), CASES, ids=[case[0].__name__ for case in CASES])
def test_error_has_its_class_and_code(
    wrong: Callable[[], Any], kind: type[DriftworldError], base: type[Exception], code: str
) -> None:
    with pytest.raises(DriftworldError) as refused:
        wrong()
    error = refused.value
    assert type(error) is kind and isinstance(error, base) and isinstance(error, DriftworldError)
    assert error.code == code and "expected" in str(error)


@pytest.mark.parametrize(("wrong", "kind", "base", "code"), CASES, ids=[case[0].__name__ for case in CASES])
def test_error_survives_copying(
    wrong: Callable[[], Any], kind: type[DriftworldError], base: type[Exception], code: str
) -> None:
    with pytest.raises(DriftworldError) as refused:
        wrong()
    error = refused.value
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert type(again) is kind and str(again) == str(error)
        for name in ("code", "pointer", "line", "column", "expected", "problems"):
            assert getattr(again, name) == getattr(error, name), name


def test_every_class_has_a_case() -> None:
    classes = {
        value for value in vars(driftworld).values() if isinstance(value, type) and issubclass(value, DriftworldError)
    }
    assert classes - {DriftworldError} == {kind for _, kind, _, _ in CASES}


def test_invalid_document_is_refused_with_pointer_line_and_column() -> None:
    with pytest.raises(driftworld.SpecError) as refused:
        unknown_key()
    error = refused.value
    assert (error.pointer, error.line, error.column) == ("/paramters", 3, 3)
    assert error.expected is not None and error.expected.startswith("one of version, name")
    assert error.problems[0]["advice"] == 'did you mean "parameters"?'
    with pytest.raises(driftworld.SpecError) as refused:
        invalid_json()
    assert (refused.value.pointer, refused.value.line, refused.value.column) == (None, 2, 11)


def test_all_problems_are_reported_in_document_order() -> None:
    with pytest.raises(driftworld.SpecError) as refused:
        TaskSpec.from_json("mine.json", '{ "name": "x", "b": 1,\n "a": 2, "world": { "c": 3 } }')
    assert [(problem["pointer"], problem["line"]) for problem in refused.value.problems] == [
        ("/b", 1),
        ("/a", 2),
        ("/world/c", 2),
    ]
    assert len(str(refused.value).splitlines()) == 3


def test_message_matches_the_command(tmp_path: Path) -> None:
    path = tmp_path / "wrong.json"
    path.write_text('{ "name": "x", "paramters": {} }', encoding="utf-8")
    for call, argv in [
        (lambda: TaskSpec.load(path), ["sample", str(path)]),
        (lambda: driftworld.variant("find_objects#rde"), ["sample", "find_objects#rde"]),
        (lambda: TaskSpec.load("find_object"), ["sample", "find_object"]),
        (lambda: driftworld.read_log(tmp_path / "x"), ["metrics", str(tmp_path / "x")]),
    ]:
        with pytest.raises(DriftworldError) as refused:
            call()
        command = subprocess.run([sys.executable, "-m", "driftworld", *argv], capture_output=True, check=False)
        message = command.stderr.decode()
        assert command.returncode == 1
        if argv[0] != "metrics":
            # The command wraps lines at words, to fit a terminal.
            assert message.split() == f"error: {refused.value}".split()
        else:
            assert str(tmp_path / "x") in message and str(tmp_path / "x") in str(refused.value)


def test_drift_through_an_invalid_variant_reports_the_problem_there() -> None:
    task = TaskSpec.from_dict(
        {
            "name": "t",
            "parameters": {
                "least": {"role": "variant", "type": "number", "affects": ["S"], "range": [0, 9], "default": 1},
                "most": {"role": "variant", "type": "number", "affects": ["S"], "range": [0, 9], "default": 2},
            },
            "require": ["(least - 4) * (least - 4) > 1"],
            "variants": {"low": {}, "high": {"least": 8}},
        }
    )
    with pytest.raises(driftworld.GeneratorError) as refused:
        driftworld.Drift(task.variant("low"), task.variant("high")).at(0.45)
    assert refused.value.code == "generator/between" and len(refused.value.problems) == 1


def test_problems_convert_to_json() -> None:
    with pytest.raises(driftworld.SpecError) as refused:
        unknown_key()
    assert json.loads(json.dumps(refused.value.problems)) == refused.value.problems


def test_file_that_is_not_utf8_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bytes.json").write_bytes(b"\xff\xfe")
    with pytest.raises(driftworld.TaskError, match="byte 0 \\(line 1\\) is not UTF-8") as refused:
        TaskSpec.load(tmp_path / "bytes.json")
    assert refused.value.code == "task/unreadable"


def test_document_of_the_wrong_kind_is_named(tmp_path: Path, world_file: Path) -> None:
    for path, found in ((tmp_path, "a folder"), (world_file, "a world")):
        with pytest.raises(driftworld.TaskError, match=f"found {found}, expected a task spec; ") as refused:
            TaskSpec.load(path)
        assert refused.value.code == "task/document"


def test_byte_order_mark_is_ignored(tmp_path: Path) -> None:
    path = tmp_path / "marked.json"
    path.write_text('\ufeff{ "name": "marked" }', encoding="utf-8")
    assert TaskSpec.load(path).name == "marked"
    assert TaskSpec.from_json("marked", path.read_text(encoding="utf-8")).name == "marked"


def test_errors_of_commands_have_code_and_line(tmp_path: Path) -> None:
    with driftworld.LogWriter(tmp_path / "log") as log:
        log.write(block_num=0, exp_num=0, block_type="train", task_name="find_red", reward=1.0)
    (tmp_path / "log" / "logger_info.json").write_text('{\n  "metrics_columns": [\n', encoding="utf-8")
    with pytest.raises(driftworld.MetricsError) as refused:
        driftworld.metrics(tmp_path / "log")
    assert refused.value.code == "metrics/json" and refused.value.line == 3
    with pytest.raises(driftworld.CurriculumError) as refused_design:
        Curriculum.design("find_objects#red", evaluate_after=[9])
    assert refused_design.value.code == "curriculum/no-such-place"


def test_broken_task_of_a_scenario_is_reported_with_its_position(tmp_path: Path) -> None:
    (tmp_path / "mine.json").write_text('{\n  "name": "mine",\n  "paramters": {}\n}', encoding="utf-8")
    regime = {"task": "mine.json", "variant": "red", "count": 1}
    with pytest.raises(driftworld.CurriculumError) as refused:
        Curriculum.from_dict({"name": "s", "blocks": [{"type": "learning", "regimes": [regime]}]}, folder=tmp_path)
    error = refused.value
    assert (error.code, error.pointer, error.line) == ("curriculum/unknown", "/paramters", 3)
    assert len(error.problems) == 1 and "block 0, regime 0" in str(error)


def test_foreign_text_cannot_control_the_terminal(tmp_path: Path) -> None:
    hostile = "\x1b]0;owned\x07\u202e\x9b2J\r\nValueError: FAKE\u200b\ufeff"
    file = tmp_path / "hostile.json"
    documents = [{"name": "t", hostile: 1}, {"name": hostile, "variants": {hostile: {}}}, {"blocks": [{"type": hostile}]}]
    messages = []
    for document in documents:
        file.write_text(json.dumps(document), encoding="utf-8")
        for attempt in (
            lambda: TaskSpec.load(file),
            lambda: TaskSpec.from_json(hostile, file.read_text(encoding="utf-8")),
            lambda: Curriculum.load(file),
            lambda: TaskSpec.load(hostile),
            lambda: driftworld.validate(file),
            lambda: driftworld.validate(hostile),
            lambda: driftworld.DriftworldEnv(world=file),
            lambda: driftworld.metrics(tmp_path / hostile),
        ):
            try:
                attempt()
            except (DriftworldError, OSError, ValueError, TypeError) as error:
                messages.append(str(error))
    assert len(messages) > 10
    for text in messages:
        shown = text.replace("\n", "")
        assert shown.isprintable(), repr(text)
        assert not any(line.startswith("ValueError: FAKE") for line in text.splitlines()), text
