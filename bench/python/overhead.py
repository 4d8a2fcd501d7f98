#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what the Python module costs in addition to the C++ call.

  PYTHONPATH=build/bench/lib/python3/dist-packages /usr/bin/python3 bench/python/overhead.py \\
      build/bench/lib/librelief-python-bench.so [TRIANGLES [ROUNDS]]

Both calls write into the same array and are interleaved. The overhead is the median of the differences.
"""
import ctypes
import statistics
import sys
import time

import numpy as np
import relief


def wave(triangles):
    side = int((triangles / 2) ** 0.5) + 1
    v, u = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    positions = np.stack([u, 1 - v, 0.1 * np.sin(20 * u + 14 * v)], axis=-1).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    corners = [first, first + side, first + side + 1, first, first + side + 1, first + 1]
    return (positions.astype(np.float32), np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32),
            np.stack(corners, axis=-1).reshape(-1, 3).astype(np.uint32))


def seconds_of(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def compare(name, direct, module, rounds):
    direct(), module()
    pairs = []
    for index in range(rounds):  # The order alternates, so that neither call always follows the other.
        first, second = (direct, module) if index % 2 == 0 else (module, direct)
        times = {first: seconds_of(first), second: seconds_of(second)}
        pairs.append((times[direct], times[module]))
    base = statistics.median(pair[0] for pair in pairs)
    overhead = statistics.median(pair[1] - pair[0] for pair in pairs)
    print(f"{name:<18} {1e3 * base:9.3f} ms in C++, {1e6 * overhead:+9.1f} us from Python "
          f"({100 * overhead / base:+.2f} %)")


def main():
    library = ctypes.CDLL(sys.argv[1])
    triangles = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 21
    for count in (2, triangles):
        positions, texcoords, faces = wave(count)
        normals = relief.vertex_normals(positions, faces)
        tangents = np.zeros((len(positions), 4), np.float32)
        size = [ctypes.c_size_t(len(positions)), faces.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(faces))]
        address = lambda array: array.ctypes.data_as(ctypes.c_void_p)
        print(f"{len(faces)} triangles")
        normal_arguments = [address(positions), *size, address(normals)]
        compare("vertex_normals", lambda: library.direct_vertex_normals(*normal_arguments),
                lambda: relief.vertex_normals(positions, faces, out=normals), rounds)
        tangent_arguments = [address(positions), address(normals), address(texcoords), *size, address(tangents)]
        compare("vertex_tangents", lambda: library.direct_vertex_tangents(*tangent_arguments),
                lambda: relief.vertex_tangents(positions, normals, texcoords, faces, out=tangents), rounds)


if __name__ == "__main__":
    main()
