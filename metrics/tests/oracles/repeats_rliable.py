"""Computes aggregates, intervals and comparisons of random score tables with rliable; writes repeats_rliable.json beside this file.

Usage: python repeats_rliable.py   (takes a few minutes: rliable calls scipy for every stratum of every resample)
Made with the versions that the JSON names. Scores are (runs, strata), as rliable takes them.

Each end of an interval is given as its mean over several seeds of rliable's bootstrap.
"""

import json
from importlib.metadata import version
from pathlib import Path

import numpy as np
from rliable import library, metrics

RESAMPLES = {"aggregates": 50_000, "improvement": 20_000}
SEEDS = {"aggregates": 6, "improvement": 3}


def aggregates(scores):
    return np.array(
        [
            metrics.aggregate_mean(scores),
            metrics.aggregate_median(scores),
            metrics.aggregate_iqm(scores),
        ]
    )


def ends(arrays, function, kind):
    """Mean over seeds of the ends of 95 % intervals: (2, values)."""
    found = []
    for seed in range(SEEDS[kind]):
        np.random.seed(seed)
        data = {"x": arrays[0] if len(arrays) == 1 else arrays}
        _, intervals = library.get_interval_estimates(data, function, reps=RESAMPLES[kind])
        found.append(intervals["x"])
    return np.mean(found, axis=0).tolist()


draw = np.random.default_rng(20240607)
tables = {
    "ten runs of ten strata": draw.normal(size=(10, 10)),
    "five runs of three strata": draw.lognormal(size=(5, 3)),
    "three runs of seven strata": draw.uniform(-2, 1, size=(3, 7)),
    "one stratum": draw.normal(50, 10, size=(12, 1)),
    "outliers": np.where(draw.uniform(size=(8, 6)) < 0.1, 1000.0, draw.normal(size=(8, 6))),
}
cases = []
for name, scores in tables.items():
    cases.append(
        {
            "name": name,
            "scores": scores.tolist(),
            "values": aggregates(scores).tolist(),
            "ends": ends([scores], aggregates, "aggregates"),
        }
    )

pairs = {
    "better": (draw.normal(0.5, 1, size=(8, 4)), draw.normal(size=(6, 4))),
    "ties": (draw.integers(0, 4, size=(9, 3)).astype(float), draw.integers(0, 4, size=(9, 3)).astype(float)),
}
comparisons = []
for name, (a, b) in pairs.items():
    def improvement(a, b):
        return np.array([metrics.probability_of_improvement(a, b)])

    comparisons.append(
        {
            "name": name,
            "a": a.tolist(),
            "b": b.tolist(),
            "value": float(improvement(a, b)[0]),
            "strata": [float(improvement(a[:, [k]], b[:, [k]])[0]) for k in range(a.shape[1])],
            "ends": ends([a, b], improvement, "improvement"),
        }
    )

made_with = ", ".join(f"{name} {version(name)}" for name in ["rliable", "arch", "scipy", "numpy"])
text = json.dumps(
    {
        "made_with": made_with,
        "resamples": RESAMPLES,
        "seeds": SEEDS,
        "cases": cases,
        "comparisons": comparisons,
    }
)
Path(__file__).with_suffix(".json").write_text(text + "\n")
