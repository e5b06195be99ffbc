"""Scores and report pages in Python match those of the command."""

from __future__ import annotations

import copy
import html
import json
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from driftworld import LogWriter, Metrics, MetricsError, metrics, report

TASKS = ("find_red", "find_blue")


def lifetime(folder: Path, better: float) -> Path:
    """Two tasks learned one after the other, evaluated before, between and after."""
    number = 0
    with LogWriter(folder) as log:
        for block in range(5):
            kind = "test" if block % 2 == 0 else "train"
            for task in TASKS if kind == "test" else (TASKS[block // 2],):
                for step in range(6):
                    reward = better * block + step + (0.5 if task == TASKS[0] else 0.0)
                    log.write(block_num=block, exp_num=number, block_type=kind, task_name=task, reward=reward)
                    number += 1
    return folder


def expert(folder: Path, task: str) -> Path:
    with LogWriter(folder, scenario_info={"scenario_type": "ste"}) as log:
        for number in range(12):
            log.write(block_num=0, exp_num=number, block_type="train", task_name=task, reward=2.0 * number)
    return folder


@pytest.fixture(name="logs")
def three_logs(tmp_path: Path) -> list[Path]:
    return [lifetime(tmp_path / name, better) for name, better in (("one", 1.0), ("two", 2.0), ("three", 2.5))]


def command_output(*argv: str | Path) -> Any:
    command = [sys.executable, "-m", "driftworld", *map(str, argv), "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def test_scores_of_one_lifetime_match_the_command(logs: list[Path]) -> None:
    found, expected = metrics(logs[0]), command_output("metrics", logs[0])
    assert found.lifetimes == [expected]
    assert found["avg_train_perf"] == expected["avg_train_perf"] == found.lifetime["avg_train_perf"]
    assert found.tasks == expected["task_metrics"] and set(found.tasks) == set(TASKS)
    assert found.repeats == []
    assert found.null == expected["null"] and found.reached == expected["reached"]
    for name, band in found.null.items():
        assert band["low"] <= band["high"] and 0 < band["p"] <= 1, name
        if name in expected:
            assert band["value"] == pytest.approx(expected[name], abs=1e-9)
    assert set(found.reached) == set(TASKS)
    assert found.curves == expected["curves"]
    assert all(curve["forgetting"] >= 0 and not curve["is_scaled"] for curve in found.curves.values())


def test_notebook_shows_the_rows_of_the_commands_table(logs: list[Path]) -> None:
    found = metrics(logs[0])
    assert found.readings == command_output("metrics", logs[0])["readings"]
    command = [sys.executable, "-m", "driftworld", "metrics", str(logs[0])]
    wide = {**os.environ, "COLUMNS": "400"}
    text = subprocess.run(command, check=True, capture_output=True, text=True, env=wide).stdout
    page = found._repr_html_()
    assert "forward_transfer_contrast" in found.readings and "forward_transfer_contrast" not in found.lifetime
    for name, row in found.readings.items():
        [line] = [line for line in text.splitlines() if line.startswith(f"{name} ")]
        [cells] = [part for part in page.split("<tr>") if f">{name}<" in part]
        assert row["explanation"] in line and row["explanation"] in cells
        if row["word"] is not None:
            assert f"  {row['word']}  " in line and f">{row['word']}<" in cells
        if row["null_band"] is not None:
            assert "\N{PLUS-MINUS SIGN}" in cells and f">{row['null_band']['p']:.3f}<" in cells
    for text in found.lifetimes[0].get("cautions", []):
        assert html.escape(text) in page
    several = metrics(logs)
    page = several._repr_html_()
    assert all(f">{row['name']}<" in page and (row["word"] or "") in page for row in several.repeats)
    assert {row["name"] for row in several.repeats} >= {"backward_transfer_contrast"}


def test_scales_are_a_file_or_a_dictionary(logs: list[Path], tmp_path: Path) -> None:
    task, other = sorted(TASKS)[:2]
    scales = {task: {"floor": -5.0, "ceiling": 45.0}}
    file = tmp_path / "scales.json"
    file.write_text(json.dumps({"scales": scales}), encoding="utf-8")
    found = metrics(logs[0], scales=scales)
    assert found == metrics(logs[0], scales=file)
    assert found.lifetimes == [command_output("metrics", logs[0], "--scales", file)]
    assert found.reached[task]["scaled_by"] == "anchors" and found.reached[other]["scaled_by"] == "own"
    for cell in found.reached[task]["evaluations"]:
        assert cell["score"] == pytest.approx((cell["mean"] + 5.0) / 50.0)
    with pytest.raises(MetricsError, match="scales"):
        metrics(logs[0], scales={task: {"floor": 0.0}})
    with pytest.raises(MetricsError, match="expected one of the two"):
        metrics(logs[0], scales=scales, data_range={name: {"min": 0, "max": 1} for name in TASKS})


def test_power_matches_the_command(logs: list[Path]) -> None:
    found = metrics(logs, power=10.0)
    assert found.power == command_output("metrics", *logs, "--power", "10")["power"]
    # Without differences between lifetimes it cannot be computed.
    powers = [row["power"] for row in found.power if row["power"] is not None]
    assert powers and all(0 <= power <= 1 for power in powers)
    assert all(row["lifetimes"] == [3, 3] for row in found.power)
    with pytest.raises(MetricsError, match="at least two"):
        metrics(logs[0], power=10.0)


def test_options_have_the_commands_effects(logs: list[Path], tmp_path: Path) -> None:
    experts = [expert(tmp_path / f"expert_{task}", task) for task in TASKS]
    ranges = tmp_path / "ranges.json"
    limits = {task: {"min": -1.0, "max": 30.0} for task in TASKS}
    ranges.write_text(json.dumps(limits), encoding="utf-8")
    found = metrics(
        logs[0],
        ste=experts,
        transfer_method="both",
        maintenance_method="both",
        smoothing_method="none",
        clamp_outliers=True,
        data_range=limits,
        noise=(0.0, 0.5),
        noise_seed=3,
    )
    flags = ["-t", "both", "-m", "both", "-g", "none", "-x", "-N", "0.0", "0.5", "--noise-seed", "3"]
    expected = command_output("metrics", logs[0], "--ste", *experts, *flags, "-d", ranges)
    assert found.lifetimes == [expected]
    assert found["ste_rel_perf"] is not None and "forward_transfer_contrast" in found.lifetime
    assert found.lifetimes != metrics(logs[0]).lifetimes


def test_intervals_of_several_lifetimes_match_the_command(logs: list[Path]) -> None:
    found, expected = metrics(logs, bootstrap_seed=5), command_output("metrics", *logs, "--bootstrap-seed", "5")
    assert found.repeats == expected["repeats"] and found.lifetimes == expected["lifetimes"]
    assert found.intervals == expected["intervals"]
    values = found["avg_eval_perf"]
    assert len(values) == 3 and found.lifetime["avg_eval_perf"] == pytest.approx(sum(values) / 3)
    with pytest.raises(ValueError, match="found 3 lifetimes"):
        _ = found.tasks


def test_two_agents_are_compared(logs: list[Path]) -> None:
    found = metrics(logs[:1], against=logs[1:])
    assert found.improvement and len(found.lifetimes_against) == 2 and found.repeats_against


def test_scores_convert_to_data_frames(logs: list[Path]) -> None:
    pytest.importorskip("pandas", reason="data frames are pandas'")
    found = metrics(logs)
    frame = found.to_pandas()
    assert frame.index.tolist() == ["one", "two", "three"]
    assert frame["avg_train_perf"].tolist() == found["avg_train_perf"]
    assert len(found.regimes()) == 3 * (3 * 2 + 2)


def test_saved_scores_match_the_command(logs: list[Path], tmp_path: Path) -> None:
    metrics(logs[0]).save(tmp_path / "results")
    names = ["one_metrics.json", "one_regime.tsv", "one_settings.json"]
    assert sorted(path.name for path in (tmp_path / "results").iterdir()) == names
    metrics(logs).save(tmp_path / "many", name="all")
    assert "all_repeats.json" in [path.name for path in (tmp_path / "many").iterdir()]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"transfer_method": "ratoi"}, "expected one of ratio, contrast, both"),
        ({"perf_measure": "rewrd"}, "rewrd"),
        ({"confidence": 2.0}, "2"),
    ],
)
def test_errors_match_the_command(
    logs: list[Path], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(MetricsError, match=message):
        metrics(logs, **options)


def test_missing_log_is_named(tmp_path: Path) -> None:
    with pytest.raises(MetricsError, match="found nothing, expected the folder of a log"):
        metrics(tmp_path / "nowhere")


def test_warnings_are_python_warnings(logs: list[Path], tmp_path: Path) -> None:
    stranger = expert(tmp_path / "stranger", "other_task")
    with pytest.warns(UserWarning, match="is ignored"):
        metrics(logs[0], ste=stranger)


def test_page_matches_the_command(logs: list[Path], tmp_path: Path) -> None:
    path = tmp_path / "pages" / "mine.html"
    page = report(logs, path, title="Mine", unit="exp_num", plot_types=["raw", "timeline"])
    assert path.read_text(encoding="utf-8") == page and "<title>Mine" in page
    other = tmp_path / "theirs.html"
    command = [sys.executable, "-m", "driftworld", "report", *map(str, logs), "-o", str(other), "--title", "Mine"]
    subprocess.run([*command, "-T", "raw", "timeline", "--unit", "exp_num"], check=True, capture_output=True)
    # The command's page also shows the command.
    without_command = re.sub('<tr><th scope="row">command</th>.*?</tr>', "", other.read_text(encoding="utf-8"))
    assert without_command == page
    with pytest.raises(MetricsError):
        report(tmp_path / "nowhere")


def test_scores_compare_by_value(logs: list[Path]) -> None:
    assert metrics(logs[0]) == metrics(str(logs[0])) != metrics(logs[1])
    assert isinstance(metrics(logs[0]), Metrics)


def test_scores_with_given_ranges_can_be_computed_again(logs: list[Path], tmp_path: Path) -> None:
    pytest.importorskip("pandas", reason="data frames are pandas'")
    found = metrics(logs[0], data_range={task: {"min": -1.0, "max": 30.0} for task in TASKS})
    found.save(tmp_path / "results")
    saved = json.loads((tmp_path / "results" / "one_metrics.json").read_text(encoding="utf-8"))
    assert saved["avg_train_perf"] == found["avg_train_perf"] != metrics(logs[0])["avg_train_perf"]
    assert len(found.regimes()) == 3 * 2 + 2


@pytest.mark.parametrize("copied", [lambda found: pickle.loads(pickle.dumps(found)), copy.deepcopy], ids=["pickle", "deepcopy"])
def test_copies_of_scores_are_equal_and_save_the_same(
    logs: list[Path], tmp_path: Path, copied: Callable[[Metrics], Metrics]
) -> None:
    pytest.importorskip("pandas", reason="data frames are pandas'")
    found = metrics(logs, common_ranges=True)
    again = copied(found)
    assert again == found and again.regimes().equals(found.regimes())
    found.save(tmp_path / "first")
    again.save(tmp_path / "second")
    texts = [{path.name: path.read_bytes() for path in (tmp_path / name).iterdir()} for name in ("first", "second")]
    assert texts[0] == texts[1]


def test_regimes_match_the_saved_ones(logs: list[Path], tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas", reason="data frames are pandas'")
    found = metrics(logs)
    found.save(tmp_path, name="all")
    saved = pandas.read_csv(tmp_path / "all_regime.tsv", sep="\t")
    frame = found.regimes()
    assert set(saved.columns) <= set(frame.columns)
    for column in saved.columns:
        if column != "task_params":
            pandas.testing.assert_series_equal(frame[column], saved[column], check_dtype=False)


def test_tiny_number_below_zero_is_accepted(logs: list[Path]) -> None:
    assert metrics(logs[0], noise=(-1e-9, 1e-9), noise_seed=1).lifetimes


def test_errors_use_pythons_option_names(logs: list[Path]) -> None:
    with pytest.raises(MetricsError, match="transfer_method") as refused:
        metrics(logs[0], transfer_method="ratoi")
    assert "--" not in str(refused.value)
