"""A ring whose normal map says what the height map of the cobbles lifts (figure 3.1 of the 2007 dissertation)."""
from pathlib import Path

import numpy as np

import cobbles
import textured

MAJOR, MINOR = 0.34, 0.15  # m
AROUND, ACROSS = 192, 72   # vertices around the ring and its tube
REPEAT = (6, 3)            # of the map
SCALE = 0.035              # m that heights lift


def ring(out: Path) -> None:
    u, v = np.meshgrid(np.linspace(0, 1, AROUND + 1), np.linspace(0, 1, ACROSS + 1))
    a, b = 2 * np.pi * u, 2 * np.pi * v
    normals = np.stack([np.cos(b) * np.cos(a), np.sin(b), -np.cos(b) * np.sin(a)], axis=2)
    middle = MAJOR * np.stack([np.cos(a), np.zeros_like(a), -np.sin(a)], axis=2)
    positions = (middle + MINOR * normals).reshape(-1, 3).astype(np.float32)
    coordinates = np.stack([REPEAT[0] * u, REPEAT[1] * (1 - v)], axis=2).reshape(-1, 2).astype(np.float32)
    heights = cobbles.heights(256)
    texel = [2 * np.pi * radius / repeat / 256 for radius, repeat in zip((MAJOR, MINOR), REPEAT)]
    normal = textured.normals_of_heights(heights, SCALE / texel[0], SCALE / texel[1])
    material = {"name": "clay", "normalTexture": {"index": 0},
                "pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.5, 0.32, 1], "metallicFactor": 0}}
    textured.write(out, positions, normals.reshape(-1, 3), coordinates, textured.grid(ACROSS + 1, AROUND), material,
                   [normal], tiles=True)
