"""Worlds for the tests, in the format of L2Explorer's clients."""

from __future__ import annotations

from typing import Any

#: Straight ahead at full speed.
AHEAD = (10.0, 0.0, 0.0)
#: Straight ahead while interacting with the object in front.
GRAB = (10.0, 0.0, 1.0)


def world(*objects: dict[str, Any], agent: dict[str, Any] | None = None, **options: Any) -> dict[str, Any]:
    """A world of 40 × 40 m whose agent stands in the middle and looks along +y."""
    return {
        "game_mode": "learn",
        "max_steps": 0,
        "environment_params": {"predefined_map": 0, "map_size": [40, 40], "light_intensity": 3.0},
        "agent_params": {
            "action_model": "byvelocity",
            "observation_size": 32,
            "max_linear_speed": 10.0,
            "max_angular_speed": 90.0,
            "coordinates": [0, 0],
            "heading": 0,
            **(agent or {}),
        },
        "objects": list(objects),
        **options,
    }


def thing(x: float, y: float, reward: float = 0.0, **options: Any) -> dict[str, Any]:
    """A cube at this position."""
    return {
        "class": "geometric",
        "model": "1",
        "coordinates": [x, y],
        "color": [0.9, 0.2, 0.1],
        "motion_model": "stationary",
        "reward": reward,
        **options,
    }
