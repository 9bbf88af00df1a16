"""A normal map made from a formula: plain weave of flat cords, as on a basket."""
from pathlib import Path

import numpy as np

import pictures

CORDS = 8        # each way
CORD_WIDTH = 0.86  # of the spacing; the rest is the gap between cords
WAVE = 0.17      # how far a cord rises and dips, in spacings; chosen by eye
BULGE = 0.30     # how round a cord is across, in spacings; chosen by eye


def cord_heights(along: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Height in spacings of cords that run along one axis; they pass over and under in turn."""
    index = np.floor(across)
    offset = (across - index - 0.5) / (0.5 * CORD_WIDTH)
    over = WAVE * np.cos(np.pi * (along - 0.5 + index))
    roundness = BULGE * np.clip(np.cos(0.5 * np.pi * np.clip(offset, -1, 1)), 0, 1)
    return np.where(np.abs(offset) <= 1, over + roundness, -0.3)


def heights(size: int) -> np.ndarray:
    """Height in texels over a square of `size` texels."""
    spacing = size / CORDS
    place = (np.arange(size) + 0.5) / spacing
    x, y = np.meshgrid(place, place)
    # The cords across are half a turn later, so that one is over where the other is under.
    surface = np.maximum(cord_heights(x, y), cord_heights(y + 1, x))
    return pictures.blur(surface * spacing, 1.2)  # 1.2 texels: a normal map cannot hold a cliff


def normal_map(out: Path) -> None:
    """8-bit PNG of n = 2 c - 1, +y up in the picture, 512 x 512."""
    height = heights(512)
    right = 0.5 * (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1))
    up = 0.5 * (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0))
    normal = np.stack([-right, -up, np.ones_like(height)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    pictures.write_png(out, pictures.quantise(0.5 + 0.5 * normal, np.uint8))
