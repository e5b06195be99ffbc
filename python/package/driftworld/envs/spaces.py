"""Observation and action spaces from the layout of an environment."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from driftworld.envs.options import Options

#: Depth of the sky in metres, the largest depth.
FAR_DEPTH = 1000.0
#: Velocities are unbounded, but a space needs a bound.
_LARGE = 1e6
#: Bound of rewards, which are unbounded, too; each part of a reward is at most 1e9.
_REWARD = 1e12
#: Minimum and maximum of each number of a state feature.
_FEATURES: dict[str, list[tuple[float, float]]] = {
    "position": [(-300.0, 300.0)] * 2,
    "heading": [(0.0, 360.0)],
    "velocity": [(-_LARGE, _LARGE)] * 2,
    "direction": [(-1.0, 1.0)] * 2,
    "own_velocity": [(-_LARGE, _LARGE)] * 2,
    "goal": [(-1000.0, 1000.0)] * 2 + [(0.0, 1.0)],
    "nearest_target": [(-1000.0, 1000.0)] * 2 + [(0.0, 1.0)],
    "counts": [(0.0, _LARGE)] * 2,
    "last_reward": [(-_REWARD, _REWARD)],
    "last_event": [(0.0, 3.0), (-_REWARD, _REWARD), (0.0, 1.0)],
    "steps_left": [(0.0, 1.0)],
    "carrying": [(0.0, 100.0), (0.0, 65535.0), (0.0, 100_000.0)],
    "energy": [(0.0, 1e9)],
    "zone": [(0.0, 1000.0), (-_REWARD, _REWARD)],
}

#: Bounds of each number of an instruction.
_INSTRUCTION = (-1e6, 1e6)


def observation_space(options: Options, layout: dict[str, Any], num_labels: int) -> spaces.Space[Any]:
    """The space of one observation: a ``Dict``, or the ``Box`` of its one modality."""
    kinds = options.modalities or ()
    boxes: dict[str, spaces.Space[Any]] = {kind: _box(kind, options, layout) for kind in kinds}
    if not options.is_dict:
        return boxes[kinds[0]]
    if options.task_label == "observation":
        boxes["task"] = spaces.Box(0.0, 1.0, (num_labels,), np.float32)
    return spaces.Dict(boxes)


def _box(kind: str, options: Options, layout: dict[str, Any]) -> spaces.Box:
    shape = (layout["height"], layout["width"], 3 if kind == "rgb" else 1)
    if kind == "state":
        pairs = [pair for name in layout["state_features"] for pair in _FEATURES[name]]
        bounds = np.array(pairs + layout["instruction_len"] * [_INSTRUCTION], dtype=np.float32)
        bounds = bounds.reshape(-1, 2)
        return spaces.Box(bounds[:, 0], bounds[:, 1], dtype=np.float32)
    if kind == "depth" and options.depth == "float32":
        return spaces.Box(0.0, FAR_DEPTH, shape, np.float32)
    dtype = {"depth": options.depth, "class": "uint16", "instance": "uint32"}.get(kind, "uint8")
    return spaces.Box(0, np.iinfo(dtype).max, shape, np.dtype(dtype).type)


def action_space(layout: dict[str, Any]) -> spaces.Space[Any]:
    """The space of one action: a ``Discrete`` of table rows, or a ``Box`` of numbers."""
    action = layout["action"]
    if "n" in action:
        return spaces.Discrete(action["n"])
    bounds = np.array(action["bounds"], dtype=np.float32)
    return spaces.Box(bounds[:, 0], bounds[:, 1], dtype=np.float32)


def label(names: list[str], variant_id: str) -> NDArray[np.float32]:
    """A variant as a one-hot vector among the names; all 0 if it is not one of them."""
    return np.array([float(name == variant_id) for name in names], dtype=np.float32)
