"""Writes ospa.json: OSPA and GOSPA of small sets of objects, by their formulas around scipy's assignment. Run: python make_ospa.py"""
import json
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linear_sum_assignment

rng = np.random.default_rng(7)
cases = []


def objects(count, classes):
    return [[int(rng.integers(classes)), *rng.uniform(-10, 10, 2).round(3).tolist()] for _ in range(count)]


def sums(a, b, cut_off, order):
    """Least sum over one table of all objects: those of different classes are a cut-off apart."""
    if not a or not b:
        return 0.0
    x, y = np.array(a), np.array(b)
    far = np.minimum(np.linalg.norm(x[:, None, 1:] - y[None, :, 1:], axis=2), cut_off)
    far[x[:, None, 0] != y[None, :, 0]] = cut_off
    powers = far**order
    rows, columns = linear_sum_assignment(powers)
    return powers[rows, columns].sum()


for m, n in [(0, 0), (0, 3), (1, 1), (4, 4), (3, 7), (7, 3), (20, 20), (12, 30)]:
    for classes in (1, 3):
        for cut_off, order in [(5.0, 1.0), (2.0, 2.0), (30.0, 3.5)]:
            a, b = objects(m, classes), objects(n, classes)
            least, alone = sums(a, b, cut_off, order), abs(m - n)
            mean = (least + cut_off**order * alone) / max(m, n, 1)
            total = least + cut_off**order / 2 * alone
            cases.append({"cut_off": cut_off, "order": order, "a": a, "b": b,
                          "ospa": float(mean ** (1 / order)), "gospa": float(total ** (1 / order))})

document = {"made_by": {"numpy": np.__version__, "scipy": scipy.__version__}, "cases": cases}
Path(__file__).with_name("ospa.json").write_text(json.dumps(document) + "\n")
