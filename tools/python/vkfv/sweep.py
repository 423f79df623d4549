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
    """A folder that `vkfv sweep` wrote."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self._json = json.loads((self.folder / "sweep.json").read_text(encoding="utf-8"))
        self._labels = {parameter["key"]: parameter["label"] for parameter in self.parameters}

    def __repr__(self):
        return f"vkfv.Sweep({str(self.folder)!r})"

    @property
    def parameters(self) -> list[dict]:
        """What was varied: "key", "label" and "values"."""
        return self._json["parameters"]

    @cached_property
    def records(self) -> list[dict]:
        """A record a combination: values by the parameters' labels, figures by name (None: there is none), "folder".

        pandas.DataFrame(sweep.records) is the table.
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
        """A parameter or a figure of all records; NaN where there is none."""
        return numpy.array([numpy.nan if record.get(name) is None else record[name] for record in self.records])

    def select(self, **values) -> list[dict]:
        """The records with these values of parameters, by label."""
        return [record for record in self.records if all(record[label] == value for label, value in values.items())]

    def stacks(self, record: dict) -> list[Stack]:
        """Of a sweep of stacks: that of a record, or its repeats."""
        if self._json["of"] != "stacks":
            raise ValueError("this is a sweep of images: ask for image()")
        folder = record["folder"]
        repeats = sorted(folder.glob("repeat_*"))
        return [Stack(repeat) for repeat in repeats or [folder]]

    def image(self, record: dict) -> Array:
        """Of a sweep of images: that of a record."""
        if self._json["of"] != "images":
            raise ValueError("this is a sweep of stacks: ask for stacks()")
        return read_map(record["folder"] / "image.tif", "image")
