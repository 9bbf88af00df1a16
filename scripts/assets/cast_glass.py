"""Heights of a pane of cast glass: rings around two places, as where drops fell into the melt."""
from pathlib import Path

import numpy as np

import pictures

SIZE = 192
CENTRES = (0.34, 0.38), (0.71, 0.66)  # of the rings, in sides of the pane
RINGS = 6.5                           # to a side
FADE = 1.8                            # how fast rings die out, per side; chosen by eye


def heights(out: Path) -> None:
    """16-bit PNG; the pane is half as thick as 1 where no ring is."""
    place = (np.arange(SIZE) + 0.5) / SIZE
    x, y = np.meshgrid(place, place)
    rings = [np.cos(2 * np.pi * RINGS * np.hypot(x - u, y - v)) * np.exp(-FADE * np.hypot(x - u, y - v))
             for u, v in CENTRES]
    pictures.write_png(out, pictures.quantise(0.5 + 0.25 * sum(rings), np.uint16))
