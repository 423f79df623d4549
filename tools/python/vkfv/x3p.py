"""X3P files, the exchange format of ISO 5436-2 and ISO 25178-72."""

import hashlib
import os
import zipfile
from xml.etree import ElementTree

import numpy

from .array import Array

UM_PER_M = 1e6
POINT_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}


def _child(parent, *names):
    """By names without their namespace's prefix; None where there is none."""
    for name in names:
        if parent is None:
            return None
        parent = next((node for node in parent if node.tag.rsplit("}", 1)[-1] == name), None)
    return parent


def _text(parent, *names, default: str | None = None) -> str:
    node = _child(parent, *names)
    text = "" if node is None or node.text is None else node.text.strip()
    if text:
        return text
    if default is None:
        raise ValueError(f"main.xml has no {'.'.join(names)}")
    return default


def _linked_points(archive: zipfile.ZipFile, folder: str, link) -> bytes:
    points = archive.read(folder + _text(link, "PointDataLink").removeprefix("./"))
    stated = _text(link, "MD5ChecksumPointData", default="").lower()
    if stated and hashlib.md5(points, usedforsecurity=False).hexdigest() != stated:
        raise ValueError("the points do not have the MD5 checksum that main.xml states: the file is damaged")
    return points


def _listed_points(points) -> numpy.ndarray:
    """The last of the coordinates between semicolons; NaN where there is none."""
    heights = [(datum.text or "").rsplit(";", 1)[-1].strip() for datum in points]
    return numpy.array([float(height) if height else numpy.nan for height in heights])


def _provenance(record2) -> dict[str, str]:
    """Creator, date, comment and the instrument, as far as they are known."""
    texts = {name.lower(): _text(record2, name, default="") for name in ("Creator", "Date", "Comment")}
    for name in ("Manufacturer", "Model", "Serial", "Version"):
        texts[name.lower()] = _text(record2, "Instrument", name, default="")
    return {name: text for name, text in texts.items() if text and text != "unknown"}


def read_x3p(path: str | os.PathLike) -> Array:
    """Heights of a surface on a regular grid in um, NaN where not measured, the first row with the highest y.

    `attributes` are creator, date, comment and the instrument's manufacturer, model and so on, as far as the file tells.
    Raises ValueError where the file is something else or damaged.
    """
    with zipfile.ZipFile(path) as archive:
        main = min((name for name in archive.namelist() if name.rsplit("/", 1)[-1] == "main.xml"), key=len, default=None)
        if main is None:
            raise ValueError(f"{os.fspath(path)} is no X3P file: it has no main.xml")
        folder = main.removesuffix("main.xml")
        root = ElementTree.fromstring(archive.read(main))
        record1, record2, record3 = (_child(root, f"Record{number}") for number in (1, 2, 3))
        if _text(record1, "FeatureType") != "SUR":
            raise ValueError(f"FeatureType {_text(record1, 'FeatureType')}: a surface (SUR) is read alone")
        axes = _child(record1, "Axes")
        for axis in ("CX", "CY"):
            if _text(axes, axis, "AxisType") != "I":
                raise ValueError(f"{axis} is not incremental: a regular grid is read alone")
        columns, rows = (int(_text(record3, "MatrixDimension", size)) for size in ("SizeX", "SizeY"))
        link = _child(record3, "DataLink")
        if _child(record3, "DataList") is not None:
            stored = _listed_points(_child(record3, "DataList"))
        else:
            kind = _text(axes, "CZ", "DataType")
            stored = numpy.frombuffer(_linked_points(archive, folder, link), POINT_TYPES[kind])
        if stored.size != columns * rows:
            raise ValueError(f"{stored.size} points where {columns} x {rows} belong")
        heights = float(_text(axes, "CZ", "Offset", default="0")) + stored.astype(float) * float(
            _text(axes, "CZ", "Increment", default="1")
        )
        valid = _text(link, "ValidPointsLink", default="") if link is not None else ""
        if valid:
            bits = numpy.frombuffer(archive.read(folder + valid.removeprefix("./")), numpy.uint8)
            heights[numpy.unpackbits(bits, bitorder="little")[: heights.size] == 0] = numpy.nan
    pitch_x, pitch_y = (UM_PER_M * float(_text(axes, axis, "Increment")) for axis in ("CX", "CY"))
    x0, y0 = (UM_PER_M * float(_text(axes, axis, "Offset", default="0")) for axis in ("CX", "CY"))
    coords = {"y": y0 + (rows - 1 - numpy.arange(rows)) * pitch_y, "x": x0 + numpy.arange(columns) * pitch_x}
    values = UM_PER_M * heights.reshape(rows, columns)
    return Array(values, ("y", "x"), coords, "um", "height", _provenance(record2))
