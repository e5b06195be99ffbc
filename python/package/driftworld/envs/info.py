"""The keys of ``info``: what a reset says of a world, and what a step says of an episode."""

from __future__ import annotations

from typing import Any

#: Where a world comes from, in the native batch's order. An agent without a label is not told the first two.
ORIGIN = ("task_id", "variant_id", "seed", "index", "world_hash")

#: What every step says: what the agent met, whether the task is done, what ended the episode, and the label where infos have it.
OF_STEP = ("events", "is_success", "ended_by", "task_label")


def of_step(events: Any = (), success: bool = False, ended_by: str | None = None) -> dict[str, Any]:
    """The info of one environment's step; by default that of a step in which nothing happened, as a reset has it."""
    return {"events": events, "is_success": success, "ended_by": ended_by}
