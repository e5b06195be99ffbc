"""The exceptions of Driftworld: one base, one subclass for each part of the toolkit.

Messages are written in Rust, where the errors are found.
"""

from __future__ import annotations

from typing import Any


class DriftworldError(Exception):
    """Base of all errors raised by Driftworld.

    Attributes:
        code: A stable name for the kind of error, such as ``"spec/unknown-key"``, or ``None``.
        pointer: JSON pointer to the first wrong value, such as ``"/variants/red/light"``.
        line: Its line in the text, from 1.
        column: Its column, in characters from 1.
        expected: What was expected there.
        problems: Every problem of a document, ordered by position: dictionaries with ``code``, ``pointer``, ``line``,
            ``column``, ``found``, ``expected``, ``advice`` and ``message``.
    """

    def __init__(
        self,
        message: str = "",
        *,
        code: str | None = None,
        problems: list[dict[str, Any]] | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        super().__init__(message)
        self.problems = list(problems or [])
        first = self.problems[0] if self.problems else {}
        self.code = code
        self.pointer: str | None = first.get("pointer")
        self.line: int | None = line if line is not None else first.get("line")
        self.column: int | None = column if column is not None else first.get("column")
        self.expected: str | None = first.get("expected")


class SpecError(DriftworldError, ValueError):
    """A task spec, world or scenario is wrong; each problem has its position."""


class TaskError(DriftworldError, LookupError, ValueError):
    """There is no task, variant or file of that name, or the file cannot be read."""


class GeneratorError(DriftworldError):
    """A world cannot be drawn from a variant."""


class SimilarityError(DriftworldError):
    """A distance cannot be measured, or variants cannot be ordered."""


class EnvError(DriftworldError):
    """A world cannot be run or drawn as requested, or an action cannot be carried out."""


class MetricsError(DriftworldError):
    """A log cannot be read, written or scored."""


class CurriculumError(DriftworldError):
    """A curriculum cannot be designed or run."""
