"""Distances between variants and between worlds, distance matrices, and orders by distance.

The measures are those of ``driftworld distance`` and ``driftworld order``, with the same numbers.
"""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from driftworld import _native
from driftworld._files import read_text, write_whole
from driftworld._html import note, number, table
from driftworld._literals import ComparedBy, OrderMethod, Scale
from driftworld.envs.options import library_bytes
from driftworld.logs import _pandas
from driftworld.specs import TaskSpec, Variant, document_text, variant, variants

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Self

#: The elements of the decision process, by letter.
ELEMENTS = {"S": "state", "A": "action", "T": "transition", "R": "reward", "O": "observation"}

#: Maximum number of rows and columns of a matrix that a notebook shows.
SHOWN = 20

Weights = Mapping[str, float]
PathLike = str | os.PathLike[str]
#: The methods that search for the best path from a first item; ``None`` selects a method by the number of items.
SEEKING = frozenset([None, "nearest", "exact", "two-opt", "abrupt", "farthest", "target-step", "gradual", "outward"])
Named = str | Variant | TaskSpec


class Distance(float):
    """A distance: a number, with the parts it is made of.

    Attributes:
        elements: The distance in each element of the decision process, by letter: ``S``, ``A``, ``T``, ``R``, ``O``;
            ``None`` if nothing could differ.
        parts: The compared parts: dictionaries with ``name``, ``element``, ``measure``, ``how`` (for distributions),
            ``raw``, ``normalised``, ``weight`` and ``share``, largest contribution first.
        by: The basis of comparison, such as ``"parameters"``.
        compared: How the two were compared, in words.
    """

    elements: dict[str, float | None]
    parts: list[dict[str, Any]]
    by: str
    compared: str

    def __new__(
        cls,
        total: float,
        elements: Mapping[str, float | None],
        parts: Iterable[dict[str, Any]],
        by: str,
        compared: str,
    ) -> Self:
        """The total distance, at least 0, and the parts it is made of."""
        distance = super().__new__(cls, total)
        distance.elements, distance.parts = dict(elements), list(parts)
        distance.by, distance.compared = by, compared
        return distance

    @property
    def total(self) -> float:
        """The total distance, at least 0, as a plain number."""
        return float(self)

    def __repr__(self) -> str:
        return f"Distance({self.total!r}, {self.compared!r})"

    def __str__(self) -> str:
        return str(self.total)

    def _repr_html_(self) -> str:
        elements = [(f"{letter} {ELEMENTS[letter]}", number(value)) for letter, value in self.elements.items()]
        html = table(("element", "distance"), [("all", number(self.total)), *elements], self.compared)
        head = ("part", "element", "measure", "raw", "weight", "share")
        rows = [
            (part["name"], part["element"], part["measure"], number(part["raw"]), f"{part['weight']:g}", f"{part['share']:.1%}")
            for part in self.parts
            if part["raw"] != 0
        ]
        equal = dict.fromkeys(part["name"] for part in self.parts if part["raw"] == 0)
        return html + (table(head, rows) if rows else "") + note(f"equal: {', '.join(equal)}" if equal else "")

    def __getnewargs__(self) -> tuple[Any, ...]:
        return (self.total, self.elements, self.parts, self.by, self.compared)

    def explain(self) -> str:
        """The parts of the distance, as a table in plain text."""
        lines = [f"{self.total:.4f}, {self.compared}"]
        for letter, value in self.elements.items():
            lines.append(f"  {letter} {ELEMENTS[letter]:<12} {'-' if value is None else f'{value:.4f}'}")
        rows = [("part", "element", "measure", "how", "raw", "counts", "weight", "share")]
        for part in self.parts:
            numbers = (f"{part['raw']:.4f}", f"{part['normalised']:.4f}", f"{part['weight']:g}", f"{part['share']:.1%}")
            rows.append((part["name"], part["element"], part["measure"], _words(part.get("how")), *numbers))
        widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        for row in rows:
            cells = [
                f"{cell:<{width}}" if k < 4 else f"{cell:>{width}}" for k, (cell, width) in enumerate(zip(row, widths))
            ]
            lines.append("  ".join(cells).rstrip())
        return "\n".join(lines)


