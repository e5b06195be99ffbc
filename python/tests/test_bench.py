"""`python -m driftworld.bench` measures and prints; no test depends on speed."""

from __future__ import annotations

import json

import pytest
from driftworld import bench


def test_quick_run_prints_every_figure(capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.main(["--quick"]) == 0
    printed = capsys.readouterr().out
    for line in ("64 environments, three modalities, copies", "read-only views (copy=False)", "views, depth in metres"):
        assert line in printed
    assert "µs a step beyond the step in Rust" in printed


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
