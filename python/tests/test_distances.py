"""Distances, matrices and orders in Python match those of the command."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any, get_args

import driftworld
import numpy as np
import pytest
from driftworld import DistanceMatrix, SimilarityError, _native, distance, distance_matrix, order
from driftworld._literals import ComparedBy

VARIANTS = ["find_objects#blue", "find_objects#red", "find_objects#dusk", "find_objects#penalty"]


def command_output(*argv: str) -> Any:
    """The command's output as JSON."""
    command = [sys.executable, "-m", "driftworld", *argv, "--json"]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)


@pytest.mark.parametrize(
    ("a", "b", "options", "flags"),
    [
        ("find_objects#blue", "find_objects#dusk", {}, []),
        (
            "find_objects#blue",
            "find_objects#dusk",
            {"weights": {"R": 2, "observation": 0.5}},
            ["--weight", "R=2", "--weight", "O=0.5"],
        ),
        ("find_objects#blue", "get_to_goal#plain", {"worlds": 3, "seed": 4}, ["--worlds", "3", "--seed", "4"]),
    ],
)
def test_distance_matches_the_command(a: str, b: str, options: dict[str, Any], flags: list[str]) -> None:
    found, expected = distance(a, b, **options), command_output("distance", a, b, *flags)
    assert float(found) == found.total == expected["total"]
    assert list(found.elements.values()) == list(expected["elements"].values())
    assert found.compared == expected["compared"]
    assert sorted(part["name"] for part in found.parts) == sorted(part["name"] for part in expected["parts"])
    shares = [part["share"] for part in found.parts]
    assert shares == sorted(shares, reverse=True) and sum(shares) == pytest.approx(1)


def test_worlds_are_compared_directly(tmp_path: Path) -> None:
    variant = driftworld.variant("find_objects#blue")
    paths = [tmp_path / "a.json", tmp_path / "b.json"]
    worlds = variant.sample_many(2)
    for path, world in zip(paths, worlds, strict=True):
        path.write_text(json.dumps(world), encoding="utf-8")
    expected = command_output("distance", *map(str, paths))["total"]
    assert expected > 0
    assert (
        distance(*worlds).total
        == distance(*paths).total
        == distance(json.dumps(worlds[0]), worlds[1]).total
        == expected
    )
    assert distance(worlds[0], worlds[0]) == 0
    assert distance(variant, worlds[0]).compared == "by worlds, mean of 16 worlds of each drawn under seed 0"


@pytest.mark.parametrize("by", get_args(ComparedBy))
def test_every_measure_has_a_name(by: ComparedBy) -> None:
    if by == "dynamics:bisimulation":
        pytest.skip("worlds of this size take seconds; the library's own tests use smaller ones")
    found = distance("find_objects#red", "find_objects#penalty", by=by, worlds=1)
    expected = command_output("distance", "find_objects#red", "find_objects#penalty", "--by", by, "--worlds", "1")
    assert (found.by, found.total, found.compared) == (by, expected["total"], expected["compared"])
    matrix = distance_matrix(["find_objects#red", "find_objects#penalty"], by=by, worlds=1)
    assert matrix[0, 1] == pytest.approx(found.total, abs=1e-12)


def test_shares_are_relative_to_the_diameter() -> None:
    units = distance("find_objects#red", "find_objects#dusk")
    share = distance("find_objects#red", "find_objects#dusk", scale="share")
    assert 0 < share < units and "a share of the task's diameter" in share.compared
    assert sum(part["normalised"] * part["weight"] for part in share.parts) == pytest.approx(share.total)
    with pytest.raises(ValueError, match="as a share"):
        distance("find_objects#red", "find_objects#dusk", scale="share", by="rewards")
    with pytest.raises(ValueError, match="scale: found 'whole', expected units or share|scale: found \"whole\""):
        distance("find_objects#red", "find_objects#dusk", scale="whole")  # type: ignore[arg-type]


def test_distance_behaves_as_a_number() -> None:
    near, far = distance(VARIANTS[0], VARIANTS[1]), distance(VARIANTS[0], VARIANTS[3])
    assert near < far and max(near, far) is far and near < 1.9 and near != far and near == near.total
    assert np.asarray([near, far]).sum() == near + far == near.total + far.total
    again = pickle.loads(pickle.dumps(far))
    assert again == far and again.parts == far.parts and again.elements == far.elements
    assert (
        str(near) == str(near.total) and f"{near:.3f}" == f"{near.total:.3f}" and repr(near).startswith("Distance(1.0")
    )


def test_distance_explains_its_parts() -> None:
    text = distance("find_objects#blue", "find_objects#dusk").explain()
    lines = text.splitlines()
    assert lines[0] == "1.4474, by parameters"
    assert any(line.startswith("  O observation") for line in lines)
    assert any(line.startswith("light ") and line.endswith("%") for line in lines)