def _words(how: Any) -> str:
    return "of the values" if how is None else str(how)


def distance(
    a: Any,
    b: Any,
    *,
    weights: Weights | None = None,
    worlds: int | None = None,
    seed: int = 0,
    index: int = 0,
    by: ComparedBy | None = None,
    scale: Scale = "units",
    assets: PathLike | Iterable[PathLike] = (),
) -> Distance:
    """The distance between two variants, or two worlds.

    Two variants of one task are compared as the task declares, by parameters by default, with its weights and measures.
    Variants of different tasks are compared by worlds drawn from each under one seed; worlds are compared directly.

    Args:
        a: A variant, its name such as ``"find_objects#red"``, a world as a dictionary or JSON text, or the path of a
            world.
        b: The other variant or world.
        weights: Weights of elements, overriding the task's: ``{"R": 2}`` or ``{"reward": 2}``, each 0 to 1,000,000.
        worlds: Number of worlds of each to compare, 1 to 100,000; by default 16, or 4 by pictures and dynamics, or 64
            by placements. If given, variants of one task are compared by worlds instead of by parameters.
        seed: The seed of drawn worlds.
        index: The number of the first drawn world.
        by: ``"parameters"`` (two variants of one task), ``"worlds"``, ``"pictures"``, ``"occupancy"``,
            ``"placements"``, ``"objects"``, ``"colors"``, ``"rewards"``, ``"dynamics"``, ``"behavior"``, some with a
            measure after a colon, such as ``"occupancy:jaccard"``.
        scale: By parameters, ``"units"`` (1 is one parameter over its whole range) or ``"share"`` (of the task's
            diameter, where all parameters span their whole ranges).
        assets: Paths of asset libraries with classes that the worlds use.

    Raises:
        SpecError: If a document is wrong.
        TaskError: If there is no such task or variant.
        GeneratorError: If a world cannot be drawn.
        SimilarityError: For an invalid weight.
    """
    laid = None if weights is None else dict(weights)
    sides = _side(a), _side(b)
    found = _native.distance(*sides, laid, worlds, seed, index, by, scale, library_bytes(assets))
    tasks = [side.task for side in sides if isinstance(side, Variant)]
    if by is None and worlds is None and len(tasks) == 2 and tasks[0] != tasks[1]:
        warnings.warn(
            "distance: found variants of two tasks and no by, expected by=\"worlds\" or another measure: the tasks have no "
            "parameters in common, so the distance is measured by worlds, in a different unit",
            stacklevel=2,
        )
    letters = {name: letter for letter, name in ELEMENTS.items()}
    return Distance(
        total=found["total"],
        elements={letters[name]: value for name, value in found["elements"].items()},
        parts=sorted(found["parts"], key=lambda part: -part["share"]),
        by=found["by"],
        compared=found["compared"],
    )


def _side(side: Any) -> Variant | tuple[str, str]:
    """The variant itself, or the name and the text of a world."""
    if isinstance(side, Variant):
        return side
    if isinstance(side, TaskSpec):
        return side.variant()
    if isinstance(side, (str, os.PathLike)):
        name = os.fspath(side)
        if not name.lstrip().startswith("{") and not _is_world_file(name):
            return variant(name)
    return document_text(side)


def _is_world_file(name: str) -> bool:
    try:
        document = json.loads(read_text(name))
    except (OSError, ValueError):
        return False
    return isinstance(document, dict) and not any(key in document for key in ("name", "parameters", "groups"))


