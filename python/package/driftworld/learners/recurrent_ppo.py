"""Recurrent PPO: PPO with a GRU, trained on whole sequences of single environments.

The memory is reset at the start of an episode. A rollout stores its initial memory; each pass runs through the
sequences from there, so that gradients reach back to the start of the rollout (truncated backpropagation through time).
Source: stored states as in R2D2 (Kapturowski et al. 2019, section 3), without its burn-in; PPO as in ``ppo.py``.

Known traps:

- The initial memory of a rollout was computed with older weights, so it is stale after several passes. Few epochs limit
  this.
- A cue seen before the rollout is remembered, but remembering it gets no gradient: ``settings.rollout`` should not be
  shorter than the gap to bridge.
- The other methods use single images, and cannot be combined with it unchanged.
- The last observation of a truncated episode is evaluated with that episode's memory, not with an empty one.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import torch
from torch import nn

from driftworld.learners.networks import RecurrentNetwork
from driftworld.learners.ppo import PPO
from driftworld.learners.rollout import Rollout


class RecurrentPPO(PPO):
    """PPO with :class:`driftworld.learners.networks.RecurrentNetwork`. Arguments as for :class:`PPO`.

    Attributes:
        memory: The memory in each environment, ``(num_envs, hidden)``.
    """

    name = "recurrent_ppo"

    def __init__(self, num_actions: int, num_envs: int, **options: Any) -> None:
        super().__init__(num_actions, num_envs, **options)
        length = self.settings.rollout
        self.memory = torch.zeros(num_envs, self.network.hidden)
        self._starts = torch.ones(num_envs, dtype=torch.bool)
        # Stored with the rest of the rollout, so that they are saved with it.
        vars(self.rollout).update(
            starts=torch.zeros((length, num_envs), dtype=torch.bool), memories=torch.zeros(length, num_envs, self.network.hidden)
        )  # fmt: skip

    def make_network(self) -> nn.Module:
        """A network with a GRU."""
        return RecurrentNetwork(self.num_actions, self.size)

    def begin(self, env: int, label: str | None, seed: int) -> None:
        """Called before an experience: resets the memory of its environment."""
        super().begin(env, label, seed)
        self._starts[env] = True

    def look(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-probabilities and values for acting; advances the memory by a step."""
        if not self.frozen:
            self._extra("starts")[self.time], self._extra("memories")[self.time] = self._starts, self.memory
        log_policy, values, self.memory = self.network(images.unsqueeze(0), self.memory, self._starts.unsqueeze(0))
        self._starts = torch.zeros_like(self._starts)
        return log_policy.squeeze(0), values.squeeze(0)

    def values_of(self, images: torch.Tensor, envs: torch.Tensor) -> torch.Tensor:
        """Values of the observations of some environments, given their memory, which stays unchanged."""
        starts = torch.zeros((1, len(envs)), dtype=torch.bool)
        values: torch.Tensor = self.network(images[envs].unsqueeze(0), self.memory[envs], starts)[1]
        return values.squeeze(0)

    def parts(self, rollout: Rollout) -> Iterator[torch.Tensor]:
        """Indices of active steps in the flattened rollout, in parts of whole environments."""
        envs = rollout.active.any(dim=0).nonzero().squeeze(-1)
        if int(rollout.active.sum()) < 2:
            return
        shuffled = envs[torch.randperm(len(envs), generator=self.shuffles)]
        parts = max(1, round(int(rollout.active.sum()) / self.settings.minibatch))
        for some in shuffled.tensor_split(min(parts, len(envs))):
            chosen = torch.zeros(self.num_envs, dtype=torch.bool)
            chosen[some] = True
            places = (rollout.active & chosen).flatten().nonzero().squeeze(-1)
            if len(places) > 1:
                yield places

    def look_again(self, rollout: Rollout, part: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Runs through the sequences of a part again, with gradients."""
        envs, columns = (part % self.num_envs).unique(return_inverse=True)
        starts, memories = (vars(rollout)[name] for name in ("starts", "memories"))
        log_policy, values, _ = self.network(rollout.images[:-1, envs], memories[0, envs], starts[:, envs])
        steps = part // self.num_envs
        return log_policy[steps, columns], values[steps, columns]

    def _extra(self, name: str) -> torch.Tensor:
        rows: torch.Tensor = vars(self.rollout)[name]
        return rows
