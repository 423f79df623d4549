#!/usr/bin/python3
"""Fringes of an interferometer by Abbe's sum over source points, pupil points and wavelengths, for tests/fields.

Shares no code with vkfv and uses no transfer function: for each source point s and wavelength the surface's waves are summed over its points
for each pupil point p, exp(-i k [(gamma_s + gamma_p) h(x) + (p - s) x]), and come together with the reference's at each pixel. Surfaces
depend on x alone, so that p_y = s_y, and are periodic. Lengths in um.
Usage: tests/references/fringe_reference.py     prints the figures that the tests state
"""
import numpy as np


def spectrum(centre, width, count):
    """Wavelengths of a Gaussian spectrum of this full width at half maximum, and their shares; one line for width 0."""
    if width == 0:
        return [(centre, 1.0)]
    deviation = width / np.sqrt(8 * np.log(2))
    place, weight = np.polynomial.legendre.leggauss(count)
    weight = weight * np.exp(-((4 * place) ** 2) / 2)
    return list(zip(centre + 4 * deviation * place, weight / weight.sum()))


def sources(aperture, count):
    """Points of a square lattice in the upper half of the pupil, twice the lower."""
    lattice = aperture * ((np.arange(count) + 0.5) / count * 2 - 1)
    x, y = np.meshgrid(lattice, lattice[lattice > 0])
    inside = np.hypot(x, y) < aperture
    return x[inside], y[inside]


def fringes(heights, pitch, aperture, light, count, scan, at):
    """E(x, zeta) / E(0) of a level mirror: rows scan, columns at (indices of points)."""
    n = len(heights)
    x = np.arange(n) * pitch
    result = np.zeros((len(scan), len(at)), complex)
    for wavelength, share in light:
        k = 2 * np.pi / wavelength
        s_x, s_y = sources(aperture, count)
        for sx, sy in zip(s_x, s_y):
            # p - s takes the frequencies of the period.
            m = np.arange(-int(2 * aperture * n * pitch / wavelength) - 1, int(2 * aperture * n * pitch / wavelength) + 2)
            p = sx + m * wavelength / (n * pitch)
            p, m = p[np.hypot(p, sy) < aperture], m[np.hypot(p, sy) < aperture]
            gamma = np.sqrt(1 - sx**2 - sy**2) + np.sqrt(1 - p**2 - sy**2)
            q = 2 * np.pi * m / (n * pitch)
            c = np.exp(-1j * (k * gamma[:, None] * heights + q[:, None] * x)).sum(1) / n
            waves = c[:, None] * np.exp(1j * q[:, None] * x[at])
            result += share / len(s_x) * np.exp(1j * k * gamma[None, :] * np.array(scan)[:, None]) @ waves
    return result