class DistanceMatrix:
    """All pairwise distances among labelled items: symmetric, at least 0, and 0 on the diagonal.

    ``np.asarray(matrix)`` is the array; ``matrix[0, 1]`` and ``matrix["task#a", "task#b"]`` are distances,
    ``matrix["task#a"]`` is a row. Like a data frame, it iterates over labels, and ``in`` tests for a label. Two
    matrices are equal if labels, distances and :attr:`is_metric` are.

    Args:
        labels: Names of the items, each once.
        values: The distances, float64 (items, items).

    Raises:
        SimilarityError: If the numbers are not distances, or do not fit the labels.
    """

    def __init__(self, labels: Sequence[str], values: ArrayLike) -> None:
        self._native = _native.Matrix.from_values(list(labels), np.asarray(values, dtype=np.float64))
        self._values: NDArray[np.float64] | None = None

    @classmethod
    def _of(cls, native: _native.Matrix) -> DistanceMatrix:
        matrix = cls.__new__(cls)
        matrix._native = native
        matrix._values = None
        return matrix

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> DistanceMatrix:
        """Reads a matrix written by :meth:`save` or ``driftworld order --matrix``, in the format of the file's
        extension.

        Raises:
            SimilarityError: If the file contains no distances.
        """
        path = Path(path)
        read = _native.Matrix.from_csv if _ending(path) == ".csv" else _native.Matrix.from_json
        return cls._of(read(read_text(path, "matrix")))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the matrix as ``.csv`` or ``.json``, by the name's extension."""
        path = Path(path)
        native = self._native
        write_whole(path, (native.to_csv() if _ending(path) == ".csv" else native.to_json()).encode())

    @property
    def labels(self) -> list[str]:
        """Names of the items."""
        return self._native.labels

    @property
    def values(self) -> NDArray[np.float64]:
        """The distances, float64 (items, items); read-only."""
        if self._values is None:
            self._values = self._native.values()
            self._values.flags.writeable = False
        return self._values

    @property
    def is_metric(self) -> bool:
        """Whether the triangle inequality holds, as far as known for the measure."""
        return self._native.is_metric

    def embed(self, dim: int = 2) -> NDArray[np.float64]:
        """Embeds the items as points that preserve the distances as well as possible (classical scaling), float64
        (items, dim).

        Args:
            dim: 1 or 2. The first axis is the longer one.
        """
        if dim not in (1, 2):
            raise ValueError(f"dim: found {dim!r}, expected 1 or 2; for more dimensions, pass `values` to an embedding library")
        points, _ = self._native.map()
        return points[:, :dim]

    def explained(self) -> float:
        """Share of the matrix that two dimensions explain, in 0..=1."""
        return self._native.map()[1]

    def order(
        self,
        method: OrderMethod | None = None,
        *,
        start: str | None = None,
        end: str | None = None,
        seed: int = 0,
        target_step: float | None = None,
    ) -> Order:
        """Orders the items; see :func:`order`."""
        ends = [
            None if label is None else self._index(option, label) for option, label in (("start", start), ("end", end))
        ]
        return Order(**self._native.order(method, ends[0], ends[1], seed, target_step))

    def _index(self, option: str, label: str) -> int:
        labels = self.labels
        if label in labels:
            return labels.index(label)
        shown = ", ".join(labels[:20]) + (f" and {len(labels) - 20} more" if len(labels) > 20 else "")
        raise ValueError(f"{option}: found {label!r}, expected one of {shown}")

    @property
    def shape(self) -> tuple[int, int]:
        """(items, items)."""
        return (len(self), len(self))

    @property
    def ndim(self) -> int:
        """Always 2."""
        return 2

    @property
    def dtype(self) -> np.dtype[np.float64]:
        """Always float64."""
        return self.values.dtype

    def to_pandas(self) -> pandas.DataFrame:
        """The distances as a data frame, with the labels on rows and columns.

        Raises:
            ImportError: If pandas is not installed.
        """
        labels = self.labels
        return _pandas().DataFrame(np.array(self.values), index=labels, columns=labels)

    def __len__(self) -> int:
        return len(self._native)

    def __iter__(self) -> Iterator[str]:
        return iter(self.labels)

    def __contains__(self, label: object) -> bool:
        return label in self.labels

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DistanceMatrix):
            return NotImplemented
        return (
            self.labels == other.labels
            and self.is_metric == other.is_metric
            and np.array_equal(self.values, other.values)
        )

    def __hash__(self) -> int:
        return hash((tuple(self.labels), self.values.tobytes()))

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, tuple):
            key = tuple(self._index("label", part) if isinstance(part, str) else part for part in key)
        elif isinstance(key, str):
            key = self._index("label", key)
        return self.values[key]

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self.values.dtype:
            raise ValueError(f"copy: found False with {dtype}, expected float64, the dtype of the distances")
        return np.array(self.values, dtype=dtype) if copy else np.asarray(self.values, dtype=dtype)

    def __repr__(self) -> str:
        return f"<DistanceMatrix of {len(self)} items>"

    def _repr_html_(self) -> str:
        shown = min(len(self), SHOWN)
        labels = self.labels[:shown]
        # Column heads omit the task if all variants belong to the same task.
        tasks = {label.partition("#")[0] for label in labels}
        heads = [label.partition("#")[2] or label for label in labels] if len(tasks) == 1 else labels
        more = f"; the first {shown} are shown" if shown < len(self) else ""
        rows = [(labels[row], *(number(float(value)) for value in self.values[row, :shown])) for row in range(shown)]
        values = self.values[:shown, :shown]
        shades = (values / (values.max(initial=0.0) or 1.0)).tolist()
        return table(("", *heads), rows, f"{len(self)} items{more}", shades)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_matrix_again, (self._native.to_json(),))


