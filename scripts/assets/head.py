"""A head of our own making: ellipsoids and capsules that flow into each other, as one closed mesh. Centimetres, face
towards +z, eyes at y = 1."""
from pathlib import Path

import numpy as np

from solids import capsule, carve, ellipsoid, join, mirrored, write

LOW, HIGH = np.array([-12.5, -17.6, -12.5]), np.array([12.5, 13.5, 12.5])
FINE, COARSE = 0.3, 0.6  # cells, cm


def surface(points: np.ndarray) -> np.ndarray:
    """Below 0 inside; about the distance in cm near the surface. Both halves are alike."""
    p = mirrored(points)

    head = join(ellipsoid(p, (0, 3.7, -1.7), (7.3, 8.3, 9.2)), ellipsoid(p, (0, -2.4, 2.2), (5.7, 7.6, 6.2)), 3.5)
    head = join(head, capsule(p, (5.0, -4.2, 0.2), (1.9, -9.0, 4.9), 1.7, 1.6), 2.5)   # jaw
    head = join(head, ellipsoid(p, (0, -9.2, 5.9), (1.9, 1.6, 1.9)), 1.8)              # chin
    head = join(head, ellipsoid(p, (3.9, -1.9, 5.2), (2.1, 1.7, 2.1)), 2.2)            # cheekbone
    head = join(head, capsule(p, (0.9, 2.7, 7.5), (4.4, 2.9, 5.6), 0.75, 0.6), 1.2)    # brow
    head = carve(head, ellipsoid(p, (2.9, 0.9, 8.9), (1.9, 1.25, 1.9)), 1.4)           # socket
    head = join(head, ellipsoid(p, (2.9, 0.8, 5.75), (1.55, 1.35, 1.5)), 0.35)         # closed eye
    head = join(head, capsule(p, (1.5, 0.45, 6.75), (4.1, 0.5, 6.05), 0.16, 0.14), 0.35)  # where its lids meet
    nose = join(capsule(p, (0, 1.9, 7.0), (0, -2.4, 9.3), 0.75, 1.0), ellipsoid(p, (0, -2.6, 9.4), (1.15, 1.0, 1.15)), 0.8)
    nose = join(nose, ellipsoid(p, (1.15, -3.0, 8.4), (0.8, 0.75, 1.0)), 0.6)
    head = join(head, nose, 1.1)
    head = carve(head, ellipsoid(p, (0.62, -3.75, 8.9), (0.38, 0.4, 0.6)), 0.3)        # nostril
    head = join(head, ellipsoid(p, (0, -5.55, 7.7), (2.0, 0.62, 1.15)), 0.7)           # lips
    head = join(head, ellipsoid(p, (0, -6.6, 7.6), (1.7, 0.7, 1.1)), 0.6)
    head = carve(head, ellipsoid(p, (0, -6.02, 9.0), (2.15, 0.1, 0.9)), 0.28)
    head = carve(head, ellipsoid(p, (0, -7.75, 8.7), (1.6, 0.55, 0.7)), 0.9)

    head = join(head, capsule(p, (0, -5.5, -3.0), (0, -17, -4.2), 4.6, 5.2), 2.5)       # neck
    head = join(head, capsule(p, (3.6, -4.5, -2.2), (0.9, -15.6, 1.2), 0.9, 0.8), 1.6)  # its muscle
    head = join(head, ellipsoid(p, (0, -19.6, -4.0), (11.5, 4.6, 6.4)), 3.5)            # shoulders
    head = carve(head, 17.2 + p[..., 1], 2.0)                                        # stands on a plane, with a round edge

    out, back = np.radians(28), np.radians(-14)
    turn = np.array([[np.cos(out), 0, np.sin(out)], [0, 1, 0], [-np.sin(out), 0, np.cos(out)]]) @ \
        np.array([[1, 0, 0], [0, np.cos(back), -np.sin(back)], [0, np.sin(back), np.cos(back)]])
    place = np.array([7.75, -0.1, -1.3])
    local = (p - place) @ turn
    ring = np.sqrt((np.hypot(local[..., 1] / 3.1, local[..., 2] / 1.75) - 0.86) ** 2 * 4.4 + local[..., 0] ** 2) - 0.34
    ear = join(ellipsoid(p, place, (0.24, 3.0, 1.7), turn), ring, 0.35)
    ear = join(ear, ellipsoid(p, place + turn @ (0.0, -2.5, 0.35), (0.33, 0.85, 0.75), turn), 0.5)  # lobe
    return join(head, ear, 0.8)


def head(out: Path) -> None:
    write(out, surface, LOW, HIGH, FINE)


def bust(out: Path) -> None:
    """For what is worked out from each vertex to all others: a quarter of them, evenly spread."""
    write(out, surface, LOW, HIGH, COARSE)
