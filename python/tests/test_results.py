"""The committed results still match: their variants and worlds have the recorded hashes."""

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
    for name, told in worlds.items():
        path = f"{ROOT / name}" if ".json" in name else name
        assert driftworld.variant(path).hash == told["variant"], f"{name}: made anew, or deleted"
        env = gym.make("driftworld/Task-v0", task=path)
        found = {seed: env.reset(seed=int(seed))[1]["world_hash"] for seed in told["first_worlds"]}
        assert found == told["first_worlds"], f"{name}: made anew, or deleted"
