#!/usr/bin/env python3
"""README's picture of a stack: the image at z = 0, measured heights, true heights, deviation. Needs numpy and tifffile.

usage: tools/studies/demo_picture.py STACK_FOLDER OUT.png
"""
import pathlib
import struct
import sys
import zlib

import numpy as np
import tifffile

folder, out = sys.argv[1:3]
scale, gap = 5, 12  # screen pixels a pixel; between panels


def read(name):
    return tifffile.imread(f"{folder}/{name}").astype(float)


def level(heights):
    """Without its least-squares plane over the measured points."""
    rows, columns = np.indices(heights.shape)
    good = np.isfinite(heights)
    terms = np.stack([rows, columns, np.ones_like(rows)], axis=-1).astype(float)
    plane, *_ = np.linalg.lstsq(terms[good], heights[good], rcond=None)
    return heights - terms @ plane


def colours(values, low, high, anchors):
    """RGB by linear interpolation between anchors; grey where not measured."""
    t = np.clip((values - low) / (high - low), 0, 1)
    steps = np.linspace(0, 1, len(anchors))
    rgb = np.stack([np.interp(np.nan_to_num(t), steps, [a[k] for a in anchors]) for k in range(3)], axis=-1)
    rgb[~np.isfinite(values)] = 160
    return np.kron(rgb.round().astype(np.uint8), np.ones((scale, scale, 1), np.uint8))


grey = [(0, 0, 0), (255, 255, 255)]
relief = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]
signed = [(33, 102, 172), (247, 247, 247), (178, 24, 43)]
stack = sorted(pathlib.Path(folder, "images").glob("z_*.tif"))
image = tifffile.imread(stack[len(stack) // 2]).astype(float)
measured, truth = level(read("topography.tif")), level(read("truth.tif"))
reach = np.nanmax(np.abs(truth))
panels = [colours(image, 0, np.percentile(image, 99.5), grey), colours(measured, -reach, reach, relief),
          colours(truth, -reach, reach, relief), colours(level(measured - truth), -reach, reach, signed)]
white = np.full((panels[0].shape[0], gap, 3), 255, np.uint8)
picture = np.concatenate([part for panel in panels for part in (panel, white)][:-1], axis=1)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


height, width, _ = picture.shape
lines = b"".join(b"\0" + row.tobytes() for row in picture)
with open(out, "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
               chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
