"""Solids that flow into each other, as one closed mesh: distances to ellipsoids and capsules, joined and carved, and a
surface net of where they are 0. Any unit of length; below 0 is inside."""
from collections.abc import Callable
from pathlib import Path

import numpy as np

from meshes import write_glb


def mirrored(points: np.ndarray, axis: int = 0) -> np.ndarray:
    """So that what is made on the positive side of an axis stands on both."""
    p = points.copy()
    p[..., axis] = np.abs(p[..., axis])
    return p


def ellipsoid(p: np.ndarray, centre, radii, turn=np.eye(3)) -> np.ndarray:
    """About the distance near the surface. Columns of `turn` are its axes."""
    local = (p - np.array(centre)) @ turn
    near = np.linalg.norm(local / radii, axis=-1)
    slope = np.linalg.norm(local / np.square(radii), axis=-1)
    return near * (near - 1) / np.maximum(slope, 1e-9)


def capsule(p: np.ndarray, start, end, first: float, last: float) -> np.ndarray:
    """Its radius goes from `first` to `last`."""
    start, way = np.array(start, float), np.subtract(end, start)
    along = np.clip((p - start) @ way / (way @ way), 0, 1)
    return np.linalg.norm(p - start - along[..., None] * way, axis=-1) - (first + along * (last - first))


def join(a: np.ndarray, b: np.ndarray, k: float) -> np.ndarray:
    """The union; within k the two flow into each other."""
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k / 4


def carve(a: np.ndarray, b: np.ndarray, k: float) -> np.ndarray:
    return -join(-a, b, k)


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


def pulled(surface: Callable, points: np.ndarray) -> np.ndarray:
    """Two steps of Newton's towards the surface itself, which smooths what the grid has left."""
    for _ in range(2):
        height = surface(points)
        slope = np.stack([surface(points + 0.01 * axis) - surface(points - 0.01 * axis) for axis in np.eye(3)], axis=-1) / 0.02
        points = points - (height / np.maximum((slope ** 2).sum(axis=-1), 0.1))[:, None] * slope
    return points


def write(out: Path, surface: Callable, low, high, cell: float) -> None:
    """
    @param surface    distances of points
    @param low, high  corners of a box around it
    @param cell       of the grid
    """
    axes = [np.arange(first, last, cell) for first, last in zip(low, high)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    vertices, triangles = surface_net(surface(grid))
    write_glb(out, pulled(surface, np.array(low) + cell * vertices).astype(np.float32), triangles.astype(np.uint32))
