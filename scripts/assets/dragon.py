"""The dragon's depth as a picture, so that a page fetches 0.7 MB of heights and not 15 MB of triangles."""
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import pictures

# Chosen by eye: the head turned a little towards the viewer.
VIEW = ["--size", "1024x768", "--rotate", "0,-12,0", "--margin", "0.045", "--floor-gap", "0.10"]
STONE = np.array([0.70, 0.67, 0.62])
JADE = np.array([0.20, 0.47, 0.32])


def dragon(program: Path, mesh: Path, heights: Path, outline: Path, colors: Path) -> None:
    """16-bit heights; the outline as an 8-bit mask; and a colour map: jade on pale stone."""
    with tempfile.NamedTemporaryFile(suffix=".pfm") as file:
        subprocess.run([program, "convert", mesh, "-o", file.name, *VIEW], check=True, stdout=subprocess.DEVNULL)
        height = pictures.read_pfm(Path(file.name))
    pictures.write_png(heights, pictures.quantise(height, np.uint16))
    body = np.clip(pictures.blur((height > 0).astype(float), 0.6), 0, 1)  # 0.6 texels: soft steps along the outline
    pictures.write_png(outline, pictures.quantise(body, np.uint8))
    pictures.write_color(colors, STONE + body[..., None] * (JADE - STONE))
