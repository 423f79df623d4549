#!/usr/bin/env python3
"""Searches the rank-1 lattices of src/trace/interface/lattice_generators.hpp.

For n = 2^m points, the components are odd numbers whose worst-case error P2 with product weights is small (J. Dick,
F. Y. Kuo, I. H. Sloan, Acta Numerica 22 (2013), section 5). They are found one after the other, the weightiest first,
and then each again with the others held, until none becomes better; also from random beginnings, as that ends in a
minimum near where it began. Prints one row of the table for each m. Takes two minutes.
"""
import random

import numpy

# A backward path's light changes most with its place in the pupil (components 2 and 3), less with that in the pixel (0,
# 1) and with the direction to the source (4, 5), of which several are weighed against each other. The weights are
# those, of five shapes in three sizes, whose lattices did well in bench_paper_chain at 16 to 1024 paths a pixel.
WEIGHTS = [0.06, 0.06, 0.3, 0.3, 0.06, 0.06, 0.015, 0.015]
ORDER = sorted(range(len(WEIGHTS)), key=lambda k: -WEIGHTS[k])
LARGEST = 14


def kernel(x):
    return 2 * numpy.pi**2 * (x * x - x + 1 / 6)


def search(n, beginnings):
    index = numpy.arange(n)
    values = kernel(index / n)
    odd = list(range(1, max(n, 2), 2))

    def factor(k, z):
        return 1 + WEIGHTS[k] * values[index * z % n]

    def best_component(k, generator):
        """The least error with it, and it: neither another's number nor its mirror image, while there are others."""
        product = numpy.ones(n)
        for other, z in enumerate(generator):
            if other != k and z:
                product *= factor(other, z)
        taken = {min(z, n - z) for other, z in enumerate(generator) if other != k and z}
        fresh = [z for z in odd if min(z, n - z) not in taken]
        mean = product.mean()
        return min((mean + WEIGHTS[k] * (product @ values[index * z % n]) / n, z) for z in fresh or odd)

    found = None
    for beginning in range(beginnings):
        chance = random.Random(beginning)
        generator = [0 if beginning == 0 else chance.choice(odd) for _ in WEIGHTS]
        error = numpy.inf
        while True:
            for k in ORDER:
                now, generator[k] = best_component(k, generator)
            if not now < error * (1 - 1e-12):
                break
            error = now
        if found is None or error < found[0]:
            found = (error, generator)
    generator = found[1]
    inverse = pow(generator[0], -1, n) if n > 1 else 1
    return [z * inverse % n for z in generator] if n > 1 else generator  # the same points in another order


for m in range(LARGEST + 1):
    row = search(1 << m, 40 if m <= 10 else 10)
    print("    {{" + ", ".join(f"{z}" for z in row) + f"}}}}, // 2^{m}", flush=True)
