"""A head of our own making: ellipsoids and capsules that flow into each other, as one closed mesh. Centimetres, face
towards +z, eyes at y = 1."""
from pathlib import Path

import numpy as np

from meshes import write_glb

LOW, HIGH = np.array([-12.5, -17.6, -12.5]), np.array([12.5, 13.5, 12.5])
FINE, COARSE = 0.3, 0.6  # cells, cm


def surface(points: np.ndarray) -> np.ndarray:
    """Below 0 inside; about the distance in cm near the surface. Both halves are alike."""
    p = points.copy()
    p[..., 0] = np.abs(p[..., 0])

    def ellipsoid(centre, radii, turn=np.eye(3)) -> np.ndarray:
        local = (p - np.array(centre)) @ turn
        near = np.linalg.norm(local / radii, axis=-1)
        slope = np.linalg.norm(local / np.square(radii), axis=-1)
        return near * (near - 1) / np.maximum(slope, 1e-9)

    def capsule(start, end, first, last) -> np.ndarray:
        start, way = np.array(start, float), np.subtract(end, start)
        along = np.clip((p - start) @ way / (way @ way), 0, 1)
        return np.linalg.norm(p - start - along[..., None] * way, axis=-1) - (first + along * (last - first))

    def join(a, b, k) -> np.ndarray:
        """The union; within k the two flow into each other."""
        h = np.maximum(k - np.abs(a - b), 0) / k
        return np.minimum(a, b) - h * h * k / 4

    def carve(a, b, k) -> np.ndarray:
        return -join(-a, b, k)

    head = join(ellipsoid((0, 3.7, -1.7), (7.3, 8.3, 9.2)), ellipsoid((0, -2.4, 2.2), (5.7, 7.6, 6.2)), 3.5)
    head = join(head, capsule((5.0, -4.2, 0.2), (1.9, -9.0, 4.9), 1.7, 1.6), 2.5)   # jaw
    head = join(head, ellipsoid((0, -9.2, 5.9), (1.9, 1.6, 1.9)), 1.8)              # chin
    head = join(head, ellipsoid((3.9, -1.9, 5.2), (2.1, 1.7, 2.1)), 2.2)            # cheekbone
    head = join(head, capsule((0.9, 2.7, 7.5), (4.4, 2.9, 5.6), 0.75, 0.6), 1.2)    # brow
    head = carve(head, ellipsoid((2.9, 0.9, 8.9), (1.9, 1.25, 1.9)), 1.4)           # socket
    head = join(head, ellipsoid((2.9, 0.8, 5.75), (1.55, 1.35, 1.5)), 0.35)         # closed eye
    head = join(head, capsule((1.5, 0.45, 6.75), (4.1, 0.5, 6.05), 0.16, 0.14), 0.35)  # where its lids meet
    nose = join(capsule((0, 1.9, 7.0), (0, -2.4, 9.3), 0.75, 1.0), ellipsoid((0, -2.6, 9.4), (1.15, 1.0, 1.15)), 0.8)
    nose = join(nose, ellipsoid((1.15, -3.0, 8.4), (0.8, 0.75, 1.0)), 0.6)
    head = join(head, nose, 1.1)
    head = carve(head, ellipsoid((0.62, -3.75, 8.9), (0.38, 0.4, 0.6)), 0.3)        # nostril
    head = join(head, ellipsoid((0, -5.55, 7.7), (2.0, 0.62, 1.15)), 0.7)           # lips
    head = join(head, ellipsoid((0, -6.6, 7.6), (1.7, 0.7, 1.1)), 0.6)
    head = carve(head, ellipsoid((0, -6.02, 9.0), (2.15, 0.1, 0.9)), 0.28)
    head = carve(head, ellipsoid((0, -7.75, 8.7), (1.6, 0.55, 0.7)), 0.9)

    head = join(head, capsule((0, -5.5, -3.0), (0, -17, -4.2), 4.6, 5.2), 2.5)       # neck
    head = join(head, capsule((3.6, -4.5, -2.2), (0.9, -15.6, 1.2), 0.9, 0.8), 1.6)  # its muscle
    head = join(head, ellipsoid((0, -19.6, -4.0), (11.5, 4.6, 6.4)), 3.5)            # shoulders
    head = carve(head, 17.2 + p[..., 1], 2.0)                                        # stands on a plane, with a round edge

    out, back = np.radians(28), np.radians(-14)
    turn = np.array([[np.cos(out), 0, np.sin(out)], [0, 1, 0], [-np.sin(out), 0, np.cos(out)]]) @ \
        np.array([[1, 0, 0], [0, np.cos(back), -np.sin(back)], [0, np.sin(back), np.cos(back)]])
    place = np.array([7.75, -0.1, -1.3])
    local = (p - place) @ turn
    ring = np.sqrt((np.hypot(local[..., 1] / 3.1, local[..., 2] / 1.75) - 0.86) ** 2 * 4.4 + local[..., 0] ** 2) - 0.34
    ear = join(ellipsoid(place, (0.24, 3.0, 1.7), turn), ring, 0.35)
    ear = join(ear, ellipsoid(place + turn @ (0.0, -2.5, 0.35), (0.33, 0.85, 0.75), turn), 0.5)  # lobe
    return join(head, ear, 0.8)


