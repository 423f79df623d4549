#!/usr/bin/python3
"""The share of light that scatter models keep, and how far they are from reciprocal, by quadrature. Shares no code with vkfv.

GGX keeps the light that facets reflect once: the integral of D(h) G(i, o) / (4 cos i) over all directions o, with the distribution D
of slopes and the height-correlated masking G as Walter et al. and Heitz print them; alpha is the slope that half of the projected area
exceeds. Henyey-Greenstein about the mirror direction is normalised for each angle of incidence i, by H(i): its integral with the cosine
of o. So f(i to the normal) / f(normal to i) = H(0) / H(i). Prints both as Markdown. Needs numpy.
"""
import numpy

# Gauss-Legendre points of the cosine of o, and evenly distributed azimuths about the plane of incidence.
NODES, WEIGHTS = numpy.polynomial.legendre.leggauss(2000)
COSINE = ((NODES + 1) / 2)[:, None]
AZIMUTH = ((numpy.arange(4000) + 0.5) / 4000 * 2 * numpy.pi)[None, :]
SINE = numpy.sqrt(1 - COSINE**2)


def integral(values):
    """Over the hemisphere of the directions o."""
    return float((WEIGHTS / 2) @ values.mean(axis=1) * 2 * numpy.pi)


def kept_by_ggx(alpha, incidence):
    cosine, sine = numpy.cos(incidence), numpy.sin(incidence)
    x, y, z = sine + SINE * numpy.cos(AZIMUTH), SINE * numpy.sin(AZIMUTH), cosine + COSINE
    slope_squared = (x**2 + y**2) / z**2
    normal_cosine = 1 / numpy.sqrt(1 + slope_squared)
    density = 1 / (numpy.pi * alpha**2 * normal_cosine**4 * (1 + slope_squared / alpha**2) ** 2)

    def shadow(of):
        return (numpy.sqrt(1 + alpha**2 * (1 / of**2 - 1)) - 1) / 2

    return integral(density / (1 + shadow(cosine) + shadow(COSINE)) / (4 * cosine))


def normalisation(g, incidence):
    towards_mirror = numpy.cos(incidence) * COSINE + numpy.sin(incidence) * SINE * numpy.cos(AZIMUTH)
    phase = (1 - g**2) / (4 * numpy.pi * (1 + g**2 - 2 * g * towards_mirror) ** 1.5)
    return integral(phase * COSINE)


def table(head, rows):
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")


def main():
    table(["alpha", "0 degrees", "30", "60", "80"],
          [[f"{alpha:g}", *(f"{kept_by_ggx(alpha, numpy.radians(angle)):.5f}" for angle in (0, 30, 60, 80))] for alpha in (0.1, 0.3, 0.5, 0.7, 1)])
    print()
    table(["g", "30 degrees", "45", "60", "75"],
          [[f"{g:g}", *(f"{normalisation(g, 0.0) / normalisation(g, numpy.radians(angle)):.4f}" for angle in (30, 45, 60, 75))]
           for g in (0.3, 0.65, 0.8, 0.95)])


if __name__ == "__main__":
    main()
