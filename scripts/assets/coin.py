"""A medal of our own design: a lighthouse over the sea, beams to both sides, lettering and beads around.

Lengths are in radii of the medal, angles in radians, heights in [0,1].
"""
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import pictures

SIZE = 768
FONT = "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf"
EDGE = 0.985        # where the picture ends, so that its border keeps a few empty texels
FIELD = 0.42        # height of the flat ground
BEADS = 108


def pillow(distance: np.ndarray, width: float) -> np.ndarray:
    """A rounded rise from 0 outside a shape to 1 `width` inside it; `distance` is positive inside."""
    t = np.clip(distance / width, 0, 1)
    return np.sqrt(np.clip(1 - (1 - t) ** 2, 0, 1))


def dome(x: np.ndarray, y: np.ndarray, radius: float) -> np.ndarray:
    return np.sqrt(np.clip(1 - (x * x + y * y) / radius ** 2, 0, 1))


def lettering(radius: np.ndarray, angle: np.ndarray, text: str, middle: float, inner: float, outer: float,
              upright_inwards: bool) -> np.ndarray:
    """Text along a ring: 1 on letters. `middle` is the angle of its centre, clockwise from the top; the feet of the
    letters point to the centre of the medal, or away from it."""
    font = ImageFont.truetype(FONT, 160)
    left, top, right, bottom = font.getbbox(text)
    strip = Image.new("L", (right - left + 40, bottom - top + 40))
    ImageDraw.Draw(strip).text((20 - left, 20 - top), text, font=font, fill=255)
    letters = np.asarray(strip, np.float64) / 255
    texel = (outer - inner) / letters.shape[0]
    turn = (angle - middle + np.pi) % (2 * np.pi) - np.pi
    column = turn * 0.5 * (inner + outer) / texel
    row = (outer - radius) / texel
    if not upright_inwards:
        column, row = -column, letters.shape[0] - row
    return sample(letters, row - 0.5, column + 0.5 * letters.shape[1] - 0.5)


def sample(picture: np.ndarray, row: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Bilinear; 0 outside."""
    padded = np.pad(picture, 1)
    row = np.clip(row + 1, 0, padded.shape[0] - 1.001)
    column = np.clip(column + 1, 0, padded.shape[1] - 1.001)
    i, j = row.astype(int), column.astype(int)
    u, v = row - i, column - j
    return ((1 - u) * ((1 - v) * padded[i, j] + v * padded[i, j + 1]) +
            u * ((1 - v) * padded[i + 1, j] + v * padded[i + 1, j + 1]))


def tower(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The lighthouse: tapered tower with two grooves, gallery, lantern, roof."""
    foot, top = -0.30, 0.16
    up = np.clip((y - foot) / (top - foot), 0, 1)
    half = 0.125 - 0.055 * up
    groove = sum(np.exp(-((y - level) / 0.008) ** 2) for level in (-0.15, 0.0))
    shaft = np.where((y >= foot) & (y <= top), dome(x / half, 0 * x, 1) * (0.30 - 0.05 * groove), 0)
    gallery = box(x, y, 0.0, 0.175, 0.105, 0.018, 0.02) * 0.33
    lantern = np.where(abs(y - 0.235) <= 0.045, dome(x / 0.055, 0 * x, 1) * 0.24, 0)
    panes = sum(np.exp(-((x - bar) / 0.006) ** 2) for bar in (-0.028, 0.0, 0.028)) * (abs(y - 0.235) <= 0.045) * 0.05
    roof_half = np.clip(0.08 * (0.36 - y) / 0.08, 1e-6, 0.08)
    roof = np.where((y >= 0.28) & (y <= 0.36), dome(x / roof_half, 0 * x, 1) * 0.28, 0)
    knob = dome(x, y - 0.375, 0.022) * 0.2
    return np.maximum.reduce([shaft, gallery, lantern + panes * (lantern > 0), roof, knob])


def box(x: np.ndarray, y: np.ndarray, at_x: float, at_y: float, half_x: float, half_y: float,
        edge: float) -> np.ndarray:
    return pillow(np.minimum(half_x - abs(x - at_x), half_y - abs(y - at_y)), edge)


def rays(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Two beams of three rays each from the lantern, fading before the ring around the scene."""
    far = np.hypot(x, y - 0.235)
    steep = np.arctan2(y - 0.235, abs(x))
    beam = sum(pillow(1 - abs(steep - middle) / 0.055, 1.0) for middle in (-0.2, 0.0, 0.2))
    return 0.13 * beam * pictures.smoothstep(0.10, 0.16, far) * pictures.smoothstep(0.59, 0.46, np.hypot(x, y))


def sea(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Rows of waves, nearer rows in front, and the rock that the tower stands on."""
    inside = pictures.smoothstep(0.60, 0.585, np.hypot(x, y))
    height = 0.16 * dome(x / 0.34, (y + 0.36) / 0.13, 1) * (1 + 0.10 * np.cos(29 * x + 11 * y) * np.cos(23 * y - 7 * x))
    for row, level in enumerate((-0.34, -0.43, -0.52)):
        crest = level + 0.022 * np.cos(2 * np.pi * (x / 0.20 + 0.5 * row))
        below = crest - y
        wave = (0.10 + 0.05 * row) * np.exp(-np.clip(below, 0, None) / 0.06) * pictures.smoothstep(0, 0.012, below)
        height = np.where(below > 0, np.maximum(wave, 0.02), height)
    return height * inside


def heights(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    rim = pillow(np.minimum(radius - 0.895, EDGE - radius), 0.045) * 0.40
    place = (angle / (2 * np.pi) * BEADS) % 1 - 0.5
    beads = dome(place * 2 * np.pi * 0.862 / BEADS, radius - 0.862, 0.021) * 0.16
    ring = pillow(0.010 - abs(radius - 0.615), 0.010) * 0.10
    upper = lettering(radius, angle, "LIGHT IN RELIEF", 0, 0.655, 0.815, True)
    lower = lettering(radius, angle, "LUCENT · MMXXVI", np.pi, 0.655, 0.815, False)
    # Letters with soft flanks: a blur of 1.5 texels, steepened.
    letters = pictures.smoothstep(0.15, 0.85, pictures.blur(np.maximum(upper, lower), 1.5)) * 0.15
    scene = np.maximum.reduce([tower(x, y), sea(x, y), rays(x, y)])
    dish = 0.05 * np.clip(radius / 0.6, 0, 1) ** 2  # the ground rises towards the lettering, as on struck medals
    struck = FIELD + dish + np.maximum.reduce([beads, ring, letters, scene])
    return np.where(radius < EDGE, np.maximum(struck, FIELD + rim), 0)


def coin(relief: Path, alpha: Path, colors: Path) -> None:
    """Heights in 16 bits, the round outline in 8, and a patina: dark bronze in the hollows, bright on what hands
    and cloths have rubbed."""
    place = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
    x, y = np.meshgrid(place, -place)
    height = pictures.blur(heights(x, y), 0.7)  # 0.7 texels: no steeper edge than the texels can hold
    pictures.write_png(relief, pictures.quantise(height, np.uint16))
    texel = 2 / SIZE
    pictures.write_png(alpha, pictures.quantise((EDGE - 0.008 - np.hypot(x, y)) / texel + 0.5, np.uint8))
    rubbed = pictures.smoothstep(-0.05, 0.09, height - pictures.blur(height, 14))
    hollow, bright = np.array([0.16, 0.105, 0.06]), np.array([0.80, 0.53, 0.27])
    pictures.write_color(colors, hollow + rubbed[..., None] * (bright - hollow))
