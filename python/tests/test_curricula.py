"""Tests curricula in Python: designing, reading, iterating and saving."""

from __future__ import annotations

import copy
import json
import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import driftworld
import pytest
from driftworld import Curriculum, CurriculumError, SpecError, TaskError
from small_lifetime import Circler, small


def test_design_matches_the_command(tmp_path: Path) -> None:
    curriculum = Curriculum.design(
        "find_objects#blue", "find_objects#red", "find_objects#dusk", learn=3, eval_episodes=1, evaluate="ends", seed=4
    )
    path = tmp_path / "s.json"
    flags = ["--learn", "3", "--eval-episodes", "1", "--evaluate", "ends", "--seed", "4"]
    tasks = ["find_objects#blue", "find_objects#red", "find_objects#dusk"]
    subprocess.run(
        [sys.executable, "-m", "driftworld", "curriculum", *tasks, *flags, "-o", path], check=True, capture_output=True
    )
    assert curriculum.to_dict() == json.loads(path.read_text(encoding="utf-8")) == Curriculum.load(path).scenario
    curriculum.save(tmp_path / "mine.json")
    assert (tmp_path / "mine.json").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    "options",
    [
        {"probe": "reward", "order": "gradual", "variants": 4},
        {"probe": "observation", "step_distance": 0.1, "steps": 2},
        {"form": "alternating", "blocks": 4, "drift": "cosine"},
        {"evaluate_after": [0, 2], "task_label": "info", "method": "nearest"},
        {"form": "permuted", "mix": False, "pre_deployment": 2},
    ],
)
def test_every_option_of_the_command_is_supported(options: dict[str, Any]) -> None:
    tasks = ["find_objects#blue", "find_objects#dusk"] if "form" in options else ["find_objects"]
    curriculum = Curriculum.design(*tasks, learn=2, eval_episodes=1, **options)
    assert sum(len(block) for block in curriculum) == curriculum.num_experiences > 0


def test_controls_are_written_with_the_design(tmp_path: Path) -> None:
    Curriculum.design(
        "find_objects#blue", "find_objects#red", "find_objects#dusk", controls=tmp_path, plot=tmp_path / "p.png"
    )
    names = sorted(path.name for path in tmp_path.iterdir())
    assert len([name for name in names if name.endswith(".json")]) == 3 and "p.png" in names


def test_experts_and_lifetimes_return_several_curricula() -> None:
    experts = Curriculum.experts("find_objects#blue", "find_objects#red", learn=2)
    assert [expert.name for expert in experts] == ["curriculum-blue", "curriculum-red"]
    assert {experience.variant for block in experts[1] for experience in block if block.kind == "learning"} == {
        "find_objects#red"
    }
    lives = Curriculum.lifetimes(3, "find_objects#blue", "find_objects#red", "find_objects#dusk", learn=1, seed=2)
    assert [life.name for life in lives] == ["curriculum-1", "curriculum-2", "curriculum-3"]
    assert all(life.num_experiences == lives[0].num_experiences for life in lives)


def test_blocks_and_experiences_can_be_iterated() -> None:
    curriculum = small()
    assert [(block.kind, block.phase, len(block)) for block in curriculum] == [
        ("learning", "pre_deployment", 2),
        ("evaluation", "deployment", 3),
        ("learning", "deployment", 5),
        ("evaluation", "deployment", 3),
        ("learning", "deployment", 3),
        ("evaluation", "deployment", 3),
    ]
    everything = [experience for block in curriculum for experience in block]
    assert (
        [experience.number for experience in everything] == list(range(19)) == list(range(curriculum.num_experiences))
    )
    drifting = [experience for experience in curriculum[2] if experience.progress > 0]
    assert [experience.progress for experience in drifting] == [0.5, 1.0] and drifting[
        0
    ].variant == "find_objects#red..dusk"
    second = curriculum.blocks[1][1]
    assert (second.task, second.variant, second.seed, second.index, second.learning) == (
        "find_objects", "find_objects#blue", 1, 1, False
    )  # fmt: skip
    expected = driftworld.variant("find_objects#blue").sample(1, 1)
    # The step limit replaces the task's time limit.
    assert expected.pop("max_seconds") == 30
    assert second.world() == {**expected, "max_steps": 40}
    assert curriculum[1][-1] == curriculum[1][2] == curriculum[1][2:][0]
    with pytest.raises(IndexError, match="expected one of 3"):
        curriculum[1][3]


@pytest.mark.skipif(os.name != "posix", reason="only POSIX has file modes")
def test_file_modes_follow_the_umask(tmp_path: Path) -> None:
    file = tmp_path / "scenario.json"
    before = os.umask(0o027)
    try:
        small().save(file)
        assert file.stat().st_mode & 0o777 == 0o640
        file.chmod(0o604)
        small().save(file)
        assert file.stat().st_mode & 0o777 == 0o604
    finally:
        os.umask(before)
    with pytest.raises(IsADirectoryError, match="tmp|pytest"):
        small().save(tmp_path)


