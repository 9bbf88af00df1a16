"""Meshes with textures, in one binary glTF file."""
import tempfile
from pathlib import Path

import numpy as np

import meshes
import pictures

Body = tuple[np.ndarray, np.ndarray, np.ndarray]


def grid(rows: int, around: int) -> np.ndarray:
    """Triangles of a grid of vertices, row after row, whose last column lies on its first."""
    first = (np.arange(rows - 1)[:, None] * (around + 1) + np.arange(around)).ravel()
    above = first + around + 1
    return np.vstack([np.stack([first, first + 1, above + 1], axis=1),
                      np.stack([first, above + 1, above], axis=1)]).astype(np.uint32)


def revolved(profile: np.ndarray, v: np.ndarray, around: int) -> Body:
    """Positions, coordinates and triangles of an outline (radius, height; m) that turns around y; u goes once around."""
    rows, angle = len(profile), np.linspace(0, 2 * np.pi, around + 1)
    radius, height = profile[:, :1], np.repeat(profile[:, 1:], around + 1, axis=1)
    positions = np.stack([radius * np.sin(angle), height, radius * np.cos(angle)], axis=2).reshape(-1, 3)
    coordinates = np.stack([np.tile(np.linspace(0, 1, around + 1), (rows, 1)), np.repeat(v[:, None], around + 1, 1)],
                           axis=2).reshape(-1, 2)
    return positions.astype(np.float32), coordinates.astype(np.float32), grid(rows, around)


def seamless_normals(positions: np.ndarray, triangles: np.ndarray, around: int) -> np.ndarray:
    """Smooth ones of such a grid, across the seam too, whose vertices stand there twice."""
    normals = meshes.smooth_normals(positions, triangles).reshape(-1, around + 1, 3)
    seam = normals[:, 0] + normals[:, -1]
    seam /= np.maximum(np.linalg.norm(seam, axis=1, keepdims=True), 1e-9)
    normals[:, 0] = normals[:, -1] = seam
    return normals.reshape(-1, 3)


def normals_of_heights(heights: np.ndarray, across: float, down: float) -> np.ndarray:
    """The normal map of heights that go on from edge to edge, as glTF stores it: x along u, y against v.

    @param across, down  heights' unit over a texel's width and height on the surface
    """
    slope_u = across * (np.roll(heights, -1, axis=1) - np.roll(heights, 1, axis=1)) / 2
    slope_v = down * (np.roll(heights, -1, axis=0) - np.roll(heights, 1, axis=0)) / 2
    normal = np.stack([-slope_u, slope_v, np.ones_like(heights)], axis=2)
    return 0.5 + 0.5 * normal / np.linalg.norm(normal, axis=2, keepdims=True)


def png(values: np.ndarray) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "texture.png"
        pictures.write_png(path, pictures.quantise(values, np.uint8))
        content = path.read_bytes()
    return content + b"\0" * (-len(content) % 4)


def write(out: Path, positions: np.ndarray, normals: np.ndarray, coordinates: np.ndarray, triangles: np.ndarray,
          material: dict, textures: list[np.ndarray], tiles: bool = False) -> None:
    """
    @param material  as glTF has it, with indices of `textures`
    @param textures  [0,1], as they are stored; they repeat along u
    @param tiles     whether they repeat along v too, and do not end there
    """
    parts = [positions.astype("<f4").tobytes(), normals.astype("<f4").tobytes(), coordinates.astype("<f4").tobytes(),
             triangles.astype("<u4").tobytes(), *map(png, textures)]
    starts = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).tolist()
    count, numbers = len(positions), range(len(textures))
    document = {
        "asset": {"version": "2.0", "generator": "lucent make_assets"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3,
                                    "material": 0}]}],
        "materials": [material],
        "textures": [{"source": number, "sampler": 0} for number in numbers],
        "samplers": [{"wrapS": 10497, "wrapT": 10497 if tiles else 33071}],
        "images": [{"bufferView": 4 + number, "mimeType": "image/png"} for number in numbers],
        "buffers": [{"byteLength": starts[-1]}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(part)}
                        for start, part in zip(starts, parts)],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
                       "min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()},
                      {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5126, "count": count, "type": "VEC2"},
                      {"bufferView": 3, "componentType": 5125, "count": triangles.size, "type": "SCALAR"}],
    }
    meshes.write_document(out, document, b"".join(parts))
