"""Writes a network and its log-probabilities, which env/src/agents/network/tests.rs compares with its own.

    python scripts/golden_network.py

Needs driftworld.learners and torch; a different version of torch may change the last digits.
"""

from __future__ import annotations

import json
from pathlib import Path

import torch
from driftworld.learners import PPO
from driftworld.learners.networks import PatchNetwork

ACTIONS = [[10, 0, 0], [3, 90, 0], [0, 0, 1]]
SIZE = 16
GOLDEN = Path(__file__).parents[1] / "env" / "tests" / "golden"


class Small(PPO):
    """PPO with a small network."""

    def make_network(self) -> PatchNetwork:
        """A network with large weights, so that every layer matters."""
        network = PatchNetwork(self.num_actions, self.size, width=4, hidden=8)
        for parameter in network.parameters():
            torch.nn.init.normal_(parameter, std=0.4)
        return network


def image(number: int) -> list[int]:
    """The bytes of an image; the test generates the same."""
    return [(k * (7 + 2 * number) + k // 5) % 256 for k in range(SIZE * SIZE * 3)]


torch.set_num_threads(1)
learner = Small(len(ACTIONS), 1, seed=1, size=SIZE, policy="greedy")
learner.export(GOLDEN / "network.safetensors", actions=ACTIONS, frame_skip=5)
images = torch.tensor([image(number) for number in range(4)], dtype=torch.uint8).reshape(4, SIZE, SIZE, 3)
with torch.no_grad():
    log_policy, _ = learner.network(images)
rows = [[round(number, 6) for number in row] for row in log_policy.tolist()]
(GOLDEN / "network.json").write_text(json.dumps(rows) + "\n")
