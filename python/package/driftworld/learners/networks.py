"""Networks of the learners: policy and value for small images, without memory and with a GRU."""

from __future__ import annotations

import torch
from torch import nn

#: Side of a patch in pixels; the second layer joins 2 × 2 patches.
PATCH = 4


class Patches(nn.Module):
    """Features of images: patches of 4 × 4 pixels, then 2 × 2 patches, then a hidden layer.

    Both patch layers are matrix products. On one thread they take a third of the time of equally wide convolutions.

    Args:
        size: Side of the images in pixels, a multiple of 8.
        width: Number of features of a patch; the second layer has twice as many.
        hidden: Number of features of the image.
    """

    def __init__(self, size: int, width: int, hidden: int) -> None:
        super().__init__()
        if size < 2 * PATCH or size % (2 * PATCH):
            raise ValueError(f"size: found {size}, expected a multiple of {2 * PATCH}, such as 32")
        self.side, self.width = size // PATCH, width
        self.small = nn.Linear(3 * PATCH * PATCH, width)
        self.large = nn.Linear(4 * width, 2 * width)
        self.image = nn.Linear((self.side // 2) ** 2 * 2 * width, hidden)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        """Features ``(n, hidden)`` of images ``(n, size, size, 3)``, bytes."""
        count, side = images.shape[0], self.side
        cut = images.reshape(count, side, PATCH, side, PATCH * 3).transpose(2, 3)
        patches = cut.reshape(count * side * side, PATCH * PATCH * 3).float().mul_(1 / 255)
        small = torch.relu(self.small(patches)).reshape(count, side // 2, 2, side // 2, 2 * self.width)
        joined = small.transpose(2, 3).reshape(count * (side // 2) ** 2, 4 * self.width)
        return torch.relu(self.image(torch.relu(self.large(joined)).reshape(count, -1)))


def initialize(network: nn.Module) -> None:
    """Sets orthogonal weights and zero biases. The gain is √2, except 1 for ``value`` and 0.01 for ``policy``, which
    then starts almost uniform.
    """
    gains = {"policy": 0.01, "value": 1.0}
    for name, module in network.named_modules():
        if isinstance(module, (nn.Linear, nn.GRUCell)):
            for kind, parameter in module.named_parameters():
                if kind.startswith("weight"):
                    nn.init.orthogonal_(parameter, gains.get(name, 2**0.5))
                else:
                    nn.init.zeros_(parameter)


class PatchNetwork(nn.Module):
    """Policy and value for an image: 142,000 weights and 361,000 multiplications at 32 × 32 pixels.

    Args:
        num_actions: Number of actions.
        size: Side of the images in pixels, a multiple of 8.
        width: Number of features of a patch of 4 × 4 pixels.
        hidden: Number of units in the last hidden layer.

    Raises:
        ValueError: If ``size`` is not a multiple of 8.
    """

    def __init__(self, num_actions: int, size: int = 32, width: int = 32, hidden: int = 128) -> None:
        super().__init__()
        self.trunk = Patches(size, width, hidden)
        self.policy, self.value = nn.Linear(hidden, num_actions), nn.Linear(hidden, 1)
        initialize(self)

    def forward(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Log-probabilities ``(n, num_actions)`` and values ``(n,)`` of images ``(n, size, size, 3)``, bytes."""
        features = self.trunk(images)
        return torch.log_softmax(self.policy(features), dim=-1), self.value(features).squeeze(-1)


class RecurrentNetwork(nn.Module):
    """Policy and value for a sequence of images: :class:`PatchNetwork` with a GRU before its heads.

    Args:
        num_actions: Number of actions.
        size: Side of the images in pixels, a multiple of 8.
        width: Number of features of a patch of 4 × 4 pixels.
        hidden: Number of units in the hidden layer, and in the GRU.

    Raises:
        ValueError: If ``size`` is not a multiple of 8.
    """

    def __init__(self, num_actions: int, size: int = 32, width: int = 32, hidden: int = 128) -> None:
        super().__init__()
        self.hidden = hidden
        self.trunk, self.memory = Patches(size, width, hidden), nn.GRUCell(hidden, hidden)
        self.policy, self.value = nn.Linear(hidden, num_actions), nn.Linear(hidden, 1)
        initialize(self)

    def forward(
        self, images: torch.Tensor, state: torch.Tensor, starts: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Runs through ``length`` steps of ``n`` environments.

        Args:
            images: ``(length, n, size, size, 3)``, bytes.
            state: The memory before the first step, ``(n, hidden)``.
            starts: Whether an episode starts at a step, bool ``(length, n)``: the memory is reset before it.

        Returns:
            Log-probabilities ``(length, n, num_actions)``, values ``(length, n)``, and the memory after the last step.
        """
        length, count = starts.shape
        features = self.trunk(images.flatten(0, 1)).reshape(length, count, -1)
        states = []
        for step in range(length):
            state = self.memory(features[step], state * ~starts[step].unsqueeze(-1))
            states.append(state)
        # The heads also get the image features directly: what needs no memory is learned as fast as without a GRU.
        seen = torch.stack(states) + features
        return torch.log_softmax(self.policy(seen), dim=-1), self.value(seen).squeeze(-1), state
