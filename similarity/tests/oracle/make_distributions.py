"""Writes distributions.json: pairs of declared distributions and their distances by scipy and POT.

Run: python make_distributions.py

Traps: scipy's energy_distance is the root, its jensenshannon is the root and in nats; ot.wasserstein_1d(p=2) is the square;
ot.wasserstein_circle counts in turns. Densities are integrated by Gauss–Legendre quadrature with 40 nodes between many
break points: a quantile for every power of ten of the probability, on either side.
"""
import json
from pathlib import Path

import numpy as np
import ot
import scipy
from scipy import stats
from scipy.spatial.distance import jensenshannon
from scipy.special import xlogy

SCIPY = {
    "uniform": lambda low, high: stats.uniform(low, high - low),
    "normal": lambda mean, std: stats.norm(mean, std),
    "truncated_normal": lambda mean, std, low, high: stats.truncnorm((low - mean) / std, (high - mean) / std, mean, std),
    "log_normal": lambda mu, sigma: stats.lognorm(sigma, scale=np.exp(mu)),
    "exponential": lambda rate: stats.expon(scale=1 / rate),
    "beta": lambda alpha, beta, low=0, high=1: stats.beta(alpha, beta, low, high - low),
    "triangular": lambda low, mode, high: stats.triang((mode - low) / (high - low), low, high - low),
    "bernoulli": lambda p: stats.bernoulli(p),
    "binomial": lambda n, p: stats.binom(n, p),
    "poisson": lambda mean: stats.poisson(mean),
    "geometric": lambda p: stats.geom(p, loc=-1),
    "integer_uniform": lambda low, high: stats.randint(low, high + 1),
}

CONTINUOUS = [
    {"uniform": {"low": -1, "high": 2}},
    {"uniform": {"low": 0.5, "high": 6}},
    {"normal": {"mean": 0.5, "std": 1.25}},
    {"normal": {"mean": 3, "std": 0.4}},
    {"truncated_normal": {"mean": 1, "std": 2, "low": 0, "high": 4}},
    {"truncated_normal": {"mean": -1, "std": 1, "low": 0, "high": 3}},
    {"log_normal": {"mu": 0.2, "sigma": 0.5}},
    {"log_normal": {"mu": -0.5, "sigma": 1}},
    {"exponential": {"rate": 0.5}},
    {"exponential": {"rate": 2}},
    {"beta": {"alpha": 2, "beta": 5}},
    {"beta": {"alpha": 0.5, "beta": 0.7, "low": 0, "high": 3}},
    {"beta": {"alpha": 30, "beta": 4, "low": 0, "high": 5}},
    {"triangular": {"low": -1, "mode": 2, "high": 4}},
]
COUNTS = [
    {"bernoulli": {"p": 0.3}},
    {"binomial": {"n": 12, "p": 0.4}},
    {"binomial": {"n": 7, "p": 0.9}},
    {"poisson": {"mean": 3.5}},
    {"poisson": {"mean": 40}},
    {"geometric": {"p": 0.25}},
    {"integer_uniform": {"low": -2, "high": 6}},
]


def frozen(declared):
    (name, numbers), = declared.items()
    return SCIPY[name](**numbers)


def infinite_as_text(x):
    return "infinite" if np.isinf(x) else float(x)


NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)
TAILS = 10.0 ** -np.arange(1, 16)
CHANCES = np.concatenate([TAILS[::-1], [0.25, 0.5, 0.75], 1 - TAILS])


def pieces(f, points):
    low, high = np.asarray(points[:-1], dtype=float), np.asarray(points[1:], dtype=float)
    # Skips intervals too narrow to separate the nodes; their contribution is negligible.
    fine = high - low > 5e-13 * np.maximum(abs(low), abs(high))
    half, middle = (high - low)[fine] / 2, (high + low)[fine] / 2
    values = f((middle[:, None] + half[:, None] * NODES).ravel()).reshape(-1, len(NODES))
    return float((values @ WEIGHTS * half).sum())


def break_points(*laws):
    points = {float(x) for law in laws for x in law.ppf(CHANCES)}
    points |= {float(x) for law in laws for x in law.support() if np.isfinite(x)}
    # The modes of the triangular distributions are whole numbers.
    points |= {float(x) for x in range(-1, 7)}
    return sorted(points)


