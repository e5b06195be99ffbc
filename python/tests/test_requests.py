"""Signatures and docstrings of operations have all fields of their requests, with the same defaults."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

import driftworld
import pytest
from driftworld import _native

#: Options of scoring that a report takes from a file of settings.
SETTINGS = set(inspect.signature(driftworld.metrics).parameters) - set(inspect.signature(driftworld.report).parameters)
#: For each request, its function, and the fields that the function does not offer, with the reason.
OFFERED: dict[str, tuple[Callable[..., Any], dict[str, str]]] = {
    "elements": (driftworld.elements, {}),
    "design": (
        driftworld.Curriculum.design,
        {
            "lifetimes": "Curriculum.lifetimes has it",
            "experts": "Curriculum.experts has it",
            "lifetime": "Curriculum.experts has it",
            "fixed_evaluation": "Curriculum.experts and Curriculum.lifetimes have it",
            "complexity": "only the command offers it",
            "difficulty": "only the command offers it",
        },
    ),
    "metrics": (driftworld.metrics, {}),
    "report": (
        driftworld.report,
        {
            "tasks": "only the command offers it",
            "no_show_eval_lines": "only the command offers it",
            **dict.fromkeys(SETTINGS, "load_settings has it"),
        },
    ),
}
#: Arguments that are not fields, because the function itself uses them.
NOT_FIELDS = {"design": {"plot"}, "report": {"path"}}


def differences(fields: list[tuple[str, str | None]], function: Callable[..., Any], allowed: set[str]) -> list[str]:
    """The differences between a request's fields and a function, in names, defaults, and defaults in the docstring."""
    found = []
    parameters, docstring = inspect.signature(function).parameters, inspect.getdoc(function) or ""
    for name in {name for name, _ in fields} ^ set(parameters) ^ allowed:
        found.append(f"{name}: found in {'the signature' if name in parameters else 'the request'} alone")
    for name, default in fields:
        if name not in parameters:
            continue
        entry = re.search(rf"^    (?:\w+, )*{name}(?:, \w+)*: (.*(?:\n {{8}}.*)*)", docstring, re.MULTILINE)
        if entry is None:
            found.append(f"{name}: found no entry in the docstring")
        elif default not in (None, "0", "none", "false"):
            value = parameters[name].default
            number = f"{int(default):,}" if default.isdigit() else default
            if value is None and not re.search(rf"{re.escape(number)}\b.*default|default\W+{re.escape(number)}", entry[1]):
                found.append(f"{name}: found no default {number} in the docstring")
            elif value is not None and str(value) != default:
                found.append(f"{name}: found the default {value}, expected {default}")
    return sorted(found)


@pytest.mark.parametrize("operation", OFFERED)
def test_signature_has_the_requests_fields(operation: str) -> None:
    function, withheld = OFFERED[operation]
    assert differences(_native.requests()[operation], function, set(withheld) | NOT_FIELDS.get(operation, set())) == []


def test_every_request_is_compared() -> None:
    assert set(OFFERED) == set(_native.requests())


def test_added_field_is_missed_in_signature_and_docstring() -> None:
    fields = [*_native.requests()["elements"], ("added", "3")]
    assert differences(fields, driftworld.elements, set()) == ["added: found in the request alone"]

    def forgetful(known: int = 2, added: int | None = None) -> None:
        """Does something.

        Args:
            known: A number.
        """

    found = ["added: found no entry in the docstring", "known: found the default 2, expected 3"]
    assert differences([("known", "3"), ("added", None)], forgetful, set()) == found
