"""The folder of a stack: what was traced and what was measured."""

import json
import os
import tomllib
from enum import IntEnum
from functools import cached_property
from pathlib import Path

import numpy

from .array import Array, centred_coords
from .focus import focus_curves
from .tables import read_records
from .tiff import described, grid_of, image_unit, read_description, read_map, read_pixels
from .x3p import read_x3p


class PointState(IntEnum):
    """The values of a mask: whether a point was measured, or why not (docs/topography.md explains each)."""

    MEASURED = 0
    NO_PEAK = 1
    BY_CHANCE = 2
    POOR_FIT = 3
    MANY_PEAKS = 4
    REPAIRED = 5
    LOW_CONTRAST = 6
    DARK = 7


class Stack:
    """A folder that `vkfv stack`, `merge` or `topography` wrote. A file is read when its property is first used, and kept.

    Maps are Arrays (y, x); lengths are um; the first row has the highest y. docs/outputs.md says what every file holds.
    Raises FileNotFoundError for a folder without results.json and stack.toml, and where a property's file is missing.
    """

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        if not (self.folder / "results.json").exists() and not (self.folder / "stack.toml").exists():
            raise FileNotFoundError(f"{self.folder} holds neither a results.json nor a stack.toml")

    def __repr__(self):
        return f"vkfv.Stack({str(self.folder)!r})"

    @cached_property
    def results(self) -> dict:
        """The contents of results.json; the keys end in their units, and docs/outputs.md lists them."""
        return json.loads((self.folder / "results.json").read_text(encoding="utf-8"))

    @cached_property
    def configuration(self) -> dict:
        """The contents of stack.toml, with all defaults; empty for images of another instrument."""
        file = self.folder / "stack.toml"
        return tomllib.loads(file.read_text(encoding="utf-8")) if file.exists() else {}

    @property
    def dimensions(self) -> list[dict]:
        """The dimensions of a standard, each with nominal, true and measured value; empty for other specimens."""
        return self.results.get("dimensions", [])

    # Maps

    @cached_property
    def coords(self) -> dict[str, numpy.ndarray]:
        """x and y of the pixels' centres, um: the grid of the heights, or of the images where there are no heights."""
        evaluated = self.folder / "height_noise.tif"  # written whatever `output.surfaces` says
        if evaluated.exists():
            return grid_of(evaluated)
        values, _, pitch = read_pixels(self._image_files[0])
        return centred_coords(values.shape[1], values.shape[0], pitch)

    @cached_property
    def heights(self) -> Array:
        """Measured heights, um; NaN where a point is not measured."""
        if (self.folder / "topography.tif").exists():
            return self._map("topography.tif", "um", "height")
        return read_x3p(self.folder / "topography.x3p")

    @cached_property
    def truth(self) -> Array:
        """True heights where the pixels look, um. Raises FileNotFoundError for images of another instrument."""
        return self._map("truth.tif", "um", "true height")

    @cached_property
    def deviation(self) -> Array:
        """Measured minus true heights, both after removal of form and filtering, um."""
        return self._map("deviation.tif", "um", "deviation")

    @cached_property
    def height_noise(self) -> Array:
        """Standard deviation of the height due to the noise of the images, um."""
        return self._map("height_noise.tif", "um", "noise of the height")

    @cached_property
    def height_uncertainty(self) -> Array:
        """Standard uncertainty of the height, um (docs/heights.md lists its parts)."""
        return self._map("height_uncertainty.tif", "um", "uncertainty of the height")

    @cached_property
    def mask(self) -> Array:
        """A PointState for each point, as an integer."""
        return self._map("mask.tif", "", "state")

    @property
    def measured(self) -> numpy.ndarray:
        """Whether each point has a height of its own, neither left out nor repaired: booleans (y, x)."""
        return self.mask.values == PointState.MEASURED

    @cached_property
    def contrast(self) -> Array:
        """Height of the focus curve's maximum over its mean in standard deviations of its noise."""
        return self._map("quality.tif", "", "contrast")

    @cached_property
    def fit_residual(self) -> Array:
        """RMS distance of the focus curve from a Gaussian, in units of its maximum."""
        return self._map("fit_residual.tif", "", "fit residual")

    @cached_property
    def all_in_focus(self) -> Array:
        """Each pixel from the images around its height: (y, x) or (y, x, channel). Values have the images' unit."""
        values, _, _ = read_pixels(self.folder / "all_in_focus.tif")
        if values.ndim == 2:
            return Array(values, ("y", "x"), self.coords, name="all in focus")
        coords = {**self.coords, "channel": numpy.arange(values.shape[2])}
        return Array(values, ("y", "x", "channel"), coords, name="all in focus")

    @cached_property
    def diffracted(self) -> "DiffractedMaps | None":
        """The maps of the images after `[diffraction]` blurred them; None if it did not."""
        return DiffractedMaps(self) if "diffracted" in self.results else None

    # Images

    @cached_property
    def z(self) -> numpy.ndarray:
        """Nominal height of the focal plane in each image, um. Raises FileNotFoundError if the folder has no images."""
        return numpy.array([float(described(read_description(file))["z_um"]) for file in self._image_files])

    def image(self, place: int) -> Array:
        """One image (y, x) of the stack, in W or DN. place: from 0; -1: the last. Raises IndexError beyond."""
        values, description, _ = read_pixels(self._image_files[place])
        text = described(description)
        name = f"image at z = {text['z_um']} um"
        return Array(values, ("y", "x"), self.coords, image_unit(description), name, text)

    @cached_property
    def images(self) -> Array:
        """All images, (z, y, x), in W or DN. 1000 images of 1000 x 1000 pixels take 4 GB; `image` reads one at a time."""
        images = [self.image(place) for place in range(len(self._image_files))]
        z = numpy.array([float(image.attributes["z_um"]) for image in images])
        values = numpy.stack([image.values for image in images])
        return Array(values, ("z", "y", "x"), {"z": z, **self.coords}, images[0].unit, "image")

    def focus_curves(self, rows: slice = slice(None), columns: slice = slice(None), **settings) -> Array:
        """Focus curves (z, y, x) of these rows and columns (slices without a step), averaged along z.

        The settings are those by which the heights were found; keywords replace them. See vkfv.focus_curves().
        """
        return focus_curves(self.images, {**self.results["topography"], **settings}, rows, columns)

    def focus_curve(self, x: float, y: float, **settings) -> Array:
        """The focus curve (z) of the pixel nearest to (x, y), um. Raises KeyError outside of the field."""
        row, column = (self.images._place(dim, at) for dim, at in (("y", y), ("x", x)))
        curves = self.focus_curves(slice(row, row + 1), slice(column, column + 1), **settings)
        return curves.isel(y=0, x=0)

    # Tables

    @cached_property
    def ledger(self) -> list[dict]:
        """The lines of ledger.csv, a dictionary an image: where its light went, in W."""
        return read_records(self.folder / "ledger.csv")

    @cached_property
    def stage(self) -> list[dict]:
        """The lines of stage.csv, a dictionary an image: where it was really taken.

        Raises FileNotFoundError without `[stage]`.
        """
        return read_records(self.folder / "stage.csv")

    # Inside

    def _map(self, name: str, unit: str, label: str) -> Array:
        return read_map(self.folder / name, label, unit, self.coords)

    @cached_property
    def _image_files(self) -> list[Path]:
        files = sorted((self.folder / "images").glob("z_*.tif"), key=lambda file: int(file.stem[len("z_") :]))
        if not files:
            where = self.results.get("stack") if (self.folder / "results.json").exists() else None
            raise FileNotFoundError(f"{self.folder} holds no images" + (f": they are in {where}" if where else ""))
        return files


class DiffractedMaps(Stack):
    """The maps and figures of the folder `diffracted` in that of a stack, read like a Stack; it has no images."""

    def __init__(self, stack: Stack):
        self.folder = stack.folder / "diffracted"
        self.results = {**stack.results, **stack.results["diffracted"]}
        self.configuration = stack.configuration

    @property
    def _image_files(self):
        raise FileNotFoundError("the images are stored without diffraction: ask the stack itself for them")