def crossings(gap, points):
    """The points, and the zeros of the gap between them."""
    found = list(points)
    ends = np.asarray(points, dtype=float)
    grids = ends[:-1, None] + np.diff(ends)[:, None] * np.linspace(1e-6, 1 - 1e-6, 100)
    for grid, signs in zip(grids, gap(grids.ravel()).reshape(grids.shape)):
        for k in np.flatnonzero(signs[:-1] * signs[1:] < 0):
            found.append(scipy.optimize.brentq(gap, grid[k], grid[k + 1], xtol=1e-13))
        found += grid[signs == 0].tolist() if np.any(signs) else []
    return sorted(found)


def densities(a, b):
    points = break_points(a, b)
    split = crossings(lambda x: a.pdf(x) - b.pdf(x), points)
    f, g = a.pdf, b.pdf

    def js(x):
        # Densities that underflow would give 0 times an infinite logarithm.
        p, q = (np.where(density > 1e-250, density, 0.0) for density in (f(x), g(x)))
        m = np.where(p + q > 0, (p + q) / 2, 1.0)
        return 0.5 * (xlogy(p, p / m) + xlogy(q, q / m)) / np.log(2)

    (a_low, a_high), (b_low, b_high) = a.support(), b.support()
    inside = a_low >= b_low and a_high <= b_high
    kl = pieces(lambda x: np.where(f(x) == 0, 0.0, f(x) * (a.logpdf(x) - b.logpdf(x))), points) if inside else np.inf
    return {
        "total_variation": pieces(lambda x: abs(f(x) - g(x)) / 2, split),
        "hellinger": np.sqrt(pieces(lambda x: (np.sqrt(f(x)) - np.sqrt(g(x))) ** 2 / 2, points)),
        "jensen_shannon": np.sqrt(pieces(js, split)),
        "kullback_leibler": infinite_as_text(kl),
    }


def transport(a, b):
    points = break_points(a, b)
    # In the upper tail, one minus a CDF is mostly rounding error, so survival functions are compared.
    gap = lambda x: np.where(a.cdf(x) > 0.5, b.sf(x) - a.sf(x), a.cdf(x) - b.cdf(x))
    if a.dist.name in COUNT_NAMES and b.dist.name in COUNT_NAMES:
        xs = np.arange(-5, 200)
        w1, square = np.abs(gap(xs)).sum(), (gap(xs) ** 2).sum()
    else:
        whole = [float(x) for x in range(-3, 120)] if {a.dist.name, b.dist.name} & COUNT_NAMES else []
        points = sorted({*points, *whole})
        split = crossings(gap, points)
        w1 = pieces(lambda x: abs(gap(x)), split)
        square = pieces(lambda x: gap(x) ** 2, points)
    return {"wasserstein_1": float(w1), "energy": float(np.sqrt(2 * square))}


COUNT_NAMES = {"bernoulli", "binom", "poisson", "geom", "randint"}


def quantiles(a, b):
    points = np.array(break_points(a, b) + ([float(x) for x in range(-5, 200)] if {a.dist.name, b.dist.name} & COUNT_NAMES else []))
    halves = []
    # The upper half uses survival functions, so that its tail keeps its precision.
    for cumulative, inverse in (("cdf", "ppf"), ("sf", "isf")):
        chances = {0.5, *TAILS.tolist()} | {float(u) for law in (a, b) for u in getattr(law, cumulative)(points)}
        chances = sorted(u for u in chances if 1e-15 <= u <= 0.5)
        halves.append(pieces(lambda u: (getattr(a, inverse)(u) - getattr(b, inverse)(u)) ** 2, chances))
    return {"wasserstein_2": np.sqrt(sum(halves))}


def masses(a, b):
    xs = np.arange(-5, 400)
    p, q = a.pmf(xs), b.pmf(xs)
    kl = np.inf if np.any((p > 0) & (q == 0)) else float(scipy.special.rel_entr(p, q).sum())
    return {
        "total_variation": float(np.abs(p - q).sum() / 2),
        "hellinger": float(np.sqrt(((np.sqrt(p) - np.sqrt(q)) ** 2).sum() / 2)),
        "jensen_shannon": float(jensenshannon(p, q, base=2)),
        "kullback_leibler": infinite_as_text(kl),
    }


