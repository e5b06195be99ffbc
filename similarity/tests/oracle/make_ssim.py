"""Writes ssim.json: structural similarities of small pictures by scikit-image. Run: python make_ssim.py

The pictures are computed from integers by a rule that the test repeats (see `picture` in tests/picture.rs), so they need not
be stored.
"""
import json
from pathlib import Path

import numpy as np
import skimage
from skimage.metrics import structural_similarity


def picture(kind, seed, height, width):
    row, column, channel = np.meshgrid(np.arange(height), np.arange(width), np.arange(3), indexing="ij")
    if kind == "stripes":
        value = (column * (seed + 3) + channel * 40) % 256
    elif kind == "checks":
        value = ((row // (seed + 2) + column // (seed + 2)) % 2) * 200 + channel * 10
    elif kind == "noise":
        value = ((row * 7919 + column * 104729 + channel * 1299709 + seed * 15485863) * 2654435761 % 2**32) // 2**24
    else:
        value = np.full_like(row, seed)
    return value.astype(np.uint8)


KINDS = [("stripes", 1), ("stripes", 4), ("checks", 1), ("checks", 3), ("noise", 1), ("noise", 2), ("flat", 0), ("flat", 255), ("flat", 90)]
cases = []
for height, width in [(11, 11), (16, 24), (33, 40)]:
    for i, a in enumerate(KINDS):
        for b in KINDS[i:]:
            similarity = structural_similarity(
                picture(*a, height, width), picture(*b, height, width), channel_axis=2, gaussian_weights=True,
                sigma=1.5, use_sample_covariance=False, data_range=255)
            cases.append({"height": height, "width": width, "a": a, "b": b, "similarity": float(similarity)})
document = {"made_by": {"numpy": np.__version__, "scikit-image": skimage.__version__}, "cases": cases}
Path(__file__).with_name("ssim.json").write_text(json.dumps(document) + "\n")
