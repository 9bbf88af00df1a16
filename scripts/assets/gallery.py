"""The gallery: scene files with their data beside them, a poster and a thumbnail of each, and a list for the page."""
import json
import subprocess
import tempfile
from pathlib import Path

from PIL import Image

POSTER = 512     # pixels, the longer side
THUMBNAIL = 256  # pixels, the longer side


def files_of(scene: Path) -> list[Path]:
    """Files that a scene names: every text in it that is the name of a file beside it."""
    def texts(value) -> list[str]:
        if isinstance(value, dict):
            value = list(value.values())
        if isinstance(value, list):
            return [text for item in value for text in texts(item)]
        return [value] if isinstance(value, str) else []

    beside = {path.name: path for path in scene.parent.iterdir()}
    return [beside[text] for text in texts(json.loads(scene.read_text())) if text in beside]


def save_small(picture: Image.Image, side: int, out: Path) -> None:
    small = picture.copy()
    small.thumbnail((side, side), Image.LANCZOS)
    small.save(out, quality=85)


def pictures_of(program: Path, scene: Path, poster: Path, thumbnail: Path) -> None:
    """Renders a scene; transparent parts become light grey. Under lamps at twice the poster's size, which smooths its
    edges; light from all around has few sharp ones and costs hundreds of lamps."""
    content = json.loads(scene.read_text())
    width, height = content["size"]
    scale = POSTER * (1 if "environment" in content else 2) / max(width, height)
    size = f"{round(width * scale)}x{round(height * scale)}"
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        subprocess.run([program, "render", scene, "-o", file.name, "--size", size], check=True)
        rendered = Image.open(file.name).convert("RGBA")
    picture = Image.new("RGBA", rendered.size, (236, 235, 232, 255))
    picture.alpha_composite(rendered)
    save_small(picture.convert("RGB"), POSTER, poster)
    save_small(picture.convert("RGB"), THUMBNAIL, thumbnail)


def write_index(*paths: Path) -> None:
    """The list that the page shows: of the scenes in the order given, written to the last path."""
    *scenes, out = paths
    entries = []
    for scene in scenes:
        content = json.loads(scene.read_text())
        entries.append({"id": scene.stem, "title": content["title"], "caption": content["caption"],
                        "scene": scene.name, "thumbnail": f"{scene.stem}-256.jpg", "poster": f"{scene.stem}-512.jpg"})
    out.write_text(json.dumps(entries, indent=2, ensure_ascii=False) + "\n")
