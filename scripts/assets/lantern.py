"""A pierced lantern of brass: what is cut out of it stands in the alpha of its colour."""
from pathlib import Path

import numpy as np

import pictures
import textured
import vase

AROUND = 96
WIDTH, HEIGHT = 1536, 768  # texels
# Outline from the foot up: radius and height, m.
OUTLINE = np.array([(0.040, 0.000), (0.070, 0.012), (0.105, 0.050), (0.118, 0.100), (0.105, 0.150), (0.070, 0.188),
                    (0.030, 0.205), (0.022, 0.225), (0.000, 0.240)])
STARS = (0.28, 0.46)       # bands of the cutting, as shares of the way along the outline: (from, to)
PETALS = (0.50, 0.72)
DOTS = ((0.10, 11), (0.14, 13), (0.21, 16), (0.25, 18), (0.755, 16), (0.80, 12))  # rows of holes: place and how many


def holes(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Where nothing is. u goes once around, v from foot to tip."""
    cut = np.zeros_like(u, bool)
    for place, count in DOTS:
        cut |= np.hypot(2 * ((count * u) % 1) - 1, (v - place) / 0.016) < 0.55
    # stars of six rays
    x, y = 2 * ((12 * u) % 1) - 1, 2 * vase.inside(v, STARS) - 1
    cut |= vase.within(v, STARS) & (np.hypot(x, y) < 0.52 + 0.34 * np.cos(6 * np.arctan2(y, x)))
    # petals, pointed at both ends
    x, y = 2 * ((20 * u) % 1) - 1, 2 * vase.inside(v, PETALS) - 1
    return cut | (vase.within(v, PETALS) & (np.abs(x) < 0.62 * (1 - y ** 2)))


def lantern(out: Path) -> None:
    profile = vase.curve(OUTLINE, 96)
    positions, coordinates, triangles = textured.revolved(profile, np.linspace(1, 0, len(profile)), AROUND)
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, 1 - (np.arange(HEIGHT) + 0.5) / HEIGHT)
    chance = np.random.default_rng(1207)
    cloud = pictures.blur(chance.standard_normal((HEIGHT, WIDTH)), 18)
    color = np.array([0.85, 0.58, 0.24]) * (1 + 0.06 * cloud / cloud.std())[..., None]
    solid = pictures.blur(1 - holes(u, v).astype(float), 1.0)
    material = {"name": "brass", "alphaMode": "MASK", "doubleSided": True,
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "roughnessFactor": 0.55}}
    textured.write(out, positions, textured.seamless_normals(positions, triangles, AROUND), coordinates, triangles,
                   material, [np.dstack([pictures.srgb(color), solid])])
