"""Fewer triangles for the same shape, by the library meshoptimizer (quadric error metrics, Garland, Heckbert 1997)."""
import ctypes
import ctypes.util

import numpy as np


def library() -> ctypes.CDLL:
    name = ctypes.util.find_library("meshoptimizer")
    if name is None:
        raise FileNotFoundError("libmeshoptimizer: does not exist; expected it from scripts/setup (libmeshoptimizer-dev)")
    return ctypes.CDLL(name)


def simplify(positions: np.ndarray, triangles: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """About `count` triangles, each vertex one of the old ones. What is closed stays closed."""
    points = np.ascontiguousarray(positions, np.float32)
    corners = np.ascontiguousarray(triangles, np.uint32)
    out = np.empty(corners.size, np.uint32)
    call = library().meshopt_simplify
    call.restype = ctypes.c_size_t
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    call.argtypes = [pointer, pointer, size, pointer, size, size, size, ctypes.c_float, ctypes.c_uint, pointer]
    any_error, no_options = 1.0, 0  # the error is over the extent of the mesh: the count alone decides
    kept = call(out.ctypes.data, corners.ctypes.data, corners.size, points.ctypes.data, len(points),
                points.strides[0], 3 * count, any_error, no_options, None)
    used, renumbered = np.unique(out[:kept], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3).astype(np.uint32)
