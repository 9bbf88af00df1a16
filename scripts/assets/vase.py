"""A painted vase with textures: colour, metal and roughness, and normals, in one binary glTF file."""
from pathlib import Path

import numpy as np

import pictures
import textured

AROUND = 96                # vertices once around
WIDTH, HEIGHT = 1536, 768  # texels of each texture
BEND = 0.004               # m, radius of the lip

# Outline from the foot up: radius and height, m. Between them a smooth curve.
OUTLINE = np.array([(0.050, 0.000), (0.052, 0.006), (0.034, 0.022), (0.046, 0.050), (0.088, 0.105), (0.098, 0.150),
                    (0.086, 0.195), (0.050, 0.232), (0.036, 0.255), (0.038, 0.285), (0.056, 0.305)])

# Bands of the painting, as shares of the way along the outline: (from, to).
FOOT, RAYS, MEANDER, WAVES, NECK, LIP = (0, 0.1), (0.14, 0.34), (0.44, 0.58), (0.64, 0.72), (0.78, 0.92), (0.95, 1)


def curve(points: np.ndarray, count: int) -> np.ndarray:
    """Points at even shares of the way along a Catmull-Rom curve through others."""
    padded = np.vstack([2 * points[0] - points[1], points, 2 * points[-1] - points[-2]])
    t = np.linspace(0, 1, 64, endpoint=False)[:, None]
    a, b, c, d = (padded[i:len(points) - 1 + i, None, :] for i in range(4))
    fine = (b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))).reshape(-1, 2)
    fine = np.vstack([fine, points[-1]])
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))])
    even = np.linspace(0, way[-1], count)
    return np.stack([np.interp(even, way, fine[:, axis]) for axis in range(2)], axis=1)


def within(v: np.ndarray, band: tuple[float, float]) -> np.ndarray:
    return (v >= band[0]) & (v < band[1])


def inside(v: np.ndarray, band: tuple[float, float]) -> np.ndarray:
    """Share of the way through a band."""
    return (v - band[0]) / (band[1] - band[0])


def meander(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A Greek key of squares: 1 where it is painted."""
    key = np.array([[1, 1, 1, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0, 0, 0, 1], [1, 1, 1, 1, 1, 1, 0, 1],
                    [1, 0, 0, 0, 0, 1, 0, 1], [1, 0, 1, 1, 0, 1, 0, 1], [1, 0, 1, 1, 1, 1, 0, 1],
                    [1, 0, 0, 0, 0, 0, 0, 1], [1, 1, 1, 1, 1, 1, 1, 1]])
    return key[np.clip((8 * (1 - v)).astype(int), 0, 7), (8 * u).astype(int) % 8]


def painting(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where black glaze and gold lie. u goes once around, v from foot to lip."""
    glaze = within(v, FOOT) | within(v, NECK) | within(v, LIP)
    glaze |= within(v, (RAYS[1] + 0.02, RAYS[1] + 0.04)) | within(v, (WAVES[1] + 0.02, WAVES[1] + 0.03))
    # rays that grow narrower upwards
    glaze |= within(v, RAYS) & (np.abs(2 * ((24 * u) % 1) - 1) < 1 - inside(v, RAYS))
    glaze |= within(v, MEANDER) & (meander((18 * u) % 1, inside(v, MEANDER)) == 1)
    wave = 0.5 + 0.32 * np.sin(2 * np.pi * 20 * u)
    glaze |= within(v, WAVES) & (np.abs(inside(v, WAVES) - wave) < 0.14)
    gold = within(v, (MEANDER[0] - 0.03, MEANDER[0] - 0.015)) | within(v, (MEANDER[1] + 0.015, MEANDER[1] + 0.03))
    gold |= within(v, (0.985, 1.1)) | within(v, (NECK[0] - 0.012, NECK[0]))
    return glaze & ~gold, gold


def textures() -> list[np.ndarray]:
    """Colour (linear), roughness and metal (as glTF has them in green and blue), normals; row 0 is the lip."""
    u, v = np.meshgrid((np.arange(WIDTH) + 0.5) / WIDTH, 1 - (np.arange(HEIGHT) + 0.5) / HEIGHT)
    glaze, gold = painting(u, v)
    edges = [pictures.blur(mask.astype(float), 1.2) for mask in (glaze, gold)]
    chance = np.random.default_rng(2007)
    grain = pictures.blur(chance.standard_normal((HEIGHT, WIDTH)), 1.5)
    cloud = pictures.blur(chance.standard_normal((HEIGHT, WIDTH)), 24)
    grain, cloud = grain / grain.std(), cloud / cloud.std()

    def mixed(clay, black, metal):
        black_share, gold_share = edges[0][..., None], edges[1][..., None]
        return (clay * (1 - black_share) + black * black_share) * (1 - gold_share) + metal * gold_share

    clay = np.array([0.48, 0.165, 0.06]) * (1 + 0.07 * cloud + 0.04 * grain)[..., None]
    color = mixed(clay, np.array([0.012, 0.011, 0.011]), np.array([0.95, 0.64, 0.22]))
    roughness = mixed((0.82 + 0.03 * grain)[..., None], 0.24 + 0.02 * cloud[..., None], 0.3)[..., 0]
    facets = np.stack([np.ones_like(roughness), roughness, edges[1]], axis=2)
    # Grooves of the potter's wheel and grains, in units of a texel; glaze lies over the clay.
    heights = 0.5 * np.sin(2 * np.pi * 70 * v) * (1 - 0.7 * edges[0]) + 0.25 * grain * (1 - edges[0]) + \
        1.2 * edges[0] + 1.6 * edges[1]
    across = (np.roll(heights, -1, axis=1) - np.roll(heights, 1, axis=1)) / 2
    down = np.gradient(heights, axis=0)
    normal = np.stack([-across, down, np.full_like(heights, 4)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return [color, facets, 0.5 + 0.5 * normal]


def body() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, texture coordinates and triangles: outside, lip, and the inside of the neck down to its dark."""
    outside = curve(OUTLINE, 128)
    inner = outside[:60:-1] - [BEND, 0]
    rim = np.stack([outside[-1, 0] - BEND / 2 + BEND / 2 * np.cos(np.linspace(0, np.pi, 8)[1:-1]),
                    outside[-1, 1] + BEND / 2 * np.sin(np.linspace(0, np.pi, 8)[1:-1])], axis=1)
    profile = np.vstack([[[0, 0]], outside, rim, inner, [[0, inner[-1, 1]]]])
    v = np.concatenate([[1], np.linspace(1, 0, len(outside)), np.zeros(len(rim)), np.full(len(inner) + 1, 0.12)])
    return textured.revolved(profile, v, AROUND)


def vase(out: Path) -> None:
    positions, coordinates, triangles = body()
    color, facets, normal = textures()
    material = {"name": "pottery", "normalTexture": {"index": 2},
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}}
    textured.write(out, positions, textured.seamless_normals(positions, triangles, AROUND), coordinates, triangles,
                   material, [pictures.srgb(color), facets, normal])
