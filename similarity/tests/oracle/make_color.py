"""Writes color.json: distances between colours by scikit-image and colour-science, and Sharma's 34 pairs. Run: python make_color.py"""
import json
from pathlib import Path

import colour
import numpy as np
import skimage
from skimage.color import deltaE_cie76, deltaE_ciede2000, rgb2lab

# Sharma, Wu and Dalal 2005, table 1: L1 a1 b1 L2 a2 b2 and the difference.
SHARMA = """
50 2.6772 -79.7751 50 0 -82.7485 2.0425
50 3.1571 -77.2803 50 0 -82.7485 2.8615
50 2.8361 -74.0200 50 0 -82.7485 3.4412
50 -1.3802 -84.2814 50 0 -82.7485 1.0000
50 -1.1848 -84.8006 50 0 -82.7485 1.0000
50 -0.9009 -85.5211 50 0 -82.7485 1.0000
50 0 0 50 -1 2 2.3669
50 -1 2 50 0 0 2.3669
50 2.49 -0.001 50 -2.49 0.0009 7.1792
50 2.49 -0.001 50 -2.49 0.0010 7.1792
50 2.49 -0.001 50 -2.49 0.0011 7.2195
50 2.49 -0.001 50 -2.49 0.0012 7.2195
50 -0.001 2.49 50 0.0009 -2.49 4.8045
50 -0.001 2.49 50 0.0010 -2.49 4.8045
50 -0.001 2.49 50 0.0011 -2.49 4.7461
50 2.5 0 50 0 -2.5 4.3065
50 2.5 0 73 25 -18 27.1492
50 2.5 0 61 -5 29 22.8977
50 2.5 0 56 -27 -3 31.9030
50 2.5 0 58 24 15 19.4535
50 2.5 0 50 3.1736 0.5854 1.0000
50 2.5 0 50 3.2972 0 1.0000
50 2.5 0 50 1.8634 0.5757 1.0000
50 2.5 0 50 3.2592 0.3350 1.0000
60.2574 -34.0099 36.2677 60.4626 -34.1751 39.4387 1.2644
63.0109 -31.0961 -5.8663 62.8187 -29.7946 -4.0864 1.2630
61.2901 3.7196 -5.3901 61.4292 2.2480 -4.9620 1.8731
35.0831 -44.1164 3.7933 35.0232 -40.0716 1.5901 1.8645
22.7233 20.0904 -46.6940 23.0331 14.9730 -42.5619 2.0373
36.4612 47.8580 18.3852 36.2715 50.5065 21.2231 1.4146
90.8027 -2.0831 1.4410 91.1528 -1.6435 0.0447 1.4441
90.9257 -0.5406 -0.9208 88.6381 -0.8985 -0.7239 1.5381
6.7747 -0.2908 -2.4247 5.8714 -0.0985 -2.2286 0.6377
2.0776 0.0795 -1.1350 0.9033 -0.0636 -0.5514 0.9082
"""
sharma = [[float(word) for word in line.split()] for line in SHARMA.strip().splitlines()]
assert len(sharma) == 34

rng = np.random.default_rng(5)
corners = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0]), -1).reshape(-1, 3)
greys = np.repeat(np.linspace(0, 1, 8)[:, None], 3, axis=1)
a = np.concatenate([corners, greys, rng.random((100, 3)).round(4)])
b = np.concatenate([corners[[3, 5, 0, 6, 7, 1, 2, 4]], greys[::-1] * [1, 0.9, 1], rng.random((100, 3)).round(4)])
lab_a, lab_b = rgb2lab(a[:, None])[:, 0], rgb2lab(b[:, None])[:, 0]
oklab_a, oklab_b = (colour.XYZ_to_Oklab(colour.sRGB_to_XYZ(rgb)) for rgb in (a, b))
by_skimage = deltaE_ciede2000(lab_a, lab_b)
by_colour = colour.delta_E(lab_a, lab_b, method="CIE 2000")
assert abs(by_skimage - by_colour).max() < 1e-9
document = {
    "made_by": {"numpy": np.__version__, "scikit-image": skimage.__version__, "colour-science": colour.__version__},
    "sharma": sharma,
    "pairs": [
        {"a": list(a[k]), "b": list(b[k]), "lab_a": list(lab_a[k]), "lab_b": list(lab_b[k]),
         "srgb": float(np.linalg.norm(a[k] - b[k])), "cie76": float(deltaE_cie76(lab_a, lab_b)[k]),
         "ciede2000": float(by_skimage[k]), "hyab": float(colour.difference.delta_E_HyAB(lab_a, lab_b)[k]),
         "oklab": float(np.linalg.norm(oklab_a[k] - oklab_b[k]))}
        for k in range(len(a))
    ],
}
Path(__file__).with_name("color.json").write_text(json.dumps(document) + "\n")
