"""Writes mdp.json: distances of 1,000 random pairs of deterministic decision processes, by linear programs
that SciPy solves. Only summary numbers are stored; `../mdp.rs` draws the same processes. Takes some minutes. Run: python make_mdp.py"""
import json
import sys
from multiprocessing import Pool
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linprog
from scipy.sparse import lil_matrix

from split_mix import SplitMix64

EXACT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10, "presolve": False}


class Transports:
    """Many transport problems as one linear program with fixed marginals and variable costs."""

    def __init__(self, pairs):
        """`pairs`: (from, to) masses of each problem. Positions without mass are ignored."""
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
        """The minimum cost of each problem; `table` holds the cost from each position to each."""
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
            rows[state, action, rng.below(states)] = 1
            rewards[state, action] = (rng.below(2001) - 1000) / 1000
    return rows, rewards


def bisimulation(a, b, discount):
    (transitions_a, rewards_a), (transitions_b, rewards_b) = a, b
    actions = transitions_a.shape[1]
    triples = [(s, t, k) for s in range(len(transitions_a)) for t in range(len(transitions_b)) for k in range(actions)]
    transports = Transports([(transitions_a[s, k], transitions_b[t, k]) for s, t, k in triples])
    gaps = (1 - discount) * np.array([abs(rewards_a[s, k] - rewards_b[t, k]) for s, t, k in triples])
    d = np.zeros((len(transitions_a), len(transitions_b)))
    while True:
        next_d = (gaps + discount * transports.costs(d)).reshape(len(transitions_a), len(transitions_b), actions).max(axis=2)
        error = discount / (1 - discount) * np.abs(next_d - d).max()
        d = next_d
        if error < 2e-11:
            return d


def w1(a, b, unit, counted, ground):
    """The mean, over counted states and actions, of the difference in reward plus the transport distance of successors."""
    (transitions_a, rewards_a), (transitions_b, rewards_b) = a, b
    distances = [
        abs(rewards_a[s, k] - rewards_b[s, k]) / unit + transport(transitions_a[s, k], transitions_b[s, k], ground)
        for s in np.flatnonzero(counted) for k in range(transitions_a.shape[1])
    ]
    return np.mean(distances)


def distances_for_seed(seed):
    """`../mdp.rs` documents the draws and their order."""
    rng = SplitMix64(seed)
    num_states_a = 1 + rng.below(6)
    num_states_b = num_states_a if rng.below(2) == 0 else 1 + rng.below(6)
    actions, discount = 1 + rng.below(3), (3 + 2 * rng.below(3)) / 10
    a, b = process(rng, num_states_a, actions), process(rng, num_states_b, actions)
    unit = (1 + rng.below(4)) / 4
    counted = [rng.below(2) == 1 or state == 0 for state in range(num_states_a)]
    found = [bisimulation(a, b, discount).mean()]
    if num_states_a == num_states_b:
        ground = np.abs(np.arange(num_states_a)[:, None] - np.arange(num_states_a)[None, :]) / 2
        found.append(w1(a, b, unit, counted, ground))
    return [round(float(value), 11) for value in found]


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with Pool(2) as pool:
        cases = pool.map(distances_for_seed, range(count), chunksize=10)
    document = {"made_by": {"numpy": np.__version__, "scipy": scipy.__version__}, "cases": cases}
    Path(__file__).with_name("mdp.json").write_text(json.dumps(document, separators=(",", ":")) + "\n")