def test_incomparable_subjects_are_refused_with_reason() -> None:
    with pytest.raises(SimilarityError) as refused:
        distance(VARIANTS[0], VARIANTS[1], weights={"R": -1})
    assert refused.value.code is not None and refused.value.code.startswith("similarity/")
    with pytest.raises(ValueError, match="element: found"):
        distance(VARIANTS[0], VARIANTS[1], weights={"X": 1})
    with pytest.raises(ValueError, match="worlds"):
        distance(VARIANTS[0], VARIANTS[1], worlds=0)
    with pytest.raises(driftworld.TaskError):
        distance("find_object#blue", VARIANTS[1])
    with pytest.raises(TypeError, match="document: found int"):
        distance(3, VARIANTS[1])


def test_matrix_matches_the_command() -> None:
    matrix, expected = distance_matrix(VARIANTS), command_output("order", *VARIANTS)["matrix"]
    assert matrix.labels == expected["labels"] == VARIANTS
    assert np.array_equal(matrix, np.array(expected["values"]))
    assert matrix.is_metric and expected["nature"] == "metric"
    assert matrix[0, 1] == matrix["find_objects#blue", "find_objects#red"] == distance(VARIANTS[0], VARIANTS[1]).total
    assert matrix.values.dtype == np.float64 and matrix.values.shape == (4, 4) and len(matrix) == 4
    with pytest.raises(ValueError, match="read-only"):
        matrix.values[0, 1] = 3


def test_matrix_takes_tasks_variants_and_names_each_once() -> None:
    task = driftworld.TaskSpec.load("find_objects")
    whole = distance_matrix("find_objects")
    assert len(whole) == len(task.variants) and np.array_equal(whole, distance_matrix(task))
    made = task.variant("red").with_values("mine", light=0.3)
    mixed = distance_matrix(["find_objects#red", task.variant("red"), made, "find_objects"])
    assert mixed.labels[:2] == ["find_objects#red", "find_objects#mine"] and len(mixed) == len(whole) + 1


def test_variants_of_several_tasks_are_compared_by_worlds() -> None:
    with pytest.raises(ValueError, match="by: found variants of several tasks"):
        distance_matrix(["find_objects#blue", "get_to_goal#plain"])
    matrix = distance_matrix(["find_objects#blue", "get_to_goal#plain"], by="worlds")
    with pytest.warns(UserWarning, match="distance: found variants of two tasks and no by"):
        separation = distance("find_objects#blue", "get_to_goal#plain")
    assert "two tasks have no parameters in common; the unit differs" in separation.compared
    assert separation == distance("find_objects#blue", "get_to_goal#plain", by="worlds")
    assert not matrix.is_metric and matrix[0, 1] == pytest.approx(separation.total)


@pytest.mark.parametrize("ending", ["csv", "json"])
def test_matrix_survives_saving_and_loading(tmp_path: Path, ending: str) -> None:
    matrix, path = distance_matrix(VARIANTS), tmp_path / "new" / f"matrix.{ending}"
    matrix.save(path)
    again = DistanceMatrix.load(path)
    assert again.labels == VARIANTS and np.array_equal(again, matrix)
    assert command_output("order", "--from-matrix", str(path))["order"] == order(matrix).labels


def test_matrix_from_numbers_is_validated() -> None:
    assert DistanceMatrix(["a", "b"], [[0, 1], [1, 0]]).values[0, 1] == 1
    for values in ([[0, 1], [2, 0]], [[0, -1], [-1, 0]], [[0, np.nan], [np.nan, 0]], [[0, 1, 2], [1, 0, 2]]):
        with pytest.raises(SimilarityError):
            DistanceMatrix(["a", "b"], values)
    with pytest.raises(ValueError, match="ends in .csv"):
        distance_matrix(VARIANTS[:2]).save("matrix.txt")
    with pytest.raises(ValueError, match="removed in 0.3; use .csv or .json"):
        distance_matrix(VARIANTS[:2]).save("matrix.npy")


def test_matrix_supports_the_numpy_array_protocol() -> None:
    matrix = distance_matrix(VARIANTS[:2])
    assert np.asarray(matrix) is matrix.values
    owned = np.array(matrix)
    owned[0, 1] = 7
    assert matrix[0, 1] != 7
    assert np.asarray(matrix, dtype=np.float32).dtype == np.float32
    assert np.array_equal(pickle.loads(pickle.dumps(matrix)), matrix)


def test_matrix_is_a_container_of_labelled_rows() -> None:
    matrix = distance_matrix(VARIANTS)
    assert list(matrix) == VARIANTS == [label for label in matrix]
    assert all(label in matrix for label in VARIANTS) and "find_objects#green" not in matrix and 0.0 not in matrix
    assert (matrix.shape, matrix.ndim, matrix.dtype) == ((4, 4), 2, np.float64)
    assert (np.shape(matrix), np.ndim(matrix)) == ((4, 4), 2)
    assert all(np.array_equal(matrix[label], matrix.values[row]) for row, label in enumerate(matrix))


def test_matrices_are_equal_if_labels_and_distances_are() -> None:
    matrix, again = distance_matrix(VARIANTS), distance_matrix(VARIANTS)
    assert matrix == again == pickle.loads(pickle.dumps(matrix)) and len({matrix, again}) == 1
    assert matrix != distance_matrix(VARIANTS[::-1]) and matrix != distance_matrix(VARIANTS, {"R": 3})
    assert matrix != VARIANTS and (matrix == matrix.values).all()


