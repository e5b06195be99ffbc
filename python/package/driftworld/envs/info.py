"""The keys of ``info``: what a reset reports about a world, and a step about an episode."""

from __future__ import annotations

from typing import Any

#: The origin of a world, in the native batch's order. An agent without a label does not get the first two.
ORIGIN = ("task_id", "variant_id", "seed", "index", "world_hash")

#: In the info of every step: what the agent met, whether the task is done, what ended the episode, and the label if
#: infos have it.
OF_STEP = ("events", "is_success", "ended_by", "task_label")


def of_step(events: Any = (), success: bool = False, ended_by: str | None = None) -> dict[str, Any]:
    """The info of one environment's step; by default that of an uneventful step, as after a reset."""
    return {"events": events, "is_success": success, "ended_by": ended_by}
