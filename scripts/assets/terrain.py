"""A measured landscape: the elevation model that Debian's python-matplotlib-data packages.

Ridges of the Appalachians near Jacksboro, Tennessee: 403 x 344 whole metres from 236 to 1076, one each 3 arc seconds
of longitude and latitude.
"""
import math
from pathlib import Path

import numpy as np

import pictures

METRES_PER_DEGREE = 111_200  # of latitude, on a sphere of the Earth's mean radius


def resample(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Rows at fractional `places` of the samples, by Catmull and Rom's cubic (1974); the border rows go on."""
    below = np.floor(places).astype(int)
    t = (places - below)[:, None]
    rows = [values[np.clip(below + k, 0, len(values) - 1)] for k in (-1, 0, 1, 2)]
    return 0.5 * (2 * rows[1] + t * (rows[2] - rows[0]) + t ** 2 * (2 * rows[0] - 5 * rows[1] + 4 * rows[2] - rows[3])
                  + t ** 3 * (3 * (rows[1] - rows[2]) + rows[3] - rows[0]))


def square_texels(elevation: np.ndarray, across: float, down: float, columns: int) -> np.ndarray:
    """The samples, `across` by `down` metres each, on square texels; `columns` of them over the same ground."""
    texel = elevation.shape[1] * across / columns
    rows = round(elevation.shape[0] * down / texel)

    def places(count: int, spacing: float) -> np.ndarray:
        return (np.arange(count) + 0.5) * texel / spacing - 0.5

    return resample(resample(elevation, places(rows, down)).T, places(columns, across)).T


def tint(height: np.ndarray) -> np.ndarray:
    """Colours by height after the school of Swiss relief maps: cool green valleys, warm pale crests. Taste."""
    stops = np.array([[0.22, 0.30, 0.26], [0.42, 0.46, 0.33], [0.66, 0.58, 0.42], [0.84, 0.78, 0.68]])
    place = np.linspace(0, 1, len(stops))
    return np.stack([np.interp(height, place, stops[:, channel]) for channel in range(3)], axis=-1)


def elevation(source: Path, heights: Path, colors: Path, terraced: Path) -> None:
    """Heights as 16-bit PNG, 0 for the lowest and 1 for the highest metre; tints; and the same heights in 8 bits,
    whose terraces are 3.3 m high."""
    data = np.load(source)
    # The file's ymin is the latitude of row 0, in the north.
    down = float(data["dy"]) * METRES_PER_DEGREE
    across = float(data["dx"]) * METRES_PER_DEGREE * math.cos(math.radians(float(data["ymin"])))
    metres = square_texels(data["elevation"].astype(np.float64), across, down, 512)
    height = (metres - metres.min()) / (metres.max() - metres.min())
    width = data["elevation"].shape[1] * across
    print(f"elevation: {width / 1000:.2f} km wide, {metres.max() - metres.min():.0f} m from lowest to highest; "
          f"true heightScale of a 1 m model: {(metres.max() - metres.min()) / width:.5f}")
    pictures.write_png(heights, pictures.quantise(height, np.uint16))
    pictures.write_png(terraced, pictures.quantise(height, np.uint8))
    pictures.write_color(colors, tint(pictures.blur(height, 1.5)))
