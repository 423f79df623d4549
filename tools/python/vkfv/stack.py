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
    """The values of a mask: what became of a point."""

    MEASURED = 0
    NO_PEAK = 1
    BY_CHANCE = 2
    POOR_FIT = 3
    MANY_PEAKS = 4
    REPAIRED = 5
    LOW_CONTRAST = 6
    DARK = 7


class Stack:
    """A folder that `vkfv stack`, `merge` or `topography` wrote. Files are read when they are asked for, and kept.

    docs/outputs.md says what every file holds. Lengths are um; the first row of every map has the highest y.
    """

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        if not (self.folder / "results.json").exists() and not (self.folder / "stack.toml").exists():
            raise FileNotFoundError(f"{self.folder} holds neither a results.json nor a stack.toml")

    def __repr__(self):
        return f"vkfv.Stack({str(self.folder)!r})"

    @cached_property
    def results(self) -> dict:
        """results.json."""
        return json.loads((self.folder / "results.json").read_text(encoding="utf-8"))

    @cached_property
    def configuration(self) -> dict:
        """stack.toml, every default spelled out; empty of the images of another instrument."""
        file = self.folder / "stack.toml"
        return tomllib.loads(file.read_text(encoding="utf-8")) if file.exists() else {}

    @property
    def dimensions(self) -> list[dict]:
        """Of a standard: nominal, true and measured; empty of other specimens."""
        return self.results.get("dimensions", [])

    # Maps

    @cached_property
    def coords(self) -> dict[str, numpy.ndarray]:
        """x and y of the pixels' centres, um: the heights' grid; of a stack without heights, that of its images."""
        evaluated = self.folder / "height_noise.tif"  # written whatever `output.surfaces` says
        if evaluated.exists():
            return grid_of(evaluated)
        values, _, pitch = read_pixels(self._image_files[0])
        return centred_coords(values.shape[1], values.shape[0], pitch)

    @cached_property
    def heights(self) -> Array:
        """Measured heights, um; NaN: not measured."""
        if (self.folder / "topography.tif").exists():
            return self._map("topography.tif", "um", "height")
        return read_x3p(self.folder / "topography.x3p")

    @cached_property
    def truth(self) -> Array:
        """True heights at the pixels' centres, um. FileNotFoundError of the images of another instrument."""
        return self._map("truth.tif", "um", "true height")

    @cached_property
    def deviation(self) -> Array:
        """Measured less true heights after form and filters, um."""
        return self._map("deviation.tif", "um", "deviation")

    @cached_property
    def height_noise(self) -> Array:
        """Standard deviation of the height that the images' noise brings, um."""
        return self._map("height_noise.tif", "um", "noise of the height")

    @cached_property
    def height_uncertainty(self) -> Array:
        """Standard uncertainty of the height by what neighbouring windows do not agree on, um."""
        return self._map("height_uncertainty.tif", "um", "uncertainty of the height")

    @cached_property
    def mask(self) -> Array:
        """A PointState for each point."""
        return self._map("mask.tif", "", "state")

    @property
    def measured(self) -> numpy.ndarray:
        """Whether a point has a height of its own: neither left out nor repaired."""
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
        """Every pixel from the images around its height, in their unit."""
        values, _, _ = read_pixels(self.folder / "all_in_focus.tif")
        if values.ndim == 2:
            return Array(values, ("y", "x"), self.coords, name="all in focus")
        coords = {**self.coords, "channel": numpy.arange(values.shape[2])}
        return Array(values, ("y", "x", "channel"), coords, name="all in focus")

    @cached_property
    def diffracted(self) -> "DiffractedMaps | None":
        """The maps of the images after `[diffraction]` blurred them; None without."""
        return DiffractedMaps(self) if "diffracted" in self.results else None

    # Images

    @cached_property
    def z(self) -> numpy.ndarray:
        """Nominal heights of the focal plane, um, one an image."""
        return numpy.array([float(described(read_description(file))["z_um"]) for file in self._image_files])

    def image(self, place: int) -> Array:
        """One image of the stack, from 0; -1: the last."""
        values, description, _ = read_pixels(self._image_files[place])
        text = described(description)
        name = f"image at z = {text['z_um']} um"
        return Array(values, ("y", "x"), self.coords, image_unit(description), name, text)

    @cached_property
    def images(self) -> Array:
        """All images, (z, y, x). Of 1000 images of 1000 x 1000 that is 4 GB: `image` takes one at a time."""
        images = [self.image(place) for place in range(len(self._image_files))]
        z = numpy.array([float(image.attributes["z_um"]) for image in images])
        values = numpy.stack([image.values for image in images])
        return Array(values, ("z", "y", "x"), {"z": z, **self.coords}, images[0].unit, "image")

    def focus_curves(self, rows: slice = slice(None), columns: slice = slice(None), **settings) -> Array:
        """Focus curves (z, y, x) of these rows and columns, averaged along z, by the settings that the heights were
        found by; others of [topography] may be given instead. See vkfv.focus_curves()."""
        return focus_curves(self.images, {**self.results["topography"], **settings}, rows, columns)

    def focus_curve(self, x: float, y: float, **settings) -> Array:
        """That of the pixel nearest to (x, y) in um."""
        row, column = (self.images._place(dim, at) for dim, at in (("y", y), ("x", x)))
        curves = self.focus_curves(slice(row, row + 1), slice(column, column + 1), **settings)
        return curves.isel(y=0, x=0)

    # Tables

    @cached_property
    def ledger(self) -> list[dict]:
        """ledger.csv, a record an image: where its light went, in W."""
        return read_records(self.folder / "ledger.csv")

    @cached_property
    def stage(self) -> list[dict]:
        """stage.csv, a record an image: where it was really taken. FileNotFoundError without a `[stage]`."""
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
    """The maps of the folder `diffracted` in a stack's, and their figures."""

    def __init__(self, stack: Stack):
        self.folder = stack.folder / "diffracted"
        self.results = {**stack.results, **stack.results["diffracted"]}
        self.configuration = stack.configuration

    @property
    def _image_files(self):
        raise FileNotFoundError("the images are stored without diffraction: ask the stack itself for them")
