"""Compares continual learners: frozen sequences of tasks, a runner that resumes after being killed, and tables from its
logs.

    driftworld benchmark list
    driftworld benchmark run smoke --learner finetuning --learner ewc --seeds 2 --jobs 2 -o results
    driftworld benchmark table results/smoke

A cell is one learner with one seed in one sequence. Learning needs torch; tables do not.
"""

from driftworld.benchmark.measures import Matrix, cora, gem, interquartile_mean, interval, regret
from driftworld.benchmark.runner import Cell, run_cells
from driftworld.benchmark.sequence import Sequence
from driftworld.benchmark.table import Results

__all__ = [
    "Cell", "Matrix", "Results", "Sequence", "cora", "gem", "interquartile_mean", "interval", "regret", "run_cells",
]  # fmt: skip
