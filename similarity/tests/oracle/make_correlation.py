"""Golden values for correlations and the Mantel test, by scipy and scikit-bio. Run: python make_correlation.py > correlation.json

Needs numpy, scipy, scikit-bio. Exact shares come from an enumeration of all relabellings with scipy's correlations.
"""

import itertools
import json
import sys

import numpy
import scipy
import skbio
from scipy.stats import pearsonr, spearmanr
from skbio.stats.distance import mantel

random = numpy.random.default_rng(20261121)
CORRELATIONS = {"spearman": spearmanr, "pearson": pearsonr}


def lists():
    """Lists with and without ties, and two that are numerically difficult."""
    for size, grid in [(3, None), (5, None), (12, 4), (30, 6), (50, None), (50, 2)]:
        a, noise = random.normal(size=size), random.normal(size=size)
        b = 0.5 * a + noise
        if grid:
            a, b = numpy.round(a * grid / 2), numpy.round(b * grid / 2)
        yield a, b
    yield numpy.array([1.0, 2.0, 3.0, 4.0, 1e6]), numpy.array([4.0, 3.0, 2.0, 1.0, 5.0])
    yield 1e9 + numpy.arange(8.0), numpy.array([3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0])


def matrix(size):
    """Distances of points in the plane, rounded so that some are equal."""
    points = random.uniform(0, 3, size=(size, 2))
    distances = numpy.round(numpy.linalg.norm(points[:, None] - points[None], axis=2), 1)
    return distances


def gaps(distances, share):
    """Ordered pairs, some left out, with noisy values that fall with distance."""
    size = len(distances)
    kept = [(a, b) for a in range(size) for b in range(size) if a != b and random.uniform() < share]
    return [(a, b, round(float(-distances[a, b] + random.normal()), 2)) for a, b in kept]


def enumerated(distances, pairs, correlate):
    """The correlation; the numbers of relabellings at least as far from 0, as low and as high; the number of relabellings."""
    items = sorted({item for a, b, _ in pairs for item in (a, b)})
    values = [value for _, _, value in pairs]

    def correlation(labels):
        to = dict(zip(items, labels))
        found = [distances[to[a], to[b]] for a, b, _ in pairs]
        return correlate(found, values)[0] if len(set(found)) > 1 else None

    observed = correlation(items)
    far = low = high = count = 0
    for labels in itertools.permutations(items):
        found = correlation(labels)
        count += 1
        far += found is None or abs(found) >= abs(observed) - 1e-9
        low += found is None or found <= observed + 1e-9
        high += found is None or found >= observed - 1e-9
    return {"correlation": float(observed), "far": int(far), "low": int(low), "high": int(high), "count": count}


def exact_cases():
    for size, share in [(3, 1.0), (4, 1.0), (5, 1.0), (5, 0.6), (6, 0.8), (6, 0.35)]:
        distances = matrix(size)
        pairs = gaps(distances, share)
        for name, correlate in CORRELATIONS.items():
            yield {
                "description": f"{size} items, {len(pairs)} of {size * (size - 1)} ordered pairs",
                "distances": distances.tolist(),
                "pairs": pairs,
                "method": name,
                **enumerated(distances, pairs, correlate),
            }


def drawn_cases():
    for size in [9, 12]:
        a = matrix(size)
        noise = random.normal(size=(size, size)) * 3.5
        b = numpy.abs(a + (noise + noise.T) / 2)
        numpy.fill_diagonal(b, 0)
        for name in CORRELATIONS:
            case = {"a": a.tolist(), "b": b.tolist(), "method": name, "relabellings": 19_999}
            for alternative, key in [("two-sided", "p_two_sided"), ("less", "p_less"), ("greater", "p_greater")]:
                found, share, _ = mantel(a, b, method=name, permutations=19_999, alternative=alternative, seed=1)
                case["correlation"], case[key] = float(found), float(share)
            yield case


json.dump(
    {
        "made_by": "make_correlation.py",
        "versions": {"numpy": numpy.__version__, "scipy": scipy.__version__, "scikit-bio": skbio.__version__},
        "correlations": [
            {
                "a": a.tolist(),
                "b": b.tolist(),
                **{name: float(correlate(a, b)[0]) for name, correlate in CORRELATIONS.items()},
            }
            for a, b in lists()
        ],
        "enumerated": list(exact_cases()),
        "drawn": list(drawn_cases()),
    },
    sys.stdout,
)
print()
