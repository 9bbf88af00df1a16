"""Pictures that lamps project."""
from pathlib import Path

import numpy as np

import pictures


def checkerboard(out: Path) -> None:
    """8 by 8 squares, white and dark, with the first at the upper left white."""
    rows, columns = np.indices((256, 256)) // 32
    pictures.write_color(out, np.repeat(((rows + columns) % 2 == 0)[..., None] * 0.97 + 0.03, 3, axis=2))
