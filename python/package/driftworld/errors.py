"""The exceptions of Driftworld: one base, one subclass for each part of the toolkit.

What they say is written where the mistake is found, in Rust; here is only what a program may ask them.
"""

from __future__ import annotations

from typing import Any


class DriftworldError(Exception):
    """Anything that Driftworld refuses or cannot do.

    Attributes:
        code: A stable name for the kind of mistake, such as ``"spec/unknown-key"``; ``None`` where there is none.
        pointer: JSON pointer to the first value that is wrong, such as ``"/variants/red/light"``.
        line: Its line in the text, from 1.
        column: Its column, in characters from 1.
        expected: What should have stood there.
        problems: Every problem of a document, in the order of places: dictionaries with ``code``, ``pointer``,
            ``line``, ``column``, ``found``, ``expected``, ``advice`` and ``message``.
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

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (type(self), str(self), self.code, self.problems, self.line, self.column))


def _again(
    kind: type[DriftworldError],
    message: str,
    code: str | None,
    problems: list[dict[str, Any]],
    line: int | None,
    column: int | None,
) -> DriftworldError:
    """The exception in another process."""
    return kind(message, code=code, problems=problems, line=line, column=column)


class SpecError(DriftworldError, ValueError):
    """A task spec, world or scenario is wrong; each problem comes with its place."""


class TaskError(DriftworldError, LookupError, ValueError):
    """There is no task, variant or file of that name, or the file cannot be read."""


class GeneratorError(DriftworldError):
    """A world cannot be drawn from a variant."""


class SimilarityError(DriftworldError):
    """A distance cannot be measured, or variants cannot be ordered."""


class EnvError(DriftworldError):
    """A world cannot be run or drawn as asked for, or an action cannot be carried out."""


class MetricsError(DriftworldError):
    """A log cannot be read, written or scored."""


class CurriculumError(DriftworldError):
    """A curriculum cannot be designed or run."""
