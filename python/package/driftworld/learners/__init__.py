"""Learners for curricula: PPO for small images, and one file for each continual method. Each is a
``driftworld.VectorAgent``.

    from driftworld.learners import EWC

    learner = EWC(num_actions=5, num_envs=64, seed=1, strength=0.1)
    curriculum.run_vector(learner, "logs/ewc", num_envs=64, modalities="rgb", size=32, actions=ACTIONS, frame_skip=5)
    print(learner.report())

They need torch. All have the same network, and learn from the same number of decisions; none uses a global generator.
"""

try:
    import torch as _torch  # noqa: F401
except ImportError as error:
    raise ImportError(
        'driftworld.learners: found no torch, expected version 2.1 or later; pip install "torch>=2.1"'
    ) from error

from driftworld.learners.clear import CLEAR
from driftworld.learners.ewc import EWC, OnlineEWC
from driftworld.learners.finetuning import FineTuning, ResetOptimizer
from driftworld.learners.from_scratch import FromScratch
from driftworld.learners.l2 import L2
from driftworld.learners.learner import Learner
from driftworld.learners.networks import PatchNetwork, RecurrentNetwork
from driftworld.learners.packnet import PackNet
from driftworld.learners.ppo import PPO, Settings
from driftworld.learners.recurrent_ppo import RecurrentPPO
from driftworld.learners.rollout import Rollout
from driftworld.learners.shrink_and_perturb import ShrinkAndPerturb

__all__ = [
    "CLEAR",
    "EWC",
    "L2",
    "PPO",
    "FineTuning",
    "FromScratch",
    "Learner",
    "OnlineEWC",
    "PackNet",
    "PatchNetwork",
    "RecurrentNetwork",
    "RecurrentPPO",
    "ResetOptimizer",
    "Rollout",
    "Settings",
    "ShrinkAndPerturb",
]
