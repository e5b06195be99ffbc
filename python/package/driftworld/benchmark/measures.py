"""Published measures of a lifetime, each as its source defines it. Needs only NumPy.

The matrix of a lifetime of ``T`` tasks has a row for each evaluation block (the first precedes any learning) and a
column for each task, in the order of learning: ``values[k, i]`` is the evaluation of task ``i`` after ``k`` tasks. The papers evaluate many
times while a task is learned and take the mean of the last few. Here a row is one evaluation block instead.
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
    """Evaluations of one lifetime, and Continual World's measures of them (Wołczyk et al. 2021, arXiv:2105.10919).

    Continual World evaluates every 20,000 steps; its rows are means of five evaluations, its curves evaluations of the
    current task. The curves here are the learning episodes.

    Attributes:
        values: ``(T + 1, T)``; 0 and 1 are the ends of the scale.
        curves: For each task the rewards of its learning episodes on the same scale, in the order in which they ended.
        steps: For each task the lengths of these episodes; empty if all have the same length.
    """

    values: Floats
    curves: tuple[Floats, ...] = ()
    steps: tuple[Floats, ...] = ()

    @classmethod
    def pooled(cls, lifetimes: SequenceOf[Matrix]) -> Matrix:
        """The mean of several seeds. Continual World and COOM divide only after averaging, so their measures are those
        of this mean.
        """
        values = np.mean([each.values for each in lifetimes], axis=0)
        areas = np.mean([each.areas() for each in lifetimes], axis=0)
        return cls(values, tuple(areas[:, None]))

    def performance(self) -> float:
        """Mean of all tasks at the end of the lifetime."""
        return float(self.values[-1].mean())

    def learned(self) -> Floats:
        """Each task right after it was learned."""
        return np.diagonal(self.values, offset=-1).copy()

    def forgetting(self) -> float:
        """Mean over all tasks, including the last, of the loss from right after learning to the end."""
        return float((self.learned() - self.values[-1]).mean())

    def forward_transfer(self, alone: Matrix) -> float:
        """Mean over the tasks of (AUC − AUC alone) / (1 − AUC alone); meaningless once an AUC alone reaches 1.

        Args:
            alone: The same tasks, each learned from scratch for the same number of steps.
        """
        here, there = self.areas(), alone.areas()
        return float(((here - there) / (1.0 - there)).mean())

    def areas(self) -> Floats:
        """The AUC of each task: the mean of its curve over steps, so that long episodes weigh more."""
        steps = self.steps or (None,) * len(self.curves)
        return np.array([np.average(curve, weights=each) for curve, each in zip(self.curves, steps, strict=True)])

    def backward(self) -> float:
        """Mean over all tasks but the last of the change caused by later tasks; below 0 is forgetting."""
        return _mean(list((self.values[-1] - self.learned())[:-1]))

    def coom(self, alone: Matrix) -> dict[str, float]:
        """``performance``, ``forgetting`` and ``transfer`` as COOM computes them (Tomilin et al. 2023).

        Performance is the mean over all tasks and all rows since each task was learned (COOM: over all evaluations
        since training on it began, without exact zeros). Forgetting omits the last task; transfer averages AUCs, then divides.
        """
        rows, here, there = self.values[1:], self.areas().mean(), alone.areas().mean()
        return {
            "performance": float(rows[np.tril_indices(len(rows))].mean()),
            "forgetting": -self.backward(),
            "transfer": float((here - there) / (1.0 - there)),
        }


def gem(values: ArrayLike) -> dict[str, float]:
    """``ACC``, ``BWT`` and ``FWT`` of Lopez-Paz and Ranzato 2017 (arXiv:1706.08840), from a matrix as above.

    ``BWT`` and ``FWT`` are means over ``T - 1`` tasks, as in the paper. The authors' program divides by ``T``.
    """
    matrix = np.asarray(values, dtype=float)
    start, result = matrix[0], matrix[1:]
    tasks = len(result)
    after = [result[-1, i] - result[i, i] for i in range(tasks - 1)]
    before = [result[i - 1, i] - start[i] for i in range(1, tasks)]
    return {"ACC": float(result[-1].mean()), "BWT": _mean(after), "FWT": _mean(before)}


def cora(values: ArrayLike) -> dict[str, Floats]:
    """Isolated forgetting and zero-shot transfer of CORA (Powers et al. 2022, arXiv:2110.10067).

    Both are the change in task ``i`` while task ``j`` is learned (negated for forgetting), divided by the largest
    absolute evaluation of ``i`` in any seed (CORA: in its whole smoothed curve, and undefined if that is 0). Forgetting is defined where ``j`` comes after
    ``i``, transfer where it comes before; other entries are NaN. Entries are means over seeds. CORA prints ten times
    the entries; the averages beside its tables are means of rows, of columns and of all entries, ignoring NaN.

    Args:
        values: A matrix as above, or one for each seed: ``(seeds, T + 1, T)``.

    Returns:
        ``forgetting`` and ``transfer``, each ``(T, T)``: row ``i``, column ``j``.
    """
    matrix = np.asarray(values, dtype=float)
    tasks = matrix.shape[-1]
    lifetimes = matrix.reshape(-1, tasks + 1, tasks)
    scale = np.abs(lifetimes).max(axis=(0, 1))
    gained = np.diff(lifetimes.mean(axis=0), axis=0).T / np.where(scale > 0, scale, 1.0)[:, None]
    i, j = np.indices((tasks, tasks))
    return {"forgetting": np.where(i < j, -gained, np.nan), "transfer": np.where(i > j, gained, np.nan)}


def regret(rewards: SequenceOf[ArrayLike], ceilings: SequenceOf[float]) -> float:
    """Mean over all learning episodes of ceiling minus reward: bsuite's total regret per episode (arXiv:1908.03568)."""
    missed = [ceiling - np.asarray(earned, dtype=float) for earned, ceiling in zip(rewards, ceilings, strict=True)]
    return float(np.concatenate(missed).mean())


def interquartile_mean(values: ArrayLike) -> float:
    """The mean of all values except the lowest and the highest quarter: rliable's IQM (arXiv:2108.13264)."""
    ordered = np.sort(np.asarray(values, dtype=float), axis=None)
    cut = int(0.25 * len(ordered))
    return float(ordered[cut : len(ordered) - cut].mean())


def interval(values: ArrayLike, draws: int = 10_000, seed: int = 0) -> tuple[float, float]:
    """The 95 % interval of the interquartile mean, by rliable's stratified percentile bootstrap.

    For ``(seeds, tasks)``, seeds are drawn for each task separately. rliable takes 50,000 draws, with a different
    generator. For a few seeds without a task axis, every possible draw is taken once, and the interval is exact.
    """
    found = np.asarray(values, dtype=float)
    if found.ndim == 1 and len(found) ** len(found) <= draws:
        drawn = np.indices((len(found),) * len(found)).reshape(len(found), -1).T
    else:
        drawn = np.random.default_rng(seed).integers(len(found), size=(draws, *found.shape))
    resampled = np.take_along_axis(found[None], drawn, axis=1).reshape(len(drawn), -1)
    cut = int(0.25 * found.size)
    means = np.sort(resampled, axis=1)[:, cut : found.size - cut].mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)


def _mean(values: list[Any]) -> float:
    return float(np.mean(values)) if values else float("nan")
