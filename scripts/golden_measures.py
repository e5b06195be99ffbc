"""Writes python/tests/golden_measures.json: random lifetimes, and their measures by the references' formulae.

    python scripts/golden_measures.py

The measures transcribe the programs named below as plain loops of Python's arithmetic, and share no code with
driftworld.benchmark.measures. NumPy only draws the lifetimes and the bootstrap samples.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

FILE = Path(__file__).parents[1] / "python" / "tests" / "golden_measures.json"
CASES, STEPS, DRAWS = 20, 24, 200

List = list[Any]


def mean(values: List) -> float:
    """The exactly rounded sum divided by the count."""
    return math.fsum(values) / len(values)


def over_steps(curve: List, steps: List | None) -> List:
    """The curve with one point for each step, because the references evaluate on an even grid."""
    points: List = []
    for index, value in enumerate(curve):
        points += [value] * (1 if steps is None else int(steps[index]))
    return points


# awarelab/continual_world, continualworld/results_processing/tables.py at 73f63bb4: calculate_data_at_the_end,
# calculate_forgetting_individual, normalized_ft, BootstrapCI._apply_statistics. An evaluation represents the last five.
def continual_world(values: List, curves: List, alone: List, steps: List | None) -> dict[str, float]:
    """Performance and forgetting are averaged over tasks, then over seeds; for transfer, AUCs are averaged over seeds first."""
    tasks, performance, forgetting, transfer = len(values[0][0]), [], [], []
    for matrix in values:
        performance.append(mean([matrix[tasks][i] for i in range(tasks)]))
        forgetting.append(mean([matrix[i + 1][i] - matrix[tasks][i] for i in range(tasks)]))
    for i in range(tasks):
        lengths = None if steps is None else steps[i]
        sequential = mean([mean(over_steps(seed[i], lengths)) for seed in curves])
        from_scratch = mean([mean(over_steps(seed[i], lengths)) for seed in alone])
        transfer.append((sequential - from_scratch) / (1 - from_scratch))
    return {"performance": mean(performance), "forgetting": mean(forgetting), "transfer": mean(transfer)}


# TTomilin/COOM, results/common.py at 79298011: calculate_performance, calculate_forgetting, calculate_transfer.
# The mean over seeds comes first there (load_cl_data). One evaluation represents the whole time of a task there.
def coom(values: List, curves: List, alone: List, steps: List | None) -> dict[str, float]:
    """Performance counts each task from its own training on, forgetting all tasks but the last. Transfer joins the curves
    of all tasks.
    """
    tasks, seen, drops = len(values[0][0]), [], []
    for i in range(tasks):
        ends = [mean([matrix[k + 1][i] for matrix in values]) for k in range(tasks)]
        seen += [ends[k] for k in range(tasks) if k >= i]
        if i < tasks - 1:
            drops.append(ends[i] - ends[tasks - 1])

    def joined(seed: List) -> float:
        return mean([x for i in range(tasks) for x in over_steps(seed[i], None if steps is None else steps[i])])

    from_scratch = mean([joined(seed) for seed in alone])
    transfer = mean([(joined(seed) - from_scratch) / (1 - from_scratch) for seed in curves])
    return {"performance": mean(seen), "forgetting": mean(drops), "transfer": transfer}


# facebookresearch/GradientEpisodicMemory, metrics/metrics.py at 34c6b8e9: confusion_matrix, which divides by the number
# of tasks; equations 2 to 4 of the paper (arXiv:1706.08840) divide BWT and FWT by one less.
def gem(matrix: List) -> dict[str, float]:
    """Accuracy, backward and forward transfer, as in the paper and as in the program."""
    baseline, result = matrix[0], matrix[1:]
    tasks = len(result)
    accuracy = mean(result[tasks - 1])
    backward = math.fsum(result[tasks - 1][t] - result[t][t] for t in range(tasks))
    forward = math.fsum(result[t - 1][t] - baseline[t] for t in range(1, tasks))
    paper = {"ACC": accuracy, "BWT": backward / (tasks - 1), "FWT": forward / (tasks - 1)}
    return paper | {"program_BWT": backward / tasks, "program_FWT": forward / tasks}


# AGI-Labs/continual_rl, continual_rl/utils/metrics.py at f2754bb2: compute_metrics, compute_forgetting_metric and
# compute_forward_transfer_metric with USE_ISOLATED_*, get_rewards_for_region, plot_metrics (without its factor of 10).
def cora(values: List) -> dict[str, Any]:
    """Tables of forgetting and transfer, averaged over seeds, and the mean of all entries of a seed, averaged over seeds."""
    tasks = len(values[0][0])
    tables: dict[str, Any] = {name: [[None] * tasks for _ in range(tasks)] for name in ("forgetting", "transfer")}
    corners: dict[str, List] = {name: [[] for _ in values] for name in tables}
    for i in range(tasks):
        scale = max(abs(row[i]) for matrix in values for row in matrix)
        found: dict[tuple[str, int], List] = {}
        for seed, matrix in enumerate(values):
            # The evaluation after k tasks is placed just before time k.
            points = [(max(k - 0.25, 0.0), row[i] / scale) for k, row in enumerate(matrix)]

            def last(low: float, high: float, points: List = points) -> float:
                return float([y for x, y in points if low < x < high][-1])

            for j in range(tasks):
                after = last(j, j + 1)
                if j > i:
                    found.setdefault(("forgetting", j), []).append(last(-math.inf, j) - after)
                if j < i:
                    before = last(0, j) if j > 0 else points[0][1]
                    found.setdefault(("transfer", j), []).append(after - before)
            for (name, _), entries in found.items():
                corners[name][seed].append(entries[-1])
        for (name, j), entries in found.items():
            tables[name][i][j] = mean(entries)
    return tables | {f"{name}_mean": mean([mean(entries) for entries in corners[name]]) for name in corners}


# google-deepmind/bsuite, bsuite/environments/bandit.py and bsuite/utils/plotting.py (ave_regret_score) at effafc01.
def regret(rewards: List, ceilings: List) -> float:
    """The total after the last episode divided by the number of episodes."""
    total, episodes = 0.0, 0
    for earned, ceiling in zip(rewards, ceilings, strict=True):
        for reward in earned:
            total += ceiling - reward
            episodes += 1
    return total / episodes


# google-research/rliable, rliable/metrics.py at 3ccd9f4d (aggregate_iqm: SciPy's trim_mean, which cuts int(n / 4)).
def iqm(values: List) -> float:
    """The interquartile mean."""
    ordered = sorted(values)
    for _ in range(int(0.25 * len(values))):
        ordered = ordered[1:-1]
    return mean(ordered)


# google-research/rliable, rliable/library.py at 3ccd9f4d (StratifiedBootstrap.update_indices: draws a seed for each
# cell of the table, within its column), and bashtage/arch, arch/bootstrap/base.py at 543f44cf (conf_int, "percentile").
def interval(table: List) -> List:
    """The bootstrap interval of the IQM of a table of seeds and tasks."""
    seeds, tasks = len(table), len(table[0])
    resamples = np.random.default_rng(0).integers(seeds, size=(DRAWS, seeds, tasks)).tolist()
    found = sorted(iqm([table[row[t]][t] for row in rows for t in range(tasks)]) for rows in resamples)
    ends = []
    for percent in (2.5, 97.5):
        rank = percent / 100 * (DRAWS - 1)
        low = math.floor(rank)
        ends.append(found[low] + (rank - low) * (found[low + 1] - found[low]))
    return ends


def draw(number: int) -> dict[str, Any]:
    """Draws several seeds of a lifetime; every other lifetime has episodes of several lengths."""
    rng = np.random.default_rng([2105, number])
    tasks, seeds = 2 + number % 7, 1 + number % 5
    steps = None
    if number % 2:
        cuts = [np.sort(rng.choice(np.arange(1, STEPS), rng.integers(2, 9), replace=False)) for _ in range(tasks)]
        steps = [np.diff([0, *cut, STEPS]).tolist() for cut in cuts]
    lengths = [8] * tasks if steps is None else [len(each) for each in steps]
    return {
        "values": rng.uniform(-0.3, 1.1, (seeds, tasks + 1, tasks)).round(3).tolist(),
        "curves": [[rng.uniform(-0.2, 1.0, n).round(3).tolist() for n in lengths] for _ in range(seeds)],
        "alone": [[rng.uniform(-0.2, 0.9, n).round(3).tolist() for n in lengths] for _ in range(seeds)],
        "steps": steps,
        "ceilings": rng.uniform(0.8, 2.0, tasks).round(3).tolist(),
    }


def main() -> None:
    """Writes the file."""
    cases = []
    for number in range(CASES):
        case = draw(number)
        values, data = case["values"], (case["values"], case["curves"], case["alone"], case["steps"])
        ends = [matrix[-1] for matrix in values]
        case["golden"] = {
            "continual_world": continual_world(*data),
            "coom": coom(*data),
            "gem": [gem(matrix) for matrix in values],
            "cora": cora(values),
            "regret": regret(case["curves"][0], case["ceilings"]),
            "iqm": iqm([value for row in ends for value in row]),
            "interval": interval(ends),
        }
        cases.append(case)
    rows = ",\n".join(json.dumps(case, separators=(",", ":")) for case in cases)
    FILE.write_text(f'{{"draws":{DRAWS},"cases":[\n{rows}\n]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