def _matrix_again(text: str) -> DistanceMatrix:
    """Unpickles a matrix."""
    return DistanceMatrix._of(_native.Matrix.from_json(text))


def _ending(path: Path) -> str:
    ending = path.suffix
    if ending not in (".csv", ".json"):
        advice = _native.removed_format(ending[1:]) or "expected a name that ends in .csv or .json"
        raise ValueError(f"path: found {str(path)!r}, {advice}")
    return ending


@dataclass(frozen=True)
class Order(Sequence[str]):
    """Items ordered by their distances.

    A sequence of their labels: ``order[0]``, ``order[-2:]``, ``"task#a" in order``.

    Attributes:
        method: The method that found it.
        order: The labels, in order.
        indices: The same order as item indices, from 0.
        steps: The distance from each item to the next.
        length: The sum of the steps.
        largest_step: The largest of them.
        mean_step: Their mean.
        anchor_correlation: Rank correlation, in −1..=1, of position with distance from the first item, or ``None``.
        share_of_shorter_random_orders: The share of 1,000 random orders, drawn from ``seed``, that are shorter.
    """

    method: str
    order: list[str]
    indices: list[int]
    steps: list[float]
    length: float
    largest_step: float
    mean_step: float
    anchor_correlation: float | None
    share_of_shorter_random_orders: float

    @property
    def labels(self) -> list[str]:
        """The labels, in order."""
        return self.order

    @overload
    def __getitem__(self, place: int) -> str: ...
    @overload
    def __getitem__(self, place: slice) -> list[str]: ...
    def __getitem__(self, place: int | slice) -> str | list[str]:
        return self.order[place]

    def __len__(self) -> int:
        return len(self.order)

    def __str__(self) -> str:
        return "\n".join([*("  ".join(row).rstrip() for row in self._rows(True)), self._summary()])

    def _repr_html_(self) -> str:
        return table(("", "item", "from the one before"), self._rows(False)) + note(self._summary())

    def _rows(self, padded: bool) -> list[tuple[str, str, str]]:
        """A row for each item: its position, its label, and the step to it."""
        wide = max(map(len, self.order), default=0) if padded else 0
        steps = ["", *(f"{step:.4f}" for step in self.steps)]
        return [(f"{place}", f"{label:<{wide}}", step) for place, (label, step) in enumerate(zip(self.order, steps), start=1)]

    def _summary(self) -> str:
        """A summary of the whole order."""
        return (
            f"{self.method}: length {self.length:.4f}, largest step {self.largest_step:.4f}; "
            f"{self.share_of_shorter_random_orders:.1%} of random orders are shorter"
        )


