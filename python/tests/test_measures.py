"""The benchmark's measures match reference formulae (scripts/golden_measures.py), and satisfy invariants."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driftworld.benchmark import Matrix, cora, gem, interquartile_mean, interval, regret

GOLDEN = json.loads((Path(__file__).parent / "golden_measures.json").read_text(encoding="utf-8"))
EACH_CASE = pytest.mark.parametrize("case", GOLDEN["cases"], ids=range(len(GOLDEN["cases"])))


def matrices(case: dict[str, Any], curves: str) -> list[Matrix]:
    """A matrix for each seed."""
    steps = tuple(np.array(each, dtype=float) for each in case["steps"] or ())
    return [
        Matrix(np.array(values), tuple(np.array(curve) for curve in seed), steps)
        for values, seed in zip(case["values"], case[curves], strict=True)
    ]


def near(expected: Any) -> Any:
    """Within 1e-9."""
    return pytest.approx(expected, rel=0, abs=1e-9)


@EACH_CASE
def test_pooled_seeds_match_continual_world_and_coom(case: dict[str, Any]) -> None:
    sequential, from_scratch = Matrix.pooled(matrices(case, "curves")), Matrix.pooled(matrices(case, "alone"))
    golden = case["golden"]["continual_world"]
    assert sequential.performance() == near(golden["performance"])
    assert sequential.forgetting() == near(golden["forgetting"])
    assert sequential.forward_transfer(from_scratch) == near(golden["transfer"])
    assert sequential.coom(from_scratch) == near(case["golden"]["coom"])


@EACH_CASE
def test_gem_divides_as_in_the_paper_not_as_in_its_program(case: dict[str, Any]) -> None:
    for sequential, golden in zip(matrices(case, "curves"), case["golden"]["gem"], strict=True):
        found, tasks = gem(sequential.values), sequential.values.shape[1]
        assert found == near({name: golden[name] for name in ("ACC", "BWT", "FWT")})
        assert found["BWT"] * (tasks - 1) / tasks == near(golden["program_BWT"])
        assert found["FWT"] * (tasks - 1) / tasks == near(golden["program_FWT"])
        assert found["ACC"] == near(sequential.performance())
        assert found["BWT"] == near(sequential.backward())


@EACH_CASE
def test_cora_matches_the_entries_and_averages_of_its_tables(case: dict[str, Any]) -> None:
    found = cora(case["values"])
    for name, table in found.items():
        expected = np.array(case["golden"]["cora"][name], dtype=float)
        np.testing.assert_allclose(table, expected, rtol=0, atol=1e-9, equal_nan=True)
        assert np.nanmean(table) == near(case["golden"]["cora"][f"{name}_mean"])


@EACH_CASE
def test_regret_matches_bsuite(case: dict[str, Any]) -> None:
    assert regret(case["curves"][0], case["ceilings"]) == near(case["golden"]["regret"])


@EACH_CASE
def test_interquartile_mean_and_interval_match_rliable(case: dict[str, Any]) -> None:
    ends = np.array(case["values"])[:, -1]
    assert interquartile_mean(ends) == near(case["golden"]["iqm"])
    assert interval(ends, GOLDEN["draws"]) == near(tuple(case["golden"]["interval"]))


def test_interval_of_a_list_equals_that_of_one_column() -> None:
    values = np.random.default_rng(0).random(9)
    assert interval(values) == interval(values[:, None])


def test_interval_of_five_seeds_uses_all_possible_draws() -> None:
    values = [0.1, 0.2, 0.35, 0.8, 0.9]
    means = [interquartile_mean(drawn) for drawn in itertools.product(values, repeat=5)]
    assert interval(values) == near(tuple(np.quantile(means, [0.025, 0.975])))


def test_unchanged_lifetime_has_no_forgetting_and_no_transfer() -> None:
    unchanged = Matrix(np.tile([0.1, 0.5, 0.9], (4, 1)), tuple(np.full(5, value) for value in (0.1, 0.5, 0.9)))
    assert unchanged.forgetting() == unchanged.backward() == 0
    assert unchanged.coom(unchanged)["forgetting"] == 0
    assert gem(unchanged.values) == near({"ACC": 0.5, "BWT": 0.0, "FWT": 0.0})
    assert all(np.nanmax(np.abs(table)) == 0 for table in cora(unchanged.values).values())


@EACH_CASE
def test_from_scratch_against_itself_has_no_forward_transfer(case: dict[str, Any]) -> None:
    for from_scratch in matrices(case, "alone"):
        assert from_scratch.forward_transfer(from_scratch) == from_scratch.coom(from_scratch)["transfer"] == 0


@EACH_CASE
def test_permuting_seeds_changes_nothing(case: dict[str, Any]) -> None:
    sequential, from_scratch, values = matrices(case, "curves"), Matrix.pooled(matrices(case, "alone")), np.array(case["values"])
    pooled, permuted = Matrix.pooled(sequential), Matrix.pooled(sequential[::-1])
    assert permuted.forward_transfer(from_scratch) == near(pooled.forward_transfer(from_scratch))
    assert permuted.coom(from_scratch) == near(pooled.coom(from_scratch))
    for name, table in cora(values[::-1]).items():
        np.testing.assert_allclose(table, cora(values)[name], rtol=0, atol=1e-9, equal_nan=True)
    assert interquartile_mean(values[::-1, -1]) == near(interquartile_mean(values[:, -1]))


@EACH_CASE
def test_larger_scale_scales_everything_but_cora(case: dict[str, Any]) -> None:
    values, ends = np.array(case["values"]), np.array(case["values"])[:, -1]
    once, thrice = Matrix(values[0]), Matrix(3 * values[0])
    assert thrice.performance() == near(3 * once.performance())
    assert thrice.forgetting() == near(3 * once.forgetting())
    assert gem(thrice.values) == near({name: 3 * value for name, value in gem(once.values).items()})
    assert interquartile_mean(3 * ends) == near(3 * interquartile_mean(ends))
    assert interval(3 * ends, 100) == near(tuple(3 * end for end in interval(ends, 100)))
    for name, table in cora(3 * values).items():
        np.testing.assert_allclose(table, cora(values)[name], rtol=0, atol=1e-9, equal_nan=True)


def test_long_episodes_weigh_more_in_the_area_of_a_curve() -> None:
    curve, values = np.array([0.0, 1.0]), np.zeros((2, 1))
    assert Matrix(values, (curve,)).areas().tolist() == [0.5]
    assert Matrix(values, (curve,), (np.array([1.0, 3.0]),)).areas().tolist() == [0.75]


def test_backward_transfer_of_a_single_task_is_undefined() -> None:
    assert np.isnan(Matrix(np.zeros((2, 1))).backward())


def test_unrewarded_task_counts_zero_in_cora() -> None:
    tables = cora(np.zeros((3, 2)))
    assert (tables["forgetting"][0, 1], tables["transfer"][1, 0]) == (0, 0)
