"""`python -m driftworld.bench` measures and prints; no test depends on speed."""

from __future__ import annotations

import json
import runpy
from pathlib import Path

import pytest
from driftworld import DriftworldVectorEnv, bench


def test_quick_run_prints_every_figure(capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.main(["--quick"]) == 0
    printed = capsys.readouterr().out
    for line in ("64 environments, three modalities, copies", "read-only views (copy=False)", "views, depth in metres"):
        assert line in printed
    assert "µs a step on top of the step in Rust" in printed


def test_json_has_rates_and_their_ratio(capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.main(["--quick", "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["vector"] > 0 and figures["resets"] > 0
    assert figures["vector_ratio"] == pytest.approx(figures["vector"] / figures["vector_rust"])


def test_missing_peer_is_listed_with_the_reason() -> None:
    def missing(_seconds: float) -> float:
        raise ModuleNotFoundError("No module named 'vizdoom'")

    assert bench._beside("vizdoom", missing, (8, 8), 0.01) == {
        "vizdoom_missing": "ModuleNotFoundError: No module named 'vizdoom'"
    }


def test_zero_seconds_are_refused() -> None:
    with pytest.raises(SystemExit) as ended:
        bench.main(["--seconds", "0"])
    assert ended.value.code == 2


def test_arenas_of_the_scaling_table_have_the_size_in_their_name(capsys: pytest.CaptureFixture[str]) -> None:
    scaling = runpy.run_path(str(Path(__file__).parents[2] / "scripts/scaling.py"))
    world = scaling["arena"](num_objects=100, corners=120)
    state = json.loads(DriftworldVectorEnv(num_envs=1, world=world)._members.batch.state(0))
    assert len(state["objects"]) == 100
    assert sum(len(wall["polygon"]) for wall in state["environment_params"]["walls"]) == 120
    rates = scaling["best"]({"one": (lambda: None, 1), "two": (lambda: None, 2)}, seconds=0.001, rounds=2)
    scaling["table"]("title", rates, "calls a second", "one")
    assert "title" in capsys.readouterr().out and min(rates.values()) > 0
    with pytest.raises(SystemExit) as ended:
        scaling["main"](["--rounds", "0"])
    assert ended.value.code == 2
