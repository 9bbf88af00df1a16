"""A height map made from a formula: round cobbles, which go on from tile to tile."""
from pathlib import Path

import numpy as np

import pictures

STONES = 6      # each way
SCATTER = 0.36  # how far a stone lies from its place in the grid, in spacings; chosen by eye
GAP = 0.42      # how far apart the two nearest stones must be for their domes to be whole, in spacings
SEED = 7


def heights(size: int) -> np.ndarray:
    """Heights in [0, 1]: how much nearer the nearest stone is than the next, rounded, a little different for each."""
    random = np.random.default_rng(SEED)
    grid = np.stack(np.meshgrid(np.arange(STONES), np.arange(STONES)), axis=-1).reshape(-1, 2)
    stones = grid + 0.5 + SCATTER * random.uniform(-1, 1, grid.shape)
    tall = random.uniform(0.75, 1, len(stones))
    place = (np.arange(size) + 0.5) * STONES / size
    here = np.stack(np.meshgrid(place, place), axis=-1)[..., None, :]
    apart = np.abs(here - stones)
    apart = np.minimum(apart, STONES - apart)  # the nearer of its copies in the tiles around
    distance = np.hypot(apart[..., 0], apart[..., 1])
    nearest = np.argsort(distance, axis=-1)[..., :2]
    first, second = (np.take_along_axis(distance, nearest[..., i:i + 1], axis=-1)[..., 0] for i in (0, 1))
    inside = np.clip((second - first) / GAP, 0, 1)
    return pictures.blur(np.sqrt(1 - (1 - inside) ** 2) * tall[nearest[..., 0]], 1.0)


def height_map(out: Path) -> None:
    """16-bit PNG, 256 x 256."""
    pictures.write_png(out, pictures.quantise(heights(256), np.uint16))
