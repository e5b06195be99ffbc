"""Writes mdp.json: distances of 1,000 drawn pairs of decision processes, by linear programs that SciPy solves. Only numbers that sum
them up are stored; `../mdp.rs` draws the same processes. Takes some minutes. Run: python make_mdp.py"""
import itertools
import json
import sys
from multiprocessing import Pool
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linear_sum_assignment, linprog
from scipy.sparse import lil_matrix

from split_mix import SplitMix64

EXACT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10, "presolve": False}


class Transports:
    """Many transport problems as one program; the marginals stay, the costs change."""

    def __init__(self, pairs):
        """`pairs`: (from, to) masses of each problem. Places without mass take no part."""
        self.pairs = [(np.flatnonzero(a), np.flatnonzero(b)) for a, b in pairs]
        sizes = [len(a) * len(b) for a, b in self.pairs]
        self.starts = np.concatenate([[0], np.cumsum(sizes)])
        rows = sum(len(a) + len(b) - 1 for a, b in self.pairs)
        sums, self.masses, row = lil_matrix((rows, self.starts[-1])), np.zeros(rows), 0
        for (a, b), start, (p, q) in zip(self.pairs, self.starts, pairs):
            for i, origin in enumerate(a):
                sums[row, start + i * len(b) : start + (i + 1) * len(b)] = 1
                self.masses[row] = p[origin]
                row += 1
            # The last column's sum follows from the others.
            for j, destination in enumerate(b[:-1]):
                sums[row, start + j : start + len(a) * len(b) : len(b)] = 1
                self.masses[row] = q[destination]
                row += 1
        self.sums = sums.tocsr()

    def costs(self, table):
        """What each problem costs at least, where `table` is what it costs from each place to each."""
        cost = np.concatenate([table[np.ix_(a, b)].ravel() for a, b in self.pairs])
        found = linprog(cost, A_eq=self.sums, b_eq=self.masses, method="highs-ds", options=EXACT)
        assert found.status == 0, found.message
        return np.add.reduceat(cost * found.x, self.starts[:-1])


def transport(p, q, table):
    return float(Transports([(p, q)]).costs(table)[0])


def process(rng, states, actions):
    rows, rewards = np.zeros((states, actions, states)), np.zeros((states, actions))
    for state in range(states):
        for action in range(actions):
            for _ in range(1 + rng.below(3)):
                successor = rng.below(states)
                rows[state, action, successor] += 1 + rng.below(8)
            rewards[state, action] = (rng.below(2001) - 1000) / 1000
    return rows / rows.sum(axis=2, keepdims=True), rewards


def bisimulation(a, b, share):
    (of_a, pays_a), (of_b, pays_b) = a, b
    actions = of_a.shape[1]
    places = [(s, t, k) for s in range(len(of_a)) for t in range(len(of_b)) for k in range(actions)]
    transports = Transports([(of_a[s, k], of_b[t, k]) for s, t, k in places])
    gaps = (1 - share) * np.array([abs(pays_a[s, k] - pays_b[t, k]) for s, t, k in places])
    d = np.zeros((len(of_a), len(of_b)))
    while True:
        following = (gaps + share * transports.costs(d)).reshape(len(of_a), len(of_b), actions).max(axis=2)
        left = share / (1 - share) * np.abs(following - d).max()
        d = following
        if left < 2e-11:
            return d


def values(process, discount):
    rows, rewards = process
    v = np.zeros(len(rows))
    while True:
        following = (rewards + discount * rows @ v).max(axis=1)
        if np.abs(following - v).max() < 1e-15:
            return following
        v = following


def pooled(a, b, weights, ground):
    """Successors and rewards of all states and actions in one heap each."""
    def heap(process):
        rows, rewards = process
        states, actions, _ = rows.shape
        return [
            (successor, rewards[state, action], weights[state] / actions * rows[state, action, successor])
            for state in range(states) for action in range(actions) for successor in range(states)
        ]

    of_a, of_b = heap(a), heap(b)
    table = np.array([[ground[s, t] + abs(r - u) for t, u, _ in of_b] for s, r, _ in of_a])
    return transport(np.array([mass for *_, mass in of_a]), np.array([mass for *_, mass in of_b]), table)


def drawn(seed):
    """What is drawn, and in which order, stands in `../mdp.rs`."""
    rng = SplitMix64(seed)
    of_a = 1 + rng.below(4)
    of_b = of_a if rng.below(2) == 0 else 1 + rng.below(4)
    actions, share = 1 + rng.below(3), (3 + 2 * rng.below(3)) / 10
    a, b = process(rng, of_a, actions), process(rng, of_b, actions)
    start_a, start_b = (np.array([1.0 + rng.below(5) for _ in range(n)]) for n in (of_a, of_b))
    start_a, start_b = start_a / start_a.sum(), start_b / start_b.sum()
    d = bisimulation(a, b, share)
    found = [
        d.mean(),
        max(d.min(axis=1).max(), d.min(axis=0).max()),
        transport(start_a, start_b, d),
        np.abs(values(a, share)).sum(),
    ]
    if of_a == of_b:
        pairs = linear_sum_assignment(d)
        pairings = [d[range(of_a), order] for order in itertools.permutations(range(of_a))]
        cheap = [pairing for pairing in pairings if pairing.mean() < d[pairs].mean() + 1e-9]
        ground = np.abs(np.arange(of_a)[:, None] - np.arange(of_a)[None, :]) / 2
        aligned = sum(
            start_a[s] / actions
            * (abs(a[1][s, k] - b[1][s, k]) + transport(a[0][s, k], b[0][s, k], ground))
            for s in range(of_a) for k in range(actions)
        )
        found += [d[pairs].mean(), min(pairing.max() for pairing in cheap), aligned, pooled(a, b, start_a, ground)]
    return [round(float(value), 11) for value in found]


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with Pool(2) as pool:
        cases = pool.map(drawn, range(count), chunksize=10)
    document = {"made_by": {"numpy": np.__version__, "scipy": scipy.__version__}, "cases": cases}
    Path(__file__).with_name("mdp.json").write_text(json.dumps(document, separators=(",", ":")) + "\n")
