"""The ids under which Gymnasium knows the environments. What they do is in ``single.py`` and ``vector.py``."""

from __future__ import annotations

from typing import Any

import gymnasium

#: Each id and the options that it stands for.
ENV_IDS: dict[str, dict[str, Any]] = {
    "driftworld/FindObjects-v0": {"task": "find_objects"},
    "driftworld/GetToGoal-v0": {"task": "get_to_goal"},
    "driftworld/SelectObject-v0": {"task": "select_object"},
    "driftworld/MovingObject-v0": {"task": "moving_object"},
    "driftworld/ScavengerHunt-v0": {"task": "scavenger_hunt"},
    "driftworld/BlueRedGreen-v0": {"task": "blue_red_green"},
    "driftworld/Task-v0": {},
    "driftworld/World-v0": {},
}


def register_envs() -> None:
    """Registers every id that is not registered yet; ``import driftworld`` does it."""
    for env_id, options in ENV_IDS.items():
        if env_id not in gymnasium.registry:
            # Entry points are strings, so that specs can be written down.
            gymnasium.register(
                id=env_id,
                entry_point="driftworld.envs:DriftworldEnv",
                vector_entry_point="driftworld.envs:DriftworldVectorEnv",
                kwargs=options,
            )