def test_matrix_converts_to_pandas() -> None:
    pandas = pytest.importorskip("pandas", reason="data frames are pandas'")
    matrix = distance_matrix(VARIANTS)
    frame = matrix.to_pandas()
    assert frame.index.tolist() == frame.columns.tolist() == VARIANTS
    assert frame.loc[VARIANTS[0], VARIANTS[1]] == matrix[0, 1]
    frame.iloc[0, 1] = 7.0
    assert matrix[0, 1] != 7.0
    assert frame.shape == pandas.DataFrame(matrix, index=list(matrix), columns=list(matrix)).shape == matrix.shape
    assert np.array_equal(pandas.DataFrame(matrix), matrix)


def test_order_is_a_sequence_of_labels() -> None:
    found = order(VARIANTS, start=VARIANTS[2])
    assert [found[place] for place in range(len(found))] == list(found) == found.labels
    assert found[0] == VARIANTS[2] and found[-1] == found.labels[-1] and found[1:3] == found.labels[1:3]
    assert VARIANTS[0] in found and "nobody" not in found
    assert found.index(VARIANTS[2]) == 0 and found.count(VARIANTS[1]) == 1 and list(reversed(found)) == found.labels[::-1]
    assert found == order(VARIANTS, start=VARIANTS[2]) and found != order(VARIANTS, start=VARIANTS[1])
    with pytest.raises(IndexError):
        found[4]


@pytest.mark.parametrize("method", [None, *_native.order_methods()])
def test_order_matches_the_command(method: str | None) -> None:
    options: dict[str, Any] = {"seed": 3} if method == "random" else {}
    flags = ["--seed", "3"] if method == "random" else []
    if method == "target-step":
        options, flags = {"target_step": 0.05}, ["--target-step", "0.05"]
    expected = command_output("order", *VARIANTS, *flags, *([] if method is None else ["--order", method]))
    found = order(VARIANTS, method, **options)
    for field in ("method", "order", "steps", "length", "largest_step", "mean_step", "anchor_correlation"):
        assert getattr(found, field) == expected[field], field
    assert [VARIANTS[index] for index in found.indices] == found.labels == list(found)


def test_order_keeps_its_ends() -> None:
    found = order(VARIANTS, start=VARIANTS[2], end=VARIANTS[1])
    assert (found.labels[0], found.labels[-1]) == (VARIANTS[2], VARIANTS[1])
    with pytest.raises(ValueError, match="start: found 'nobody', expected one of find_objects#blue"):
        order(VARIANTS, start="nobody")
    with pytest.raises(SimilarityError, match="nearby"):
        order(VARIANTS, "nearby")
    with pytest.raises(ValueError, match="already holds its distances"):
        order(distance_matrix(VARIANTS[:2]), weights={"R": 1})
    for name, value in {"by": "parameters", "worlds": 3, "scale": "share", "assets": ["a.dwal"]}.items():
        with pytest.raises(ValueError, match=f"{name}: found a value in addition to a matrix"):
            order(distance_matrix(VARIANTS[:2]), **{name: value})  # type: ignore[arg-type]


def test_embedding_keeps_distances_in_a_plane() -> None:
    points = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])
    distances = np.linalg.norm(points[:, None] - points[None], axis=-1)
    matrix = DistanceMatrix(["a", "b", "c"], distances)
    mapped = matrix.embed()
    assert mapped.shape == (3, 2) and matrix.explained() == pytest.approx(1)
    assert np.linalg.norm(mapped[:, None] - mapped[None], axis=-1) == pytest.approx(distances)
    assert matrix.embed(1).shape == (3, 1)
    with pytest.raises(ValueError, match="expected 1 or 2"):
        matrix.embed(3)


def test_file_that_is_neither_world_nor_task_is_refused(tmp_path: Path) -> None:
    (tmp_path / "three.json").write_text("3", encoding="utf-8")
    with pytest.raises(driftworld.SpecError, match="three.json"):
        driftworld.distance(str(tmp_path / "three.json"), "find_objects#red")


def test_notebook_shows_differences_and_distances() -> None:
    html = distance("find_objects#blue", "find_objects#dusk")._repr_html_()
    assert "<td style=\"text-align: left\">light</td>" in html
    # Equal parts are listed below the table, not as rows of zeros.
    assert "equal: " in html and "<td style=\"text-align: left\">spread</td>" not in html
    matrix = distance_matrix(["find_objects#blue", "find_objects#red", "find_objects#dusk"])
    shown = matrix._repr_html_()
    assert shown.count("background-color") == 9 and "rgba(66, 133, 244, 0.60)" in shown
    assert ">red</th>" in shown and ">find_objects#red</td>" in shown
    found = order(matrix)
    lines = str(found).splitlines()
    assert [line.split()[1] for line in lines[:3]] == found.labels
    assert lines[1].endswith(f"{found.steps[0]:.4f}") and f"length {found.length:.4f}" in lines[3]
    assert found._repr_html_().count("<tr>") == 4
