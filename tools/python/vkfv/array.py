"""Arrays that know their unit and where their values stand."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy


@dataclass(frozen=True, eq=False)
class Array:
    """Values with a unit and a coordinate for each dimension, as xarray.DataArray has them.

    `dims` name the dimensions, ("y", "x") for maps and ("z", "y", "x") for stacks; `coords[dim]` are their positions in
    um ("channel" counts from 0). As in the files the first row has the highest y: y falls along its dimension, x and z
    rise. numpy's functions take an Array as its values. Raises ValueError if coordinates and values differ in length.
    """

    values: numpy.ndarray
    dims: tuple[str, ...]
    coords: Mapping[str, numpy.ndarray]
    unit: str = ""  # empty: dimensionless
    name: str = ""
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        lengths = tuple(len(self.coords[dim]) for dim in self.dims)
        if lengths != self.values.shape:
            raise ValueError(f"values of shape {self.values.shape} with coordinates of lengths {lengths}")

    def __array__(self, dtype=None, copy=None):
        return numpy.array(self.values, dtype=dtype) if copy else numpy.asarray(self.values, dtype=dtype)

    def __repr__(self):
        axes = ", ".join(
            f"{dim}: {len(at)} from {at[0]:.6g} to {at[-1]:.6g} um" if len(at) else f"{dim}: 0"
            for dim, at in ((dim, self.coords[dim]) for dim in self.dims)
        )
        return f"<vkfv.Array {self.name} [{self.unit or '1'}] {self.values.dtype} ({axes})>"

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of values along each of `dims`."""
        return self.values.shape

    @property
    def x(self) -> numpy.ndarray:
        """Positions of the columns, um. Raises KeyError if the array has no such dimension; so do `y` and `z`."""
        return self.coords["x"]

    @property
    def y(self) -> numpy.ndarray:
        """Positions of the rows, um, from the highest to the lowest."""
        return self.coords["y"]

    @property
    def z(self) -> numpy.ndarray:
        """Heights of the focal plane, um."""
        return self.coords["z"]

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top edge of the outermost pixels in um, the `extent` of matplotlib's imshow.

        Needs at least two columns and two rows; raises IndexError with fewer.
        """
        x, y = self.x, self.y
        half_x, half_y = abs(x[1] - x[0]) / 2, abs(y[1] - y[0]) / 2
        return (x.min() - half_x, x.max() + half_x, y.min() - half_y, y.max() + half_y)

    def isel(self, **places: Any) -> "Array":
        """Selects by index along dimensions, from 0: an integer removes the dimension, a slice keeps it.

        Raises KeyError for a dimension that the array lacks, IndexError for an index outside.
        """
        self._check(places)
        index = tuple(places.get(dim, slice(None)) for dim in self.dims)
        kept = tuple(dim for dim, at in zip(self.dims, index) if not isinstance(at, int | numpy.integer))
        coords = {dim: self.coords[dim][places.get(dim, slice(None))] for dim in kept}
        return replace(self, values=self.values[index], dims=kept, coords=coords)

    def sel(self, **positions: float | slice) -> "Array":
        """Selects by position in um along dimensions: the nearest place, or all from slice.start to slice.stop inclusive.

        A number removes the dimension, a slice keeps it. Raises KeyError for a dimension that the array lacks, and for a
        position more than half a step outside.
        """
        self._check(positions)
        return self.isel(**{dim: self._place(dim, at) for dim, at in positions.items()})

    def with_values(self, values: numpy.ndarray, *, unit: str | None = None, name: str | None = None) -> "Array":
        """An Array of other values, of the same shape, at the same places; ValueError for another shape."""
        return replace(
            self,
            values=numpy.asarray(values),
            unit=self.unit if unit is None else unit,
            name=self.name if name is None else name,
        )

    def to_xarray(self):
        """The same as an xarray.DataArray, with the units in `attrs`. Raises ImportError without xarray."""
        import xarray

        coords = {dim: xarray.DataArray(self.coords[dim], dims=dim, attrs={"units": "um"}) for dim in self.dims}
        attributes = {**self.attributes, "units": self.unit}
        return xarray.DataArray(self.values, coords=coords, dims=self.dims, name=self.name or None, attrs=attributes)

    def _check(self, dims: Mapping[str, Any]) -> None:
        for dim in dims:
            if dim not in self.dims:
                raise KeyError(f"no dimension {dim} among {', '.join(self.dims)}")

    def _place(self, dim: str, at: float | slice) -> int | slice:
        coordinate = self.coords[dim]
        if isinstance(at, slice):
            low = -numpy.inf if at.start is None else at.start
            high = numpy.inf if at.stop is None else at.stop
            inside = numpy.flatnonzero((coordinate >= min(low, high)) & (coordinate <= max(low, high)))
            return slice(inside[0], inside[-1] + 1) if inside.size else slice(0, 0)
        nearest = int(numpy.abs(coordinate - at).argmin())
        step = abs(coordinate[1] - coordinate[0]) if len(coordinate) > 1 else numpy.inf
        if abs(coordinate[nearest] - at) > 0.5 * step * (1 + 1e-9):
            raise KeyError(f"{dim} = {at} um is outside {coordinate.min():.6g} to {coordinate.max():.6g} um")
        return nearest


def centred_coords(columns: int, rows: int, pitch_um: float) -> dict[str, numpy.ndarray]:
    """Pixel centres in um with the middle of the grid at the origin; y falls from the first row on."""
    return {
        "y": ((rows - 1) / 2 - numpy.arange(rows)) * pitch_um,
        "x": (numpy.arange(columns) - (columns - 1) / 2) * pitch_um,
    }
