"""The benchmark runner: each cell runs once, in any process, with the same digest after a kill; tables are computed from
the logs alone.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tarfile
import threading
import time
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from driftworld.benchmark import Cell, Results, Sequence, run_cells
from driftworld.benchmark import runner as running
from driftworld.benchmark.command import main

#: Changes to the smoke sequence that make it run in seconds.
TINY = {"decisions": 600, "evaluations": 2, "num_envs": 8}


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    """A short sequence file."""
    sequence = json.loads((Path(running.__file__).parent / "sequences/smoke.json").read_text(encoding="utf-8"))
    del sequence["frozen"]
    path = tmp_path / "tiny.json"
    path.write_text(json.dumps({**sequence, **TINY, "tasks": ["t_maze#left", "t_maze#right", "t_maze#left"]}), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", Sequence.names())
def test_frozen_sequences_are_unchanged(name: str) -> None:
    sequence = Sequence.load(name)
    assert set(sequence.frozen) == set(sequence.tasks) == set(sequence.scale)
    assert sequence.check() == []


def test_changed_sequence_is_reported(tiny: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = json.loads(tiny.read_text(encoding="utf-8"))
    document["frozen"] = {"t_maze#left": {**Sequence.load("smoke").frozen["t_maze#left"], "frames": "0"}}
    tiny.write_text(json.dumps(document), encoding="utf-8")
    assert main(["check", str(tiny)]) == 1
    assert "t_maze#left: found different frames" in capsys.readouterr().err


def test_lifetimes_of_seeds_and_splits_share_no_world() -> None:
    sequence = Sequence.load("smoke")
    worlds = [
        {(regime["seed"], regime["first_index"]) for block in lifetime.scenario["blocks"] for regime in block["regimes"]}
        for lifetime in (sequence.curriculum(0), sequence.curriculum(1), sequence.curriculum(0, "validation"))
    ]
    evaluated = [
        {regime["seed"] for block in lifetime.scenario["blocks"] if block["type"] == "evaluation" for regime in block["regimes"]}
        for lifetime in (sequence.curriculum(0), sequence.curriculum(1), sequence.curriculum(0, "validation"))
    ]
    assert not worlds[0] & worlds[1] and not evaluated[0] & evaluated[2]


def test_claim_belongs_to_one_process_until_it_is_stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    claim = tmp_path / "claim"
    with running._claim(claim) as first:
        with running._claim(claim) as second:
            assert (first, second) == (True, False)
        assert claim.is_dir()
    assert not claim.exists()
    claim.mkdir()
    os.utime(claim, (0, 0))
    with running._claim(claim) as taken:
        assert taken
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words, expected",
    [
        (["run", "smoke"], "found no learner, expected --learner NAME or --all"),
        (["run", "smok", "--learner", "ewc"], "found 'smok', expected a file or one of"),
        (["run", "smoke", "--learner", "ewc", "--jobs", "0"], "--jobs: found 0, expected at least 1"),
        (["run", "smoke", "--learner", "ewc", "--seed", "-1"], "expected --seed to be at least 0 and --seeds at least 1"),
        (["table", "nowhere", "--sequence", "smoke"], "nowhere: found no such folder, expected a folder of cells, such as results/mixed"),
        (["table", "."], "expected --sequence with its name or file"),
        (["table", ".", "--sequence", "smoke"], ".: found no finished cell, expected LEARNER/SEED/report.json"),
        (["run", "smoke", "--learner", "ewc", "--set", "strength=1", "--set", "strength=2"], "--set: found strength=1, strength=2, expected each name once"),
    ],
)
def test_invalid_input_is_refused_with_reason(words: list[str], expected: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 1
    assert expected in capsys.readouterr().err


ROOT = Path(__file__).parents[2]


def test_results_page_is_made_from_the_logs(tmp_path: Path) -> None:
    results = ROOT / "examples/benchmark/mixed"
    page, figure = tmp_path / "results.md", tmp_path / "images/results.svg"
    figure.parent.mkdir()
    assert main(["table", str(results), "-o", str(page), "--figure", str(figure)]) == 0
    assert page.read_text(encoding="utf-8") == (ROOT / "docs/results.md").read_text(encoding="utf-8")
    assert figure.read_text(encoding="utf-8") == (ROOT / "docs/images/results.svg").read_text(encoding="utf-8")


def test_table_logs_contain_all_learning_experiences() -> None:
    for name in ("mixed", "memory"):
        for runs in Results(Sequence.load(name), ROOT / "examples/benchmark" / name).runs.values():
            for run in runs:
                assert sum(int(steps.sum()) for steps in run.sampled.steps) == run.report["decisions"], run.folder


@pytest.mark.parametrize("learner", ["finetuning", "packnet"])
def test_table_logs_match_their_reports(learner: str, tmp_path: Path) -> None:
    cell = ROOT / "examples/benchmark/mixed" / learner / "0"
    with tarfile.open(cell / "logs.tar.xz") as tar:
        tar.extractall(tmp_path, filter="data")
    logs = [tmp_path / "sampled", *sorted(tmp_path.glob("greedy-*"))]
    report = json.loads((cell / "report.json").read_text(encoding="utf-8"))
    assert running.digest(logs) == report["digest"]


@pytest.mark.learners
def test_killed_run_ends_with_the_same_digests(tiny: Path, tmp_path: Path) -> None:
    words = [sys.executable, "-m", "driftworld", "benchmark", "run", str(tiny), "--learner", "ewc", "--learner", "clear", "--jobs", "2"]
    whole = tmp_path / "whole"
    subprocess.run([*words, "-o", str(whole)], check=True, capture_output=True)
    cells = [Cell(str(tiny), learner, 0) for learner in ("ewc", "clear")]
    expected = [json.loads((cell.folder(whole) / "report.json").read_text(encoding="utf-8")) for cell in cells]
    killed, random = tmp_path / "killed", np.random.default_rng(0)
    for _ in range(4):
        process = subprocess.Popen([*words, "-o", str(killed)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        time.sleep(random.uniform(2.0, 7.0))
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        for claim in killed.rglob("claim"):
            # Makes the claim stale.
            os.utime(claim, (0, 0))
    found = run_cells(cells, killed)
    for report, before in zip(found, expected, strict=True):
        assert report is not None
        for name in ("digest", "weights", "decisions", "updates"):
            assert report[name] == before[name], name
    table = Results(Sequence.load(str(tiny)), killed / "tiny")
    assert {row["learner"]: row["seeds"] for row in table.rows()} == {"ewc": 1, "clear": 1}
    (run,) = table.runs["ewc"]
    assert run.sampled.values.shape == run.greedy.values.shape == (4, 3)
    assert [len(curve) > 0 for curve in run.sampled.curves] == [True] * 3
    page, figure = killed / "page.md", killed / "images/figure.svg"
    figure.parent.mkdir()
    assert main(["table", str(killed / "tiny"), "--sequence", str(tiny), "-o", str(page), "--figure", str(figure)]) == 0
    assert "| `ewc` | 1 |" in page.read_text(encoding="utf-8") and "![](images/figure.svg)" in page.read_text(encoding="utf-8")
    svg = ElementTree.fromstring(figure.read_text(encoding="utf-8"))
    lines = [path.attrib["d"] for path in svg.iter("{http://www.w3.org/2000/svg}path") if path.attrib["class"] == "mean"]
    assert len(lines) == 2 and f"{120 * (1 - run.sampled.values[-1].mean()):.1f}" in {line.split()[-1] for line in lines}


@pytest.mark.learners
def test_cell_whose_learner_was_lost_reruns_to_the_same_digest(tiny: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cell = Cell(str(tiny), "finetuning", 0)
    (whole,) = run_cells([cell], tmp_path / "whole")

    def kill(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(running, "_finish", kill)
        with pytest.raises(KeyboardInterrupt):
            run_cells([cell], tmp_path / "killed")
    saved_learners = sorted((tmp_path / "killed").rglob("kept/*.pt"))
    assert len(saved_learners) == 3
    saved_learners[1].unlink()
    (again,) = run_cells([cell], tmp_path / "killed")
    assert whole is not None and again is not None and whole["digest"] == again["digest"]


@pytest.mark.learners
def test_custom_learner_is_one_file(
    tiny: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my_learner"]) == 0
    run = ["run", str(tiny), "--learner", "my_learner.py:MyLearner", "-o", "results"]
    for dry in ([], ["--dry-run"]):
        assert main([*run, "--set", "strenght=0.1", *dry]) == 1
        assert "unexpected keyword argument 'strenght'" in capsys.readouterr().err
    assert not Path("results").exists()
    assert main([*run, "--set", "strength=0.1"]) == 0
    report = json.loads(Path("results/tiny/mylearner-strength=0.1/0/report.json").read_text(encoding="utf-8"))
    assert report["learner"] == "my_learner" and report["method_bytes"] > 0
    assert report["made_with"]["strength"] == 0.1 and report["made_with"]["entropy"] == 0.05
    capsys.readouterr()
    Path("my_learner.py").write_text(Path("my_learner.py").read_text(encoding="utf-8") + "# Another one.\n", encoding="utf-8")
    assert main([*run, "--set", "strength=0.1"]) == 1
    assert "found a cell finished with another version of my_learner.py" in capsys.readouterr().err
    assert main(["new", "my_learner"]) == 1


@pytest.mark.learners
def test_smoke_sequence_is_learned_and_forgotten(tmp_path: Path) -> None:
    (report,) = run_cells([Cell("smoke", "finetuning", 0)], tmp_path)
    assert report is not None and report["decisions"] >= 4 * 33_000
    (run,) = Results(Sequence.load("smoke"), tmp_path / "smoke").runs["finetuning"]
    # Processors round differently, and one of the four tasks is not always learned.
    assert np.median(run.sampled.learned()) > 0.6, run.sampled.values
    assert run.sampled.forgetting() > 0.3, run.sampled.values


@pytest.mark.learners
def test_dead_ray_node_changes_no_digest(tiny: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cluster_utils = pytest.importorskip("ray.cluster_utils")
    ray = pytest.importorskip("ray")
    cells = [Cell(str(tiny), "finetuning", seed) for seed in (0, 1, 2)]
    local = run_cells(cells, tmp_path / "alone")
    # The nodes start their own processes, which read this variable.
    monkeypatch.setenv("DRIFTWORLD_STALE_SECONDS", "12")
    cluster = cluster_utils.Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
    try:
        nodes = [cluster.add_node(num_cpus=1) for _ in range(3)]
        killer = threading.Timer(12.0, lambda: cluster.remove_node(nodes[0], allow_graceful=False))
        killer.start()
        found = run_cells(cells, tmp_path / "shared", ray=cluster.address)
        killer.join()
    finally:
        ray.shutdown()
        cluster.shutdown()
    digests = [[report and report["digest"] for report in reports] for reports in (local, found)]
    assert digests[0] == digests[1] and None not in digests[0]
