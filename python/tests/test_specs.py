"""Tests task specs, variants, drifts and documents in Python."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from driftworld import Drift, SpecError, TaskError, TaskSpec, Variant, validate

LAMPS: dict[str, Any] = {
    "name": "lamps",
    "description": "Light and dark.",
    "parameters": {
        "light": {"role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2},
        "far": {"role": "variant", "type": "number", "affects": ["S"], "range": [1, 9], "default": 5},
    },
    "world": {"max_steps": 50, "environment_params": {"light_intensity": {"param": "light"}}},
    "groups": [
        {
            "name": "trees",
            "count": 3,
            "placement": {"disc": {"center": [0, 0], "radius": 20}},
            "object": {"class": "tree"},
        }
    ],
    "variants": {"day": {}, "dusk": {"light": 0.5}, "light": {"grid": {"light": [1, 2, 3]}}},
}


@pytest.fixture(name="lamps")
def lamps_task() -> TaskSpec:
    return TaskSpec.from_dict(LAMPS)


def test_task_has_its_documents_content(lamps: TaskSpec) -> None:
    assert (lamps.name, lamps.description) == ("lamps", "Light and dark.")
    assert lamps.parameters["light"]["range"] == [0.2, 4]
    assert list(lamps.parameters) == ["light", "far"]
    names = lamps.families["light"]
    assert lamps.variant_names() == ["day", "dusk", *names] and len(names) == 3
    assert [variant.name for variant in lamps.variants] == lamps.variant_names()
    assert TaskSpec.from_json("again", lamps.to_json()) == lamps
    assert lamps.to_dict()["world"] == LAMPS["world"]


def test_task_is_loaded_by_name_or_path(tmp_path: Path, lamps: TaskSpec) -> None:
    path = tmp_path / "lamps.json"
    path.write_text(json.dumps(LAMPS), encoding="utf-8")
    assert TaskSpec.load(path) == TaskSpec.load(str(path)) == lamps
    assert driftworld.variant(f"{path}#dusk") == lamps.variant("dusk")
    found = driftworld.variants("find_objects#red", f"{path}#light", lamps.variant("day"), f"{path}#light")
    members = [f"{path}#{name}" for name in lamps.families["light"]]
    assert [label for label, _ in found] == ["find_objects#red", *members, "lamps#day"]
    assert {TaskSpec.load(name).name for name in driftworld.built_in_tasks()} >= {"find_objects", "scavenger_hunt"}


def test_missing_task_is_refused_with_the_known_ones() -> None:
    with pytest.raises(TaskError, match='did you mean "find_objects"'):
        TaskSpec.load("find_object")
    with pytest.raises(TaskError, match='did you mean "red"') as refused:
        TaskSpec.load("find_objects").variant("rde")
    assert refused.value.code == "spec/unknown-variant"


def test_variant_has_its_values(lamps: TaskSpec) -> None:
    dusk = lamps.variant("dusk")
    assert (dusk.id, dusk.name, dusk.task) == ("lamps#dusk", "dusk", lamps)
    assert dusk.values == {"light": 0.5, "far": 5.0}
    assert len(dusk.hash) == 64 and dusk.hash != lamps.variant("day").hash
    assert lamps.variant().values == {"light": 2.0, "far": 5.0}


def test_notebooks_show_the_changes_of_variants(lamps: TaskSpec) -> None:
    html = lamps.variant("dusk")._repr_html_()
    assert ">lamps#dusk<" in html and "<td style=\"text-align: left\">light</td>" in html
    assert ">0.5<" in html and ">2<" in html and "at their defaults: far 5" in html
    assert lamps.variant("day")._repr_html_().count("<tr>") == 1, "only the header row"
    html = lamps._repr_html_()
    assert html.count("<tr>") == 1 + len(lamps.variants)
    assert ">light 0.5<" in html and ">the defaults<" in html and "lamps: Light and dark." in html
    named = TaskSpec.from_dict({**LAMPS, "description": "<b>"})
    assert "&lt;b&gt;" in named._repr_html_()


def test_variant_can_be_changed_into_another(lamps: TaskSpec) -> None:
    made = lamps.variant("dusk").with_values("made", far=7)
    assert (made.id, made.values) == ("lamps#made", {"light": 0.5, "far": 7.0})
    with pytest.raises(SpecError) as refused:
        made.with_values("wrong", light=9, far="wide")
    assert len(refused.value.problems) == 2
    with pytest.raises(SpecError, match="brightness"):
        made.with_values("wrong", brightness=1)


@pytest.mark.parametrize("copied", [pickle.loads, copy.deepcopy], ids=["pickle", "deepcopy"])
@pytest.mark.parametrize("name", ["day", "dusk", "made", "between"])
def test_variant_survives_copying(lamps: TaskSpec, name: str, copied: Any) -> None:
    variant = {
        "made": lambda: lamps.variant("day").with_values("made", light=3.25),
        "between": lambda: Drift(lamps.variant("day"), lamps.variant("dusk")).at(0.3),
    }.get(name, lambda: lamps.variant(name))()
    again = copied(variant) if copied is copy.deepcopy else copied(pickle.dumps(variant))
    assert again == variant and hash(again) == hash(variant) and again.hash == variant.hash
    assert again.sample(3, 4) == variant.sample(3, 4)


@pytest.mark.parametrize("task", driftworld.built_in_tasks())
def test_every_variant_of_every_built_in_task_pickles(task: str) -> None:
    spec = TaskSpec.load(task)
    assert pickle.loads(pickle.dumps(spec)) == spec
    assert pickle.loads(pickle.dumps(spec.variants)) == spec.variants


def test_worlds_match_the_command() -> None:
    variant = driftworld.variant("find_objects#red")
    command = [sys.executable, "-m", "driftworld", "sample", "find_objects#red", "--seed", "7", "--index", "123"]
    text = subprocess.run(command, capture_output=True, check=True).stdout.decode()
    assert variant.sample_json(7, 123) == text.strip()
    assert variant.sample(7, 123) == json.loads(text)
    assert TaskSpec.load("find_objects").sample("red", 7, 123) == variant.sample(7, 123)


@pytest.mark.parametrize("threads", [0, 1, 3])
def test_sample_many_equals_single_samples(lamps: TaskSpec, threads: int) -> None:
    variant = lamps.variant("dusk")
    many = variant.sample_many(600, seed=2, start=10, threads=threads)
    assert many == [variant.sample(2, index) for index in range(10, 610)]
    assert variant.sample_many_json(3, seed=2, start=10, threads=threads) == [
        variant.sample_json(2, k) for k in (10, 11, 12)
    ]
    assert variant.sample_many(0) == []


def test_impossible_number_of_worlds_is_refused(lamps: TaskSpec) -> None:
    with pytest.raises(ValueError, match="room for 2 worlds"):
        lamps.variant("day").sample_many(2, start=2**64 - 1)


@pytest.mark.parametrize("seed", [-1, 2**64])
def test_seed_must_be_a_whole_number(lamps: TaskSpec, seed: int) -> None:
    with pytest.raises(ValueError, match=f"found {seed}, expected a whole number in 0..18446744073709551615"):
        lamps.variant("day").sample(seed)
    with pytest.raises(TypeError, match="seed"):
        lamps.variant("day").sample(1.5)  # type: ignore[arg-type]
    assert lamps.variant("day").sample(np.int64(3)) == lamps.variant("day").sample(3)  # type: ignore[arg-type]


def test_drift_leads_from_one_variant_to_another(lamps: TaskSpec) -> None:
    day, dusk = lamps.variant("day"), lamps.variant("dusk")
    drift = Drift(day, dusk)
    assert (drift.at(0.0), drift.at(1.0)) == (day, dusk)
    assert drift.at(0.5).values["light"] == pytest.approx(1.25)
    assert Drift(day, dusk, schedule="cosine").at(0.25).values["light"] > drift.at(0.25).values["light"]
    assert Drift(day, dusk, schedule={"steps": 1}).at(0.25) == day
    assert Drift(day, dusk, schedule={"sawtooth": 2}).at(0.5) == day


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"schedule": "cosinus"}, 'found "cosinus", expected "linear"'),
        ({"schedule": {"steps": 0}}, "with n at least 1"),
        ({"switch": "sudden"}, 'found "sudden", expected "at_point", "mixture" or "task"'),
    ],
)
def test_unknown_schedule_or_switch_is_refused_with_the_known_ones(lamps: TaskSpec, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Drift(lamps.variant("day"), lamps.variant("dusk"), **options)
    with pytest.raises(ValueError, match="in 0..1"):
        Drift(lamps.variant("day"), lamps.variant("dusk")).at(1.5)


def test_variant_at_a_distance_has_that_distance(lamps: TaskSpec) -> None:
    day = lamps.variant("day")
    found, distance = day.at_distance(0.25, "observation", name="dimmer")
    assert found.id == "lamps#dimmer" and distance == pytest.approx(0.25, abs=1e-3)
    assert driftworld.distance(day, found).elements["O"] == distance
    found, distance = day.at_distance(0.1, ["far"])
    assert float(driftworld.distance(day, found)) == distance == pytest.approx(0.1, abs=1e-3)
    with pytest.raises(driftworld.GeneratorError):
        day.at_distance(0.5, "reward")
    with pytest.raises(ValueError, match="element: found"):
        day.at_distance(0.5, "rewards")


def test_valid_document_has_no_problems(lamps: TaskSpec) -> None:
    world = lamps.variant("day").sample()
    for document in (LAMPS, json.dumps(LAMPS), world, "find_objects"):
        assert validate(document) == []
    assert validate(world, kind="world", check=True) == []


def test_problems_have_their_positions(tmp_path: Path) -> None:
    path = tmp_path / "wrong.json"
    path.write_text('{ "name": "x",\n  "paramters": {},\n  "world": { "max_stepps": 3 } }', encoding="utf-8")
    problems = validate(path)
    assert [(problem["pointer"], problem["line"], problem["column"]) for problem in problems] == [
        ("/paramters", 2, 3),
        ("/world/max_stepps", 3, 14),
    ]
    with pytest.raises(SpecError) as refused:
        validate(path, check=True)
    error = refused.value
    assert (error.pointer, error.line, error.column, error.code) == ("/paramters", 2, 3, "spec/unknown-key")
    assert error.problems == problems and str(error).count("\n") == 1
    assert str(error).splitlines()[0] == f"{path}:{problems[0]['message']}"


def test_text_that_is_not_json_is_one_problem() -> None:
    (problem,) = validate('{ "name": ', kind="task")
    assert (problem["code"], problem["line"]) == ("spec/syntax", 1)
    with pytest.raises(SpecError) as refused:
        validate('{ "name": ', kind="task", check=True)
    assert (refused.value.code, refused.value.line) == ("spec/syntax", 1)


def test_scenario_is_checked_against_its_tasks() -> None:
    regime = {"task": "find_objects", "variant": "rde", "count": 1}
    (problem,) = validate({"name": "s", "blocks": [{"type": "learning", "regimes": [regime]}]})
    assert problem["pointer"] == "/blocks/0/regimes/0/variant" and '"red"' in problem["message"]


def test_unknown_document_is_refused() -> None:
    with pytest.raises(FileNotFoundError, match="expected the path of a document"):
        validate("nowhere.json")
    with pytest.raises(TypeError, match="found int"):
        validate(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='did you mean "scenario"'):
        validate("{}", kind="scenrio")


def test_variants_and_tasks_compare_by_value(lamps: TaskSpec) -> None:
    other = TaskSpec.from_dict({**LAMPS, "name": "candles"})
    assert lamps != other and lamps.variant("day") != other.variant("day")
    assert lamps.variant("day") == TaskSpec.from_dict(LAMPS).variant("day") != "lamps#day"
    assert len({lamps.variant("day"), TaskSpec.from_dict(LAMPS).variant("day")}) == 1
    assert isinstance(lamps.variant("day"), Variant)


def test_different_variants_with_the_same_name_are_refused(lamps: TaskSpec) -> None:
    day = lamps.variant("day")
    near, _ = day.at_distance(0.1, "observation")
    far, _ = day.at_distance(0.2, "observation")
    with pytest.raises(ValueError, match="two different variants called 'lamps#found'.*name="):
        driftworld.distance_matrix([day, near, far])
    edited = TaskSpec.from_dict({**LAMPS, "variants": {"day": {"light": 3}}})
    with pytest.raises(ValueError, match="'lamps#day'"):
        driftworld.variants(lamps, edited)
    assert len(driftworld.distance_matrix([day, near, near, lamps.variant("day")])) == 2


@pytest.mark.parametrize("name", ["", "a#b"])
def test_new_variant_needs_a_valid_name(lamps: TaskSpec, name: str) -> None:
    with pytest.raises(ValueError, match="name: found"):
        lamps.variant("day").with_values(name, light=1)
    with pytest.raises(ValueError, match="name: found"):
        lamps.variant("day").at_distance(0.1, "O", name=name)


def test_value_may_be_numpys_and_must_be_finite(lamps: TaskSpec) -> None:
    day = lamps.variant("day")
    made = day.with_values("made", light=np.float32(0.5), far=np.int64(3))
    assert made == day.with_values("made", light=0.5, far=3)
    with pytest.raises(ValueError, match="light: found nan, expected .* a finite number"):
        day.with_values("wrong", light=float("nan"))
    with pytest.raises(TypeError, match="light: found <object"):
        day.with_values("wrong", light=object())


def test_too_many_threads_are_refused(lamps: TaskSpec) -> None:
    with pytest.raises(ValueError, match="threads: found 5000, expected at most 1024"):
        lamps.variant("day").sample_many(4, threads=5000)


@pytest.mark.parametrize("copied", [lambda thing: pickle.loads(pickle.dumps(thing)), copy.deepcopy])
@pytest.mark.parametrize("schedule", [None, "cosine", {"steps": 3}])
def test_drift_survives_copying(lamps: TaskSpec, copied: Any, schedule: Any) -> None:
    drift = Drift(lamps.variant("day"), lamps.variant("dusk"), schedule=schedule, switch="mixture", seed=4)
    again = copied(drift)
    assert [again.at(progress, 3) for progress in (0.0, 0.4, 1.0)] == [drift.at(x, 3) for x in (0.0, 0.4, 1.0)]


def test_suspicious_document_causes_warnings() -> None:
    with pytest.warns(UserWarning, match='the key "oddity" has no meaning here'):
        assert validate({"environment_params": {}, "oddity": 1}, kind="l2explorer-world") == []


DISTRIBUTIONS = {
    "color_uniform": {"from": [0.0, 0.5, 0.0], "to": [1.0, 1.0, 0.25]},
    "color_normal": {"mean": {"param": "leaf"}, "std": {"param": "loose"}},
    "color_perturb": {"value": [0.0, 0.5, 0.5], "noise": 0.2, "channels": "together"},
    "color_hsv": {"hue": [-20.0, 40.0], "value": [0.5, 1.0]},
}


@pytest.mark.parametrize("family", DISTRIBUTIONS)
def test_colour_distributions_round_trip(family: str) -> None:
    distribution = {family: DISTRIBUTIONS[family]}
    document = {
        "version": 2,
        "name": "sky",
        "parameters": {
            "leaf": {
                "role": "variant",
                "type": "color",
                "affects": ["O"],
                "choices": [[0, 0.5, 0], [1, 0.5, 0]],
                "default": [0, 0.5, 0],
            },
            "loose": {"role": "variant", "type": "number", "affects": ["O"], "range": [0, 1], "default": 0.1},
            "sky": {"role": "randomized", "type": "color", "affects": ["O"], "distribution": distribution},
        },
        "world": {"environment_params": {"sky_color": {"param": "sky"}}},
        "variants": {"autumn": {"leaf": [1, 0.5, 0], "loose": 0}},
    }
    task = TaskSpec.from_dict(document)
    again = TaskSpec.from_dict(task.to_dict())
    assert again == task and again.to_dict()["parameters"]["sky"]["distribution"] == distribution
    colors = [task.variant("autumn").sample(3, index)["environment_params"]["sky_color"] for index in range(5)]
    assert colors == [again.variant("autumn").sample(3, index)["environment_params"]["sky_color"] for index in range(5)]
    assert all(0 <= channel <= 1 for color in colors for channel in color)
    assert (colors[0] == colors[1]) == (family == "color_normal")


def test_parameters_without_effect_cause_warnings() -> None:
    idle = {"role": "variant", "type": "number", "affects": [], "range": [0, 1], "default": 0}
    with pytest.warns(UserWarning, match="parameter idle affects no element, expected some"):
        assert driftworld.validate({"version": 2, "name": "t", "parameters": {"idle": idle}}) == []
