"""Shrink and perturb: at each task border all weights are scaled down, and scaled weights of a fresh network are added.

θ ← shrink · θ + perturb · θ_fresh, with θ_fresh as at the start of a lifetime. Source: Ash and Adams 2020
(arXiv:1910.08475), alg. 1. It preserves plasticity (a network trained for long learns new tasks more slowly), and does
not prevent forgetting.

Known traps:

- Adam's moments belong to the old weights; they are cleared, so compare this method with ``ResetOptimizer``.
- Shrinking a ReLU network of n layers without biases by s scales its outputs by sⁿ: the policy becomes less certain,
  which is part of the effect. Compare with a different ``entropy``, too.
"""

from __future__ import annotations

from typing import Any

import torch

from driftworld.learners.ppo import PPO


class ShrinkAndPerturb(PPO):
    """PPO whose weights are shrunk and perturbed at the end of each task.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        shrink: Factor of the old weights, 0 to 1.
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
        """Shrinks and perturbs the weights, and clears Adam's moments."""
        fresh = dict(self.fresh_network(self.tasks).named_parameters())
        for name, weight in self.network.named_parameters():
            weight.mul_(self.shrink).add_(fresh[name], alpha=self.perturb)
        self.reset_optimizer()
