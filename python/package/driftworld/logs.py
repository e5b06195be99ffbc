"""Writes, reads and checks experience logs in the l2logger format."""

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


class LogWriter:
    """Writes a log row by row, and flushes each row.

    Use it as a context manager::

        with LogWriter("logs/mine", ["reward"]) as log:
            log.write(block_num=0, exp_num=0, block_type="train", task_name="find_red", reward=3.0)

    Args:
        path: A new or empty folder; with ``resume``, that of an interrupted log.
        columns: The metrics of every row: a name, or several.
        scenario_info: Description of the run, written into ``scenario_info.json``: ``complexity``, ``difficulty`` and
            ``scenario_type`` (``condensed``, ``dispersed``, ``permuted``, ``alternating``, ``ste``, ``custom``) must be
            words of the format; anything else is stored unchanged.
        resume: Resume the log in the folder.

    Raises:
        MetricsError: If the folder is not empty, or another process is writing it.
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
        """Writes one row with the current time.

        Args:
            block_num: The block, from 0; never decreases.
            exp_num: The experience over the whole lifetime, from 0; never decreases.
            block_type: ``"train"`` or ``"test"``.
            task_name: By convention ``task_variant``, letters and digits on both sides.
            task_params: Parameters of the task; the same for all experiences of one block and task.
            block_subtype: ``"wake"`` or ``"sleep"``.
            exp_status: ``"complete"`` or ``"incomplete"``.
            worker_id: The worker that gathered the experience.
            recording: The recording from ``env.recording()``, stored beside the row for :func:`driftworld.replay`.
            metrics: Values of at least every metrics column, with the same names in every row; NaN for a missing value.

        Raises:
            MetricsError: If the row breaks a rule of the format; nothing is written.
            ValueError: If the log is closed.
        """
        numbers = {name: float(value) for name, value in metrics.items()}
        params = dict(task_params or {})
        kept = None if recording is None else recording._handle
        self._file.write(
            block_num, exp_num, block_type, block_subtype, task_name, params, exp_status, worker_id, numbers, kept
        )

    def close(self) -> None:
        """Ends the log and syncs it to disk."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


@dataclass(frozen=True, eq=False)
class Log:
    """A log read from disk: a table, like a data frame.

    ``len(log)`` is the number of rows; ``log["reward"]`` is a column; it iterates over column names, and ``in`` tests
    for one. Two logs are equal if their contents are, whatever the names of their folders.

    Attributes:
        run_id: The name of its folder.
        columns: Every column by its name, each an array (rows,): int64 for ``block_num`` and ``exp_num``,
            datetime64[us] for ``timestamp``, float64 for metrics, objects for strings and for ``task_params``, which
            are dictionaries.
        metrics: The names of its metrics columns.
        scenario_info: Contents of ``scenario_info.json``.
        logger_info: Contents of ``logger_info.json``.
        warnings: Suspicious parts of the log.
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
        """The names of the columns; ``dict(log)`` maps them to their arrays."""
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
    """Whether two columns are equal, with NaN equal to NaN."""
    return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype == np.float64)


def read_log(path: str | os.PathLike[str], *, texts: bool = False) -> Log:
    """Reads a log, written by Driftworld or by any other program that uses l2logger.

    Args:
        path: Its folder.
        texts: Also read text columns that ``logger_info.json`` does not declare.

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
    """Lists every problem of a log.

    Args:
        path: Its folder.

    Returns:
        ``valid``; ``problems``, dictionaries with ``code`` and ``message``, and ``more_problems``, the number of
        unlisted ones; ``warnings`` and ``more_warnings``; and counts: ``rows``, ``complete_rows``, ``experiences``,
        ``files``, ``workers``, ``blocks``, ``tasks``.
    """
    return _native.validate_log(Path(path))


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError('found no pandas, expected it for data frames; pip install "pandas>=2"') from error
    return pandas
