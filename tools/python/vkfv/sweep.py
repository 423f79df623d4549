"""The folder of a sweep."""

import json
import os
from functools import cached_property
from pathlib import Path

import numpy

from .array import Array
from .stack import Stack
from .tiff import read_map


class Sweep:
    """A folder that `vkfv sweep` wrote. Raises FileNotFoundError if it has no sweep.json."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self._json = json.loads((self.folder / "sweep.json").read_text(encoding="utf-8"))
        self._labels = {parameter["key"]: parameter["label"] for parameter in self.parameters}

    def __repr__(self):
        return f"vkfv.Sweep({str(self.folder)!r})"

    @property
    def parameters(self) -> list[dict]:
        """The varied parameters, each with its "key", "label" and "values"."""
        return self._json["parameters"]

    @cached_property
    def records(self) -> list[dict]:
        """A dictionary for each combination: the parameters' values by label, figures by name (None: no value), "folder".

        The names of figures end in their units. pandas.DataFrame(sweep.records) is the table.
        """
        return [
            {
                **{self._labels[key]: value for key, value in row["values"].items()},
                **row["figures"],
                "folder": self.folder / row["folder"],
            }
            for row in self._json["rows"]
        ]

    def column(self, name: str) -> numpy.ndarray:
        """One parameter (by label) or figure (by name) of all records; NaN where a record has none."""
        return numpy.array([numpy.nan if record.get(name) is None else record[name] for record in self.records])

    def select(self, **values) -> list[dict]:
        """The records whose parameters, named by label, have these values. Raises KeyError for an unknown label."""
        return [record for record in self.records if all(record[label] == value for label, value in values.items())]

    def stacks(self, record: dict) -> list[Stack]:
        """The stack of a record, or its repeats. Raises ValueError if this is a sweep of images."""
        if self._json["of"] != "stacks":
            raise ValueError("this is a sweep of images: ask for image()")
        folder = record["folder"]
        repeats = sorted(folder.glob("repeat_*"))
        return [Stack(repeat) for repeat in repeats or [folder]]

    def image(self, record: dict) -> Array:
        """The image (y, x) of a record, in W or DN. Raises ValueError if this is a sweep of stacks."""
        if self._json["of"] != "images":
            raise ValueError("this is a sweep of stacks: ask for stacks()")
        return read_map(record["folder"] / "image.tif", "image")
