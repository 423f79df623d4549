#!/usr/bin/env python3
"""Wavefront and transfer function of a shipped objective on the axis, for tests/optics/wavefront_test.cpp and
point_waves_test.cpp.

Shares no code with vkfv: a fan of meridional rays is traced from the detector's middle backward through spheres of the
prescriptions, and what vkfv fits over the pupil is integrated here along its radius. Prints the wavefront's Zernike
coefficients (Noll's order, unit RMS, waves), its RMS and Strehl ratio, the transfer function H(f, z), and the heights at which gratings have their
highest contrast. Heights: of the specimen, towards the objective, um.
Usage: tests/references/wavefront_reference.py [objective [period_um ...]]
"""
import math
import pathlib
import sys
import tomllib

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

WAVELENGTH = 0.587562e-3  # mm; the middle one of each medium's table
ASSETS = pathlib.Path(__file__).resolve().parents[2] / "assets"


def lens(path):
    """[curvature, index behind, thickness, semi-diameter] of each surface."""
    table = tomllib.loads((ASSETS / path).read_text())
    assert not any("conic" in s or "aspheric" in s for s in table["surface"])
    return [[1 / s["radius_mm"] if "radius_mm" in s else 0.0,
             table["media"][s["medium"]]["indices"][1] if "medium" in s else 1.0,
             s.get("thickness_mm", 0.0), s["semi_diameter_mm"]] for s in table["surface"]]


def turned(surfaces):
    """The same, for light the other way; between vertices the same way, behind the last none."""
    indices = [1.0] + [s[1] for s in surfaces]
    ways = [0.0] + [s[2] for s in surfaces[:-1]]
    return [[-s[0], indices[k], ways[k], s[3]] for k, s in reversed(list(enumerate(surfaces)))]


def back_focus(surfaces):
    """Behind the last vertex, and the focal length."""
    height, slope, index = 1.0, 0.0, 1.0
    for k, (curvature, after, thickness, _) in enumerate(surfaces):
        slope = (index * slope - height * (after - index) * curvature) / after
        height += thickness * slope if k + 1 < len(surfaces) else 0.0
        index = after
    return -height / slope, -1 / slope