def surface_net(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, in cells, and triangles of the surface where values pass 0 (naive surface nets, Gibson 1998): one vertex in
    each cell that it crosses, in the middle of its crossings, and two triangles for each crossed edge of the grid."""
    inside = values < 0
    total, count = np.zeros((*np.subtract(values.shape, 1), 3)), np.zeros(np.subtract(values.shape, 1))
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        a, b = values[tuple(low)], values[tuple(high)]
        crossed = inside[tuple(low)] != inside[tuple(high)]
        share = np.where(crossed, a / np.where(crossed, a - b, 1), 0)
        others = [other for other in range(3) if other != axis]
        for i in (0, 1):
            for j in (0, 1):
                part = [slice(None)] * 3
                for other, offset in zip(others, (i, j)):
                    part[other] = slice(offset, values.shape[other] - 1 + offset)
                part = tuple(part)
                at = np.zeros((*share[part].shape, 3))
                at[..., axis] = share[part]
                at[..., others[0]], at[..., others[1]] = i, j
                total += np.where(crossed[part][..., None], at, 0)
                count += crossed[part]
    active = count > 0
    number = np.full(active.shape, -1)
    number[active] = np.arange(active.sum())
    vertices = np.argwhere(active) + total[active] / count[active][:, None]

    triangles = []
    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        inner = [slice(1, -1)] * 3
        inner[axis] = slice(None, -1)
        next_ = list(inner)
        next_[axis] = slice(1, None)
        enters = inside[tuple(inner)].astype(int) - inside[tuple(next_)]
        places = np.argwhere(enters) + [int(other != axis) for other in range(3)]
        leaves = enters[enters != 0] > 0

        def cell(i: int, j: int) -> np.ndarray:
            at = places.copy()
            at[:, one] -= i
            at[:, two] -= j
            return number[tuple(at.T)]

        around = np.stack([cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)], axis=1)
        around[~leaves] = around[~leaves][:, ::-1]
        triangles += [around[:, [0, 1, 2]], around[:, [0, 2, 3]]]
    return vertices, np.vstack(triangles)


def pulled(points: np.ndarray) -> np.ndarray:
    """Two steps of Newton's towards the surface itself, which smooths what the grid has left."""
    for _ in range(2):
        height = surface(points)
        slope = np.stack([surface(points + 0.01 * axis) - surface(points - 0.01 * axis) for axis in np.eye(3)], axis=-1) / 0.02
        points = points - (height / np.maximum((slope ** 2).sum(axis=-1), 0.1))[:, None] * slope
    return points


def write_head(out: Path, cell: float) -> None:
    axes = [np.arange(low, high, cell) for low, high in zip(LOW, HIGH)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    vertices, triangles = surface_net(surface(grid))
    write_glb(out, pulled(LOW + cell * vertices).astype(np.float32), triangles.astype(np.uint32))


def head(out: Path) -> None:
    write_head(out, FINE)


def bust(out: Path) -> None:
    """For what is worked out from each vertex to all others: a quarter of them, evenly spread."""
    write_head(out, COARSE)
