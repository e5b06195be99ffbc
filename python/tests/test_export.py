"""With an exported network, the built-in agent acts like the learner; unsupported learners are refused."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import driftworld
import numpy as np
import pytest
from small_learners import ACTIONS, OPTIONS, package, small

pytestmark = pytest.mark.learners
EPISODES = 20


def test_built_in_agent_acts_like_the_learner_in_whole_episodes(tmp_path: Path) -> None:
    torch, learners = pytest.importorskip("torch"), package()
    learner = learners.PPO(len(ACTIONS), 1, seed=2, size=32, policy="greedy")
    # Makes the policy as decisive as a trained one; an untrained greedy policy always takes the same action.
    with torch.no_grad():
        learner.network.policy.weight.mul_(300)
    learner.export(tmp_path / "net.safetensors", actions=ACTIONS, frame_skip=5, interact=False)
    regime = {"task": "find_objects", "variant": "red", "count": EPISODES, "seed": 5}
    scenario = {"version": 1, "name": "look", "blocks": [{"type": "evaluation", "regimes": [regime]}]}
    (tmp_path / "look.json").write_text(json.dumps(scenario))
    curriculum = driftworld.Curriculum.load(tmp_path / "look.json")
    curriculum.run_vector(learner, tmp_path / "python", num_envs=1, record=True, size=32, **OPTIONS)
    command = [sys.executable, "-m", "driftworld", "run", "look.json", "--record", "--agent", "net:net.safetensors", "-o", "rust"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    used: set[int] = set()
    for episode in range(EPISODES):
        rows = driftworld.Recording.read(tmp_path / "python", episode).actions
        numbers = driftworld.Recording.read(tmp_path / "rust", episode).actions
        decided = np.array(ACTIONS, dtype=float)[rows]
        # Each agent's own steps count towards the step limit, so the shorter episode must be a prefix of the longer.
        length = min(len(numbers), 5 * len(decided))
        assert length >= 20
        assert np.array_equal(np.repeat(decided, 5, axis=0)[:length], numbers[:length])
        used |= set(rows.tolist())
    assert len(used) > 2
    log = json.loads(next((tmp_path / "rust").glob("**/scenario_info.json")).read_text())
    assert len(log["made_from"]["network"]) == 64


@pytest.mark.parametrize("kind", ["RecurrentPPO", "PackNet"])
def test_learner_with_state_beyond_its_network_is_refused(kind: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="expected a PatchNetwork alone"):
        small(kind).export(tmp_path / "net.safetensors", actions=ACTIONS)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("actions", [ACTIONS[:4], [[10, 0]] * 5])
def test_wrong_action_table_is_refused(actions: Any, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="actions: found .*, expected a table of 5 rows of three numbers"):
        small().export(tmp_path / "net.safetensors", actions=actions)
    assert not list(tmp_path.iterdir())