class Microscope:
    def __init__(self, name):
        self.objective, self.tube = lens(f"objectives/{name}.toml"), lens("tube_lenses/200mm.toml")
        self.working_distance, self.focal_length = back_focus(turned(self.objective))
        self.detector, tube_length = back_focus(self.tube)
        self.magnification = tube_length / self.focal_length
        joined = [s[:] for s in self.objective] + [s[:] for s in self.tube]
        joined[len(self.objective) - 1][2] = 100.0
        self.backward = turned(joined)
        # The marginal ray's slope at the detector, where an edge stops it.
        self.rim_slope = brentq(lambda s: self.clearance(s), 1e-4, 0.05, xtol=1e-15)
        slopes = self.rim_slope * np.sin(0.5 * np.pi * np.linspace(0, 1, 1201))
        self.p, self.x, path, _ = self.trace(slopes)
        self.rim = self.p[-1]
        path = path - path[0]
        # Hamilton's mixed characteristic of light that goes up: grad W = t = -x.
        self.w = -(path + self.p * self.x)
        self.spline = CubicSpline(self.p, self.w, bc_type=((1, 0.0), (1, -self.x[-1])))

    def clearance(self, slope):
        return self.trace(np.array([slope]))[3]

    def trace(self, slopes):
        """Backward, in the y = 0 plane: direction cosine p of the light going up, where it leaves the paraxial object
        plane, optical path, and how far inside all edges it stays (least over surfaces and rays)."""
        c = 1 / np.sqrt(1 + slopes**2)
        x, z, l, n, path, index = np.zeros_like(slopes), np.full_like(slopes, -self.detector), slopes * c, c, 0.0, 1.0
        inside = math.inf
        for curvature, after, thickness, semi_diameter in self.backward:
            half = n - curvature * (x * l + z * n)
            rest = curvature * (x * x + z * z) - 2 * z
            with np.errstate(invalid="ignore"):
                t = rest / (half + np.sqrt(half**2 - curvature * rest))
            x, z, path = x + t * l, z + t * n, path + index * t
            inside = min(inside, float(np.min(np.where(np.isnan(x), -1.0, semi_diameter - np.abs(x)))))
            nx, nz = -curvature * x, 1 - curvature * z
            cosine, ratio = nx * l + nz * n, index / after
            with np.errstate(invalid="ignore"):
                turn = np.sqrt(1 - ratio**2 * (1 - cosine**2)) - ratio * cosine
            l, n, index = ratio * l + turn * nx, ratio * n + turn * nz, after
            z = z - thickness
        t = (self.working_distance - z) / n
        # Turned half a turn about the y axis, light going up has -l of the way down; x keeps its place.
        return -l, x + t * l, path + t, inside

    def at(self, p, z):
        """W at the height z (mm) above the paraxial object plane; grad W = -x, and x there is x + z tan."""
        return self.spline(p) + z * np.sqrt(1 - p * p)

    def over_pupil(self, count=400):
        """Nodes in p^2, uniform over the pupil, and weights."""
        u, weight = np.polynomial.legendre.leggauss(count)
        return self.rim * np.sqrt(0.5 * (u + 1)), 0.5 * weight

    def least_spot(self):
        p, weight = self.over_pupil()
        x, slope = -self.spline(p, 1), p / np.sqrt(1 - p * p)
        return -np.sum(weight * x * slope) / np.sum(weight * slope**2)

    def least_variance(self):
        p, weight = self.over_pupil()
        w, g = self.spline(p), np.sqrt(1 - p * p)
        w, g = w - np.sum(weight * w), g - np.sum(weight * g)
        return -np.sum(weight * w * g) / np.sum(weight * g * g)

    def zernike(self, z, orders=(2, 4, 6, 8, 10, 12)):
        """{Noll's number: coefficient in waves} of the rotationally symmetric terms of these radial orders."""
        p, weight = self.over_pupil()
        w, square = self.at(p, z) / WAVELENGTH, (p / self.rim)**2
        result = {}
        for n in orders:
            # R_n^0(rho) is Legendre's polynomial of order n / 2 in 2 rho^2 - 1.
            legendre = np.polynomial.legendre.Legendre.basis(n // 2)(2 * square - 1)
            result[(n * (n + 1)) // 2 + 1] = np.sum(weight * w * legendre) * math.sqrt(n + 1)
        return result

    def transfer(self, frequency, z, count=160):
        """H at cycles per mm, by a product of Gauss's rules over the overlap of the two shifted pupils."""
        half = 0.5 * WAVELENGTH * frequency
        if half >= self.rim:
            return 0.0
        u, weight = np.polynomial.legendre.leggauss(count)
        angle = 0.5 * np.pi * u
        top = math.sqrt(self.rim**2 - half**2)
        y, of_y = top * np.sin(angle), 0.5 * np.pi * top * np.cos(angle) * weight
        width = np.sqrt(self.rim**2 - y**2) - half
        x = width[:, None] * u[None, :]
        right, left = np.hypot(x + half, y[:, None]), np.hypot(x - half, y[:, None])
        phase = 2 * np.pi / WAVELENGTH * (self.at(right, z) - self.at(left, z))
        return np.sum(of_y[:, None] * width[:, None] * weight[None, :] * np.cos(phase)) / (np.pi * self.rim**2)

    def best_contrast(self, period, about, reach):
        heights = about + np.linspace(-reach, reach, 121)
        values = [self.transfer(1 / period, z, 60) for z in heights]
        k = int(np.argmax(values))
        return minimize_scalar(lambda z: -self.transfer(1 / period, z), bracket=(heights[k - 1], heights[k]),
                               tol=1e-10).x


def main():
    name = sys.argv[1] if len(sys.argv) > 1 else "10x_0.28"
    periods = [float(v) for v in sys.argv[2:]] or [2.5, 4.0, 8.0]
    scope = Microscope(name)
    spot, focus = scope.least_spot(), scope.least_variance()
    depth = WAVELENGTH / scope.rim**2
    print(f"{name}: magnification {-scope.magnification:.6f}, numerical aperture {scope.rim:.9f}")
    print(f"least RMS spot {spot * 1e3:.6f} um over the paraxial plane, least wavefront variance {focus * 1e3:.6f} um")
    for where, z in (("least variance", focus), ("least spot", spot)):
        print(f"Zernike coefficients (waves) at the {where}: "
              + ", ".join(f"Z{j} {a:+.6f}" for j, a in scope.zernike(z).items()))
    p, weight = scope.over_pupil()
    waves = scope.at(p, focus) / WAVELENGTH
    rms = np.sqrt(np.sum(weight * (waves - np.sum(weight * waves))**2))
    print(f"at the least variance: RMS {rms:.7f} waves, Strehl ratio {abs(np.sum(weight * np.exp(2j * np.pi * waves)))**2:.7f}")
    for period in periods:
        best = scope.best_contrast(period * 1e-3, focus, 4 * depth)
        print(f"period {period:g} um: highest contrast {scope.transfer(1e3 / period, best):.5f} at "
              f"{(best - spot) * 1e3:+.4f} um over the least spot, {(best - focus) * 1e3:+.4f} um over the least variance; "
              f"H at least variance + 0, 1, 2 depths of field n lambda / 2 NA^2: "
              + ", ".join(f"{scope.transfer(1e3 / period, focus + k * depth / 2):.6f}" for k in range(3)))


if __name__ == "__main__":
    main()
