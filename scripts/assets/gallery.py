"""The gallery: scene files with their data beside them, a poster and a thumbnail of each, and a list for the page."""
import json
import subprocess
import tempfile
from pathlib import Path

from PIL import Image

POSTER = 512     # pixels, the longer side
THUMBNAIL = 256  # pixels, the longer side

# Of truths: pixels of the longer side, directions that stand for an environment. Lamps are one question a pixel, light
# from all around is one for each direction.
TRUTH_UNDER_LAMPS = 192, 1
TRUTH_UNDER_SKY = 128, 2048

# Of truths with bent and mirrored light: pixels of the longer side, light rays, points of each pixel, of lamps that have
# a size and of the environment.
TRUTH_WITH_LIGHT_RAYS = 128, 32_000_000, 4096

# Of truths with light inside: pixels of the longer side, lines for each of them on which light may enter.
TRUTH_OF_DIPOLES = 128, 512

# Kinds of materials that send light back by a BRDF.
GLOSSY = "glossy", "phong", "blinn", "cook-torrance", "oren-nayar", "measured"

# Of truths with glossy surfaces: pixels of the longer side, directions and points of lamps for each of them.
TRUTH_OF_GLOSS = 128, 1024

# How the names of files end in scenes.
ENDINGS = ".png", ".hdr", ".exr", ".glb", ".obj", ".json"


def files_of(scene: Path) -> list[Path]:
    """Files that a scene names, beside it: every text in it that ends like the name of one."""
    def texts(value) -> list[str]:
        if isinstance(value, dict):
            value = list(value.values())
        if isinstance(value, list):
            return [text for item in value for text in texts(item)]
        return [value] if isinstance(value, str) else []

    return [scene.with_name(text) for text in texts(json.loads(scene.read_text())) if text.endswith(ENDINGS)]


def picture_names(scene: Path) -> dict[str, str]:
    return {"thumbnail": f"{scene.stem}-{THUMBNAIL}.jpg", "poster": f"{scene.stem}-{POSTER}.jpg"}


def is_relief(content: dict) -> bool:
    return all(thing["shape"]["type"] == "heightfield" for thing in content["objects"])


def is_single_relief(scene: Path) -> bool:
    content = json.loads(scene.read_text())
    return is_relief(content) and len(content["objects"]) == 1


def scatters(content: dict) -> bool:
    """Whether light goes on inside some of its things."""
    materials = [thing.get("material", {}) for thing in content["objects"]]
    return any("preset" in material or "scattering" in material for material in materials)


def is_glossy(content: dict) -> bool:
    """Whether some of its things are; what brings its materials along is taken for glossy."""
    return any(thing.get("material", {}).get("kind") in GLOSSY or
               (thing["shape"]["type"] == "mesh" and "material" not in thing) for thing in content["objects"])


def save_small(picture: Image.Image, side: int, out: Path) -> None:
    small = picture.copy()
    small.thumbnail((side, side), Image.LANCZOS)
    small.save(out, quality=85)


def pictures_of(program: Path, scene: Path, poster: Path, thumbnail: Path) -> None:
    """Renders a scene; transparent parts become light grey. At twice the poster's size, which smooths its edges; reliefs
    under light from all around have few sharp ones and cost hundreds of lamps."""
    content = json.loads(scene.read_text())
    width, height = content["size"]
    scale = POSTER * (1 if "environment" in content and is_relief(content) else 2) / max(width, height)
    size = f"{round(width * scale)}x{round(height * scale)}"
    with tempfile.NamedTemporaryFile(suffix=".png") as file:
        subprocess.run([program, "render", scene, "-o", file.name, "--size", size,
                        "--set", "technique.sampling.pixelSamples=1"], check=True)
        rendered = Image.open(file.name).convert("RGBA")
    picture = Image.new("RGBA", rendered.size, (236, 235, 232, 255))
    picture.alpha_composite(rendered)
    save_small(picture.convert("RGB"), POSTER, poster)
    save_small(picture.convert("RGB"), THUMBNAIL, thumbnail)


def has_truth(content: dict) -> bool:
    """Whether light is shown; other quantities have no truth."""
    return content.get("view", {}).get("show", "color") == "color"


def truth_name(scene: Path) -> str:
    return f"{scene.stem}-truth.pfm"


def truth_of(program: Path, scene: Path, truth: Path, _facts: Path) -> None:
    """The exact picture of a scene, linear. The program writes beside it what it is and how far it may be off."""
    content = json.loads(scene.read_text())
    if is_relief(content):
        side, directions = TRUTH_UNDER_SKY if "environment" in content else TRUTH_UNDER_LAMPS
        alone = len(content["objects"]) == 1 # others are solved with what each keeps from the others
        options = ["--directions" if alone else "--samples", directions]
    elif scatters(content):
        side, lines = TRUTH_OF_DIPOLES
        options = ["--estimator", "dipole", "--samples", lines]
    elif is_glossy(content):
        side, samples = TRUTH_OF_GLOSS
        options = ["--samples", samples]
    else:
        side, rays, points = TRUTH_WITH_LIGHT_RAYS
        options = ["--estimator", "light", "--photons", rays, "--samples", points]
    width, height = (round(length * side / max(content["size"])) for length in content["size"])
    subprocess.run([program, "truth", scene, "-o", truth, "--size", f"{width}x{height}", *map(str, options)],
                   check=True, stdout=subprocess.DEVNULL)


def index_of_truth(scene: Path) -> dict | None:
    """What the page must know of a truth; None where there is none yet."""
    truth = scene.with_name(truth_name(scene))
    facts = truth.with_name(truth.name + ".json")
    if not truth.exists() or not facts.exists():
        return None
    known = json.loads(facts.read_text())
    return {"file": truth.name, "size": [known["width"], known["height"]], "noise": known["standardError"],
            "directions": known["directions"]}


def kind_of(scene: dict) -> str:
    """Under which heading the page shows a scene: what light does in it."""
    materials = [thing.get("material", {}) for thing in scene["objects"]]
    if any(material.get("reflectance") for material in materials):
        return "Caustics"
    if any(thing["shape"]["type"] == "water" for thing in scene["objects"]):
        return "Caustics"
    if any(material.get("precomputed") for material in materials):
        return "Throughput"
    if any("paint" in thing for thing in scene["objects"]):
        return "Paint"
    if scatters(scene):
        return "Subsurface"
    if any(material.get("transmission") for material in materials):
        return "Refraction"
    if any("displacement" in thing for thing in scene["objects"]):
        return "Displacement"
    return "BRDF" if is_glossy(scene) else "Relief"


def index_of(scenes: list[Path]) -> str:
    """The list that the page shows, of the scenes in the order given. Under "making" stands what is not there yet: the
    "scene" itself where a file that it names is missing, its "picture", its "truth"."""
    entries = []
    for scene in scenes:
        content = json.loads(scene.read_text())
        entry = {"id": scene.stem, "title": content["title"], "caption": content["caption"], "kind": kind_of(content),
                 "scene": scene.name}
        names, truth, making = picture_names(scene), index_of_truth(scene), []
        if not all(path.exists() for path in files_of(scene)):
            making.append("scene")
        if all(scene.with_name(name).exists() for name in names.values()):
            entry |= names
        else:
            making.append("picture")
        if truth:
            entry["truth"] = truth
        elif has_truth(content):
            making.append("truth")
        entries.append(entry | ({"making": making} if making else {}))
    return json.dumps(entries, indent=2, ensure_ascii=False) + "\n"
