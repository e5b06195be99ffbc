"""Writes occupancy.json: distances between grids by SciPy, scikit-image and POT. Run: python make_occupancy.py"""
import json
from pathlib import Path

import numpy as np
import ot
import scipy
import skimage
from scipy.spatial.distance import cdist, jaccard
from skimage.metrics import hausdorff_distance

rng = np.random.default_rng(11)


def centres(shape):
    rows, columns = np.indices(shape)
    return np.stack([columns.ravel(), rows.ravel()], 1).astype(float)


taken = []
for shape in [(1, 1), (1, 9), (3, 4), (8, 8), (9, 15), (50, 50)]:
    for share in [0.02, 0.1, 0.5, 0.9]:
        cell = float(rng.choice([0.5, 1.0, 2.0]))
        a, b = (rng.random(shape) < share for _ in range(2))
        case = {
            "rows": shape[0],
            "columns": shape[1],
            "cell": cell,
            "a": np.flatnonzero(a).tolist(),
            "b": np.flatnonzero(b).tolist(),
            "jaccard": float(jaccard(a.ravel(), b.ravel())),
        }
        if a.any() and b.any():
            distances = cdist(np.argwhere(a), np.argwhere(b)) * cell
            from_a, from_b = distances.min(1), distances.min(0)
            case["chamfer"] = float((from_a.mean() + from_b.mean()) / 2)
            case["hausdorff"] = float(hausdorff_distance(a, b) * cell)
        taken.append(case)

masses = []
for shape, holes in [((1, 5), 0.0), ((4, 3), 0.3), ((6, 6), 0.0), ((8, 5), 0.7), ((12, 12), 0.5), ((25, 25), 0.0), ((25, 25), 0.9)]:
    cell = float(rng.choice([0.5, 1.0, 2.0]))
    a, b = (np.where(rng.random(shape) < holes, 0.0, rng.random(shape)).ravel().round(6) for _ in range(2))
    a[0] += 1e-3
    b[-1] += 1e-3
    positions = centres(shape) * cell
    cost = ot.dist(positions, metric="euclidean")
    p, q = a / a.sum(), b / b.sum()
    masses.append({
        "rows": shape[0],
        "columns": shape[1],
        "cell": cell,
        "a": a.tolist(),
        "b": b.tolist(),
        "earth_movers": float(ot.emd2(p, q, cost, numItermax=10**7)),
    })

document = {
    "made_by": {
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "scikit-image": skimage.__version__,
        "pot": ot.__version__,
    },
    "taken": taken,
    "masses": masses,
}
Path(__file__).with_name("occupancy.json").write_text(json.dumps(document) + "\n")
