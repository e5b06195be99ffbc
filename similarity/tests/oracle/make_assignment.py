"""Writes assignment.json: cost matrices and the minimum sums that scipy finds. Run: python make_assignment.py"""
import json
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linear_sum_assignment

rng = np.random.default_rng(5)
cases = []


def add(description, costs):
    rows, columns = linear_sum_assignment(costs)
    cases.append({
        "description": description,
        "rows": costs.shape[0],
        "columns": costs.shape[1],
        "costs": costs.ravel().tolist(),
        "total": float(costs[rows, columns].sum()),
    })


for shape in [(1, 1), (2, 2), (5, 5), (20, 20), (3, 9), (9, 3), (1, 12), (12, 1), (40, 25), (25, 40)]:
    add(f"uniform {shape}", rng.random(shape).round(6))
    add(f"whole numbers with many ties {shape}", rng.integers(0, 4, shape).astype(float))
    add(f"negative too {shape}", rng.normal(size=shape).round(6))
    a, b = rng.random((shape[0], 2)), rng.random((shape[1], 2))
    add(f"points of a square {shape}", np.linalg.norm(a[:, None] - b[None], axis=2).round(9))
rows = np.arange(1, 21)
add("products of row and column, where bidding takes longest", np.outer(rows, rows).astype(float))
add("the same from the far end", -np.outer(rows, rows).astype(float))
add("six orders of magnitude", (10.0 ** rng.uniform(-3, 3, (20, 20))).round(9))
add("a block that is nearly forbidden", np.where(rng.random((15, 15)) < 0.7, 1e9, rng.random((15, 15)).round(6)))

document = {"made_by": {"numpy": np.__version__, "scipy": scipy.__version__}, "cases": cases}
Path(__file__).with_name("assignment.json").write_text(json.dumps(document) + "\n")
