"""The experience since a learner's last update, and generalised advantage estimation."""

from __future__ import annotations

import torch


class Rollout:
    """``length`` steps of ``num_envs`` environments.

    Tensors are ``(length, num_envs, …)``, with one more step for images and values.

    Attributes:
        images: Bytes ``(length + 1, num_envs, size, size, 3)``.
        values: Value of each image, ``(length + 1, num_envs)``.
        last_values: Value of an episode's last image if a step limit ended the episode, ``(length, num_envs)``.
        log_policy: Log-probabilities of all actions, ``(length, num_envs, num_actions)``.
        actions: Action indices, ``(length, num_envs)``.
        rewards: Scaled rewards, ``(length, num_envs)``.
        terminated: Whether the episode terminated, ``(length, num_envs)``.
        ended: Whether it terminated or was truncated by a step limit.
        active: Whether an experience was running; other steps are not learned from.
    """

    def __init__(self, length: int, num_envs: int, size: int, num_actions: int) -> None:
        self.images = torch.zeros((length + 1, num_envs, size, size, 3), dtype=torch.uint8)
        self.values = torch.zeros((length + 1, num_envs))
        self.last_values = torch.zeros((length, num_envs))
        self.log_policy = torch.zeros((length, num_envs, num_actions))
        self.actions = torch.zeros((length, num_envs), dtype=torch.long)
        self.rewards = torch.zeros((length, num_envs))
        self.terminated = torch.zeros((length, num_envs), dtype=torch.bool)
        self.ended = torch.zeros((length, num_envs), dtype=torch.bool)
        self.active = torch.zeros((length, num_envs), dtype=torch.bool)

    def first(self, length: int) -> Rollout:
        """A view of its first steps."""
        view = object.__new__(type(self))
        longer = ("images", "values")
        vars(view).update({name: rows[: length + (name in longer)] for name, rows in vars(self).items()})
        return view

    def following(self, values: torch.Tensor) -> torch.Tensor:
        """The value after each step, ``(length, num_envs)``, from values ``(length + 1, num_envs)`` of the images.

        It is 0 after a termination, and ``last_values`` after a truncation: never the value of the next episode's first
        image.
        """
        return torch.where(self.ended, self.last_values, values[1:]) * ~self.terminated


def gae(rollout: Rollout, discount: float, trace: float) -> torch.Tensor:
    """Generalised advantage estimates ``(length, num_envs)``: Σ (discount · trace)ᵏ δ, up to the end of the episode or
    of the rollout.

    δ = reward + discount · V(next) − V. Source: Schulman et al. 2016 (arXiv:1506.02438), eq. 16.

    Args:
        rollout: The rollout, with ``values`` of all images.
        discount: For each decision, 0 to 1.
        trace: λ, 0 (one step) to 1 (all steps).
    """
    surprise = rollout.rewards + discount * rollout.following(rollout.values) - rollout.values[:-1]
    carried = discount * trace * ~rollout.ended
    advantages, later = torch.zeros_like(surprise), torch.zeros_like(surprise[0])
    for step in reversed(range(len(surprise))):
        later = surprise[step] + carried[step] * later
        advantages[step] = later
    return advantages
