"""Stroke scripts of painted scenes."""
import json
from pathlib import Path

import numpy as np

import head
from solids import pulled


def write_strokes(out: Path, strokes: list[dict]) -> None:
    lines = ",\n".join("  " + json.dumps(stroke) for stroke in strokes)
    out.write_text(f'{{ "lucentStrokes": 1, "strokes": [\n{lines}\n] }}\n')


def checkerboard(out: Path) -> None:
    """Every other square of 8 by 8 on a plane of 64 mm takes no light."""
    side, count = 0.008, 8
    strokes = []
    for row in range(count):
        for column in range(row % 2, count, 2):
            x, z = (column - count / 2) * side, (row - count / 2) * side
            strokes.append({"brush": "glow", "value": [0, 0, 0],
                            "fill": {"low": [round(x, 6), None, round(z, 6)],
                                     "high": [round(x + side, 6), None, round(z + side, 6)]}})
    write_strokes(out, strokes)


def dabs(places: list[tuple]) -> list[list[float]]:
    """Touches of a brush on the head nearest to these places (cm), at full pressure."""
    points = pulled(head.surface, np.array(places, float))
    slope = np.stack([head.surface(points + 0.01 * axis) - head.surface(points - 0.01 * axis) for axis in np.eye(3)],
                     axis=-1)
    normals = slope / np.linalg.norm(slope, axis=-1, keepdims=True)
    return np.hstack([points, normals, np.ones((len(points), 1))]).round(4).tolist()


def makeup(out: Path) -> None:
    """Red lips, and cheeks whose colour lies deeper: it is blurred (dissertation 2007, figures 7.10 and 7.11)."""
    lips = dabs([(x, y, 8.8) for x in np.linspace(0, 1.7, 5) for y in (-5.55 - 0.06 * x, -6.5 + 0.1 * x)])
    cheek = dabs([(4.3, -2.2, 6.6)])
    lid = dabs([(x, 1.3, 7.2) for x in np.linspace(1.9, 3.9, 4)])
    write_strokes(out, [
        {"brush": "blur", "value": 2, "radius": 0.03, "hardness": 0, "symmetric": True, "dabs": cheek},
        {"brush": "glow", "value": [1.5, 0.75, 0.8], "radius": 0.03, "hardness": 0, "symmetric": True, "dabs": cheek},
        {"brush": "glow", "value": [1.3, 0.3, 0.4], "radius": 0.007, "hardness": 0.5, "symmetric": True, "dabs": lips},
        {"brush": "glow", "value": [0.55, 0.7, 1.6], "radius": 0.008, "hardness": 0.3, "symmetric": True, "dabs": lid}])
