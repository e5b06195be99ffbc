"""Trains PPO and films it, for the film at the top of the README.

    python scripts/trained_film.py target/release/driftworld

Writes examples/networks/obstacle_course.safetensors, unless it exists, and docs/images/trained.gif. Training takes half
a minute on one core, and needs PyTorch.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
TASK, NUM_ENVS, DECISIONS = "obstacle_course", 64, 150_000
ACTIONS = [[10, 0, 0], [10, 27, 0], [10, -27, 0], [3, 90, 0], [3, -90, 0]]
NETWORK, FILM = ROOT / f"examples/networks/{TASK}.safetensors", ROOT / "docs/images/trained.gif"


def train() -> None:
    """Learns the crowded obstacle course, and exports the network."""
    import torch
    from driftworld import Curriculum
    from driftworld.learners import PPO, Settings

    torch.set_num_threads(1)
    regime = {"task": TASK, "variant": "crowded", "count": DECISIONS, "steps": DECISIONS, "seed": 1}
    plan = Curriculum.from_dict({"version": 1, "name": "course", "blocks": [{"type": "learning", "regimes": [regime]}]})
    options = {"modalities": "rgb", "size": 32, "actions": ACTIONS, "interact": False, "frame_skip": 5}
    learner = PPO(len(ACTIONS), NUM_ENVS, seed=1, size=32, settings=Settings(annealing=DECISIONS, reward_scale=0.2))
    with tempfile.TemporaryDirectory() as place:
        plan.run_vector(learner, Path(place) / "log", num_envs=NUM_ENVS, num_threads=1, check_frozen=False, **options)
    NETWORK.parent.mkdir(exist_ok=True)
    learner.export(NETWORK, actions=ACTIONS, frame_skip=5, interact=False)


if __name__ == "__main__":
    if not NETWORK.is_file():
        train()
    command = [sys.argv[1], "film", f"{TASK}#crowded", "--agent", f"net:{NETWORK}", "--index", "2", "--size", "176", "-o", FILM]
    subprocess.run(command, check=True)
