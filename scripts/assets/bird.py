"""A bird of our own making on a stone, as one closed mesh. Centimetres, its head towards +x."""
from pathlib import Path

import numpy as np

from solids import capsule, carve, ellipsoid, join, mirrored, write

LOW, HIGH = (-7.5, -4.6, -3.4), (6.5, 5.0, 3.4)
CELL = 0.32  # cm


def tilted(degrees: float) -> np.ndarray:
    """Axes that are turned about z."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])


def surface(points: np.ndarray) -> np.ndarray:
    """Below 0 inside; about the distance in cm near the surface. Both sides are alike."""
    p = mirrored(points, 2)
    bird = join(ellipsoid(p, (0, 0, 0), (3.7, 2.1, 1.9), tilted(24)), ellipsoid(p, (1.4, 0.1, 0), (2.0, 2.1, 1.7)), 1.2)
    bird = join(bird, ellipsoid(p, (3.0, 2.7, 0), (1.65, 1.5, 1.4)), 1.4)                  # head
    bird = join(bird, capsule(p, (4.1, 2.75, 0), (5.6, 2.35, 0), 0.55, 0.2), 0.5)          # beak
    bird = carve(bird, ellipsoid(p, (3.6, 3.1, 1.45), (0.32, 0.32, 0.3)), 0.25)            # eye
    bird = join(bird, ellipsoid(p, (-4.4, -2.3, 0), (3.1, 0.45, 1.05), tilted(27)), 1.1)   # tail
    bird = join(bird, ellipsoid(p, (-0.9, 0.1, 1.75), (3.0, 1.35, 0.5), tilted(20)), 0.4)  # wing
    bird = join(bird, capsule(p, (0.6, -1.5, 0.7), (0.7, -3.4, 0.75), 0.42, 0.36), 0.5)    # leg
    stone = ellipsoid(p, (0.2, -4.2, 0), (3.2, 1.15, 2.4))
    return carve(join(bird, stone, 0.5), 4.3 + p[..., 1], 0.4)  # stands on a plane, with a round edge


def bird(out: Path) -> None:
    write(out, surface, LOW, HIGH, CELL)
