"""EWC: a quadratic penalty ("spring") on the change of every weight, in proportion to its importance for the policy.

EWC (Kirkpatrick et al. 2017, arXiv:1612.00796, eq. 3) has a set of springs for each finished task k:

    loss = loss of PPO + strength / 2 · Σₖ Σᵢ Fₖᵢ (θᵢ − θₖᵢ*)²,
    Fₖᵢ = mean over the task's observations s of Σₐ π(a|s) (∂ log π(a|s) / ∂θᵢ)².

Online EWC (Schwarz et al. 2018, arXiv:1805.06370) has one set: F ← decay · F + Fₖ, and θ* are the last task's weights.

Known traps:

- Each sample's gradient is squared. The square of a batch's mean gradient is something else, and almost 0 after
  learning.
- Actions are weighted by the policy, not sampled: otherwise it is the empirical Fisher.
- Fisher information falls as a policy becomes certain, so that the best learned tasks would be protected least.
  Importances are therefore scaled to mean 1 in each task, over the tensors that the policy depends on; ``strength``
  then means the same for every task.
- The policy does not depend on the value head, which is therefore unconstrained.
- A task that occurs again gets a second set of springs, with different targets.
"""

from __future__ import annotations

from typing import Any

import torch
from torch import nn
from torch.func import functional_call, grad, vmap

from driftworld.learners.ppo import PPO

Weights = dict[str, torch.Tensor]


def fisher(network: nn.Module, images: torch.Tensor, chunk: int = 32) -> Weights:
    """The diagonal of the policy's Fisher information, for each parameter of a network: squares per sample, actions
    weighted by the policy.

    Args:
        network: Maps images ``(n, …)`` to log-probabilities ``(n, num_actions)`` and anything else.
        images: Observed images, ``(n, …)``, at least 1.
        chunk: Number of images at a time; each needs memory for the gradients of all weights.
    """
    weights = {name: weight.detach() for name, weight in network.named_parameters()}

    def log_probability(weights: Weights, image: torch.Tensor, action: torch.Tensor) -> torch.Tensor:
        log_policy = functional_call(network, weights, (image.unsqueeze(0),))[0]
        return log_policy.squeeze(0).gather(0, action.unsqueeze(0)).squeeze(0)

    gradients = vmap(grad(log_probability), in_dims=(None, 0, 0))
    total = {name: torch.zeros_like(weight) for name, weight in weights.items()}
    for some in images.split(chunk):
        with torch.no_grad():
            policy = network(some)[0].exp()
        for action in range(policy.shape[1]):
            found = gradients(weights, some, torch.full((len(some),), action))
            for name, gradient in found.items():
                total[name] += torch.einsum("n...,n->...", gradient.square(), policy[:, action])
    return {name: squares / len(images) for name, squares in total.items()}


def normalized(importance: Weights) -> Weights:
    """Importances scaled to mean 1 over the tensors in which any is above 0."""
    used = [values for values in importance.values() if values.any()]
    mean = sum(values.sum() for values in used) / max(1, sum(values.numel() for values in used))
    return {name: values / mean if used else values for name, values in importance.items()}


class EWC(PPO):
    """PPO with springs to the weights at the end of each task.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        strength: λ of the springs, from 0; tune it on sequences that are not scored.
        samples: Number of observations from the last rollout used to compute importances, from 1.
        **options: As for :class:`PPO`; ``borders`` is ``"labels"`` by default.

    Attributes:
        springs: A pair of importances and weights for each finished task; a single pair for :class:`OnlineEWC`.
    """

    name = "ewc"
    own_borders = "labels"

    def __init__(
        self, num_actions: int, num_envs: int, *, strength: float = 0.1, samples: int = 256, **options: Any
    ) -> None:
        super().__init__(num_actions, num_envs, **options)
        self.strength, self.samples = strength, samples
        self.springs: list[tuple[Weights, Weights]] = []

    def end_task(self, label: str | None) -> None:
        """Adds the springs of the ending task, computed from its last observations."""
        seen = self.rollout.images[:-1][self.rollout.active]
        chosen = torch.randperm(len(seen), generator=self.shuffles)[: self.samples]
        if len(chosen):
            anchor = {name: weight.detach().clone() for name, weight in self.network.named_parameters()}
            self.add_springs(normalized(fisher(self.network, seen[chosen])), anchor)

    def add_springs(self, importance: Weights, anchor: Weights) -> None:
        """Adds the springs of a task to the others."""
        self.springs.append((importance, anchor))

    def extra_loss(self) -> torch.Tensor | float:
        """The energy of all springs; 0 in the first task."""
        if not self.springs:
            return 0.0
        weights = dict(self.network.named_parameters())
        energy = sum(
            (importance[name] * (weight - anchor[name]).square()).sum()
            for importance, anchor in self.springs
            for name, weight in weights.items()
        )
        return 0.5 * self.strength * energy

    def method_state(self) -> dict[str, Any]:
        """The springs."""
        return {"springs": self.springs}

    def load_method_state(self, state: dict[str, Any]) -> None:
        """Restores the springs."""
        self.springs = [(importance, anchor) for importance, anchor in state["springs"]]


class OnlineEWC(EWC):
    """EWC with one set of springs: importances accumulated over all tasks, and the last task's weights as targets.

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        decay: γ, the factor applied to old importances at each border, 0 to 1.
        **options: As for :class:`EWC`.
    """

    name = "online_ewc"

    def __init__(self, num_actions: int, num_envs: int, *, decay: float = 1.0, **options: Any) -> None:
        super().__init__(num_actions, num_envs, **options)
        self.decay = decay

    def add_springs(self, importance: Weights, anchor: Weights) -> None:
        """Adds the importances to the decayed old ones."""
        for old, _ in self.springs:
            importance = {name: self.decay * old[name] + values for name, values in importance.items()}
        self.springs = [(importance, anchor)]
