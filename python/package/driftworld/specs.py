"""Task specs, their variants, drifts between them, and the validation of documents.

``TaskSpec``, ``Variant`` and ``Drift`` are the native classes; worlds are dictionaries in the JSON format of worlds.
"""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

from driftworld import _native
from driftworld._files import read_bytes, read_text
from driftworld._html import note, table
from driftworld._literals import DocumentKind
from driftworld._native import Drift, TaskSpec, Variant

__all__ = ["Drift", "TaskSpec", "Variant", "built_in_tasks", "task_groups", "validate", "variant", "variants"]


def built_in_tasks() -> list[str]:
    """The names of the six tasks of the paper, whose variants the guides use."""
    return _native.built_in_names()


def task_groups() -> dict[str, list[str]]:
    """The names of all tasks that come with the package, grouped by kind.

    Each has an id, such as ``driftworld/KeyCorridor-v0``.
    """
    return dict(_native.task_groups())


def variant(name: str | os.PathLike[str]) -> Variant:
    """The variant of this name: ``"find_objects#red"``, ``"my.json#night"``; without ``#``, the one with all defaults.

    Raises:
        TaskError: If there is no such task, file or variant.
        SpecError: If the document is wrong.
    """
    return _native.load_variant(os.fspath(name))


def variants(*names: str | Variant | TaskSpec) -> list[tuple[str, Variant]]:
    """The variants that names refer to, each once, with their names.

    Args:
        names: ``task#variant`` for one, ``task#family`` for the members of a family, ``task`` for all variants that a
            task declares; variants and task specs are used directly.

    Returns:
        Pairs of ``task#variant``, with the task named as in the argument, and the variant.

    Raises:
        TaskError: If there is no such task, file or variant.
        SpecError: If a document is wrong.
        ValueError: If two different variants have the same name.
    """
    found: dict[str, Variant] = {}
    for name in names:
        for label, member in _named(name):
            if found.setdefault(label, member) != member:
                raise ValueError(
                    f"variants: found two different variants called {label!r}, expected distinct names; rename one with "
                    "with_values(name, ...) or at_distance(..., name=...), or rename an edited task spec"
                )
    return list(found.items())


def _variant_html(variant: Variant) -> str:
    """The values of a variant as a table: those that differ from the task's defaults first, the others in a line
    below.
    """
    usual = variant.task.variant().values
    parameters = variant.task.parameters
    rows = [
        (name, _value_text(value), _value_text(usual[name]), ", ".join(parameters[name].get("affects", [])))
        for name, value in variant.values.items()
        if value != usual[name]
    ]
    equal = [f"{name} {_value_text(value)}" for name, value in variant.values.items() if value == usual[name]]
    caption = f"{variant.id}: {variant.description}" if variant.description else variant.id
    head = ("parameter", "value", "default", "affects")
    return table(head, rows, caption) + note(f"at their defaults: {', '.join(equal)}" if equal else "")


def _task_html(task: TaskSpec) -> str:
    """The changes of each variant of a task, as a table."""
    usual = task.variant().values
    rows = [
        (
            variant.name,
            ", ".join(f"{name} {_value_text(value)}" for name, value in variant.values.items() if value != usual[name]) or "the defaults",
            variant.description or "",
        )
        for variant in task.variants
    ]
    return table(("variant", "changes", "description"), rows, f"{task.name}: {task.description}")


def _value_text(value: Any) -> str:
    """A value as JSON, strings without quotes."""
    if isinstance(value, float):
        return f"{value:g}"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _named(name: str | Variant | TaskSpec) -> Iterable[tuple[str, Variant]]:
    if isinstance(name, Variant):
        return [(name.id, name)]
    if isinstance(name, TaskSpec):
        return [(member.id, member) for member in name.variants]
    if isinstance(name, (str, os.PathLike)):
        text = os.fspath(name)
        task = text.rpartition("#")[0] or text
        return [(f"{task}#{member.name}", member) for member in _native.load_variants(text)]
    raise TypeError(f"variants: found {name!r}, expected names, variants or task specs")


def validate(
    document: str | os.PathLike[str] | Mapping[str, Any],
    kind: DocumentKind | None = None,
    *,
    check: bool = False,
    assets: str | os.PathLike[str] | Iterable[str | os.PathLike[str]] = (),
) -> list[dict[str, Any]]:
    """Lists every problem of a document, ordered by position; empty if it is valid.

    Args:
        document: A path, the name of a built-in task, JSON text, or a dictionary.
        kind: ``"task"``, ``"world"``, ``"scenario"``, ``"maps"``, ``"l2explorer-world"`` or ``"l2explorer-scenario"``;
            by default detected from the document's keys, like ``driftworld validate``.
        check: Raise an error instead of returning the problems.
        assets: Paths of asset libraries, with classes that objects may have besides the built-in ones.

    Suspicious but valid parts cause warnings.

    Returns:
        Dictionaries with ``code``, ``pointer``, ``line``, ``column`` (from 1; for a dictionary, as if written without
        line breaks), ``found``, ``expected``, ``advice`` and ``message``. Text that is not JSON has no ``found`` and
        ``expected``.

    Raises:
        SpecError: With ``check``, if something is wrong: with all problems, and pointer, line and column of the first.
        CurriculumError: With ``check``, for a scenario with two variants that a log could not tell apart.
        FileNotFoundError: If there is no such file.
        ValueError: If there is no such kind.
    """
    name, text = document_text(document)
    paths = [assets] if isinstance(assets, (str, os.PathLike)) else list(assets)
    libraries = [read_bytes(path, "library") for path in paths]
    _, problems, notes, error = _native.check(name, text, kind, libraries)
    for note_text in notes:
        warnings.warn(note_text, stacklevel=2)
    if check and error is not None:
        raise error
    return problems


def document_text(document: str | os.PathLike[str] | Mapping[str, Any]) -> tuple[str, str]:
    """A document's name for messages, and its text.

    Raises:
        FileNotFoundError: If there is no such file.
    """
    if isinstance(document, Mapping):
        return "document", json.dumps(document)
    if isinstance(document, str) and document.lstrip().startswith("{"):
        return "document", document
    if not isinstance(document, (str, os.PathLike)):
        found = type(document).__name__
        raise TypeError(f"document: found {found}, expected a path, JSON text or a dictionary")
    name = os.fspath(document)
    known = [task for tasks in task_groups().values() for task in tasks]
    if name in known:
        return f"{name}.json", TaskSpec.load(name).to_json()
    try:
        return name, read_text(name)
    except FileNotFoundError as error:
        expected = f"the path of a document, JSON text, a dictionary, or one of {', '.join(known)}"
        raise FileNotFoundError(f"document: found no file {name!r}, expected {expected}") from error


def _drift_again(from_: Variant, to: Variant, schedule: str | None, switch: Any, seed: int) -> Drift:
    """Unpickles a drift."""
    return Drift(from_, to, schedule=None if schedule is None else json.loads(schedule), switch=switch, seed=seed)
