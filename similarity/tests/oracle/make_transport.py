"""Writes transport.json: costs of moving masses and points by POT. Run: python make_transport.py"""
import json
from pathlib import Path

import numpy as np
import ot
import scipy

rng = np.random.default_rng(7)


def masses(n):
    mass = rng.random(n).round(6)
    if n > 3:
        mass[rng.integers(n)] = 0.0
    return mass / mass.sum()


plans = []
for n, m in [(1, 1), (1, 6), (2, 2), (5, 3), (8, 8), (20, 31), (40, 40), (60, 15)]:
    for kind in ["uniform", "ties", "negative", "plane"]:
        cost = {
            "uniform": lambda: rng.random((n, m)).round(6),
            "ties": lambda: rng.integers(0, 4, (n, m)).astype(float),
            "negative": lambda: rng.normal(size=(n, m)).round(6),
            "plane": lambda: ot.dist(rng.random((n, 2)), rng.random((m, 2)), metric="euclidean").round(9),
        }[kind]()
        a, b = masses(n), masses(m)
        plans.append({
            "description": f"{kind} {n} x {m}",
            "from": a.tolist(),
            "to": b.tolist(),
            "costs": cost.ravel().tolist(),
            "cost": float(ot.emd2(a, b, cost, numItermax=10**7)),
        })

points = []
for n, m in [(1, 1), (1, 5), (4, 4), (7, 3), (20, 20), (20, 30), (50, 50)]:
    for spread in [1.0, 60.0]:
        a, b = (rng.random((k, 2)).round(6) * spread for k in (n, m))
        cost = ot.dist(a, b, metric="euclidean")
        points.append({
            "a": a.tolist(),
            "b": b.tolist(),
            "earth_movers": float(ot.emd2([], [], cost, numItermax=10**7)),
        })

document = {
    "made_by": {"numpy": np.__version__, "scipy": scipy.__version__, "pot": ot.__version__},
    "plans": plans,
    "points": points,
}
Path(__file__).with_name("transport.json").write_text(json.dumps(document) + "\n")
