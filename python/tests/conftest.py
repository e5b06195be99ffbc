"""Shared fixtures: environment ids, variants, and small task and world files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import driftworld
import pytest

#: The root of the checkout.
ROOT = Path(__file__).parents[2]

TASKS = {
    "driftworld/FindObjects-v0": "find_objects",
    "driftworld/GetToGoal-v0": "get_to_goal",
    "driftworld/SelectObject-v0": "select_object",
    "driftworld/MovingObject-v0": "moving_object",
    "driftworld/ScavengerHunt-v0": "scavenger_hunt",
    "driftworld/BlueRedGreen-v0": "blue_red_green",
}


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Parametrizes ``env_id`` with each task's id, and ``task_variant`` with each variant of each task, as (id,
    name).
    """
    if "env_id" in metafunc.fixturenames:
        metafunc.parametrize("env_id", TASKS)
    if "task_variant" in metafunc.fixturenames:
        task_variants = [
            (env_id, name) for env_id, task in TASKS.items() for name in driftworld.TaskSpec.load(task).variant_names()
        ]
        metafunc.parametrize("task_variant", task_variants, ids=[f"{TASKS[env_id]}#{name}" for env_id, name in task_variants])


@pytest.fixture
def small() -> dict[str, Any]:
    """Options that make steps cheap."""
    return {"modalities": ["rgb", "state"], "size": 40}


@pytest.fixture
def world_file(tmp_path: Path) -> Path:
    """A world written by ``driftworld sample``."""
    path = tmp_path / "world.json"
    path.write_text(driftworld.variant("find_objects#red").sample_json(5, 0), encoding="utf-8")
    return path


@pytest.fixture
def task_file(tmp_path: Path) -> Path:
    """A user's own task spec."""
    document = json.loads((ROOT / "examples" / "tasks" / "get_to_goal.json").read_text(encoding="utf-8"))
    path = tmp_path / "own_task.json"
    path.write_text(json.dumps({**document, "name": "own_task"}), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def package() -> Path:
    """The folder of the installed package under test."""
    return Path(driftworld.__file__).parent
