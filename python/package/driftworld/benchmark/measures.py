"""What papers report of a lifetime, from its matrix of evaluations, each as its own source defines it. Only NumPy.

The matrix of a lifetime of ``T`` tasks has a row for each time of evaluation, the first before anything was learned, and a column
for each task, in the order in which they are learned: ``values[k, i]`` is task ``i`` after ``k`` tasks.
"""

from __future__ import annotations

from collections.abc import Sequence as SequenceOf
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Matrix:
    """Evaluations of one lifetime, and Continual World's measures of them (Wołczyk et al. 2021, arXiv:2105.10919; COOM has the same).

    Attributes:
        values: ``(T + 1, T)``; 0 and 1 are the ends of the scale.
        curves: For each task what its learning episodes earned on the same scale, in the order in which they ended.
    """

    values: Floats
    curves: tuple[Floats, ...] = ()

    def performance(self) -> float:
        """Mean of all tasks at the end."""
        return float(self.values[-1].mean())

    def learned(self) -> Floats:
        """Each task right after it was learned."""
        return np.diagonal(self.values, offset=-1).copy()

    def forgetting(self) -> float:
        """Mean over the tasks of what was lost from right after learning to the end."""
        return float((self.learned() - self.values[-1]).mean())

    def forward_transfer(self, alone: Matrix) -> float:
        """Mean over the tasks of (AUC − AUC alone) / (1 − AUC alone), AUC the mean of the curve while the task is learned.

        Args:
            alone: The same tasks, each learned from scratch.
        """
        here, there = self.areas(), alone.areas()
        return float(((here - there) / (1.0 - there)).mean())

    def areas(self) -> Floats:
        """The mean of each task's curve."""
        return np.array([curve.mean() for curve in self.curves])

    def backward(self) -> float:
        """Mean over all tasks but the last of what later tasks did to them; below 0 is forgetting."""
        return float((self.values[-1] - self.learned())[:-1].mean())


def gem(values: ArrayLike) -> dict[str, float]:
    """``ACC``, ``BWT`` and ``FWT`` of Lopez-Paz and Ranzato 2017 (arXiv:1706.08840), of a matrix as above: the first row is what a random start does."""
    matrix = np.asarray(values, dtype=float)
    start, result = matrix[0], matrix[1:]
    tasks = len(result)
    after = [result[-1, i] - result[i, i] for i in range(tasks - 1)]
    before = [result[i - 1, i] - start[i] for i in range(1, tasks)]
    return {"ACC": float(result[-1].mean()), "BWT": _mean(after), "FWT": _mean(before)}


def cora(values: ArrayLike) -> dict[str, Floats]:
    """Isolated forgetting and zero-shot transfer of CORA (Powers et al. 2022, arXiv:2110.10067), of a matrix as above.

    Both are what task ``j``, learned in between, changes of task ``i``, over the largest size of an evaluation of ``i``. Forgetting is counted for
    tasks learned before ``j``, transfer for tasks learned after ``j``; elsewhere there is NaN.

    Returns:
        ``forgetting`` and ``transfer``, each ``(T, T)``: row ``i``, column ``j``.
    """
    matrix = np.asarray(values, dtype=float)
    tasks = matrix.shape[1]
    size = np.abs(matrix).max(axis=0)
    gained = np.diff(matrix, axis=0).T / np.where(size > 0, size, 1.0)[:, None]
    i, j = np.indices((tasks, tasks))
    return {"forgetting": np.where(i < j, -gained, np.nan), "transfer": np.where(i > j, gained, np.nan)}


def regret(rewards: SequenceOf[ArrayLike], ceilings: SequenceOf[float]) -> float:
    """Mean over all learning episodes of what the ceiling of their task would have earned more."""
    missed = [ceiling - np.asarray(earned, dtype=float) for earned, ceiling in zip(rewards, ceilings, strict=True)]
    return float(np.concatenate(missed).mean())


def interquartile_mean(values: ArrayLike) -> float:
    """The mean without the lowest and the highest quarter, as SciPy's ``trim_mean(values, 0.25)``."""
    ordered = np.sort(np.asarray(values, dtype=float), axis=None)
    cut = int(0.25 * len(ordered))
    return float(ordered[cut : len(ordered) - cut].mean())


def interval(values: ArrayLike, draws: int = 10_000, seed: int = 0) -> tuple[float, float]:
    """Where 95 % of the interquartile means lie of as many values, drawn again from these."""
    found = np.asarray(values, dtype=float)
    again = np.random.default_rng(seed).choice(found, (draws, len(found)))
    cut = int(0.25 * len(found))
    means = np.sort(again, axis=1)[:, cut : len(found) - cut].mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)


def _mean(values: list[Any]) -> float:
    return float(np.mean(values)) if values else float("nan")
