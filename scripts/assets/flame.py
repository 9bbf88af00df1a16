"""A candle's flame: a drop that shines, in rings one above the other that each have a colour of their own."""
from pathlib import Path

import numpy as np

from meshes import write_document

HEIGHT, RADIUS = 0.0205, 0.0033  # m
RINGS, ROWS, SIDES = 24, 2, 48   # rings of one colour, rows of squares in each, squares around

# Radiance by height: blue where gas burns clean, dark around the wick, bright where soot glows, red where it cools.
# Chosen by eye from photographs; the brightest is what the scene's lamp would have if it were as large.
HEIGHTS = 0.0, 0.07, 0.17, 0.3, 0.5, 0.75, 0.92, 1.0
COLOURS = np.array([[0.05, 0.10, 0.42], [0.10, 0.10, 0.26], [0.55, 0.24, 0.06], [1.25, 0.72, 0.20],
                    [1.90, 1.25, 0.50], [1.50, 0.86, 0.27], [1.00, 0.44, 0.09], [0.70, 0.22, 0.03]])


def height(number):
    """At which a ring begins, as a share of HEIGHT: they are lower where the colour changes fastest."""
    return (number / RINGS) ** 1.5


def radius(share: np.ndarray) -> np.ndarray:
    """Of the drop at a share of its height, as a share of RADIUS: round below, widest at a third, pointed above."""
    return np.sqrt(27 / 4 * share) * (1 - share)


def ring(number: int) -> np.ndarray:
    """Positions of a ring's corners, row by row from below."""
    heights = height(number + np.arange(ROWS + 1) / ROWS)
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    across = RADIUS * radius(heights)[:, None]
    rows = np.broadcast_to(HEIGHT * heights[:, None], (ROWS + 1, SIDES))
    return np.stack([across * np.cos(angles), rows, across * np.sin(angles)], axis=2).reshape(-1, 3).astype("<f4")


def triangles() -> np.ndarray:
    """Of any ring; those outside are counted against the clock as seen from there. None at the tips lacks an area but
    for the half that a tip makes a point of."""
    row, side = np.meshgrid(np.arange(ROWS), np.arange(SIDES), indexing="ij")
    after = (side + 1) % SIDES
    below, above = SIDES * row, SIDES * (row + 1)
    a, b, c, d = below + side, below + after, above + after, above + side
    return np.stack([a, d, c, a, c, b], axis=2).reshape(-1, 3).astype("<u4")


def material(number: int) -> dict:
    color = [float(np.interp(height(number + 0.5), HEIGHTS, COLOURS[:, channel])) for channel in range(3)]
    strength = max(1.0, *color)
    return {"name": f"{number + 1:02}", "emissiveFactor": [round(value / strength, 6) for value in color],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}


def flame(out: Path) -> None:
    """Stands on y = 0, in metres; a material for each ring."""
    rings = [ring(number) for number in range(RINGS)]
    corners = triangles()
    points, indices = b"".join(positions.tobytes() for positions in rings), corners.tobytes()
    size = len(points) // RINGS
    document = {
        "asset": {"version": "2.0", "generator": "lucent make_assets"},
        "extensionsUsed": ["KHR_materials_emissive_strength"],
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "materials": [material(number) for number in range(RINGS)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": number}, "indices": RINGS, "material": number}
                                   for number in range(RINGS)]}],
        "buffers": [{"byteLength": len(points) + len(indices)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(points), "target": 34962},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices), "target": 34963}],
        "accessors": [{"bufferView": 0, "byteOffset": number * size, "componentType": 5126, "count": len(positions),
                       "type": "VEC3", "min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
                      for number, positions in enumerate(rings)] +
                     [{"bufferView": 1, "componentType": 5125, "count": corners.size, "type": "SCALAR"}],
    }
    write_document(out, document, points + indices)
