"""Writes orders.json: the path that OR-Tools' routing finds through 1,000 points.

Run in this folder: python make_orders.py [seconds for OR-Tools, 30 by default]
Points come from SplitMix64, so that the tests can generate them, too. OR-Tools finds round trips only: the open path is
a round trip through one more point at distance 0 from all others.
"""

import json
import math
import sys
import time

import numpy as np
import ortools
from ortools.constraint_solver import pywrapcp, routing_enums_pb2

MASK = 2**64 - 1


def units(seed, count):
    """Numbers in 0..1: SplitMix64's upper 53 bits."""
    numbers = []
    for _ in range(count):
        seed = (seed + 0x9E3779B97F4A7C15) & MASK
        z = seed
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        numbers.append(((z ^ (z >> 31)) >> 11) / 2**53)
    return numbers


def distances(seed, count):
    flat = units(seed, 2 * count)
    points = list(zip(flat[::2], flat[1::2]))
    return np.array([[math.hypot(a[0] - b[0], a[1] - b[1]) for b in points] for a in points])


def routing(matrix, seconds):
    n = len(matrix)
    costs = np.zeros((n + 1, n + 1), dtype=np.int64)
    costs[:n, :n] = np.rint(matrix * 1e6)
    manager = pywrapcp.RoutingIndexManager(n + 1, 1, n)
    model = pywrapcp.RoutingModel(manager)
    model.SetArcCostEvaluatorOfAllVehicles(model.RegisterTransitMatrix(costs.tolist()))
    search = pywrapcp.DefaultRoutingSearchParameters()
    search.first_solution_strategy = routing_enums_pb2.FirstSolutionStrategy.PATH_CHEAPEST_ARC
    search.local_search_metaheuristic = routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    search.time_limit.FromSeconds(seconds)
    start = time.process_time()
    found = model.SolveWithParameters(search)
    spent = time.process_time() - start
    path, index = [], found.Value(model.NextVar(model.Start(0)))
    while not model.IsEnd(index):
        path.append(manager.IndexToNode(index))
        index = found.Value(model.NextVar(index))
    assert sorted(path) == list(range(n))
    length = sum(matrix[a, b] for a, b in zip(path, path[1:]))
    return {"seed": 1, "points": n, "length": length, "wall_seconds": seconds, "processor_seconds": round(spent, 1)}


seconds = int(sys.argv[1]) if len(sys.argv) > 1 else 30
document = {
    "tools": {
        "python": sys.version.split()[0],
        "numpy": np.__version__,
        "ortools": ortools.__version__,
    },
    "routing": routing(distances(1, 1000), seconds),
}
json.dump(document, open("orders.json", "w"), indent=1)
print(document["routing"])
