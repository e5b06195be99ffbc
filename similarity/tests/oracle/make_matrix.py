"""Writes mds.json: maps of points by classical scaling.

Run in this folder: python make_matrix.py
"""

import json
import sys

import numpy as np
import scipy


def classical(distances, axes):
    n = len(distances)
    centring = np.eye(n) - 1 / n
    products = -0.5 * centring @ distances**2 @ centring
    values, vectors = np.linalg.eigh(products)
    values, vectors = values[::-1], vectors[:, ::-1]
    explained = np.sum(np.maximum(values[:axes], 0) ** 2) / np.sum(values**2)
    return {
        "distances": distances.tolist(),
        "eigenvalues": values[:axes].tolist(),
        # Signs are arbitrary, so only the magnitudes of the coordinates are stored.
        "sizes": np.abs(vectors[:, :axes] * np.sqrt(np.maximum(values[:axes], 0))).tolist(),
        "explained": explained,
    }


random = np.random.default_rng(5)
points = random.normal(size=(14, 4)) * [3, 2, 1, 0.3]
euclidean = np.sqrt(((points[:, None] - points[None, :]) ** 2).sum(-1))
not_euclidean = np.abs(random.normal(size=(9, 9)))
not_euclidean = not_euclidean + not_euclidean.T
np.fill_diagonal(not_euclidean, 0)
json.dump(
    {
        "tools": {"python": sys.version.split()[0], "numpy": np.__version__, "scipy": scipy.__version__},
        "euclidean": classical(euclidean, 2),
        "not_euclidean": classical(not_euclidean, 2),
    },
    open("mds.json", "w"),
)
