"""TIFF files as vkfv writes them."""

import os

import numpy
import tifffile

from .array import Array, centred_coords

UM_PER_MM = 1e3
UM_PER_CM = 1e4


def described(description: str) -> dict[str, str]:
    """The lines `key=value` of an ImageDescription."""
    return dict(line.split("=", 1) for line in description.splitlines() if "=" in line)


def read_pixels(path: str | os.PathLike) -> tuple[numpy.ndarray, dict[str, str], float]:
    """Pixels (rows, columns[, channels]; the first row has the highest y), what the description says, pitch in um.

    The pitch is that of the resolution tag, of single precision; NaN without one.
    """
    with tifffile.TiffFile(path) as file:
        page = file.pages[0]
        pitch = numpy.nan
        if "XResolution" in page.tags:
            pixels, length = page.tags["XResolution"].value
            unit = int(page.tags["ResolutionUnit"].value)
            pitch = length / pixels * (UM_PER_CM if unit == 3 else 25.4 * UM_PER_MM)
        return page.asarray(), described(page.description), pitch


def grid_of(path: str | os.PathLike) -> dict[str, numpy.ndarray] | None:
    """Coordinates in um, in double, that a height map's description tells; None of other images."""
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


def read_map(path: str | os.PathLike, unit: str, name: str, coords: dict[str, numpy.ndarray] | None = None) -> Array:
    """A map of a value a pixel. coords: None: those that the file tells."""
    values, _, pitch = read_pixels(path)
    coords = coords or grid_of(path) or centred_coords(values.shape[1], values.shape[0], pitch)
    return Array(values, ("y", "x"), coords, unit, name)
