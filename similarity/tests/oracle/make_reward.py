"""Writes reward.json: EPIC of rewards on a 3 x 3 grid and of 1,000 random rewards, by NumPy from the definitions of Gleave et al.
(2021) and of `tabular.py` in HumanCompatibleAI/evaluating-rewards. Uses long doubles, because 1 - r of nearly equal rewards would lose half
the digits of a double. Only distances are stored; `../reward.rs` draws the same rewards. Run: python make_reward.py"""
import json
from pathlib import Path

import numpy as np

from split_mix import SplitMix64

REAL = np.longdouble


def mean(values, weights):
    return (values * weights).sum() / weights.sum()


def canonical(reward, discount, of_states, of_actions):
    """R + E[g R(s', A, S') - R(s, A, S') - g R(S, A, S')]."""
    of_states, of_actions = of_states / of_states.sum(), of_actions / of_actions.sum()
    from_state = np.einsum("sat,a,t->s", reward, of_actions, of_states)
    overall = (from_state * of_states).sum()
    return reward + discount * from_state[None, None, :] - from_state[:, None, None] - discount * overall


def pearson_distance(a, b, weights):
    a, b = a - mean(a, weights), b - mean(b, weights)
    with np.errstate(invalid="ignore"):
        r = mean(a * b, weights) / (np.sqrt(mean(a * a, weights)) * np.sqrt(mean(b * b, weights)))
    return float(np.sqrt((1 - np.minimum(r, REAL(1))) / 2))


def shaped(reward, potential, discount):
    return reward + discount * potential[None, None, :] - potential[:, None, None]


def grid(rows):
    return np.array(rows, dtype=REAL).ravel()


# gridworld_rewards.py: rewards of states, and potentials, row after row of the grid.
GOAL = grid([[0, 0, 0], [0, 0, 0], [0, 0, 1]])
TO_GOAL = grid([[4, 3, 2], [3, 2, 1], [2, 1, 0]])
NONE = np.zeros(9, dtype=REAL)
GRID_REWARDS = {
    "sparse_goal": (GOAL, NONE),
    "sparse_goal_shift": (GOAL + 1, NONE),
    "sparse_goal_scale": (GOAL * 10, NONE),
    "dense_goal": (GOAL, -TO_GOAL),
    "antidense_goal": (GOAL, TO_GOAL),
    "transformed_goal": (GOAL * 4 - 1, -TO_GOAL * 3),
    "center_goal": (grid([[0, 0, 0], [0, 1, 0], [0, 0, 0]]), NONE),
    "dirt_path": (grid([[0, -1, -1], [0, 0, 0], [-1, -1, 4]]), NONE),
    "cliff_walk": (grid([[0, -1, -1], [0, 0, 0], [-4, -4, 4]]), NONE),
    "sparse_penalty": (-GOAL, NONE),
    "zero": (NONE, NONE),
}
DISCOUNT = REAL(99) / 100


def walks():
    """1 for each move on a 3 x 3 grid: left, right, up, down, stay; moves against the edge stay."""
    weights = np.zeros((9, 5, 9), dtype=REAL)
    for state in range(9):
        row, column = divmod(state, 3)
        for action, (down, right) in enumerate([(0, -1), (0, 1), (-1, 0), (1, 0), (0, 0)]):
            to = (row + down, column + right)
            inside = 0 <= to[0] < 3 and 0 <= to[1] < 3
            weights[state, action, 3 * to[0] + to[1] if inside else state] = 1
    return weights


def on_the_grid(weights):
    tables = [
        shaped(np.tile(reward[:, None, None], (1, 5, 9)), potential, DISCOUNT)
        for reward, potential in GRID_REWARDS.values()
    ]
    canonical_tables = [canonical(table, DISCOUNT, np.ones(9, dtype=REAL), np.ones(5, dtype=REAL)) for table in tables]
    found = [[pearson_distance(a, b, weights) for b in canonical_tables] for a in canonical_tables]
    return [[None if np.isnan(value) else value for value in row] for row in found]


def drawn(seed):
    """The distance between two random tables; `../reward.rs` documents the draws and their order."""
    rng = SplitMix64(seed)
    states, actions, discount = 2 + rng.below(4), 1 + rng.below(3), REAL(rng.below(101)) / 100
    is_near = rng.below(4) == 0
    shape = (states, actions, states)
    size = states * actions * states
    a = [rng.below(2001) - 1000 for _ in range(size)]
    b = [a[k] + rng.below(11) - 5 if is_near else rng.below(2001) - 1000 for k in range(size)]
    a, b = (np.array(values, dtype=REAL).reshape(shape) / 1000 for values in (a, b))
    of_states = np.array([1 + rng.below(3) for _ in range(states)], dtype=REAL)
    of_actions = np.array([1 + rng.below(3) for _ in range(actions)], dtype=REAL)
    if rng.below(2) == 0:
        weights = np.einsum("s,a,t->sat", of_states, of_actions, of_states)
    else:
        weights = np.array([1 + rng.below(5) for _ in range(size)], dtype=REAL).reshape(shape)
    a, b = (canonical(table, discount, of_states, of_actions) for table in (a, b))
    return pearson_distance(a, b, weights)


document = {
    "made_by": {"numpy": np.__version__},
    "names": list(GRID_REWARDS),
    "discount": float(DISCOUNT),
    "by_walks": on_the_grid(walks()),
    "by_all": on_the_grid(np.ones((9, 5, 9), dtype=REAL)),
    "drawn": [round(drawn(seed), 12) for seed in range(1000)],
}
Path(__file__).with_name("reward.json").write_text(json.dumps(document) + "\n")
