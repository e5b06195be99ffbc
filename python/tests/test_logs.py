"""Writing, reading and checking logs from Python."""

from __future__ import annotations

import copy
import math
import os
import pickle
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driftworld import LogWriter, MetricsError, read_log, validate_log


def write_log(folder: Path, rewards: list[float]) -> Path:
    info = {"scenario_type": "alternating", "author": "nobody"}
    with LogWriter(folder, ["reward"], scenario_info=info) as log:
        for number, reward in enumerate(rewards):
            log.write(
                block_num=number // 2,
                exp_num=number,
                block_type="train" if number // 2 % 2 == 0 else "test",
                task_name="find_red",
                task_params={"seed": 7},
                reward=reward,
                steps=number,
            )
    return folder


def test_written_rows_are_read_back(tmp_path: Path) -> None:
    log = read_log(write_log(tmp_path / "log", [1.0, math.nan, 0.1 + 0.2]))
    assert (log.run_id, len(log), sorted(log.metrics)) == ("log", 3, ["reward", "steps"])
    assert np.array_equal(log["reward"], [1.0, math.nan, 0.1 + 0.2], equal_nan=True)
    assert log["block_num"].tolist() == [0, 0, 1] and log["exp_num"].dtype == np.int64
    assert log["block_type"].tolist() == ["train", "train", "test"]
    assert log["task_params"].tolist() == [{"seed": 7}] * 3
    assert (
        log["timestamp"].dtype == np.dtype("datetime64[us]") and (np.diff(log["timestamp"]) >= np.timedelta64(0)).all()
    )
    assert log.scenario_info == {"scenario_type": "alternating", "author": "nobody"}
    assert log.logger_info["metrics_columns"] == ["reward"]


def test_log_converts_to_a_data_frame(tmp_path: Path) -> None:
    pytest.importorskip("pandas", reason="data frames are pandas'")
    frame = read_log(write_log(tmp_path / "log", [1.0, 2.0])).to_pandas()
    assert frame["reward"].tolist() == [1.0, 2.0] and frame["task_name"].tolist() == ["find_red"] * 2


def test_log_is_a_table_of_columns(tmp_path: Path) -> None:
    log = read_log(write_log(tmp_path / "log", [1.0, math.nan, 3.0]))
    assert list(log) == list(log.keys()) == list(log.columns) and len(log) == 3
    assert "reward" in log and "rewrd" not in log and 3 not in log
    assert dict(log)["reward"] is log["reward"]
    assert all(len(log[name]) == len(log) for name in log)


def test_logs_are_equal_if_their_contents_are(tmp_path: Path) -> None:
    folder = write_log(tmp_path / "log", [1.0, math.nan, 3.0])
    log = read_log(folder)
    shutil.copytree(folder, tmp_path / "again")
    assert log == read_log(tmp_path / "again") == read_log(folder)
    assert log == pickle.loads(pickle.dumps(log)) == copy.deepcopy(log)
    assert log != read_log(write_log(tmp_path / "other", [1.0, math.nan, 4.0])) and log != dict(log)
    with pytest.raises(TypeError, match="unhashable"):
        hash(log)


def test_log_follows_the_format(tmp_path: Path) -> None:
    folder = write_log(tmp_path / "log", [1.0])
    lines = (folder / "worker-default" / "0-train" / "data-log.tsv").read_text(encoding="utf-8").splitlines()
    assert lines[0].split("\t") == (
        [
            "block_num",
            "exp_num",
            "worker_id",
            "block_type",
            "block_subtype",
            "task_name",
            "task_params",
            "exp_status",
            "timestamp",
            "reward",
            "steps",
        ]
    )
    assert validate_log(folder)["valid"] and validate_log(folder)["rows"] == 1


