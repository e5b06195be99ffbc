"""Scores the logs of lifetimes: what agents retained and transferred. Also makes the report page.

The numbers are those of ``driftworld metrics``, the page that of ``driftworld report``, and options have the same
names.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from driftworld import _native
from driftworld._html import note, number, table
from driftworld._literals import (
    Aggregation,
    Maintenance,
    Normalization,
    PlotType,
    Resampling,
    Smoothing,
    SteAveraging,
    Transfer,
    Unit,
    VariantMode,
)
from driftworld.logs import _pandas

if TYPE_CHECKING:
    import pandas

PathLike = str | os.PathLike[str]
Paths = PathLike | Iterable[PathLike]

#: The metrics of a lifetime as a whole, in display order.
LIFETIME = (
    "perf_recovery",
    "avg_train_perf",
    "avg_eval_perf",
    "perf_maintenance_mrlep",
    "perf_maintenance_mrtlp",
    "forward_transfer_contrast",
    "backward_transfer_contrast",
    "forward_transfer_ratio",
    "backward_transfer_ratio",
    "ste_rel_perf",
    "sample_efficiency",
)


@dataclass(frozen=True, repr=False)
class Metrics:
    """The scores of one lifetime or of several.

    ``metrics["avg_train_perf"]`` is the value of one lifetime; for several, a list with one value each.

    Attributes:
        lifetimes: All results of each lifetime, as in ``driftworld metrics --json``.
        repeats: For several lifetimes, each metric over all of them, with interquartile mean, mean and median and their
            bootstrap intervals; ``null`` is the null band of the mean over lifetimes, if the metric depends on
            evaluations alone; ``reading`` and ``word`` interpret it, as in :attr:`readings`. Empty for one lifetime.
        improvement: With ``against``, for each metric the probability that a lifetime is better than one of the other
            agent's.
        lifetimes_against: The other agent's lifetimes.
        repeats_against: Each metric over the other agent's lifetimes.
        intervals: How the intervals were computed.
        power: With ``power``, for each metric the standard ``deviations`` between lifetimes, the ``power`` of Welch's
            test at 5 % for the requested ``effect``, the ``lifetimes_needed`` of each agent for a power of 80 %, and
            the ``smallest_effect`` that these lifetimes can show.
        varied: For several lifetimes, whether ``order``, ``learning_worlds``, ``evaluation_worlds``, ``agent`` and
            ``run_seed`` differ between them, which shows the sources of variation behind the intervals; ``None`` if the
            logs do not say.
    """

    lifetimes: list[dict[str, Any]]
    repeats: list[dict[str, Any]] = field(default_factory=list)
    improvement: list[dict[str, Any]] = field(default_factory=list, repr=False)
    lifetimes_against: list[dict[str, Any]] = field(default_factory=list, repr=False)
    repeats_against: list[dict[str, Any]] = field(default_factory=list, repr=False)
    intervals: dict[str, Any] = field(default_factory=dict, repr=False)
    power: list[dict[str, Any]] = field(default_factory=list, repr=False)
    varied: dict[str, bool | None] = field(default_factory=dict, repr=False)
    _asked: tuple[list[str], dict[str, Any]] = field(default=([], {}), repr=False, compare=False)
    _scores: _native.Scores | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        count = len(self.lifetimes)
        values = ", ".join(f"{name} {number(value)}" for name, value in self.lifetime.items())
        return f"<Metrics of {count} {'lifetime' if count == 1 else 'lifetimes'}: {values}>"

    def _repr_html_(self) -> str:
        if self.repeats or len(self.lifetimes) != 1:
            head = ("metric", "IQM", "interval", "mean", "null band", "p", "reading")
            html = table(head, [_row_of_several(row) for row in self.repeats], f"{len(self.lifetimes)} lifetimes")
            cautions = dict.fromkeys(row["caution"] for row in self.repeats if row.get("caution"))
            return html + "".join(note(f"note: {text}") for text in cautions)
        rows = [_row_of_one(row) for row in self.readings.values()]
        remarks = [*self.lifetimes[0].get("notes", []), *self.lifetimes[0].get("cautions", [])]
        html = table(("metric", "value", "null band", "p", "reading", "what it says"), rows)
        return html + "".join(note(f"note: {text}") for text in remarks)

    @property
    def lifetime(self) -> dict[str, Any]:
        """The values of the lifetime as a whole; for several, the mean of each over those lifetimes that have it."""
        if len(self.lifetimes) == 1:
            only = self.lifetimes[0]
            return {name: only[name] for name in LIFETIME if name in only}
        means: dict[str, Any] = {}
        for name in LIFETIME:
            values = [lifetime[name] for lifetime in self.lifetimes if isinstance(lifetime.get(name), (int, float))]
            if any(name in lifetime for lifetime in self.lifetimes):
                means[name] = sum(values) / len(values) if values else None
        return means

    @property
    def tasks(self) -> dict[str, dict[str, Any]]:
        """The values of each task of a single lifetime.

        Raises:
            ValueError: If there are several lifetimes; use each of :attr:`lifetimes` instead.
        """
        return self._only("tasks", "task_metrics")

    @property
    def null(self) -> dict[str, dict[str, Any]]:
        """For a single lifetime, the null band of each metric that depends on evaluations alone.

        Each has ``value``; ``low`` and ``high``, the central 95 % of values when the evaluation rows of each world are
        permuted across evaluations 1,000 times, as if the agent never changed; ``p``, from 0 to 1; and ``exchanged``,
        ``"worlds"``, ``"positions"`` or ``"worlds_and_positions"``. Metrics that also depend on training performance
        have no null band and are missing. Transfer contrasts are included whatever ``transfer_method`` is.

        Raises:
            ValueError: If there are several lifetimes; use ``"null"`` of each of :attr:`lifetimes` instead.
        """
        return self._only("null", "null")

    @property
    def readings(self) -> dict[str, dict[str, Any]]:
        """For a single lifetime, the interpretation of each metric: the rows of the table that ``driftworld metrics``
        prints.

        Each has ``value``; ``explanation``, its meaning; ``good``, the good direction; ``null_band``, as in
        :attr:`null`, or ``None``; ``reading``, ``"good"``, ``"bad"``, ``"mixed"``, ``"unclear"``, ``"untested"`` or
        ``"undefined"``, or ``None`` for a metric without a value that means no effect; and ``word``, the reading as
        shown in tables and reports, such as ``"helps"`` or ``"no clear effect"``. ``docs/metrics.md`` explains the
        rules.

        Raises:
            ValueError: If there are several lifetimes; use ``"readings"`` of each of :attr:`lifetimes` instead, and
                :attr:`repeats` for all together.
        """
        return self._only("readings", "readings")

    @property
    def reached(self) -> dict[str, dict[str, Any]]:
        """For a single lifetime, the performance reached in each task, in the log's unit.

        Each has ``evaluations``, a list of ``block``, ``mean``, ``standard_error`` over worlds and ``num_worlds``;
        ``best``, the index of the highest after learning; ``expert``, the expert's level; and ``share``, the best over
        the expert. Below 0.2 the task was never learned. With scales, ``unlabelled`` has the rewards of the best known
        agents that cannot tell the task from others (``among``): ``fixed`` and ``finds_out``.

        Raises:
            ValueError: If there are several lifetimes; use ``"reached"`` of each of :attr:`lifetimes` instead.
        """
        return self._only("reached", "reached")

    @property
    def curves(self) -> dict[str, dict[str, Any]]:
        """For a single lifetime, measures of each task's evaluation curve, independent of task borders.

        Each has ``points``, a list of ``learned``, ``mean`` and ``standard_error``; ``area``, ``forgetting`` and its
        ``forgetting_error``, ``regret`` (or ``None``), in the log's unit, or if ``is_scaled``, as fractions of the
        range from floor to ceiling; ``lag`` and ``num_present`` in learning experiences. ``docs/metrics.md`` defines
        them.

        Raises:
            ValueError: If there are several lifetimes; use ``"curves"`` of each of :attr:`lifetimes` instead.
        """
        return self._only("curves", "curves")

    def _only(self, name: str, field: str) -> dict[str, Any]:
        """A field of the only lifetime, for the property ``name``."""
        if len(self.lifetimes) != 1:
            raise ValueError(f"{name}: found {len(self.lifetimes)} lifetimes, expected one; see `lifetimes`")
        only: dict[str, Any] = self.lifetimes[0][field]
        return only

    def __getitem__(self, name: str) -> Any:
        values = [lifetime[name] for lifetime in self.lifetimes]
        return values[0] if len(values) == 1 else values

    def to_pandas(self) -> pandas.DataFrame:
        """The values of the lifetimes as a data frame, a row for each, indexed by the names of their logs.

        Raises:
            ImportError: If pandas is not installed.
        """
        names = [name for name in LIFETIME if any(name in lifetime for lifetime in self.lifetimes)]
        rows = [{name: lifetime.get(name) for name in names} for lifetime in self.lifetimes]
        index = [lifetime["run_id"] for lifetime in self.lifetimes]
        return _pandas().DataFrame(rows, index=index, columns=names)

    def regimes(self) -> pandas.DataFrame:
        """The regimes of the lifetimes as a data frame, a row for each, with its description and its values in
        normalised units.

        Raises:
            ImportError: If pandas is not installed.
        """
        return _pandas().DataFrame(self._handle().regimes())

    def save(self, folder: PathLike, *, name: str | None = None) -> None:
        """Saves the results like ``driftworld metrics --do-save``: for one lifetime ``NAME_metrics.json``,
        ``NAME_regime.tsv`` and ``NAME_settings.json``, for several ``NAME.json``, ``NAME.tsv`` and more.

        Args:
            folder: The output folder, created if necessary.
            name: ``NAME``; by default the log's, or ``ll_metrics`` for several.
        """
        self._handle().save(folder, name)

    def _handle(self) -> _native.Scores:
        """The native scores; an unpickled copy scores the logs again."""
        return self._scores if self._scores is not None else _native.Scores.of(*self._asked)[0]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_scores": None}


def metrics(
    logs: Paths,
    *,
    ste: Paths | None = None,
    against: Paths | None = None,
    recursive: bool = False,
    ste_data: PathLike | None = None,
    perf_measure: str | None = None,
    variant_mode: VariantMode | None = None,
    ste_averaging_method: SteAveraging | None = None,
    aggregation_method: Aggregation | None = None,
    maintenance_method: Maintenance | None = None,
    transfer_method: Transfer | None = None,
    normalization_method: Normalization | None = None,
    smoothing_method: Smoothing | None = None,
    smooth_eval_data: bool = False,
    window_length: int | None = None,
    clamp_outliers: bool = False,
    data_range: Mapping[str, Mapping[str, float]] | None = None,
    scales: PathLike | Mapping[str, Mapping[str, float]] | None = None,
    noise: tuple[float, float] | None = None,
    noise_seed: int | None = None,
    strict_definitions: bool = False,
    load_settings: PathLike | None = None,
    common_ranges: bool = False,
    power: float | None = None,
    confidence: float | None = None,
    resamples: int | None = None,
    resampling: Resampling | None = None,
    bootstrap_seed: int | None = None,
) -> Metrics:
    """Scores the logs of lifetimes.

    Args:
        logs: The folder of a log, or several, which count as repeats by one agent.
        ste: Folders of logs of single-task experts to compare with.
        against: Folders of another agent's logs.
        recursive: Score all logs in the folders, up to four levels deep; links are not followed.
        ste_data: The folder where ``driftworld metrics --ste-store-mode`` keeps experts.
        perf_measure: The column of the performance; ``"reward"`` by default.
        variant_mode: Whether variants of a task count as tasks: ``"aware"`` (default) or ``"agnostic"``.
        ste_averaging_method: ``"metrics"`` (default) or ``"time"``.
        aggregation_method: ``"mean"`` (default) or ``"median"``.
        maintenance_method: ``"mrlep"`` (default), ``"mrtlp"`` or ``"both"``.
        transfer_method: ``"ratio"`` (default), ``"contrast"`` or ``"both"``.
        normalization_method: ``"task"`` (default), ``"run"`` or ``"none"``.
        smoothing_method: ``"flat"`` (default), ``"hanning"``, ``"hamming"``, ``"bartlett"``, ``"blackman"`` or
            ``"none"``.
        smooth_eval_data: Smooth evaluations too.
        window_length: Length of the smoothing window, in experiences.
        clamp_outliers: Clip performances to the ranges given, or to the 0.1 and 0.9 quantiles of each task.
        data_range: The range of each task: ``{"findobjects_red": {"min": 0, "max": 10}}``.
        scales: Floor and ceiling of tasks, as a file written by ``driftworld scales`` or as ``{"findobjects_red":
            {"floor": 2, "ceiling": 486}}``; not together with ``data_range``.
        noise: Mean and standard deviation of normal noise added to every performance.
        noise_seed: The seed of the noise.
        strict_definitions: Follow the published definitions where the reference program departs from them.
        load_settings: A JSON file of settings to start from.
        common_ranges: Scale each task by its range over all lifetimes.
        power: Compute for each metric the number of lifetimes of two agents needed to show a difference of this size,
            in the metric's own unit; needs several lifetimes.
        confidence: Share of the bootstrap distribution in an interval; 0.95 by default.
        resamples: Number of bootstrap resamples; 2,000 by default.
        resampling: ``"runs"``, whole lifetimes, by default; or ``"strata"``, within each task.
        bootstrap_seed: The seed of the resampling.

    Raises:
        MetricsError: If a log cannot be read or scored, or an option is wrong.
    """
    options = dict(locals())
    folders = _paths(options.pop("logs"), "logs")
    for paths in ("ste", "against"):
        options[paths] = None if options[paths] is None else _paths(options[paths])
    scores, messages = _native.Scores.of(folders, options)
    _warn(messages)
    values = scores.values()
    if "lifetimes" not in values:
        values = {"lifetimes": [values]}
    return Metrics(**values, _asked=(folders, options), _scores=scores)


def report(
    logs: Paths,
    path: PathLike | None = None,
    *,
    ste: Paths | None = None,
    against: Paths | None = None,
    title: str | None = None,
    date: str | None = None,
    distances: PathLike | None = None,
    plots: PathLike | None = None,
    studio: str | None = None,
    plot_types: Sequence[PlotType] | None = None,
    unit: Unit | None = None,
    perf_measure: str | None = None,
    variant_mode: VariantMode | None = None,
    load_settings: PathLike | None = None,
    common_ranges: bool = False,
) -> str:
    """Makes a self-contained HTML page about lifetimes: metrics, curriculum, curves.

    Args:
        logs: Folders of logs, or folders of such folders.
        path: The file to write; by default the page is only returned.
        ste: Folders of logs of single-task experts to compare with.
        against: Folders of another agent's logs.
        title: The title; by default the lifetime's name.
        date: The date to print on the report; without it, the same logs give the same bytes.
        distances: A distance matrix file, as written by :meth:`DistanceMatrix.save`.
        plots: A folder to also write the figures to.
        studio: The address of a workbench, such as ``driftworld.studio().address``: the page links there to worlds in
            which the last evaluation failed.
        plot_types: The figures: ``"all"`` (default), or some of ``raw``, ``lb``, ``eb``, ``ste``, ``timeline``.
        unit: The unit of the horizontal axis: ``"exp_num"`` (default) or ``"steps"``.
        perf_measure: As for :func:`metrics`.
        variant_mode: As for :func:`metrics`.
        load_settings: As for :func:`metrics`; the settings file has all other scoring options.
        common_ranges: As for :func:`metrics`.

    Returns:
        The page.

    Raises:
        MetricsError: If a log cannot be read or scored.
    """
    options = dict(locals())
    folders, file = _paths(options.pop("logs"), "logs"), options.pop("path")
    for paths in ("ste", "against"):
        options[paths] = None if options[paths] is None else _paths(options[paths])
    page, messages = _native.report(folders, options)
    _warn(messages)
    if file is not None:
        from driftworld._files import write_whole

        write_whole(Path(file), page.encode())
    return page


def _row_of_one(row: Mapping[str, Any]) -> tuple[str, ...]:
    """A row of the table of one lifetime, as in ``driftworld metrics``."""
    error = (row["null_band"] or {}).get("standard_error")
    value = number(row["value"]) + ("" if error is None else f"\N{NO-BREAK SPACE}±\N{NO-BREAK SPACE}{number(error)}")
    return (row["name"], value, *_beside_null(row["null_band"]), row["word"] or "", row["explanation"])


def _row_of_several(row: Mapping[str, Any]) -> tuple[str, ...]:
    """A row of the table of several lifetimes: with Student's interval for few lifetimes, else the bootstrap's."""
    interval = row["iqm"].get("t_interval") or row["iqm"].get("interval")
    ends = "" if interval is None else f"{number(interval['low'])} to {number(interval['high'])}"
    mean = number(row["mean"]["value"])
    return (row["name"], number(row["iqm"]["value"]), ends, mean, *_beside_null(row.get("null")), row["word"] or "")


def _beside_null(band: Mapping[str, Any] | None) -> tuple[str, str]:
    """The null band of a value, and its p."""
    return ("no null", "") if band is None else (f"{number(band['low'])} to {number(band['high'])}", number(band["p"]))


def _warn(messages: Iterable[str]) -> None:
    for text in messages:
        warnings.warn(text, stacklevel=3)


def _paths(paths: Paths, name: str | None = None) -> list[str]:
    """The paths of an argument; ``name`` marks a required argument."""
    folders = [os.fspath(path) for path in ([paths] if isinstance(paths, (str, os.PathLike)) else paths)]
    if name is not None and not folders:
        raise ValueError(f"{name}: found none, expected the folder of a log, or several")
    return folders
