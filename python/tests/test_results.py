"""The variants and worlds of committed results still have the recorded hashes."""

from __future__ import annotations

import json
from pathlib import Path

import driftworld
import gymnasium as gym
import pytest
from conftest import ROOT

CONFIGS = sorted((ROOT / "examples" / "python" / "results").glob("*/config.json"))


@pytest.mark.parametrize("config", CONFIGS, ids=lambda path: path.parent.name)
def test_recorded_hashes_are_current(config: Path) -> None:
    worlds = json.loads(config.read_text(encoding="utf-8"))["worlds"]
    assert worlds
    for name, recorded in worlds.items():
        path = f"{ROOT / name}" if ".json" in name else name
        assert driftworld.variant(path).hash == recorded["variant"], f"{name}: record the result again, or delete it"
        env = gym.make("driftworld/Task-v0", task=path)
        found = {seed: env.reset(seed=int(seed))[1]["world_hash"] for seed in recorded["first_worlds"]}
        assert found == recorded["first_worlds"], f"{name}: record the result again, or delete it"
