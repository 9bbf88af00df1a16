"""The Cesium Milk Truck (Cesium, CC BY 4.0) as Debian's assimp-testmodels has it, in glTF 1.0: brought to glTF 2.0."""
import json
from pathlib import Path

import numpy as np

import meshes

TYPES = {5123: "<u2", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}

# Materials of glTF 1.0 are shaders. Those of the truck shine as Blinn's exponent of 256 does.
ROUGHNESS = (2 / (256 + 2)) ** 0.25


def materials(document: dict) -> list[dict]:
    """As metallic-roughness, in the document's order; a colour is written out or a texture's name."""
    made = []
    for material in document["materials"].values():
        color = material["values"]["diffuse"]
        look = {"baseColorTexture": {"index": 0}} if isinstance(color, str) else {"baseColorFactor": color}
        made.append({"name": material["name"],
                     "pbrMetallicRoughness": {**look, "metallicFactor": 0, "roughnessFactor": ROUGHNESS}})
    return made


def truck(source: Path, out: Path) -> None:
    old = json.loads(source.read_text())
    vertices = source.with_suffix(".bin").read_bytes()
    picture = source.with_suffix(".png").read_bytes()
    parts, accessors, numbers = [], [], {}

    def number_of(name: str) -> int:
        """Of an accessor of the new file, its values packed."""
        if name not in numbers:
            accessor = old["accessors"][name]
            view, kind, width = old["bufferViews"][accessor["bufferView"]], TYPES[accessor["componentType"]], \
                WIDTHS[accessor["type"]]
            values = np.frombuffer(vertices, kind, accessor["count"] * width,
                                   view["byteOffset"] + accessor["byteOffset"])
            content = values.tobytes()
            parts.append(content + b"\0" * (-len(content) % 4))
            numbers[name] = len(accessors)
            accessors.append({"bufferView": len(parts) - 1, "componentType": accessor["componentType"],
                              "count": accessor["count"], "type": accessor["type"],
                              **{key: accessor[key] for key in ("min", "max") if key in accessor}})
        return numbers[name]

    names = list(old["materials"])
    forms = list(old["meshes"])
    new_meshes = [{"primitives": [
        {"attributes": {key: number_of(name) for key, name in primitive["attributes"].items()},
         "indices": number_of(primitive["indices"]), "material": names.index(primitive["material"])}
        for primitive in old["meshes"][form]["primitives"]]} for form in forms]
    placement = "translation", "rotation", "scale", "matrix"
    nodes = [{"mesh": forms.index(node["meshes"][0]), **{key: node[key] for key in placement if key in node}}
             for node in old["nodes"].values() if node.get("meshes")] # none stands on another that is moved
    parts.append(picture + b"\0" * (-len(picture) % 4))
    starts = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).tolist()
    document = {
        "asset": {"version": "2.0", "generator": "lucent make_assets", "copyright": "Cesium, CC BY 4.0"},
        "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": new_meshes,
        "materials": materials(old), "textures": [{"source": 0}],
        "images": [{"bufferView": len(parts) - 1, "mimeType": "image/png"}],
        "buffers": [{"byteLength": starts[-1]}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(part)}
                        for start, part in zip(starts, parts)],
        "accessors": accessors,
    }
    meshes.write_document(out, document, b"".join(parts))
