#!/usr/bin/env python3
"""Searches the rank-1 lattices of src/trace/lattice_generators.hpp, component by component.

For n = 2^m points, each further component is the odd number that gives the least worst-case error P2 with product
weights (J. Dick, F. Y. Kuo, I. H. Sloan, Acta Numerica 22 (2013), section 5): every candidate is tried, up to the
mirrored half. Prints one row of the table for each m. Takes two minutes.
"""
import numpy

WEIGHTS = [1.0, 1.0, 1.0, 1.0, 0.7, 0.7, 0.5, 0.4]
LARGEST = 14


def kernel(x):
    return 2 * numpy.pi**2 * (x * x - x + 1 / 6)


for m in range(LARGEST + 1):
    n = 1 << m
    index = numpy.arange(n)
    product = 1 + WEIGHTS[0] * kernel(index / n)
    generator = [1]
    candidates = numpy.arange(1, max(n // 2, 2), 2)
    for weight in WEIGHTS[1:]:
        table = 1 + weight * kernel(index / n)
        errors = [product @ table[index * z % n] for z in candidates]
        # Two equal components would be one and the same number: each is taken once, while there are others.
        fresh = [e if z not in generator else numpy.inf for z, e in zip(candidates, errors)]
        best = int(candidates[int(numpy.argmin(fresh if min(fresh) < numpy.inf else errors))])
        generator.append(best)
        product = product * table[index * best % n]
    print("    {" + ", ".join(f"{z}" for z in generator) + f"}}, // 2^{m}", flush=True)
