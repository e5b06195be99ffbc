"""Computes the probability of improvement with whole runs resampled, with numpy; writes repeats_whole_runs.json beside this file.

Usage: python repeats_whole_runs.py   (a few seconds)
The JSON names the numpy version used. Scores are (runs, strata); null where a run lacks the score of a stratum.

Each agent's runs are drawn once per resample, for all strata together. If either agent drew no score in a stratum, the
resample's mean leaves that stratum out, and the stratum's own interval leaves that resample out; a resample without any
stratum does not count.
"""

import json
from pathlib import Path

import numpy as np

RESAMPLES = 400_000
SEED = 20240608

draw = np.random.default_rng(SEED)


def drawn_counts(num_runs):
    """How often each run is drawn, per resample: (resamples, runs)."""
    drawn = draw.integers(num_runs, size=(RESAMPLES, num_runs))
    return np.stack([(drawn == run).sum(axis=1) for run in range(num_runs)], axis=1)


def probabilities(counts_a, counts_b, a, b):
    """Share of drawn pairs that A wins, ties counted as half; NaN where there is no pair: (resamples, strata)."""
    columns = []
    for of_a, of_b in zip(a.T, b.T):
        has_a, has_b = ~np.isnan(of_a), ~np.isnan(of_b)
        wins = (1 + np.sign(of_a[has_a][:, None] - of_b[has_b][None, :])) / 2
        won = np.einsum("ni,ij,nj->n", counts_a[:, has_a], wins, counts_b[:, has_b])
        pairs = counts_a[:, has_a].sum(axis=1) * counts_b[:, has_b].sum(axis=1)
        columns.append(np.where(pairs > 0, won / np.maximum(pairs, 1), np.nan))
    return np.stack(columns, axis=1)


def of_strata_and_mean(found):
    """The columns of strata, then the mean over those that are not NaN."""
    present = ~np.isnan(found)
    found = found[present.any(axis=1)]
    mean = np.nansum(found, axis=1) / (~np.isnan(found)).sum(axis=1)
    return [*found.T, mean]


def ends(values):
    return np.nanpercentile(values, [2.5, 97.5]).tolist()


def like_a_run(num_runs, num_strata, shift):
    """Scores with an offset per run that is the same in all strata, like the effect of a lifetime's seed."""
    return shift + draw.normal(size=(num_runs, 1)) + 0.4 * draw.normal(size=(num_runs, num_strata))


def lacking(scores, share):
    """The scores with some removed; the first run keeps all."""
    holes = draw.uniform(size=scores.shape) < share
    holes[0] = False
    return np.where(holes, np.nan, scores)


pairs = {
    "runs that move all strata alike": (like_a_run(8, 5, 0.5), like_a_run(6, 5, 0.0)),
    "tied scores": (np.round(like_a_run(7, 3, 0.2)), np.round(like_a_run(7, 3, 0.0))),
    "runs that lack scores": (lacking(like_a_run(6, 4, 0.4), 0.4), lacking(like_a_run(5, 4, 0.0), 0.4)),
    "strata of few runs": (lacking(like_a_run(5, 3, 0.0), 0.6), lacking(like_a_run(5, 3, 0.0), 0.6)),
    "one stratum": (like_a_run(9, 1, 0.3), like_a_run(7, 1, 0.0)),
}
comparisons = []
for name, (a, b) in pairs.items():
    once = probabilities(np.ones((1, len(a))), np.ones((1, len(b))), a, b)
    drawn = probabilities(drawn_counts(len(a)), drawn_counts(len(b)), a, b)
    comparisons.append(
        {
            "name": name,
            "a": np.where(np.isnan(a), None, a).tolist(),
            "b": np.where(np.isnan(b), None, b).tolist(),
            "values": [float(column[0]) for column in of_strata_and_mean(once)],
            "ends": [ends(column) for column in of_strata_and_mean(drawn)],
            "resamples_of_strata": (~np.isnan(drawn)).sum(axis=0).tolist(),
        }
    )

text = json.dumps({"made_with": f"numpy {np.__version__}", "resamples": RESAMPLES, "comparisons": comparisons})
Path(__file__).with_suffix(".json").write_text(text + "\n")
