"""The families' pages match the output of scripts/families.py, and some measurements are reproduced."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import driftworld
import pytest
from driftworld import _native

ROOT = Path(__file__).parents[2]


def script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, ROOT / f"scripts/{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def families(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script, with the command run in this process."""
    module = script("families")

    def run_json(_: str, *words: str) -> Any:
        assert _native.main(["driftworld", *words, "--json"]) in (0, 1)
        return json.loads(capfd.readouterr().out)

    monkeypatch.setattr(module, "run_json", run_json)
    return module


def test_pages_match_the_measurements(families: ModuleType, tmp_path: Path) -> None:
    families.pages("driftworld", tmp_path)
    written = sorted(path.relative_to(tmp_path) for path in tmp_path.rglob("*.*"))
    assert len(written) > 80
    for path in written:
        assert (tmp_path / path).read_text(encoding="utf-8") == (ROOT / "docs" / path).read_text(encoding="utf-8"), path


def test_every_variant_is_measured() -> None:
    measured = json.loads((ROOT / "examples/families.json").read_text(encoding="utf-8"))
    assert list(measured) == [name for names in driftworld.task_groups().values() for name in names]
    for name, variants in measured.items():
        assert list(variants) == driftworld.TaskSpec.load(name).variant_names(), name


@pytest.mark.parametrize("name", ["pickup", "thin_ice", "color_pays", "unlock"])
def test_measurements_of_a_family_are_reproducible(families: ModuleType, name: str) -> None:
    measured = json.loads((ROOT / "examples/families.json").read_text(encoding="utf-8"))[name]
    first = next(iter(measured))
    scales = families.run_json("driftworld", "scales", f"{name}#{first}", "--worlds", str(families.WORLDS))["scales"]
    (scale,) = scales.values()
    assert round(scale["agents"]["random"]["mean"], 2) == measured[first]["random"]
    assert round(scale["agents"]["onrails"]["mean"], 2) == measured[first]["planner"]
    assert scale["agents"]["onrails"]["success"] == measured[first]["success"]


def test_readme_matches_learning_and_measurements() -> None:
    readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    measured = json.loads((ROOT / "examples/families.json").read_text(encoding="utf-8"))
    assert f"[{len(measured)} families of tasks](docs/families.md)** with {sum(map(len, measured.values()))} variants" in readme
    seeds = json.loads((ROOT / "examples/families_learned.json").read_text(encoding="utf-8"))["obstacle_course"]["ppo"]
    (success,) = {seed["success"] for seed in seeds}
    seconds = [seed["processor_seconds"] for seed in seeds]
    assert f"{success:.0%} successes".replace("%", " %") in readme
    assert f"{min(seconds)} to {max(seconds)} seconds of one core" in readme
    assert len(seeds) == 3 and "three seeds" in readme
    learning = script("learn_families")
    side = learning.OPTIONS["size"]
    assert f"{side} × {side} pixels in {learning.DECISIONS:,} decisions" in readme
    assert f"{learning.WORLDS} new worlds" in readme