def von_mises_cases():
    laws = [(10, 0.5), (350, 4), (200, 30), (77, 0)]
    for i, (m, k) in enumerate(laws):
        for n, l in laws[i + 1:]:
            degree = np.pi / 180
            density = lambda x, mean, kappa: stats.vonmises.pdf((x - mean) * degree, kappa) * degree if kappa else np.full_like(x, 1 / 360)
            f, g = (lambda x: density(x, m, k)), (lambda x: density(x, n, l))
            grid = np.linspace(0, 360, 7201)
            split = sorted({*np.linspace(0, 360, 37), *crossings(lambda x: f(x) - g(x), np.linspace(0, 360, 37))})
            # On a fine grid of midpoints the masses are accurate to 1e-8, and POT compares them as weighted points.
            middles = (grid[1:] + grid[:-1]) / 2
            p, q = f(middles), g(middles)
            turns = ot.wasserstein_circle(middles / 360, middles / 360, p / p.sum(), q / q.sum())
            yield {
                "a": {"von_mises": {"mean": m, "kappa": k}},
                "b": {"von_mises": {"mean": n, "kappa": l}},
                "total_variation": pieces(lambda x: abs(f(x) - g(x)) / 2, split),
                "hellinger": np.sqrt(pieces(lambda x: (np.sqrt(f(x)) - np.sqrt(g(x))) ** 2 / 2, split)),
                "circular_wasserstein_1": float(np.ravel(turns)[0]) * 360,
            }


def samples_cases():
    rng = np.random.default_rng(3)
    for n, m in [(1, 1), (7, 7), (256, 256), (20, 33), (100, 3)]:
        x, y = rng.normal(0, 1, n).round(4), rng.gamma(2, 1, m).round(4)
        angles, others = rng.uniform(0, 360, n).round(3), rng.normal(0, 40, m).round(3) % 360
        yield {
            "x": x.tolist(),
            "y": y.tolist(),
            "wasserstein_1": float(stats.wasserstein_distance(x, y)),
            "wasserstein_2": float(np.sqrt(ot.wasserstein_1d(x, y, p=2))),
            "energy": float(stats.energy_distance(x, y)),
            "headings": angles.tolist(),
            "other_headings": others.tolist(),
            "circular_wasserstein_1": float(np.ravel(ot.wasserstein_circle(angles / 360, others / 360))[0]) * 360,
        }


def gaussian_cases():
    rng = np.random.default_rng(4)
    for _ in range(6):
        make = lambda: (rng.normal(size=2).round(3), (lambda h: (h @ h.T).round(3))(rng.normal(size=(2, 2)) + np.eye(2)))
        (m, s), (n, t) = make(), make()
        inverse = np.linalg.inv(t)
        kl = 0.5 * (np.trace(inverse @ s) - 2 + (n - m) @ inverse @ (n - m) + np.log(np.linalg.det(t) / np.linalg.det(s)))
        yield {
            "a": {"gaussian": {"mean": m.tolist(), "covariance": s.tolist()}},
            "b": {"gaussian": {"mean": n.tolist(), "covariance": t.tolist()}},
            "planar_wasserstein_2": float(ot.gaussian.bures_wasserstein_distance(m, n, s, t)),
            "kullback_leibler": float(kl),
        }


def words_cases():
    for p, q in [([1, 2, 3], [3, 2, 1]), ([1, 0, 0], [0, 1, 1]), ([0.2, 0.3, 0.5], [0.2, 0.3, 0.5])]:
        choice = lambda weights: {"choice": {"values": ["a", "b", "c"], "weights": weights}}
        x, y = np.array(p) / sum(p), np.array(q) / sum(q)
        yield {
            "a": choice(p),
            "b": choice(q),
            "total_variation": float(np.abs(x - y).sum() / 2),
            "hellinger": float(np.sqrt(((np.sqrt(x) - np.sqrt(y)) ** 2).sum() / 2)),
            "jensen_shannon": float(jensenshannon(x, y, base=2)),
        }


pairs = []
for group, of in ((CONTINUOUS, densities), (COUNTS, masses)):
    for i, a in enumerate(group):
        for b in group[i + 1:]:
            x, y = frozen(a), frozen(b)
            pairs.append({"a": a, "b": b, **of(x, y), **transport(x, y), **quantiles(x, y)})
for a in CONTINUOUS[::3]:
    for b in COUNTS[:4]:
        x, y = frozen(a), frozen(b)
        pairs.append({"a": a, "b": b, **transport(x, y), **quantiles(x, y), "total_variation": 1.0})
pairs += [*von_mises_cases(), *gaussian_cases(), *words_cases()]
made_by = {"numpy": np.__version__, "scipy": scipy.__version__, "pot": ot.__version__}
document = {"made_by": made_by, "pairs": pairs, "samples": list(samples_cases())}
text = json.dumps(document, default=float).replace('{"a"', '\n{"a"').replace('{"x"', '\n{"x"')
Path(__file__).with_name("distributions.json").write_text(text + "\n")
