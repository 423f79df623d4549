#!/usr/bin/python3
"""The contrast error on the axis of images that are filtered by cells of the pupil (docs/waves.md), for
tests/optics/filter_error_test.cpp.

Shares no code with vkfv: the wavefront is that of wavefront_reference.py, and the means over the pupil and its cells are sums over a square
lattice of the pupil. Frequencies are eighths of the cutoff 2 NA / wavelength in five directions of the first octant, heights nine within two
depths of field, wavelength / NA^2 each, about the least wavefront variance. Prints the largest difference between the filtered contrast of a
level Lambertian surface and the contrast by waves, and where it is.
Usage: tests/references/filter_error_reference.py [objective [cells across the pupil [points of the lattice across it]]]
"""
import sys

import numpy as np
from wavefront_reference import WAVELENGTH, Microscope


def contrast_error(scope, cells, points):
    """(the largest error, its frequency over the cutoff, direction in degrees, height in um)"""
    focus, rim = scope.least_variance(), scope.rim
    lattice = rim * ((np.arange(points) + 0.5) / points * 2 - 1)
    p, q = np.meshgrid(lattice, lattice)
    inside = np.hypot(p, q) < rim
    p, q = p[inside], q[inside]
    cell = (np.floor((p / rim + 1) * cells / 2) + cells * np.floor((q / rim + 1) * cells / 2)).astype(int)
    radius = np.hypot(p, q)

    def wave(p, q, height):
        """The phase of the wavefront; 0 beyond the rim."""
        radius = np.hypot(p, q)
        known = radius < rim
        return np.where(known, np.exp(-2j * np.pi / WAVELENGTH * scope.at(np.minimum(radius, rim), height)), 0)

    def of_cells(values):
        return np.bincount(cell, values.real, cells**2) + 1j * np.bincount(cell, values.imag, cells**2)

    # The place of a ray over its direction, grad W = t: along the radius.
    def shift_over_radius(height):
        return scope.spline(radius, 1) / np.maximum(radius, 1e-12) - height / np.sqrt(1 - radius**2)

    worst = (0.0, 0.0, 0.0, 0.0)
    reach = 2 * WAVELENGTH / rim**2
    for direction in np.radians([0, 11.25, 22.5, 33.75, 45]):
        along = p * np.cos(direction) + q * np.sin(direction)
        for share in np.arange(1, 8) / 8:
            frequency = share * 2 * rim / WAVELENGTH
            half = 0.5 * WAVELENGTH * frequency * np.array([np.cos(direction), np.sin(direction)])
            by_waves = of_cells(wave(p + half[0], q + half[1], focus) * np.conj(wave(p - half[0], q - half[1], focus)))
            by_rays = of_cells(np.exp(-2j * np.pi * frequency * along * shift_over_radius(focus)))
            seen = np.abs(by_rays) > 0
            factor = np.divide(by_waves, by_rays, out=np.zeros_like(by_waves), where=seen)
            factor /= np.maximum(np.abs(factor), 1)
            for height in np.linspace(-reach, reach, 9):
                rays = of_cells(np.exp(-2j * np.pi * frequency * along * shift_over_radius(focus + height)))
                waves = (wave(p + half[0], q + half[1], focus + height) * np.conj(wave(p - half[0], q - half[1], focus + height))).sum()
                error = abs((factor * rays).sum() - waves) / len(p)
                worst = max(worst, (error, share, np.degrees(direction), 1000 * height))
    return worst


def main():
    name = sys.argv[1] if len(sys.argv) > 1 else "10x_0.28"
    cells, points = (int(sys.argv[k]) if len(sys.argv) > k else default for k, default in ((2, 8), (3, 400)))
    error, share, direction, height = contrast_error(Microscope(name), cells, points)
    print(f"{name}: contrast error {error:.4f} at {share:g} of the cutoff, {direction:g} degrees, {height:+.2f} um over best focus")


if __name__ == "__main__":
    main()
