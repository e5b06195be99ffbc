"""The contract of every Driftworld environment, and a check of any user's task against it.

``python -m driftworld.check find_objects#red my_task.json my_world.json`` prints a table of passed and failed rules,
with advice; :func:`check` does the same from a program. Nothing is trained or timed.
"""

from __future__ import annotations

import json
import platform
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import driftworld
from driftworld._files import read_text
from driftworld.check.case import Case
from driftworld.check.report import Finding, Report
from driftworld.check.rules import RULES, equal_in_processes

__all__ = ["Finding", "Report", "check", "versions"]


def check(
    task: str,
    *,
    num_envs: int = 3,
    steps: int = 60,
    seed: int = 0,
    processes: bool = True,
    **options: Any,
) -> Report:
    """Checks a task against the contract.

    Args:
        task: A built-in task or a path, with or without ``#variant``; the path of a world; or the id of an environment.
        num_envs: Number of environments in vector environments, from 1.
        steps: Number of random steps in each comparison, from 1; episodes are cut to 9 steps, so that many of them end
            within 60 steps.
        seed: The seed of worlds and actions.
        processes: Whether to compare with ``AsyncVectorEnv`` as well, which starts a process for each environment.
        **options: Options of the environment, such as ``modalities="rgb"``.

    Returns:
        A :class:`Report`; a broken rule is a finding in it, never an exception.

    Raises:
        driftworld.DriftworldError: The task does not exist, or its spec is wrong, so there is nothing to check.
        ValueError: ``num_envs`` or ``steps`` is below 1.
    """
    if num_envs < 1 or steps < 1:
        raise ValueError(f"num_envs, steps: found {num_envs} and {steps}, expected at least 1 of each")
    env_id, more = _environment_of(task)
    case = Case(env_id, {**more, **options}, num_envs, steps, seed)
    # If the environment cannot be made at all, this raises its own error.
    case.single().close()
    rules = [rule for rule in RULES if processes or rule.check is not equal_in_processes]
    findings = tuple(rule.look(case) for rule in rules)
    return Report(task, findings, versions())


def _environment_of(task: str) -> tuple[str, dict[str, Any]]:
    """The Gymnasium id and the options that make the environment of a task, a world, or an id."""
    if task.startswith("driftworld/"):
        return task, {}
    path = Path(task)
    if path.suffix == ".json" and path.is_file():
        try:
            document = json.loads(read_text(path))
        except ValueError:
            document = {}
        # A task spec declares parameters around a template; its own reader reports anything wrong with it.
        if isinstance(document, dict) and not {"template", "parameters", "variants"} & document.keys():
            return "driftworld/World-v0", {"world": task}
    return "driftworld/Task-v0", {"task": task}


def versions() -> dict[str, str]:
    """Versions of everything that a report depends on."""
    return {
        "python": platform.python_version(),
        "driftworld": driftworld.__version__,
        "gymnasium": gymnasium.__version__,
        "numpy": np.__version__,
    }