def test_log_resumes_where_it_stopped(tmp_path: Path) -> None:
    folder = write_log(tmp_path / "log", [1.0, 2.0])
    with pytest.raises(MetricsError) as refused:
        LogWriter(folder)
    assert refused.value.code == "metrics/log-exists"
    with LogWriter(folder, resume=True) as log:
        log.write(block_num=1, exp_num=2, block_type="test", task_name="find_red", reward=3.0, steps=2)
    assert read_log(folder)["reward"].tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"exp_num": 0}, "numbers never decrease"),
        ({"block_type": "learn"}, "train"),
        ({"reward": math.inf}, "finite"),
        ({"worker_id": "a/b"}, "worker_id"),
        ({"more": 1.0}, "as in the first record"),
    ],
)
def test_row_that_breaks_a_rule_is_not_written(tmp_path: Path, wrong: dict[str, Any], message: str) -> None:
    row: dict[str, Any] = {"block_num": 0, "block_type": "train", "task_name": "find_red", "reward": 1.0}
    with LogWriter(tmp_path / "log") as log:
        log.write(exp_num=3, **row)
        with pytest.raises(MetricsError, match=message):
            log.write(**{"exp_num": 4, **row, **wrong})
        log.write(exp_num=5, **row)
    assert read_log(tmp_path / "log")["exp_num"].tolist() == [3, 5]


def test_single_column_may_be_a_string(tmp_path: Path) -> None:
    LogWriter(tmp_path / "log", "performance").close()
    with LogWriter(tmp_path / "log", resume=True) as log:
        row: dict[str, Any] = {"block_num": 0, "exp_num": 0, "block_type": "train", "task_name": "find_red"}
        with pytest.raises(MetricsError, match="them to include performance"):
            log.write(**row, reward=1.0)
        log.write(**row, performance=1.0)
    assert read_log(tmp_path / "log").logger_info["metrics_columns"] == ["performance"]


@pytest.mark.skipif(os.name != "posix", reason="directories are held open on POSIX systems")
def test_deleted_log_raises_an_error(tmp_path: Path) -> None:
    log = LogWriter(tmp_path / "log", ["reward"])
    row = {"block_num": 0, "block_type": "train", "task_name": "find_red"}
    log.write(exp_num=0, **row, reward=1.0)
    (tmp_path / "log").rename(tmp_path / "away")
    for end in [lambda: log.write(exp_num=1, **row, reward=1.0), log.close]:
        with pytest.raises(MetricsError, match="found no directory.* with it 1 row") as refused:
            end()
        assert refused.value.code == "metrics/folder-lost"
    assert not (tmp_path / "log").exists()


def test_closed_log_takes_no_rows(tmp_path: Path) -> None:
    log = LogWriter(tmp_path / "log")
    log.close()
    log.close()
    with pytest.raises(ValueError, match="found it closed"):
        log.write(block_num=0, exp_num=0, block_type="train", task_name="find_red", reward=1.0)


def test_problems_of_a_log_are_reported_with_their_line(tmp_path: Path) -> None:
    folder = write_log(tmp_path / "log", [1.0, 2.0])
    file = folder / "worker-default" / "0-train" / "data-log.tsv"
    file.write_text(file.read_text(encoding="utf-8").replace("\t2.0\t", "\tmuch\t"), encoding="utf-8")
    with pytest.raises(MetricsError, match="much") as refused:
        read_log(folder)
    assert (refused.value.code, refused.value.line) == ("metrics/cell", 3)
    checked = validate_log(folder)
    assert not checked["valid"] and [problem["code"] for problem in checked["problems"]] == ["metrics/cell"]
    with pytest.raises(MetricsError):
        read_log(tmp_path / "nowhere")


@pytest.mark.parametrize("key", ["complexity", "difficulty", "scenario_type"])
def test_scenario_info_refuses_numbers_for_words(tmp_path: Path, key: str) -> None:
    with pytest.raises(ValueError, match=f"scenario_info, {key}: found 3, expected a word"):
        LogWriter(tmp_path / "log", scenario_info={key: 3})
    assert not (tmp_path / "log").exists()


def test_numpy_numbers_are_accepted(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", scenario_info={"seeds": np.arange(2)}) as log:
        params = {"seed": np.int64(7), "light": np.float32(0.5)}
        log.write(block_num=0, exp_num=0, block_type="train", task_name="t_v", task_params=params, reward=1.0)
    read = read_log(tmp_path / "log")
    assert read["task_params"].tolist() == [{"seed": 7, "light": 0.5}] and read.scenario_info == {"seeds": [0, 1]}
