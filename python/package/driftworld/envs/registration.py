"""Registers the environments' ids with Gymnasium."""

from __future__ import annotations

from typing import Any

import gymnasium

from driftworld import _native
from driftworld.miniworld import names


def _camel(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


#: The options of each id: one id for each task that comes with the package, and two ids for any task and any world.
ENV_IDS: dict[str, dict[str, Any]] = {
    **{f"driftworld/{_camel(task)}-v0": {"task": task} for _, tasks in _native.task_groups() for task in tasks},
    "driftworld/Task-v0": {},
    "driftworld/World-v0": {},
}


#: MiniWorld's ids, and the names of their environments.
MINIWORLD_IDS: dict[str, dict[str, Any]] = {f"driftworld/MiniWorld-{name}-v0": {"name": name} for name in names()}


def register_envs() -> None:
    """Registers every id that is not registered yet; called by ``import driftworld``."""
    # Entry points are strings, so that specs can be serialised.
    for env_id, options in ENV_IDS.items():
        if env_id not in gymnasium.registry:
            gymnasium.register(
                id=env_id,
                entry_point="driftworld.envs:DriftworldEnv",
                vector_entry_point="driftworld.envs:DriftworldVectorEnv",
                kwargs=options,
            )
    for env_id, options in MINIWORLD_IDS.items():
        if env_id not in gymnasium.registry:
            gymnasium.register(id=env_id, entry_point="driftworld.miniworld:MiniWorldEnv", kwargs=options)
