"""TIFF files as vkfv writes them."""

import os
import re

import numpy
import tifffile

from .array import Array, centred_coords

UM_PER_MM = 1e3
UM_PER_CM = 1e4


def described(description: str) -> dict[str, str]:
    """The values in the lines `key=value` of an ImageDescription, by key."""
    return dict(line.split("=", 1) for line in description.splitlines() if "=" in line)


def image_unit(description: str) -> str:
    """The unit of an image's values, "W" or "DN", by its ImageDescription; empty for files of other programs."""
    found = re.search(r"(?:radiant flux|radiant flux per pixel|grey values) in (W|DN)\b", description)
    return found[1] if found else ""


def read_description(path: str | os.PathLike) -> str:
    """The ImageDescription of the first page; the pixels are not read."""
    with tifffile.TiffFile(path) as file:
        return file.pages[0].description


def read_pixels(path: str | os.PathLike) -> tuple[numpy.ndarray, str, float]:
    """Pixels (rows, columns[, channels]; the first row has the highest y), ImageDescription, pitch in um.

    The pitch is that of the resolution tag, of single precision; NaN without one.
    """
    with tifffile.TiffFile(path) as file:
        page = file.pages[0]
        pitch = numpy.nan
        if "XResolution" in page.tags:
            pixels, length = page.tags["XResolution"].value
            unit = int(page.tags["ResolutionUnit"].value)
            pitch = length / pixels * (UM_PER_CM if unit == 3 else 25.4 * UM_PER_MM)
        return page.asarray(), page.description, pitch


def grid_of(path: str | os.PathLike) -> dict[str, numpy.ndarray] | None:
    """The coordinates "x" and "y" in um that the description of a height map states; None for other images."""
    with tifffile.TiffFile(path) as file:
        page = file.pages[0]
        text = described(page.description)
        if "pitch_y_mm" not in text:
            return None
        rows, columns = page.shape[:2]
        x0, y0, pitch_x, pitch_y = (UM_PER_MM * float(text[key]) for key in ("x0_mm", "y0_mm", "pitch_x_mm", "pitch_y_mm"))
    return {
        "y": y0 + (rows - 1 - numpy.arange(rows)) * pitch_y,  # x0 and y0 are of the last row's first pixel
        "x": x0 + numpy.arange(columns) * pitch_x,
    }


def read_map(
    path: str | os.PathLike, name: str, unit: str | None = None, coords: dict[str, numpy.ndarray] | None = None
) -> Array:
    """Reads an image with one value a pixel. unit, coords: None takes those that the file states."""
    values, description, pitch = read_pixels(path)
    coords = coords or grid_of(path) or centred_coords(values.shape[1], values.shape[0], pitch)
    return Array(values, ("y", "x"), coords, image_unit(description) if unit is None else unit, name)
