"""Exports networks as files for the command's ``--agent net:FILE``, in the safetensors format."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import torch

from driftworld._files import write_whole
from driftworld.learners.networks import PatchNetwork


def write_network(
    learner: Any, path: str | PathLike[str], actions: Sequence[Sequence[float]], frame_skip: int | None, interact: bool
) -> None:  # fmt: skip
    """Writes a learner's network and how it acts. For arguments and errors, see ``Learner.export``."""
    # The policy is in ``look``: an override of PPO's may do more than this network.
    if type(learner).look.__module__ != "driftworld.learners.ppo" or type(learner.network) is not PatchNetwork:
        raise ValueError(f"{learner.name}: found a learner with a memory, masks or a network of its own, expected a PatchNetwork alone")
    table = [[float(number) for number in row] for row in actions]
    if len(table) != learner.num_actions or any(len(row) != 3 for row in table):
        raise ValueError(f"actions: found {actions!r}, expected a table of {learner.num_actions} rows of three numbers")
    table = table if interact else [[speed, turn, 0.0] for speed, turn, _ in table]
    metadata = {"format": "pt", "architecture": "patch", "size": learner.size, "actions": json.dumps(table), "policy": learner.policy}
    metadata |= {"learner": learner.name, "decisions": learner.decisions} | ({"frame_skip": frame_skip} if frame_skip else {})
    content = safetensors(learner.network.state_dict(), {name: str(value) for name, value in metadata.items()})
    write_whole(Path(path), content)


def safetensors(tensors: Mapping[str, torch.Tensor], metadata: Mapping[str, str]) -> bytes:
    """Encodes float32 tensors in the safetensors format: eight bytes with the length of a JSON header, the header, and
    the numbers.
    """
    header: dict[str, object] = {"__metadata__": dict(metadata)}
    parts, end = [], 0
    for name, tensor in tensors.items():
        parts.append(tensor.detach().contiguous().numpy().astype("<f4").tobytes())
        begin, end = end, end + len(parts[-1])
        header[name] = {"dtype": "F32", "shape": list(tensor.shape), "data_offsets": [begin, end]}
    text = json.dumps(header).encode()
    # Numbers start at a multiple of eight bytes.
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + b"".join(parts)