def distance_matrix(
    items: Named | Iterable[Named],
    weights: Weights | None = None,
    *,
    by: ComparedBy | None = None,
    worlds: int | None = None,
    scale: Scale = "units",
    assets: PathLike | Iterable[PathLike] = (),
) -> DistanceMatrix:
    """All pairwise distances among variants, measured in parallel.

    The distance of a pair depends only on the two variants and on ``by``, not on the rest of the list.

    Args:
        items: Names, variants and task specs; a task adds all its variants, and each variant is taken once.
        weights: As for :func:`distance`.
        by: As for :func:`distance`, by default as the variants' task declares; required for variants of several tasks.
        worlds: Number of worlds of each to compare, drawn under seed 0, 1 to 10,000; by default 16, or 4 by pictures
            and dynamics, or 64 by placements.
        scale: As for :func:`distance`.
        assets: Paths of asset libraries with classes that the worlds use.

    Raises:
        SpecError, TaskError, GeneratorError, SimilarityError: As :func:`distance`; SimilarityError also for more than
            20,000 variants.
        ValueError: If two different variants have the same name.
    """
    found = _variants(items)
    laid = None if weights is None else dict(weights)
    labels, variants_of = [label for label, _ in found], [item for _, item in found]
    return DistanceMatrix._of(_native.Matrix.measure(labels, variants_of, laid, by, worlds, scale, library_bytes(assets)))


def _variants(items: Named | Iterable[Named]) -> list[tuple[str, Variant]]:
    if isinstance(items, (str, os.PathLike, Variant, TaskSpec)):
        return variants(items)
    return variants(*items)


def order(
    items: DistanceMatrix | Named | Iterable[Named],
    method: OrderMethod | None = None,
    *,
    start: str | None = None,
    end: str | None = None,
    seed: int = 0,
    target_step: float | None = None,
    weights: Weights | None = None,
    by: ComparedBy | None = None,
    worlds: int | None = None,
    scale: Scale = "units",
    assets: PathLike | Iterable[PathLike] = (),
) -> Order:
    """Orders variants by their distances.

    Args:
        items: A matrix, or items as for :func:`distance_matrix`.
        method: ``nearest``, ``exact`` (up to 15), ``two-opt``, ``abrupt``, ``farthest``, ``random``, ``target-step``,
            ``gradual``, ``outward`` or ``given``; by default exact where possible, else two-opt.
        start: The label that comes first. By default, methods that search for a path from a first item start at the
            variant named first, or, in a matrix or a whole task, at the best one.
        end: The label that comes last.
        seed: The seed of ``random``.
        target_step: The step of ``target-step``.
        weights: As for :func:`distance`.
        by, worlds, scale, assets: As for :func:`distance_matrix`.

    Raises:
        SimilarityError: If the method is unknown, or does not support these ends or items.
        ValueError: If a label belongs to none of the items.
    """
    if isinstance(items, DistanceMatrix):
        measured = {"weights": weights, "by": by, "worlds": worlds, "scale": None if scale == "units" else scale, "assets": assets or None}
        for name, value in measured.items():
            if value is not None:
                raise ValueError(f"{name}: found a value in addition to a matrix, expected none: the matrix already holds its distances")
        matrix = items
    else:
        named = [items] if isinstance(items, (str, os.PathLike, Variant, TaskSpec)) else list(items)
        matrix = distance_matrix(named, weights, by=by, worlds=worlds, scale=scale, assets=assets)
        first = variants(*named[:1])
        if start is None and len(first) == 1 < len(matrix) and method in SEEKING and end != first[0][0]:
            start = first[0][0]
    return matrix.order(method, start=start, end=end, seed=seed, target_step=target_step)