def test_tasks_and_worlds_are_found_in_the_scenarios_folder(tmp_path: Path) -> None:
    world = driftworld.variant("find_objects#red").sample(3)
    (tmp_path / "yard.json").write_text(json.dumps(world), encoding="utf-8")
    document = {"name": "files", "blocks": [{"type": "evaluation", "regimes": [
        {"task": "find_objects", "variant": "yard", "count": 2, "world": "yard.json", "max_steps": 4}]}]}  # fmt: skip
    (tmp_path / "s.json").write_text(json.dumps(document), encoding="utf-8")
    for curriculum in (Curriculum.load(tmp_path / "s.json"), Curriculum.from_dict(document, folder=tmp_path)):
        experience = curriculum.experience(1)
        assert (experience.seed, experience.index) == (None, None)
        assert experience.world() == {**{key: world[key] for key in world if key != "max_seconds"}, "max_steps": 4}
    with pytest.raises(CurriculumError, match="expected a world file"):
        Curriculum.from_dict(document, folder=tmp_path / "elsewhere")
    document["blocks"][0]["regimes"][0]["world"] = "yrad.json"  # type: ignore[index]
    with pytest.warns(UserWarning, match="yard.json stood in for it"):
        Curriculum(json.dumps(document), tmp_path / "s.json", stand_in=True)


def test_curriculum_pickles() -> None:
    again = pickle.loads(pickle.dumps(small()))
    assert again.scenario == small().scenario and again[2][4].world() == small()[2][4].world()


def test_invalid_curriculum_is_refused_with_pointer() -> None:
    regime = {"task": "find_objects", "variant": "rde", "count": 1}
    with pytest.raises(SpecError, match='did you mean "red"') as refused:
        Curriculum.from_dict({"name": "s", "blocks": [{"type": "learning", "regimes": [regime]}]})
    assert refused.value.pointer == "/blocks/0/regimes/0/variant"
    with pytest.raises(TaskError, match='did you mean "blue"'):
        Curriculum.design("find_objects#bleu")
    with pytest.raises(ValueError, match="tasks: found none, expected at least one"):
        Curriculum.design()
    with pytest.raises(CurriculumError, match="expected state, action"):
        Curriculum.design("find_objects", probe="rewrd")
    with pytest.raises(TypeError, match="a scenario refers to tasks by name"):
        Curriculum.design(driftworld.variant("find_objects#red"))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="without act, learn, freeze"):
        small().run(object())  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="variant: found it among the options"):
        small().run(Circler(), variant="red")


@pytest.mark.parametrize("copied", [lambda thing: pickle.loads(pickle.dumps(thing)), copy.deepcopy])
def test_blocks_and_experiences_can_be_copied(copied: Any) -> None:
    curriculum = small()
    block = copied(curriculum[2])
    assert block == curriculum[2] and list(block) == list(curriculum[2])
    assert copied(block[4]).world() == curriculum[2][4].world()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"lern": 2}, "found option 'lern', expected one of name, learn"),
        ({"learn": True}, "learn: found True, expected a whole number"),
        ({"learn": 2.5}, "learn: found 2.5, expected a whole number"),
        ({"evaluate_after": 2}, "evaluate_after: found 2, expected a list"),
        ({"evaluate_after": [1, "2"]}, "evaluate_after: found '2' in it"),
    ],
)
def test_unknown_design_options_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        Curriculum.experts("find_objects#red", **options)
    if "lern" not in options:
        with pytest.raises(TypeError, match=message):
            Curriculum.design("find_objects#red", **options)


def test_unknown_classes_and_colliding_names_are_reported(tmp_path: Path) -> None:
    world = {"objects": [{"class": "shrb", "coordinates": [3, 4]}]}
    (problem,) = driftworld.validate(world)
    assert problem["code"] == "spec/unknown-class" and "shrub" in problem["message"]
    regimes = [{"task": "find_objects", "variant": "red", "count": 1}, {"task": "Find-Objects", "variant": "r-ed", "count": 1}]
    with pytest.warns(UserWarning, match="not checked"):
        (problem,) = driftworld.validate({"name": "s", "blocks": [{"type": "learning", "regimes": regimes}]})
    assert problem["code"] == "curriculum/same-log-name"


def test_model_missing_from_its_class_is_refused(tmp_path: Path) -> None:
    world = {"objects": [{"class": "animal", "model": "foxx", "coordinates": [3, 4]}]}
    task = {
        "name": "t",
        "groups": [
            {
                "name": "g",
                "count": 1,
                "object": {"class": "geometric", "model": "9"},
                "placement": {"disc": {"center": [0, 0], "radius": 9}},
            }
        ],
    }
    for document, names in ((world, "fox"), (task, "cube, sphere, cylinder")):
        (problem,) = driftworld.validate(document)
        assert problem["code"] == "spec/unknown-model" and names in problem["message"]
    path = tmp_path / "t.json"
    path.write_text(json.dumps(task), encoding="utf-8")
    with pytest.raises(SpecError, match='did you mean "fox"'):
        driftworld.DriftworldEnv(world=world, size=16)
    with pytest.raises(SpecError, match="cube, sphere, cylinder"):
        driftworld.DriftworldEnv(str(path), size=16)


def test_notebook_shows_a_curriculum_as_its_blocks() -> None:
    curriculum = Curriculum.design("find_objects#blue", "find_objects#red", learn=3, eval_episodes=2, seed=0)
    html = curriculum._repr_html_()
    assert html.count("<tr>") == len(curriculum) + 1
    assert f"{len(curriculum)} blocks, {curriculum.num_experiences} experiences" in html
    assert html.count(">find_objects#blue, find_objects#red<") == 3 and ">learning<" in html
