"""Writes distributions.json: mean, variance, cumulative function and quantiles of every family of numbers, by scipy.

Made with scipy 1.17: python distributions.py > distributions.json
"""

import json
import math

import numpy as np
from scipy import stats

PROBABILITIES = [1e-9, 1e-4, 0.05, 0.25, 0.5, 0.7, 0.95, 0.9999, 1 - 1e-9]


def case(family, fields, law, discrete=False):
    """One distribution with scipy's values."""
    quantiles = [[p, float(law.ppf(p))] for p in PROBABILITIES]
    points = sorted({q for _, q in quantiles if math.isfinite(q)})
    if not discrete:
        points = sorted(set(points + [(a + b) / 2 for a, b in zip(points, points[1:])]))
    return {
        "distribution": {family: fields},
        "mean": float(law.mean()),
        "variance": float(law.var()),
        "cdf": [[x, float(law.cdf(x))] for x in points],
        "quantile": quantiles,
    }


def cases():
    """Every family of numbers that scipy has, with usual and extreme parameters."""
    for low, high in [(0, 1), (-3, 5), (1e6, 1e6 + 1e-3)]:
        yield case("uniform", {"low": low, "high": high}, stats.uniform(low, high - low))
    for low, high in [(0, 0), (-2, 3), (0, 1000)]:
        yield case("integer_uniform", {"low": low, "high": high}, stats.randint(low, high + 1), True)
    for mean, std in [(0, 1), (-4, 0.01), (1e5, 3e3)]:
        yield case("normal", {"mean": mean, "std": std}, stats.norm(mean, std))
    for mean, std, low, high in [(0, 1, -1, 2), (2, 3, 0, 100), (0, 1, 3, 9), (0, 1, -9, -4), (0, 1, 5, 5.5)]:
        law = stats.truncnorm((low - mean) / std, (high - mean) / std, mean, std)
        yield case("truncated_normal", {"mean": mean, "std": std, "low": low, "high": high}, law)
    for mu, sigma in [(0, 1), (2, 0.1), (-3, 2)]:
        yield case("log_normal", {"mu": mu, "sigma": sigma}, stats.lognorm(sigma, scale=math.exp(mu)))
    for rate in [1, 0.01, 300]:
        yield case("exponential", {"rate": rate}, stats.expon(scale=1 / rate))
    for alpha, beta, low, high in [(2, 5, 0, 1), (0.5, 0.5, 0, 1), (1, 1, -2, 2), (50, 3, 10, 20), (400, 700, 0, 1)]:
        law = stats.beta(alpha, beta, low, high - low)
        yield case("beta", {"alpha": alpha, "beta": beta, "low": low, "high": high}, law)
    for low, mode, high in [(0, 0.3, 1), (-5, -5, 5), (0, 2, 2)]:
        law = stats.triang((mode - low) / (high - low), low, high - low)
        yield case("triangular", {"low": low, "mode": mode, "high": high}, law)
    for n, p in [(4, 0.5), (30, 0.01), (1000, 0.3), (100_000, 0.9), (7, 0)]:
        yield case("binomial", {"n": n, "p": p}, stats.binom(n, p), True)
    for mean in [0.1, 4, 60, 500, 100_000]:
        yield case("poisson", {"mean": mean}, stats.poisson(mean), True)
    for p in [0.83, 0.5, 0.001]:
        # scipy counts trials; Driftworld counts failures before the first success.
        yield case("geometric", {"p": p}, stats.geom(p, loc=-1), True)
    for p in [0.2, 0.5, 1]:
        yield case("bernoulli", {"p": p}, stats.bernoulli(p), True)


if __name__ == "__main__":
    found = [c for c in cases()]
    for c in found:
        c["quantile"] = [[p, q] for p, q in c["quantile"] if np.isfinite(q)]
    print("[\n" + ",\n".join(json.dumps(c) for c in found) + "\n]")
