#!/usr/bin/env python3
"""Spot, wavefront and Strehl ratio of the 10x/0.28 with the 200 mm tube lens, for tests/optics/image_quality_test.cpp.

Shares no code with vkfv: spheres traced from the prescriptions, midpoints instead of Gauss's nodes over the cone, reference
spheres of finite radius. The plane is that of the least wavefront variance about such spheres, or the given one.
Usage: tests/references/image_quality_reference.py [rings [sphere's radius, mm [height of the plane, um]]]
"""
import cmath
import math
import pathlib
import sys
import tomllib

WAVELENGTH = 0.587562e-3  # mm; the middle one of each medium's table
ASSETS = pathlib.Path(__file__).resolve().parents[2] / "assets"


def lens(path):
    """(curvature, index behind, thickness, semi-diameter) of each surface."""
    table = tomllib.loads((ASSETS / path).read_text())
    return [(1 / s["radius_mm"] if "radius_mm" in s else 0.0,
             table["media"][s["medium"]]["indices"][1] if "medium" in s else 1.0,
             s.get("thickness_mm", 0.0), s["semi_diameter_mm"]) for s in table["surface"]]


def paraxial(surfaces, height, slope):
    index = 1.0
    for curvature, after, thickness, _ in surfaces:
        slope = (index * slope - height * (after - index) * curvature) / after
        height += thickness * slope
        index = after
    return height, slope


objective = lens("objectives/10x_0.28.toml")
tube = lens("tube_lenses/200mm.toml")
height, slope = paraxial([(-c, n, t, a) for (c, _, _, a), (_, n, t, _) in
                          zip(objective[::-1], objective[-2::-1] + [(0, 1.0, 0, 0)])], 1.0, 0.0)
working_distance = -height / slope
focal_length = -1 / slope
height, slope = paraxial(tube, 1.0, 0.0)
detector = -height / slope
magnification = (1 / slope) / focal_length  # f' of the tube lens is -1 / slope: inverted
system = objective[:-1] + [objective[-1][:2] + (100.0,) + objective[-1][3:]] + tube


def trace(x, z, l, m, edges=True):
    """From (x, 0, z) over the object plane to the detector: position, direction, path; None if an edge stops it."""
    p, d, index, path = [x, 0.0, z - working_distance], [l, m, math.sqrt(1 - l * l - m * m)], 1.0, 0.0
    for curvature, after, thickness, semi_diameter in system:
        # The ray meets the sphere where |p + t d - centre| = radius; the equation is multiplied by the curvature.
        half = curvature * sum(a * b for a, b in zip(p, d)) - d[2]
        rest = curvature * sum(a * a for a in p) - 2 * p[2]
        t = rest / (math.sqrt(half * half - curvature * rest) - half)
        p = [a + t * b for a, b in zip(p, d)]
        path += index * t
        if edges and math.hypot(p[0], p[1]) > semi_diameter:
            return None
        normal = (-curvature * p[0], -curvature * p[1], 1 - curvature * p[2])
        cosine = sum(a * b for a, b in zip(normal, d))
        ratio = index / after
        turn = math.sqrt(1 - ratio * ratio * (1 - cosine * cosine)) - ratio * cosine
        d = [ratio * a + turn * b for a, b in zip(d, normal)]
        p[2] -= thickness
        index = after
    p[2] += system[-1][2] - detector
    t = -p[2] / d[2]
    return (p[0] + t * d[0], p[1] + t * d[1]), d, path + t


def passing(x, rings):
    """(l, m, weight) of the cone from (x, 0): uniform in direction cosines up to the rim of each azimuth."""
    cone = []
    for k in range(2 * rings):
        angle = math.pi * (k + 0.5) / rings
        inside, outside = 0.0, 0.5
        for _ in range(50):
            middle = 0.5 * (inside + outside)
            if trace(x, 0.0, middle * math.cos(angle), middle * math.sin(angle)):
                inside = middle
            else:
                outside = middle
        for ring in range(rings):
            radius = inside * math.sqrt((ring + 0.5) / rings)
            cone.append((radius * math.cos(angle), radius * math.sin(angle), inside * inside))
    total = sum(w for _, _, w in cone)
    return [(l, m, w / total) for l, m, w in cone]


def through(x, z, cone):
    """Rays and weights; the edges have cut the cone already, at z = 0."""
    return [(trace(x, z, l, m, False), w) for l, m, w in cone]


def spot(rays):
    centre = [sum(w * r[0][k] for r, w in rays) for k in (0, 1)]
    return centre, math.sqrt(sum(w * math.dist(r[0], centre) ** 2 for r, w in rays))


def evaluate(x, z, cone, sphere):
    rays = through(x, z, cone)
    centre, rms = spot(rays)
    samples = []
    for (p, d, path), w in rays:
        # The ray goes back from the detector to the sphere about the centre.
        a = [p[0] - centre[0], p[1] - centre[1]]
        along = a[0] * d[0] + a[1] * d[1]
        square = a[0] ** 2 + a[1] ** 2
        samples.append((path - along - math.sqrt(along * along - square + sphere * sphere), d[0], d[1], w))
    means = [sum(s[3] * s[k] for s in samples) for k in range(3)]
    samples = [[s[k] - means[k] for k in range(3)] + [s[3]] for s in samples]

    def product(i, j):
        return sum(s[3] * s[i] * s[j] for s in samples)

    det = product(1, 1) * product(2, 2) - product(1, 2) ** 2
    tx = (product(0, 1) * product(2, 2) - product(0, 2) * product(1, 2)) / det
    ty = (product(0, 2) * product(1, 1) - product(0, 1) * product(1, 2)) / det
    waves = [((s[0] - tx * s[1] - ty * s[2]) / WAVELENGTH, s[3]) for s in samples]
    wavefront = math.sqrt(sum(v * w * w for w, v in waves))
    strehl = abs(sum(v * cmath.exp(2j * math.pi * w) for w, v in waves)) ** 2
    return centre[0], rms, wavefront, strehl


def figures(rings, sphere):
    on_axis = passing(0.0, rings)
    # The wavefront's mean square is a parabola in the height.
    low, middle, high = (evaluate(0.0, h, on_axis, sphere)[2] ** 2 for h in (0.0045, 0.006, 0.0075))
    found = 0.006 + 0.0015 * (low - high) / (2 * (low + high - 2 * middle))
    best = height if height is not None else found
    edge = 0.64 / abs(magnification)  # of a detector of 1.28 mm
    return [found, *evaluate(0.0, best, on_axis, sphere), *evaluate(edge, best, passing(edge, rings), sphere)]


rings = int(sys.argv[1]) if len(sys.argv) > 1 else 30
sphere = float(sys.argv[2]) if len(sys.argv) > 2 else 1e5
height = float(sys.argv[3]) * 1e-3 if len(sys.argv) > 3 else None
# The midpoint rule's error goes with the square of its step.
coarse, fine = figures(rings, sphere), figures(2 * rings, sphere)
best, *images = [f + (f - c) / 3 for c, f in zip(coarse, fine)]
print(f"best focus {best * 1e3:.6f} um, magnification {magnification:.9f}")
for name, image in (("axis", images[:4]), ("edge", images[4:])):
    print(f"{name}: centroid {image[0]:.9f} mm, RMS spot {image[1] * 1e3:.6f} um, wavefront {image[2]:.7f} waves, "
          f"Strehl {image[3]:.7f}")
