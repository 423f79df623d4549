"""Focus curves as the evaluation follows them (docs/topography.md): the same arithmetic as shaders/focus, in numpy.

They are computed anew from the images, for any part of the field, so that no file has to hold a value for every pixel of
every image.
"""

from collections.abc import Mapping
from typing import Any

import numpy

from .array import Array

REACH = 2  # pixels that the widest response sees on either side


def window_weights(width_px: int, shape: str) -> numpy.ndarray:
    """Weights of a window at distances 0, 1, ... pixels from its middle, along rows or columns.

    A pixel's weight is the product of both, up to a factor. shape: "box" or "gaussian".
    """
    distance = numpy.arange(width_px // 2 + 1)
    return numpy.ones(len(distance)) if shape == "box" else numpy.exp(-0.5 * (5.0 * distance / width_px) ** 2)


def axial_shares(smoothing_steps: float, images: int) -> numpy.ndarray:
    """Matrix (images, images) of the Gaussian average along z: row k has the images' shares in the average at image k.

    smoothing_steps: standard deviation of the Gaussian in steps from image to image; 0: no average.
    """
    distance = numpy.abs(numpy.subtract.outer(numpy.arange(images), numpy.arange(images)))
    if smoothing_steps == 0:
        return numpy.eye(images)
    reach = numpy.ceil(3 * smoothing_steps)
    weights = numpy.where(distance <= reach, numpy.exp(-0.5 * (distance / smoothing_steps) ** 2), 0.0)
    return weights / weights.sum(axis=1, keepdims=True)


def _convolved(images: numpy.ndarray, taps_y, taps_x) -> numpy.ndarray:
    """The pixels at least REACH from the border, by separable symmetric or antisymmetric taps from -n to n."""
    rows, columns = images.shape[-2] - 2 * REACH, images.shape[-1] - 2 * REACH
    along_y = sum(
        tap * images[..., REACH + d : REACH + d + rows, :] for d, tap in zip(range(-(len(taps_y) // 2), len(taps_y)), taps_y)
    )
    return sum(
        tap * along_y[..., REACH + d : REACH + d + columns]
        for d, tap in zip(range(-(len(taps_x) // 2), len(taps_x)), taps_x)
    )


ONE = (1.0,)
DIFFERENCE = (-1.0, 0.0, 1.0)
SECOND_DIFFERENCE = (-1.0, 2.0, -1.0)
SOBEL = (1.0, 2.0, 1.0)
LOW = (-0.125, 0.25, 0.75, 0.25, -0.125)
HIGH = (-0.5, 1.0, -0.5)
MAGNITUDES = ("modified-laplacian", "gradient-and-curvature")  # all others are roots of energies


def _response(images: numpy.ndarray, measure: str) -> numpy.ndarray:
    """The response of each pixel, which the window averages. images: with REACH mirrored pixels on every side."""

    def squares(*pairs):
        return sum(_convolved(images, along_y, along_x) ** 2 for along_y, along_x in pairs)

    if measure == "modified-laplacian":
        return numpy.abs(_convolved(images, ONE, SECOND_DIFFERENCE)) + numpy.abs(_convolved(images, SECOND_DIFFERENCE, ONE))
    if measure == "tenengrad":
        return squares((SOBEL, DIFFERENCE), (DIFFERENCE, SOBEL))
    if measure == "brenner":
        return squares((ONE, DIFFERENCE), (DIFFERENCE, ONE))
    if measure == "wavelet":
        return squares((HIGH, LOW), (LOW, HIGH), (HIGH, HIGH))
    if measure == "gradient-and-curvature":
        bends = squares((SOBEL, SECOND_DIFFERENCE), (SECOND_DIFFERENCE, SOBEL))
        return numpy.sqrt(squares((SOBEL, DIFFERENCE), (DIFFERENCE, SOBEL)) + 0.5 * bends)
    raise ValueError(f"no focus measure {measure}")


def _windowed(values: numpy.ndarray, weights: numpy.ndarray, inner: tuple[slice, slice]) -> numpy.ndarray:
    """Weighted means over the window around the pixels `inner`, cut off at the border of what is there."""
    for axis, places in ((-2, inner[0]), (-1, inner[1])):
        values = numpy.moveaxis(values, axis, 0)
        count = len(values)
        distance = numpy.abs(numpy.subtract.outer(numpy.arange(count)[places], numpy.arange(count)))
        share = numpy.where(distance < len(weights), weights[numpy.minimum(distance, len(weights) - 1)], 0.0)
        share /= share.sum(axis=1, keepdims=True)
        values = numpy.moveaxis(numpy.tensordot(share, values, axes=1), 0, axis)
    return values


def _part(length: int, asked: slice, margin: int) -> tuple[slice, slice]:
    """The part of a dimension that is needed for the places asked for, and their slice in that part."""
    start, stop, step = asked.indices(length)
    if step != 1:
        raise ValueError("rows and columns are slices without a step")
    first, last = max(0, start - margin), min(length, stop + margin)
    return slice(first, last), slice(start - first, stop - first)


def focus_curves(
    images: Array, settings: Mapping[str, Any], rows: slice = slice(None), columns: slice = slice(None)
) -> Array:
    """Focus curves: the focus measure of each image at these rows and columns, averaged along z as the evaluation does.

    images: (z, y, x), of any unit; the result has the same dimensions. rows, columns: slices without a step. settings:
    focus_measure, window_px, window_shape and smoothing_steps, as results.json has them under "topography". The values are
    dimensionless. Images of several channels are not taken. Raises ValueError for an unknown measure or slices with a step.
    """
    weights = window_weights(settings["window_px"], settings["window_shape"])
    measure = settings["focus_measure"]
    margin = len(weights) - 1
    part_y, inner_y = _part(len(images.y), rows, margin)
    part_x, inner_x = _part(len(images.x), columns, margin)
    share = axial_shares(settings["smoothing_steps"], len(images.z))
    curves = numpy.empty((len(images.z), inner_y.stop - inner_y.start, inner_x.stop - inner_x.start))
    for k, of_image in enumerate(share):
        used = numpy.flatnonzero(of_image)
        # Beyond its border an image goes on as its own mirror image.
        image = numpy.tensordot(of_image[used], images.values[used].astype(float), axes=1)
        image = numpy.pad(image, REACH, mode="reflect")
        image = image[part_y.start : part_y.stop + 2 * REACH, part_x.start : part_x.stop + 2 * REACH]
        grey = image[REACH:-REACH, REACH:-REACH]
        level = _windowed(grey, weights, (inner_y, inner_x))
        if measure == "standard-deviation":
            offset = grey.mean()  # no difference of large sums
            energy = _windowed((grey - offset) ** 2, weights, (inner_y, inner_x)) - (level - offset) ** 2
            amplitude = numpy.sqrt(numpy.maximum(energy, 0))
        else:
            energy = _windowed(_response(image, measure), weights, (inner_y, inner_x))
            amplitude = energy if measure in MAGNITUDES else numpy.sqrt(energy)
        curves[k] = numpy.divide(amplitude, level, out=numpy.zeros_like(amplitude), where=level > 0)
    coords = {"z": images.z, "y": images.y[rows], "x": images.x[columns]}
    return Array(numpy.tensordot(share, curves, axes=1), ("z", "y", "x"), coords, "", "focus measure")
