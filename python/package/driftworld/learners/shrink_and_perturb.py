"""Shrink and perturb: at each border of tasks all weights get smaller, and some of a fresh network's are added.

θ ← shrink · θ + perturb · θ_fresh, with θ_fresh as at the start of a life. Source: Ash and Adams 2020 (arXiv:1910.08475), alg. 1. It is
meant for plasticity (a network that learned long learns new things more slowly), not against forgetting.

Known traps:

- Adam's moments belong to the weights before; they are cleared, so that this is compared with ``ResetOptimizer``.
- A rectified network of n layers without biases that shrinks by s has outputs smaller by sⁿ: the policy gets less certain, which
  is a part of the effect. Compare with another ``entropy``, too.
"""

from __future__ import annotations

from typing import Any

import torch

from driftworld.learners.ppo import PPO


class ShrinkAndPerturb(PPO):
    """PPO whose weights shrink and are perturbed where a task ends.

    Args:
        num_actions: Rows of the table of actions.
        num_envs: Environments that it acts in.
        shrink: Factor of the weights, 0 to 1.
        perturb: Factor of the fresh weights, from 0.
        **options: As for :class:`PPO`; ``borders`` is ``"labels"`` by default.
    """

    name = "shrink_and_perturb"
    own_borders = "labels"

    def __init__(
        self, num_actions: int, num_envs: int, *, shrink: float = 0.6, perturb: float = 0.4, **options: Any
    ) -> None:
        super().__init__(num_actions, num_envs, **options)
        self.shrink, self.perturb = shrink, perturb

    @torch.no_grad()
    def end_task(self, label: str | None) -> None:
        """Shrinks, perturbs, and clears Adam's moments."""
        fresh = dict(self.fresh_network(self.tasks).named_parameters())
        for name, weight in self.network.named_parameters():
            weight.mul_(self.shrink).add_(fresh[name], alpha=self.perturb)
        self.reset_optimizer()
