"""PackNet: every task gets its own weights, which are then frozen; later tasks use them and train the rest.

Near the end of a task each layer keeps its largest free weights, an equal share for each remaining task; the rest are
set to 0 and free for later tasks. The kept weights are trained further until the end of the task. In evaluations a task
uses its own weights and those of the tasks before it. Source: Mallya and Lazebnik 2018 (arXiv:1711.05769), section 3;
as in Continual World (Wołczyk et al. 2021, arXiv:2105.10919), every task gets an equal share, and biases belong to the
first task.

Known traps:

- A gradient of 0 does not stop Adam: its moments keep moving a weight. They are cleared at borders and after pruning.
- The learner must know the length of a task (``task_decisions``) and the number of tasks (``max_tasks``). Retraining is
  included: it takes the last fraction of the task, ``retraining``. A task that ends earlier is not retrained, and its
  policy is worse.
- The label selects the weights of an evaluation. Evaluating without labels is a different problem.
- The value head is not constrained: it is only needed for learning, and forgetting it affects no score.
- A task that occurs again counts as a further task with its own weights.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch.func import functional_call

from driftworld.learners.ppo import PPO
from driftworld.learners.rollout import Rollout


class PackNet(PPO):
    """PPO with a share of the weights for each task.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        max_tasks: Number of tasks in the lifetime, counting each visit, from 1.
        task_decisions: Number of decisions in each task, from 1.
        retraining: Share of these decisions that comes after pruning, 0 to 1.
        **options: As for :class:`PPO`; ``borders`` is ``"labels"`` by default.

    Attributes:
        owners: For each parameter except the value head, the task that owns each weight: 0 for none, else its number
            from 1.
    """

    name = "packnet"
    own_borders = "labels"

    def __init__(
        self, num_actions: int, num_envs: int, *, max_tasks: int, task_decisions: int, retraining: float = 0.25, **options: Any
    ) -> None:  # fmt: skip
        super().__init__(num_actions, num_envs, **options)
        self.max_tasks, self.pruning_after = max_tasks, (1.0 - retraining) * task_decisions
        self.owners = {
            name: torch.zeros_like(weight, dtype=torch.uint8)
            for name, weight in self.network.named_parameters()
            if not name.startswith("value.")
        }
        self.slots: dict[str, int] = {}
        self.is_pruned = False
        self._views: dict[int, dict[str, torch.Tensor]] = {}

    def begin_task(self, label: str | None) -> None:
        """Numbers the task.

        Raises:
            ValueError: If there are more tasks than ``max_tasks``.
        """
        if self.tasks > self.max_tasks:
            raise ValueError(
                f"{self.name}: found task number {self.tasks}, expected at most max_tasks={self.max_tasks}"
            )
        self.slots[str(label)], self.is_pruned = self.tasks, False
        self.reset_optimizer()

    def end_task(self, label: str | None) -> None:
        """Prunes if that has not been done yet."""
        if not self.is_pruned:
            self.prune()

    def after_update(self, rollout: Rollout) -> None:
        """Prunes when it is time."""
        if not self.is_pruned and self.task_decisions >= self.pruning_after:
            self.prune()

    @torch.no_grad()
    def prune(self) -> None:
        """Gives the task its share of each layer's free weights, the largest ones, and sets the others to 0."""
        for name, weight in self.network.named_parameters():
            if name not in self.owners:
                continue
            owner = self.owners[name]
            free = owner == 0
            if weight.dim() == 1:
                owner[free] = self.tasks
                continue
            count = int(free.sum())
            share = -(-count // (self.max_tasks - self.tasks + 1))
            order = weight.abs().masked_fill(~free, -1.0).flatten().argsort(descending=True, stable=True)
            owner.view(-1)[order[:share]] = self.tasks
            weight[owner == 0] = 0.0
        self.is_pruned = True
        self.reset_optimizer()

    def mask_gradients(self) -> None:
        """Lets all free weights learn before pruning, and only the task's own afterwards."""
        learning = self.tasks if self.is_pruned else 0
        for name, weight in self.network.named_parameters():
            if name in self.owners and weight.grad is not None:
                weight.grad.mul_(self.owners[name] == learning)

    def freeze(self, frozen: bool) -> None:
        """Sets whether the learner is being evaluated."""
        super().freeze(frozen)
        self._views.clear()

    def look(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Evaluates each environment with the weights of its label's task; an unknown label uses the current task's."""
        if not self.frozen:
            return super().look(images)
        slots = torch.tensor([self.slots.get(str(label), self.tasks) for label in self.labels])
        log_policy, values = torch.zeros(self.num_envs, self.num_actions), torch.zeros(self.num_envs)
        for slot in slots.unique().tolist():
            rows = slots == slot
            log_policy[rows], values[rows] = functional_call(self.network, dict(self._weights(slot)), (images[rows],))
        return log_policy, values

    def _weights(self, slot: int) -> Mapping[str, torch.Tensor]:
        """The weights that a task uses: its own and those of earlier tasks; the current task also uses the free
        ones.
        """
        if slot not in self._views:
            fewest = 0 if slot == self.tasks else 1
            self._views[slot] = {
                name: weight * ((self.owners[name] >= fewest) & (self.owners[name] <= slot))
                if name in self.owners
                else weight
                for name, weight in self.network.named_parameters()
            }
        return self._views[slot]

    def method_state(self) -> dict[str, Any]:
        """The owners, and the task numbers of labels."""
        return {"owners": self.owners, "slots": dict(self.slots), "is_pruned": self.is_pruned}

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Restores the owners and the task numbers."""
        self.owners = {name: owner.clone() for name, owner in state["owners"].items()}
        self.slots, self.is_pruned = dict(state["slots"]), state["is_pruned"]
        self._views.clear()
