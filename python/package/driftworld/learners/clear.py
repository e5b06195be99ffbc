"""CLEAR: PPO on new experience, V-trace and cloning on a uniform sample of all past experience. It does not use task
labels.

A reservoir stores stretches of ``settings.rollout`` steps of one environment (Vitter 1985, algorithm R). The passes
over a rollout are followed by as many optimiser steps as one pass has, each on stretches drawn from the reservoir, with
the loss

    ½ (V − vₛ)² − A log π(a|s) − entropy · H(π) + policy_cloning · KL(π_then ‖ π) + value_cloning · (V − V_then)²,

where vₛ and A are V-trace's targets and advantages (Espeholt et al. 2018, arXiv:1802.01561, eq. 1) and *then* marks
values at the time of the action. Source: Rolnick et al. 2019 (arXiv:1811.11682), section 3.

Known traps:

- Its learner is PPO, not IMPALA, and its losses are means, not sums: the paper's cloning weights do not carry over.
- It takes more optimiser steps than PPO with the same number of epochs. For an equal number, use one epoch fewer.
- The reservoir takes megabytes: ``report()["method_bytes"]`` is its size.
- A stretch that ends during an episode is bootstrapped with the current value of its last image. An episode truncated
  by a step limit is bootstrapped with the value that its last image had at the time, because that image is not
  stored.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch

from driftworld.learners.ppo import PPO
from driftworld.learners.rollout import Rollout


class Reservoir:
    """A uniform sample of all stretches of experience ever offered: each is kept with probability capacity / offered.

    Args:
        capacity: Maximum number of stretches, from 1.
        seed: The seed of the sampling, from 0.

    Attributes:
        offered: Number of stretches offered so far.
        stretches: The stored stretches, each a dictionary of the tensors of a
            :class:`driftworld.learners.rollout.Rollout` for one environment.
    """

    def __init__(self, capacity: int, seed: int) -> None:
        self.capacity, self.offered = capacity, 0
        self.stretches: list[dict[str, torch.Tensor]] = []
        self.chance = np.random.default_rng(seed)

    def offer(self, rollout: Rollout) -> None:
        """Offers the stretches of all environments with an active step in a rollout."""
        for env in rollout.active.any(dim=0).nonzero().squeeze(-1).tolist():
            self.offered += 1
            place = len(self.stretches)
            if place == self.capacity:
                place = int(self.chance.integers(self.offered))
                if place >= self.capacity:
                    continue
            self.stretches[place : place + 1] = [{name: rows[:, env].clone() for name, rows in vars(rollout).items()}]

    def draw(self, count: int) -> Rollout:
        """Stretches drawn with replacement, as a rollout of ``count`` environments."""
        chosen = [self.stretches[place] for place in self.chance.integers(len(self.stretches), size=count)]
        rollout: Rollout = object.__new__(Rollout)
        vars(rollout).update({name: torch.stack([stretch[name] for stretch in chosen], dim=1) for name in chosen[0]})
        return rollout


def v_trace(
    rollout: Rollout, values: torch.Tensor, log_ratio: torch.Tensor, discount: float
) -> tuple[torch.Tensor, torch.Tensor]:
    """V-trace's targets and advantages, ``(length, n)`` each; ratios are truncated at 1.

    Args:
        rollout: The rollout.
        values: Current values of its images, ``(length + 1, n)``.
        log_ratio: Current log-probability of each action minus that at the time of the action, ``(length, n)``.
        discount: For each decision, 0 to 1.
    """
    ratio = log_ratio.exp().clamp(max=1.0)
    surprise = rollout.rewards + discount * rollout.following(values) - values[:-1]
    advantages, later = torch.zeros_like(ratio), torch.zeros_like(ratio[0])
    for step in reversed(range(len(ratio))):
        # With both truncated at 1, the advantage is the target minus the value. Nothing crosses the end of an episode.
        later = ratio[step] * (surprise[step] + discount * later * ~rollout.ended[step])
        advantages[step] = later
    return values[:-1] + advantages, advantages


class CLEAR(PPO):
    """PPO with experience replay.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        capacity: Maximum number of stretches in the reservoir, from 1; one is 100 kB at 32 × 32 pixels and 32 steps.
        policy_cloning: Weight of the divergence from the policy at the time of the action, from 0.
        value_cloning: Weight of the squared distance from the value at the time of the action, from 0.
        **options: As for :class:`PPO`.

    Attributes:
        reservoir: See :class:`Reservoir`.
    """

    name = "clear"

    def __init__(
        self, num_actions: int, num_envs: int, *, capacity: int = 512, policy_cloning: float = 0.1, value_cloning: float = 0.05,
        **options: Any,
    ) -> None:  # fmt: skip
        super().__init__(num_actions, num_envs, **options)
        self.policy_cloning, self.value_cloning = policy_cloning, value_cloning
        self.reservoir = Reservoir(capacity, self.seed)

    def after_update(self, rollout: Rollout) -> None:
        """Offers the rollout, and takes as many steps on old stretches as one pass has."""
        if len(rollout.rewards) == self.settings.rollout:
            # Rollouts cut short by a border are skipped: all stretches have the same length.
            self.reservoir.offer(rollout)
        if not self.reservoir.stretches:
            return
        for _ in range(max(1, round(int(rollout.active.sum()) / self.settings.minibatch))):
            self.step(self.replay_loss(self.reservoir.draw(max(1, self.settings.minibatch // self.settings.rollout))))

    def replay_loss(self, old: Rollout) -> torch.Tensor:
        """The loss on old stretches, averaged over their active steps."""
        length, count = old.rewards.shape
        log_policy, values = self.network(old.images.flatten(0, 1))
        log_policy, values = log_policy.view(length + 1, count, -1)[:-1], values.view(length + 1, count)
        actions = old.actions.unsqueeze(-1)
        log_prob = log_policy.gather(-1, actions).squeeze(-1)
        log_ratio = log_prob - old.log_policy.gather(-1, actions).squeeze(-1)
        targets, advantages = v_trace(old, values.detach(), log_ratio.detach(), self.settings.discount)
        entropy = -(log_policy.exp() * log_policy).sum(-1)
        policy_distance = (old.log_policy.exp() * (old.log_policy - log_policy)).sum(-1)
        value_distance = (values[:-1] - old.values[:-1]).square()
        loss = (
            0.5 * (values[:-1] - targets).square() - advantages * log_prob - self.settings.entropy * entropy
            + self.policy_cloning * policy_distance + self.value_cloning * value_distance
        )  # fmt: skip
        return loss[old.active].mean()

    def method_state(self) -> dict[str, Any]:
        """The reservoir."""
        reservoir = self.reservoir
        return {
            "offered": reservoir.offered, "stretches": reservoir.stretches, "chance": reservoir.chance.bit_generator.state
        }  # fmt: skip

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Restores the reservoir."""
        self.reservoir.offered, self.reservoir.stretches = state["offered"], list(state["stretches"])
        self.reservoir.chance.bit_generator.state = state["chance"]
