#!/usr/bin/env python3
"""Makes example meshes. Of assets/specimens: the letter F in relief, 5 um high, on a plate of 0.2 x 0.2 mm.

letter_F.stl   binary STL in mm
letter_F.glb   glTF 2.0 in m; the letter stands upright in a viewer's front view
letter_F.png   height map of 100 x 100 pixels of 2 um, 16 bit: 65535 on the letter, 0 beside it
letter_F.xyz   scattered points in um, one in each square of 4 um, in no order

And of assets/elements, in mm:

window.stl     a plate of 30 x 30 mm, 2 mm thick in its middle, whose upper face is tilted by 0.01 degrees about x

Seen from +z with x to the right and y up, each reads as F: a mirrored or turned letter is a mistake in a reader.
"""
import argparse
import json
import math
import struct
import zlib
from pathlib import Path

import numpy

HEIGHT = 0.005  # mm
# Grid lines of the letter, mm; each cell is high or low, so that walls meet cells along whole edges.
X = numpy.array([-0.1, -0.04, -0.018, 0.02, 0.04, 0.1])
Y = numpy.array([-0.1, -0.06, -0.012, 0.01, 0.038, 0.06, 0.1])
# The rows of the letter from the top, as it is read.
LETTER = [
    ".....",
    ".###.",
    ".#...",
    ".##..",
    ".#...",
    ".....",
]


def is_high(row):
    """Whether each cell of a row (counted from the lowest y) belongs to the letter."""
    return [c == "#" for c in LETTER[len(LETTER) - 1 - row]]


def triangles():
    """Corners of all triangles, mm, shape (n, 3, 3), counter-clockwise seen from outside; an open sheet."""
    high = numpy.array([is_high(row) for row in range(len(LETTER))])
    level = numpy.where(high, HEIGHT, 0.0)
    result = []

    def quad(a, b, c, d):
        result.append((a, b, c))
        result.append((a, c, d))

    rows, columns = high.shape
    for j in range(rows):
        for i in range(columns):
            z = level[j, i]
            x0, x1, y0, y1 = X[i], X[i + 1], Y[j], Y[j + 1]
            quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))
            # A wall stands where the next cell differs, facing the lower one.
            if i + 1 < columns and level[j, i + 1] != z:
                other = level[j, i + 1]
                quad((x1, y0, z), (x1, y0, other), (x1, y1, other), (x1, y1, z))
            if j + 1 < rows and level[j + 1, i] != z:
                other = level[j + 1, i]
                quad((x1, y1, z), (x1, y1, other), (x0, y1, other), (x0, y1, z))
    return numpy.array(result, dtype=numpy.float32)


def write_stl(path, corners, title):
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    with path.open("wb") as file:
        file.write(title.ljust(80).encode())
        file.write(struct.pack("<I", len(corners)))
        for normal, triangle in zip(normals, corners):
            file.write(struct.pack("<12f", *normal, *triangle.ravel()) + b"\0\0")


def window(half_width=15.0, thickness=2.0, angle_deg=0.01):
    """As triangles(), of a closed body; its lower face is z = 0."""
    rise = half_width * math.tan(math.radians(angle_deg))
    corners = numpy.array([(x, y, z + (rise * numpy.sign(y) if z else 0))
                           for z in (0, thickness) for y in (-half_width, half_width) for x in (-half_width, half_width)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [(a, b, c) for a, b, c, d in faces] + [(a, c, d) for a, b, c, d in faces]
    return corners[numpy.array(triangles)].astype(numpy.float32)


def write_glb(path, corners):
    """Vertices in um, and a node that scales them to m."""
    positions, indices = numpy.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    positions = (positions.astype(numpy.float64) * 1000).round(3).astype("<f4")
    indices = indices.ravel().astype("<u2")
    binary = positions.tobytes() + indices.tobytes()
    binary += b"\0" * (-len(binary) % 4)
    document = {
        "asset": {"version": "2.0", "generator": "make_specimens.py of vkfv"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "letter F", "mesh": 0, "scale": [1e-6, 1e-6, 1e-6]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
             "min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()},
            {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": positions.nbytes, "target": 34962},
            {"buffer": 0, "byteOffset": positions.nbytes, "byteLength": indices.nbytes, "target": 34963},
        ],
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with path.open("wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def write_png(path, size=100):
    """Pixel centres stand at (-99, -97, ..., 99) um; the file's first row is the highest y."""
    centres = (numpy.arange(size) - (size - 1) / 2) * 0.002
    column = numpy.searchsorted(X, centres) - 1
    row = numpy.searchsorted(Y, centres) - 1
    high = numpy.array([is_high(r) for r in range(len(LETTER))])
    values = numpy.where(high[numpy.ix_(row, column)], 65535, 0).astype(">u2")[::-1]
    lines = b"".join(b"\0" + line.tobytes() for line in values)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", size, size, 16, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines, 9)) +
                     chunk(b"IEND", b""))


def write_xyz(path, pitch=0.004):
    generator = numpy.random.default_rng(1)
    corners = numpy.arange(X[0], X[-1] - pitch / 2, pitch)
    x, y = (values.ravel() for values in numpy.meshgrid(corners, corners))
    x = x + pitch * generator.random(len(x))
    y = y + pitch * generator.random(len(y))
    high = numpy.array([is_high(row) for row in range(len(LETTER))])
    z = numpy.where(high[numpy.searchsorted(Y, y) - 1, numpy.searchsorted(X, x) - 1], HEIGHT, 0.0)
    points = generator.permutation(numpy.stack([x, y, z], axis=1) * 1000)
    lines = [f"{px:.1f} {py:.1f} {pz:g}" for px, py, pz in points]
    path.write_text("# letter F in relief: x, y and z in um\n" + "\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    default = Path(__file__).resolve().parents[2] / "assets" / "specimens"
    parser.add_argument("--out", type=Path, default=default, help="folder of the specimens (default: assets/specimens)")
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    corners = triangles()
    write_stl(folder / "letter_F.stl", corners, "letter F in relief, mm")
    write_glb(folder / "letter_F.glb", corners)
    write_png(folder / "letter_F.png")
    write_xyz(folder / "letter_F.xyz")
    elements = folder.parent / "elements"
    elements.mkdir(exist_ok=True)
    write_stl(elements / "window.stl", window(), "window with a wedge of 0.01 degrees, mm")


if __name__ == "__main__":
    main()
