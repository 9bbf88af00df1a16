"""Pictures in the forms that the program reads, written with numpy and nothing lossy."""
import struct
import zlib
from pathlib import Path

import numpy as np


def write_png(path: Path, values: np.ndarray) -> None:
    """An 8- or 16-bit PNG of a (rows, columns) or (rows, columns, 3 or 4) array of uint8 or uint16."""
    rows, columns = values.shape[:2]
    color_type = 0 if values.ndim == 2 else {3: 2, 4: 6}[values.shape[2]]
    stored = np.ascontiguousarray(values.astype(values.dtype.newbyteorder(">")))
    lines = stored.view(np.uint8).reshape(rows, -1)
    # Filter "sub" on every line: neighbours are alike, so their differences pack well.
    pixel = lines.shape[1] // columns
    filtered = lines.copy()
    filtered[:, pixel:] -= lines[:, :-pixel]
    data = np.hstack([np.ones((rows, 1), np.uint8), filtered]).tobytes()

    def chunk(name: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    header = struct.pack(">IIBBBBB", columns, rows, 8 * values.dtype.itemsize, color_type, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) +
                     chunk(b"IEND", b""))


def quantise(values: np.ndarray, dtype: type) -> np.ndarray:
    """[0,1] to the whole range of an unsigned integer type, rounded."""
    return np.rint(np.clip(values, 0, 1) * np.iinfo(dtype).max).astype(dtype)


def srgb(linear: np.ndarray) -> np.ndarray:
    """The sRGB curve (IEC 61966-2-1) on [0,1]."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def write_color(path: Path, linear: np.ndarray) -> None:
    """A colour map: linear [0,1] as an 8-bit sRGB PNG."""
    write_png(path, quantise(srgb(linear), np.uint8))


def read_pfm(path: Path) -> np.ndarray:
    """A 1-channel PFM as (rows, columns), row 0 at the top."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"Pf":
            raise ValueError(f"{path}: is no 1-channel PFM; expected it to begin with Pf")
        columns, rows = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        return np.frombuffer(file.read(), order + "f4").reshape(rows, columns)[::-1].astype(np.float64)


def write_hdr(path: Path, linear: np.ndarray) -> None:
    """Radiance HDR with shared exponents, not run-length packed; good to 1/256 of the brightest channel."""
    brightest = linear.max(axis=2)
    exponent = np.where(brightest > 1e-32, np.frexp(brightest)[1], -128)
    scale = np.where(exponent > -128, np.ldexp(256.0, -exponent), 0)
    pixels = np.empty((*brightest.shape, 4), np.uint8)
    pixels[..., :3] = np.clip(linear * scale[..., None], 0, 255)
    pixels[..., 3] = exponent + 128
    rows, columns = brightest.shape
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {columns}\n".encode() + pixels.tobytes())


def write_exr(path: Path, linear: np.ndarray) -> None:
    """OpenEXR of half floats, RGB, ZIP in blocks of 16 lines."""
    rows, columns = linear.shape[:2]

    def attribute(name: str, kind: str, value: bytes) -> bytes:
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value

    half = 1  # pixel type, in the channel list
    channels = b"".join(name + b"\0" + struct.pack("<iiii", half, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    header = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels) + \
        attribute("compression", "compression", b"\3") + attribute("dataWindow", "box2i", window) + \
        attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0") + \
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + \
        attribute("screenWindowCenter", "v2f", bytes(8)) + \
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    blocks = []
    for first in range(0, rows, 16):
        pixels = linear[first:first + 16, :, ::-1].transpose(0, 2, 1).astype("<f2")  # lines of B, G, R
        raw = np.frombuffer(pixels.tobytes(), np.uint8)
        apart = np.concatenate([raw[0::2], raw[1::2]]).astype(np.int64)  # low bytes, then high bytes
        delta = np.concatenate([apart[:1], np.diff(apart) + 128]).astype(np.uint8)
        packed = zlib.compress(delta.tobytes(), 9)
        data = packed if len(packed) < len(raw) else raw.tobytes()
        blocks.append(struct.pack("<ii", first, len(data)) + data)
    ends = len(header) + 8 * len(blocks) + np.cumsum([0] + [len(block) for block in blocks[:-1]])
    path.write_bytes(header + struct.pack(f"<{len(blocks)}Q", *ends) + b"".join(blocks))


def blur(values: np.ndarray, sigma: float) -> np.ndarray:
    """Gaussian blur, `sigma` in texels; the picture repeats beyond its border."""
    def response(count: int) -> np.ndarray:
        return np.exp(-2 * (np.pi * sigma * np.fft.fftfreq(count)) ** 2)
    spectrum = np.fft.fft2(values) * response(values.shape[0])[:, None] * response(values.shape[1])[None, :]
    return np.fft.ifft2(spectrum).real


def smoothstep(low: float, high: float, x: np.ndarray) -> np.ndarray:
    """0 up to `low`, 1 from `high`, a smooth cubic between; `low` may lie above `high`."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)
