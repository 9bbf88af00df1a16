"""Light probes (CC0, from the npm package @pmndrs/assets) in forms that our readers know.

The package holds EXR files whose compression (DWAB) few readers have; Debian's openexr tools pack them anew as ZIP.
"""
import base64
import re
import struct
import subprocess
import tempfile
import zlib
from pathlib import Path

import numpy as np

import pictures

SIZE = (512, 256)  # of the package's probes


def repack(module: Path, out: Path) -> None:
    """The EXR inside a JavaScript module as an EXR of one ZIP tile."""
    packed = base64.b64decode(re.search(r"base64,([A-Za-z0-9+/=]+)", module.read_text()).group(1))
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(packed)
        file.flush()
        subprocess.run(["exrmaketiled", "-z", "zip", "-t", *map(str, SIZE), file.name, str(out)], check=True)


def read_tile(path: Path) -> np.ndarray:
    """Pixels (rows, columns, RGB) of what repack() writes: one ZIP tile of half-float B, G, R."""
    data = path.read_bytes()
    end = 8
    while data[end]:  # attributes: name, type, size, value; an empty name ends them
        end = data.index(0, data.index(0, end) + 1) + 1
        end += 4 + struct.unpack_from("<i", data, end)[0]
    tile = struct.unpack_from("<Q", data, end + 1)[0]
    size = struct.unpack_from("<i", data, tile + 16)[0]
    delta = np.frombuffer(zlib.decompress(data[tile + 20:tile + 20 + size]), np.uint8).astype(np.int64)
    halves = (np.cumsum(delta - 128) + 128).astype(np.uint8)
    middle = (len(halves) + 1) // 2
    values = np.empty_like(halves)
    values[0::2], values[1::2] = halves[:middle], halves[middle:]
    columns, rows = SIZE
    return values.view("<f2").reshape(rows, 3, columns)[:, ::-1].transpose(0, 2, 1).astype(np.float64)


def read_probe(module: Path) -> np.ndarray:
    """Radiance (rows, columns, RGB). The probe's lossy compression left dark rings below 0 around lamps: they become
    0, because light cannot be negative."""
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        repack(module, Path(file.name))
        return np.maximum(read_tile(Path(file.name)), 0)


def hdr(module: Path, out: Path) -> None:
    """The probe as Radiance HDR."""
    pictures.write_hdr(out, read_probe(module))


def exr(module: Path, out: Path) -> None:
    """The probe as EXR: half floats, ZIP."""
    pictures.write_exr(out, read_probe(module))
