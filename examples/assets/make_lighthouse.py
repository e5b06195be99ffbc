"""Writes lighthouse.gltf, a model of our own: a round tower with stripes that take an object's colour.

Run it in this folder; it needs nothing but Python. The library is then packed with
`driftworld assets pack lighthouse.gltf -o harbour.assets`.
"""

import base64
import json
import math
import struct

SEGMENTS = 32

# Radius and height in metres of each ring from the ground up, and the material of the band above it.
PROFILE = [
    (2.00, 0.00, "stone"),
    (2.00, 0.45, "stone"),
    (1.70, 0.45, "white"),
    (1.58, 2.00, "main"),
    (1.45, 3.60, "white"),
    (1.33, 5.20, "main"),
    (1.20, 6.80, "white"),
    (1.14, 7.60, "iron"),
    (1.55, 7.75, "iron"),
    (1.55, 7.95, "iron"),
    (0.85, 7.95, "lamp"),
    (0.85, 9.10, "iron"),
    (1.05, 9.10, "main"),
    (0.00, 10.20, None),
]

COLORS = {
    "main": [0.62, 0.05, 0.04],
    "white": [0.85, 0.84, 0.80],
    "stone": [0.30, 0.29, 0.27],
    "iron": [0.05, 0.06, 0.07],
    "lamp": [1.00, 0.80, 0.30],
    "door": [0.10, 0.20, 0.22],
}


def tower():
    """Positions (x right, y up, z to the front), and the triangles of each material."""
    positions, triangles = [], {name: [] for name in COLORS}
    for radius, height, _ in PROFILE:
        for k in range(SEGMENTS):
            angle = 2 * math.pi * k / SEGMENTS
            positions.append((radius * math.sin(angle), height, radius * math.cos(angle)))
    for ring, (_, _, material) in enumerate(PROFILE[:-1]):
        for k in range(SEGMENTS):
            low, next_low = ring * SEGMENTS + k, ring * SEGMENTS + (k + 1) % SEGMENTS
            high, next_high = low + SEGMENTS, next_low + SEGMENTS
            triangles[material].append((low, next_low, next_high))
            if PROFILE[ring + 1][0] > 0:
                triangles[material].append((low, next_high, high))
    return positions, triangles


def add_door(positions, triangles):
    """A flat door, slightly in front of the tower."""
    first = len(positions)
    for x, y in [(-0.5, 0.45), (0.5, 0.45), (0.5, 2.1), (0.0, 2.5), (-0.5, 2.1)]:
        positions.append((x, y, 1.78 - 0.09 * y))
    triangles["door"] += [(first, first + k, first + k + 1) for k in (1, 2, 3)]


def document(positions, triangles):
    """The glTF document with everything embedded."""
    data = b"".join(struct.pack("<3f", *place) for place in positions)
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": len(data), "target": 34962}]
    accessors = [
        {
            "bufferView": 0,
            "componentType": 5126,
            "type": "VEC3",
            "count": len(positions),
            "min": [min(place[axis] for place in positions) for axis in range(3)],
            "max": [max(place[axis] for place in positions) for axis in range(3)],
        }
    ]
    primitives = []
    for number, name in enumerate(COLORS):
        corners = [corner for triangle in triangles[name] for corner in triangle]
        packed = struct.pack(f"<{len(corners)}H", *corners)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed), "target": 34963})
        accessors.append(
            {"bufferView": number + 1, "componentType": 5123, "type": "SCALAR", "count": len(corners)}
        )
        primitives.append({"attributes": {"POSITION": 0}, "indices": number + 1, "material": number})
        data += packed + b"\0" * (-len(packed) % 4)
    materials = [
        {
            "name": name,
            "pbrMetallicRoughness": {"baseColorFactor": color + [1.0], "metallicFactor": 0.0},
        }
        for name, color in COLORS.items()
    ]
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {
        "asset": {"version": "2.0", "generator": "make_lighthouse.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "lighthouse", "mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": uri}],
    }


def main():
    positions, triangles = tower()
    add_door(positions, triangles)
    with open("lighthouse.gltf", "w", encoding="utf-8") as file:
        json.dump(document(positions, triangles), file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
