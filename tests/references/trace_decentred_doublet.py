#!/usr/bin/python3
"""Traces rays through a decentred and tilted cemented doublet: the expected values of tests/optics/train_test.cpp.

Shares nothing with vkfv: every sphere stands in one global frame by its centre, a ray meets it by the quadratic equation,
turns are Rodrigues' formula about the axes as they stand. Needs numpy (Debian: python3-numpy, for /usr/bin/python3).
"""

import numpy as np

# Each surface has a radius (mm), a thickness to the next vertex (mm) and the index behind it: a 150 mm achromat of
# N-BK7 and SF5 at d.
SURFACES = [(91.62, 5.7, 1.5168), (-66.68, 2.2, 1.6727), (-197.7, 0.0, 1.0)]
# Before the surface of that number the frame is decentred in x, y (mm), then tilted about x, y, z (rad) in this order.
BREAKS = {0: (1.5, -0.8, 0.10, -0.15, 0.40), 2: (0.2, 0.1, 0.03, 0.02, -0.10)}
SCREEN = 150.0  # mm, z of the plane where rays are read, in the frame of the first vertex before its break
RAYS = [((0, 0, -10), (0, 0, 1)), ((5, 3, -10), (0.02, -0.03, 1)), ((-6, 2, -10), (-0.05, 0.04, 1)),
        ((1, -8, -10), (0.08, 0.06, 1)), ((7, -7, -10), (-0.11, 0.02, 1))]


def rotate(vector, axis, angle):
    return (vector * np.cos(angle) + np.cross(axis, vector) * np.sin(angle)
            + axis * np.dot(axis, vector) * (1 - np.cos(angle)))


def placed_surfaces():
    origin, axes = np.zeros(3), list(np.eye(3))
    for number, (radius, thickness, index) in enumerate(SURFACES):
        if number in BREAKS:
            x, y, *tilts = BREAKS[number]
            origin = origin + x * axes[0] + y * axes[1]
            for which, angle in enumerate(tilts):
                about = axes[which]
                axes = [rotate(axis, about, angle) for axis in axes]
        yield origin + radius * axes[2], radius, index
        origin = origin + thickness * axes[2]


def trace(position, direction):
    position = np.array(position, float)
    direction = np.array(direction, float)
    direction /= np.linalg.norm(direction)
    before = 1.0
    path = 0.0
    for centre, radius, after in placed_surfaces():
        offset = position - centre
        b = np.dot(direction, offset)
        root = np.sqrt(b * b - np.dot(offset, offset) + radius * radius)
        way = -b - root if radius > 0 else -b + root
        position = position + way * direction
        path += before * way
        normal = (position - centre) / abs(radius)
        cosine = np.dot(direction, normal)
        if cosine < 0:
            normal, cosine = -normal, -cosine
        ratio = before / after
        direction = ratio * direction + (np.sqrt(1 - ratio * ratio * (1 - cosine * cosine)) - ratio * cosine) * normal
        before = after
    way = (SCREEN - position[2]) / direction[2]
    return position + way * direction, direction, path + before * way


for start, towards in RAYS:
    point, cosines, length = trace(start, towards)
    print(", ".join(f"{value:.17g}" for value in [point[0], point[1], *cosines, length]))
