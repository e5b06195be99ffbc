"""PPO (Schulman et al. 2017, arXiv:1707.06347), with the hooks that a continual method overrides.

Three rules are easy to break, and are tested: a truncated episode is bootstrapped from its own last observation, a
terminated one is not; steps of environments without an experience are not learned from; evaluations have their own
random numbers, so that evaluating more often does not change learning.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from driftworld.learners.learner import Learner
from driftworld.learners.rollout import Rollout, gae
from driftworld.vector_lifetimes import VectorTransition


@dataclass(frozen=True, slots=True)
class Settings:
    """Hyperparameters of PPO.

    The defaults learn easy tasks in 150,000 decisions of 32 × 32 pixels, each held for 5 time steps.

    Attributes:
        rollout: Steps of each environment between updates, from 1.
        epochs: Passes over a rollout, from 1.
        minibatch: Approximate number of decisions in an optimiser step, from 2.
        learning_rate: Adam's learning rate, above 0.
        annealing: Number of decisions after a task border over which the learning rate falls to a tenth; 0 keeps it
            constant.
        discount: For each decision, 0 to 1.
        trace: λ of generalised advantage estimation, 0 to 1.
        clip: Maximum deviation of a probability ratio from 1, above 0.
        entropy: Weight of the policy's entropy, from 0. With 0.01 the policy becomes deterministic after an easy task
            and learns no other.
        reward_scale: Factor for rewards, above 0, so that a good episode pays 1 to 5: 0.01 if each of its objects pays
            100.
        max_gradient: Maximum gradient norm, above 0; larger gradients are clipped to it.

    Raises:
        ValueError: If a number is out of its range.
    """

    rollout: int = 32
    epochs: int = 2
    minibatch: int = 512
    learning_rate: float = 1e-3
    annealing: int = 0
    discount: float = 0.98
    trace: float = 0.95
    clip: float = 0.2
    entropy: float = 0.03
    reward_scale: float = 0.01
    max_gradient: float = 0.5

    def __post_init__(self) -> None:
        least = {"rollout": 1, "epochs": 1, "minibatch": 2, "annealing": 0, "discount": 0, "trace": 0, "entropy": 0}
        for name, bound in least.items():
            if not getattr(self, name) >= bound:
                raise ValueError(f"{name}: found {getattr(self, name)!r}, expected at least {bound}")
        for name in ("discount", "trace"):
            if getattr(self, name) > 1:
                raise ValueError(f"{name}: found {getattr(self, name)!r}, expected at most 1")
        for name in ("learning_rate", "clip", "reward_scale", "max_gradient"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name}: found {getattr(self, name)!r}, expected more than 0")


class PPO(Learner):
    """PPO with one network and one optimiser for the whole lifetime: a :class:`driftworld.VectorAgent`.

    Observations are colour images, and actions are rows of an action table: run it with ``modalities="rgb"``, the same
    ``size`` and ``actions=[…]``. The same seed gives bit-identical weights on the same machine with
    ``torch.set_num_threads(1)``.

    A subclass is a continual method. It overrides some of :meth:`extra_loss` (added to each step's loss),
    :meth:`mask_gradients` (the weights that may change), :meth:`after_update` (steps on other data), ``begin_task`` and
    ``end_task`` (task borders), and ``method_state`` (saved state, counted as memory).

    Args:
        num_actions: Number of rows in the action table.
        num_envs: Number of environments.
        settings: See :class:`Settings`.
        **options: ``seed``, ``size``, ``policy`` and ``borders``, see :class:`Learner`.

    Raises:
        ValueError: If an option is wrong.
    """

    name = "ppo"

    def __init__(self, num_actions: int, num_envs: int, *, settings: Settings | None = None, **options: Any) -> None:
        super().__init__(num_actions, num_envs, **options)
        self.settings = settings or Settings()
        self.made_with["settings"] = asdict(self.settings)
        self.rollout, self.time = Rollout(self.settings.rollout, num_envs, self.size, num_actions), 0
        self.reset_optimizer()

    def extra_loss(self) -> torch.Tensor | float:
        """A scalar to add to the loss in each optimiser step, computed from the weights; a loss on experience belongs in
        :meth:`after_update`.
        """
        return 0.0

    def mask_gradients(self) -> None:
        """Called before each optimiser step, before gradients are clipped; may change them in place."""

    def after_update(self, rollout: Rollout) -> None:
        """Called after the passes over a rollout; may take more steps with :meth:`step`. ``rollout`` holds the steps that
        were just learned from, in buffers that the next rollout overwrites.
        """

    @torch.no_grad()
    def act(self, observations: Any, infos: dict[str, Any]) -> NDArray[np.int64]:
        """Actions ``(num_envs,)`` for images ``(num_envs, size, size, 3)``, alone or as ``"rgb"`` of a dictionary.

        Raises:
            ValueError: If the images have a different shape.
        """
        began = time.process_time()
        images = self.images(observations)
        log_policy, values = self.look(images)
        if self.frozen and self.policy == "greedy":
            return np.asarray(log_policy.argmax(dim=-1))
        drawn = torch.tensor([chance.random() for chance in self.chances])
        actions = (log_policy.exp().cumsum(dim=-1) < drawn[:, None]).sum(dim=-1).clamp(max=self.num_actions - 1)
        if not self.frozen:
            rollout, t = self.rollout, self.time
            rollout.images[t], rollout.values[t], rollout.log_policy[t] = images, values, log_policy
            rollout.actions[t] = actions
            self.seconds += time.process_time() - began
        return np.asarray(actions)

    @torch.no_grad()
    def learn(self, transition: VectorTransition) -> None:
        """Stores a step, and learns when the rollout is full. An unfinished rollout continues in the task's next
        learning block.
        """
        began = time.process_time()
        rollout, t = self.rollout, self.time
        rollout.rewards[t] = torch.from_numpy(transition.rewards * self.settings.reward_scale)
        rollout.terminated[t] = torch.from_numpy(transition.terminated)
        rollout.ended[t] = torch.from_numpy(transition.terminated | transition.truncated)
        rollout.active[t] = torch.from_numpy(transition.active)
        # The next call of act replaces it, with the next episode's first image if an episode has ended.
        rollout.images[t + 1] = following = self.images(transition.next_observations)
        cut_off = torch.from_numpy(np.flatnonzero(transition.truncated & ~transition.terminated))
        if len(cut_off):
            rollout.last_values[t, cut_off] = self.values_of(following, cut_off)
        self.time += 1
        active = int(transition.active.sum())
        self.decisions, self.task_decisions = self.decisions + active, self.task_decisions + active
        if self.time == self.settings.rollout:
            self.finish_rollout()
        self.seconds += time.process_time() - began

    def look(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-probabilities and values for acting, for one image of each environment."""
        log_policy, values = self.network(images)
        return log_policy, values

    def values_of(self, images: torch.Tensor, envs: torch.Tensor) -> torch.Tensor:
        """Values ``(len(envs),)`` of the observations of some environments, without a step."""
        values: torch.Tensor = self.network(images[envs])[1]
        return values

    def look_again(self, rollout: Rollout, part: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-probabilities and values of a part of a flattened rollout, with gradients."""
        log_policy, values = self.network(rollout.images[:-1].flatten(0, 1)[part])
        return log_policy, values

    @torch.no_grad()
    def finish_rollout(self) -> None:
        """Learns from the steps since the last update; at a border there are fewer than ``settings.rollout``."""
        length, self.time = self.time, 0
        if length == 0:
            return
        rollout = self.rollout.first(length)
        rollout.values[length] = self.values_of(rollout.images[length], torch.arange(self.num_envs))
        with torch.enable_grad():
            self.update(rollout)

    def forget_rollout(self) -> None:
        """Marks all steps as inactive."""
        self.rollout.active.zero_()

    def update(self, rollout: Rollout) -> None:
        """PPO's passes over a rollout, then the method's additional steps."""
        settings = self.settings
        left = 1.0 - self.task_decisions / settings.annealing if settings.annealing else 1.0
        for group in self.optimizer.param_groups:
            group["lr"] = settings.learning_rate * max(0.1, left)
        advantages = gae(rollout, settings.discount, settings.trace)
        for _ in range(settings.epochs):
            for part in self.parts(rollout):
                self.step(self.loss(rollout, advantages, part))
        self.after_update(rollout)

    def parts(self, rollout: Rollout) -> Iterator[torch.Tensor]:
        """Indices of active steps in the flattened rollout, shuffled, in minibatches of about equal size. A single step
        is left out: one advantage has no standard deviation.
        """
        places = rollout.active.flatten().nonzero().squeeze(-1)
        if len(places) > 1:
            shuffled = places[torch.randperm(len(places), generator=self.shuffles)]
            yield from shuffled.tensor_split(max(1, round(len(places) / self.settings.minibatch)))

    def loss(self, rollout: Rollout, advantages: torch.Tensor, part: torch.Tensor) -> torch.Tensor:
        """PPO's loss: the clipped surrogate (eq. 7), half the squared error of values, and entropy."""
        clip, actions = self.settings.clip, rollout.actions.flatten()[part, None]
        target = (advantages + rollout.values[:-1]).flatten()[part]
        advantage = advantages.flatten()[part]
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        before = rollout.log_policy.flatten(0, 1)[part].gather(1, actions).squeeze(1)
        log_policy, values = self.look_again(rollout, part)
        ratio = (log_policy.gather(1, actions).squeeze(1) - before).exp()
        gain = torch.min(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean()
        entropy = -(log_policy.exp() * log_policy).sum(-1).mean()
        return 0.5 * (values - target).square().mean() - gain - self.settings.entropy * entropy

    def step(self, loss: torch.Tensor) -> None:
        """One optimiser step, with the method's loss and mask.

        Raises:
            ValueError: If a loss is not a finite number.
        """
        extra = self.extra_loss()
        for what, value in (("loss", loss), ("extra_loss", extra)):
            found: Any = value
            if isinstance(value, torch.Tensor):
                found = value.item() if value.numel() == 1 else f"shape {tuple(value.shape)}"
            if not isinstance(found, (int, float)) or not math.isfinite(found):
                raise ValueError(f"{self.name}: {what}: found {found} in update {self.updates + 1}, expected a finite number")
        if not isinstance(loss, torch.Tensor):
            raise TypeError(f"{self.name}: loss: found the number {loss}, expected a tensor with gradients")
        self.optimizer.zero_grad()
        (loss + extra).backward()
        self.mask_gradients()
        nn.utils.clip_grad_norm_(self.network.parameters(), self.settings.max_gradient, foreach=True)
        self.optimizer.step()
        self.updates += 1

    def reset_optimizer(self) -> None:
        """Starts Adam without moments, for the current network."""
        rate = self.settings.learning_rate
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=rate, eps=1e-5, foreach=True)

    def state_dict(self) -> dict[str, Any]:
        """The complete state between two experiences: a learner that loads it continues identically, bit for bit."""
        return {
            **super().state_dict(), "optimizer": self.optimizer.state_dict(), "rollout": dict(vars(self.rollout)), "time": self.time
        }  # fmt: skip

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Restores the result of :meth:`state_dict`. The learner must have been made with the same arguments."""
        super().load_state_dict(state)
        self.optimizer.load_state_dict(state["optimizer"])
        vars(self.rollout).update({name: rows.clone() for name, rows in state["rollout"].items()})
        self.time = state["time"]
