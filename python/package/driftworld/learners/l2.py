"""L2: a quadratic penalty ("spring") on the change of every weight since the last task border.

loss = loss of PPO + strength / 2 · Σᵢ (θᵢ − θᵢ*)², where θ* are the weights at the end of the last task. It is EWC with
all importances 1, and the control for EWC (Kirkpatrick et al. 2017, arXiv:1612.00796, fig. 2): a method that does no
better gains nothing from its importances.

Known traps: a spring that preserves old tasks hinders new ones, so report both; tune ``strength`` on sequences that are
not scored. The value head's weights are penalised like all others.
"""

from __future__ import annotations

from typing import Any

import torch

from driftworld.learners.ppo import PPO


class L2(PPO):
    """PPO with a spring towards the weights at the end of the last task.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        strength: Strength of the springs, from 0; tune it on sequences that are not scored.
        **options: As for :class:`PPO`; ``borders`` is ``"labels"`` by default.
    """

    name = "l2"
    own_borders = "labels"

    def __init__(self, num_actions: int, num_envs: int, *, strength: float = 0.1, **options: Any) -> None:
        super().__init__(num_actions, num_envs, **options)
        self.strength = strength
        self.anchor: dict[str, torch.Tensor] = {}

    def end_task(self, label: str | None) -> None:
        """Sets the springs' targets to the current weights."""
        self.anchor = {name: weight.detach().clone() for name, weight in self.network.named_parameters()}

    def extra_loss(self) -> torch.Tensor | float:
        """The energy of the springs; 0 in the first task."""
        if not self.anchor:
            return 0.0
        weights = self.network.named_parameters()
        return 0.5 * self.strength * sum((weight - self.anchor[name]).square().sum() for name, weight in weights)

    def method_state(self) -> dict[str, Any]:
        """The springs' targets."""
        return {"anchor": self.anchor}

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Restores the springs' targets."""
        self.anchor = state["anchor"]
