"""The command ``python -m driftworld.check``: prints a table, or JSON, for each task.

Exit status: 0 if everything passed, 1 if something failed, 2 for invalid arguments.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from typing import Any

import driftworld
from driftworld._plain import json_or_word
from driftworld.check import Finding, Report, check, versions


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m driftworld.check", description="Checks tasks against the contract of every Driftworld environment."
    )
    parser.add_argument(
        "tasks", nargs="+", metavar="TASK", help="a task or its path, with or without #variant; a world; an id"
    )
    parser.add_argument(
        "--num-envs", type=int, default=3, help="number of environments in vector environments (default: %(default)s)"
    )
    parser.add_argument("--steps", type=int, default=60, help="number of steps in each comparison (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="seed of worlds and actions (default: %(default)s)")
    parser.add_argument(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        type=_option,
        help="an option of the environment, with a value in JSON or a word; repeatable",
    )
    parser.add_argument("--no-processes", action="store_true", help="skip the comparison with AsyncVectorEnv")
    parser.add_argument("--json", action="store_true", help="print the reports as JSON")
    asked = parser.parse_args(arguments)
    if asked.num_envs < 1 or asked.steps < 1:
        parser.error("--num-envs and --steps: expected at least 1")
    reports: list[Report] = []
    for task in asked.tasks:
        reports.append(_checked(task, asked))
        if not asked.json:
            print(reports[-1], end="\n\n", flush=True)
    if asked.json:
        print(json.dumps([report.to_dict() for report in reports], indent=2))
    return 0 if all(report.ok for report in reports) else 1


def _option(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise argparse.ArgumentTypeError(f'found {text!r}, expected NAME=VALUE, such as size=64 or actions="discrete"')
    return name, json_or_word(value)


def _checked(task: str, asked: argparse.Namespace) -> Report:
    """The report on a task, even if the task cannot be made and there is nothing to check."""
    try:
        return check(
            task,
            num_envs=asked.num_envs,
            steps=asked.steps,
            seed=asked.seed,
            processes=not asked.no_processes,
            **dict(asked.option),
        )
    except Exception as error:  # noqa: BLE001 - Gymnasium and NumPy raise exceptions of their own classes
        kind = "" if isinstance(error, driftworld.DriftworldError) else f"{type(error).__name__}: "
        advice = "see python -m driftworld.check --help for what can be checked"
        return Report(task, (Finding("can be made", "failed", f"{kind}{error}", advice),), versions())


if __name__ == "__main__":
    sys.exit(main())
