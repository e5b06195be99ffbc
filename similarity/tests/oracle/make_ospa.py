"""Writes ospa.json: OSPA of order 1 of small sets of objects, by its formula with scipy's assignment. Run: python make_ospa.py"""
import json
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linear_sum_assignment

rng = np.random.default_rng(7)
cases = []


def objects(count, classes):
    return [[int(rng.integers(classes)), *rng.uniform(-10, 10, 2).round(3).tolist()] for _ in range(count)]


def least_sum(a, b, cut_off):
    """Minimum sum over all pairings; objects of different classes are a cut-off apart."""
    if not a or not b:
        return 0.0
    x, y = np.array(a), np.array(b)
    costs = np.minimum(np.linalg.norm(x[:, None, 1:] - y[None, :, 1:], axis=2), cut_off)
    costs[x[:, None, 0] != y[None, :, 0]] = cut_off
    rows, columns = linear_sum_assignment(costs)
    return costs[rows, columns].sum()


for m, n in [(0, 0), (0, 3), (1, 1), (4, 4), (3, 7), (7, 3), (20, 20), (12, 30)]:
    for classes in (1, 3):
        for cut_off in (5.0, 2.0, 30.0):
            a, b = objects(m, classes), objects(n, classes)
            mean = (least_sum(a, b, cut_off) + cut_off * abs(m - n)) / max(m, n, 1)
            cases.append({"cut_off": cut_off, "a": a, "b": b, "ospa": float(mean)})

document = {"made_by": {"numpy": np.__version__, "scipy": scipy.__version__}, "cases": cases}
Path(__file__).with_name("ospa.json").write_text(json.dumps(document) + "\n")
