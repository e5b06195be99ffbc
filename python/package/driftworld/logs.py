"""Experience logs in the l2logger format: written, read, checked. What they score is in ``scores.py``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, KeysView, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from driftworld import _native
from driftworld._literals import BlockSubtype, BlockType, Status

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Self

    from driftworld.recordings import Recording

#: Columns that hold whole numbers or numbers as they are; all others of a log but its metrics hold words.
_WORDS = ("worker_id", "block_type", "block_subtype", "task_name", "task_params", "exp_status")


class LogWriter:
    """Writes a log, row by row, each flushed as soon as it is written.

    Use it as a context manager::

        with LogWriter("logs/mine", ["reward"]) as log:
            log.write(block_num=0, exp_num=0, block_type="train", task_name="find_red", reward=3.0)

    Args:
        path: A new or empty folder; with ``resume`` that of a log which was interrupted.
        columns: The metrics that every row has: a name, or several.
        scenario_info: What the run is about, written into ``scenario_info.json``: ``complexity``, ``difficulty`` and
            ``scenario_type`` (``condensed``, ``dispersed``, ``permuted``, ``alternating``, ``ste``, ``custom``) are words of the
            format, anything else is kept as it is.
        resume: Go on with the log in the folder.

    Raises:
        MetricsError: If the folder holds something already, or is being written by another.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        columns: str | Iterable[str] = "reward",
        *,
        scenario_info: Mapping[str, Any] | None = None,
        resume: bool = False,
    ) -> None:
        self.path = Path(path)
        names = [columns] if isinstance(columns, str) else list(columns)
        if resume:
            self._file = _native.LogFile.resume(self.path)
        else:
            self._file = _native.LogFile.create(self.path, names, dict(scenario_info or {}))

    def write(
        self,
        *,
        block_num: int,
        exp_num: int,
        block_type: BlockType,
        task_name: str,
        task_params: Mapping[str, Any] | None = None,
        block_subtype: BlockSubtype = "wake",
        exp_status: Status = "complete",
        worker_id: str = "worker-default",
        recording: Recording | None = None,
        **metrics: float,
    ) -> None:
        """Writes one row, stamped with the time now.

        Args:
            block_num: The block, from 0; never falls.
            exp_num: The experience over the whole lifetime, from 0; never falls.
            block_type: ``"train"`` or ``"test"``.
            task_name: By convention ``task_variant``, letters and digits on both sides.
            task_params: Parameters of the task; experiences of one block and task have the same.
            block_subtype: ``"wake"`` or ``"sleep"``.
            exp_status: ``"complete"`` or ``"incomplete"``.
            worker_id: Who gathered the experience.
            recording: What was done in it, as ``env.recording()`` has it: it is kept beside the row, for :func:`driftworld.replay`.
            metrics: The numbers: at least every metrics column, the same names in every row; NaN for no value.

        Raises:
            MetricsError: If the row breaks a rule of the format; then nothing is written.
            ValueError: If the log is closed.
        """
        numbers = {name: float(value) for name, value in metrics.items()}
        params = dict(task_params or {})
        kept = None if recording is None else recording._handle
        self._file.write(
            block_num, exp_num, block_type, block_subtype, task_name, params, exp_status, worker_id, numbers, kept
        )

    def close(self) -> None:
        """Ends the log: asks the disk to have all of it."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


@dataclass(frozen=True, eq=False)
class Log:
    """A log as it was read: a table, as data frames are. ``len(log)`` counts its rows; ``log["reward"]`` is a column, and what is
    iterated and what is ``in`` it are the names of columns. Two are equal if they say the same, whatever their folders are called.

    Attributes:
        run_id: The name of its folder.
        columns: Every column by its name, each an array (rows,): int64 for ``block_num`` and ``exp_num``, datetime64[us] for
            ``timestamp``, float64 for metrics, objects for words and for ``task_params``, which are dictionaries.
        metrics: The names of its metrics columns.
        scenario_info: What ``scenario_info.json`` says.
        logger_info: What ``logger_info.json`` says.
        warnings: What is odd about it.
    """

    run_id: str
    columns: dict[str, NDArray[Any]]
    metrics: list[str]
    scenario_info: dict[str, Any] = field(repr=False)
    logger_info: dict[str, Any] = field(repr=False)
    warnings: list[str]

    def __len__(self) -> int:
        return len(self.columns["exp_num"])

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __contains__(self, column: object) -> bool:
        return column in self.columns

    def keys(self) -> KeysView[str]:
        """The names of the columns: ``dict(log)`` has them with their arrays."""
        return self.columns.keys()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Log):
            return NotImplemented
        mine = (self.metrics, self.scenario_info, self.logger_info, list(self.columns))
        return mine == (other.metrics, other.scenario_info, other.logger_info, list(other.columns)) and all(
            _is_same(column, other.columns[name]) for name, column in self.columns.items()
        )

    __hash__ = None  # type: ignore[assignment]

    def __getitem__(self, column: str) -> NDArray[Any]:
        return self.columns[column]

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame.

        Raises:
            ImportError: If pandas is not installed.
        """
        return _pandas().DataFrame(self.columns)


def _is_same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    """Whether columns hold the same, NaN for NaN."""
    return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype == np.float64)


def read_log(path: str | os.PathLike[str], *, texts: bool = False) -> Log:
    """Reads a log, ours or that of any agent that logs with l2logger.

    Args:
        path: Its folder.
        texts: Read columns of words that ``logger_info.json`` does not declare, too.

    Raises:
        MetricsError: If it cannot be read, with file, line and column.
    """
    run_id, columns, logger, scenario, warnings = _native.read_log(Path(path), texts)
    arrays = {name: _array(name, column) for name, column in columns.items()}
    return Log(
        run_id=run_id,
        columns=arrays,
        metrics=[name for name, column in arrays.items() if column.dtype == np.float64],
        scenario_info=scenario,
        logger_info=logger,
        warnings=warnings,
    )


def _array(name: str, column: Any) -> NDArray[Any]:
    if name == "timestamp":
        stamps: NDArray[Any] = column.astype("datetime64[us]")
        return stamps
    if isinstance(column, np.ndarray):
        return column.astype(np.int64) if column.dtype == np.uint64 else column
    words = np.empty(len(column), dtype=object)
    words[:] = column
    return words


def validate_log(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Every problem of a log.

    Args:
        path: Its folder.

    Returns:
        ``valid``; ``problems``, dictionaries with ``code`` and ``message``, and ``more_problems``, how many are not listed;
        ``warnings`` and ``more_warnings``; and counts: ``rows``, ``complete_rows``, ``experiences``, ``files``, ``workers``,
        ``blocks``, ``tasks``.
    """
    return _native.validate_log(Path(path))


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError('found no pandas, expected it for data frames; pip install "./python[pandas]"') from error
    return pandas
