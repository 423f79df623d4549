"""X3P files, the exchange format of ISO 5436-2 and ISO 25178-72."""

import errno
import hashlib
import os
import warnings
import zipfile
import zlib
from xml.etree import ElementTree

import numpy

from .array import Array

UM_PER_M = 1e6
POINT_TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}
# The limits are those of the program: a small file that unpacks to more is made to fill the memory.
LARGEST_XML, LARGEST_CHECKSUM_FILE, LARGEST_POINT_COUNT = 1 << 24, 4096, 1 << 28
FREELY_PACKED, LARGEST_PACKING = 1 << 28, 64


def _child(parent, *names):
    """The element below `parent` by these names in turn, without prefixes of namespaces; None if one is missing."""
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


class _Archive:
    """The entries of a file, in the folder of main.xml, within bounds and with their checksums."""

    def __init__(self, path: str | os.PathLike, archive: zipfile.ZipFile, accept_checksum: bool) -> None:
        self.path, self.archive, self.accept_checksum = os.fspath(path), archive, accept_checksum
        names = archive.namelist()
        main = min((name for name in names if name.rsplit("/", 1)[-1] == "main.xml"), key=len, default=None)
        if main is None:
            raise ValueError(f"{self.path} is no X3P file: it has no main.xml")
        self.folder = main.removesuffix("main.xml")

    def read(self, name: str, largest: int) -> bytes:
        try:
            with self.archive.open(self.folder + name.removeprefix("./")) as entry:
                content = entry.read(largest + 1)
        except KeyError:
            raise ValueError(f"{self.path} has no entry {name}") from None
        if len(content) > largest:
            raise ValueError(f"{self.path}: {name} is longer than {largest} bytes")
        return content

    def check(self, name: str, content: bytes, stated: str) -> None:
        """Raises ValueError where a stated checksum is another, or warns if that is accepted."""
        stated = stated.strip().lower()
        if not stated or hashlib.md5(content, usedforsecurity=False).hexdigest() == stated:
            return
        message = f"{self.path}: {name} does not have the MD5 checksum that the file states: it was changed or damaged"
        if not self.accept_checksum:
            raise ValueError(f"{message}. accept_checksum=True reads it as it is")
        warnings.warn(message, stacklevel=4)


def _points(archive: _Archive, link, kind: str, count: int) -> numpy.ndarray:
    if kind not in POINT_TYPES:
        raise ValueError(f"points of type {kind}: I, L, F and D are read")
    stored = numpy.dtype(POINT_TYPES[kind])
    unpacked = 8 * count
    if unpacked > FREELY_PACKED and unpacked // LARGEST_PACKING > os.path.getsize(archive.path):
        raise ValueError(f"{archive.path} states {count} points, more than a file of its size holds")
    name = _text(link, "PointDataLink")
    content = archive.read(name, count * stored.itemsize)
    archive.check(name, content, _text(link, "MD5ChecksumPointData", default=""))
    if len(content) != count * stored.itemsize:
        raise ValueError(f"{archive.path}: {len(content)} bytes in {name}, where {count * stored.itemsize} belong")
    return numpy.frombuffer(content, stored)


def _valid_points(archive: _Archive, link, count: int) -> numpy.ndarray | None:
    """Whether each point was measured; None: all were. Some writers (pyx3p) store a byte a point."""
    name = _text(link, "ValidPointsLink", default="") if link is not None else ""
    if not name:
        return None
    content = archive.read(name, count)
    archive.check(name, content, _text(link, "MD5ChecksumValidPoints", default=""))
    stored = numpy.frombuffer(content, numpy.uint8)
    if stored.size == (count + 7) // 8:
        return numpy.unpackbits(stored, bitorder="little")[:count] != 0
    if stored.size == count:
        warnings.warn(f"{archive.path}: {name} has a byte for each point, where ISO 25178-72 has a bit", stacklevel=4)
        return stored != 0
    raise ValueError(f"{archive.path}: {stored.size} bytes in {name}, where a bit a point belongs")


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


def read_x3p(path: str | os.PathLike, *, accept_checksum: bool = False) -> Array:
    """Heights of a surface on a regular grid in um, NaN where not measured, the first row with the highest y.

    `attributes` are creator, date, comment and the instrument's manufacturer, model and so on, as far as the file states
    them. Raises ValueError if the file is no X3P file, is damaged, or does not have the checksums that it states;
    accept_checksum=True reads a file with other checksums, with a warning.
    """
    try:
        with zipfile.ZipFile(path) as zipped:
            archive = _Archive(path, zipped, accept_checksum)
            xml = archive.read("main.xml", LARGEST_XML)
            if archive.folder + "md5checksum.hex" in zipped.namelist():
                stated = archive.read("md5checksum.hex", LARGEST_CHECKSUM_FILE)[:32].decode("latin-1")
                archive.check("main.xml", xml, stated)
            root = ElementTree.fromstring(xml)
            record1, record2, record3 = (_child(root, f"Record{number}") for number in (1, 2, 3))
            if _text(record1, "FeatureType") != "SUR":
                raise ValueError(f"FeatureType {_text(record1, 'FeatureType')}: a surface (SUR) is read alone")
            axes = _child(record1, "Axes")
            for axis in ("CX", "CY"):
                if _text(axes, axis, "AxisType") != "I":
                    raise ValueError(f"{axis} is not incremental: a regular grid is read alone")
            columns, rows = (int(_text(record3, "MatrixDimension", size)) for size in ("SizeX", "SizeY"))
            count = columns * rows
            if not (columns > 0 and rows > 0 and count <= LARGEST_POINT_COUNT):
                raise ValueError(f"{columns} x {rows} points: at least one and at most {LARGEST_POINT_COUNT} are read")
            link = _child(record3, "DataLink")
            if _child(record3, "DataList") is not None:
                stored = _listed_points(_child(record3, "DataList"))
            else:
                stored = _points(archive, link, _text(axes, "CZ", "DataType"), count)
            if stored.size != count:
                raise ValueError(f"{stored.size} points where {columns} x {rows} belong")
            heights = float(_text(axes, "CZ", "Offset", default="0")) + stored.astype(float) * float(
                _text(axes, "CZ", "Increment", default="1")
            )
            valid = _valid_points(archive, link, count)
            if valid is not None:
                heights[~valid] = numpy.nan
            heights[~numpy.isfinite(heights)] = numpy.nan
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ElementTree.ParseError) as error:
        raise ValueError(f"{os.fspath(path)} is no X3P file, or it is damaged: {error}") from error
    except OSError as error:
        if error.errno != errno.EINVAL:  # a place before the beginning of the file, which a damaged archive names
            raise
        raise ValueError(f"{os.fspath(path)} is damaged: {error}") from error
    pitch_x, pitch_y = (UM_PER_M * float(_text(axes, axis, "Increment")) for axis in ("CX", "CY"))
    x0, y0 = (UM_PER_M * float(_text(axes, axis, "Offset", default="0")) for axis in ("CX", "CY"))
    coords = {"y": y0 + (rows - 1 - numpy.arange(rows)) * pitch_y, "x": x0 + numpy.arange(columns) * pitch_x}
    values = UM_PER_M * heights.reshape(rows, columns)
    return Array(values, ("y", "x"), coords, "um", "height", _provenance(record2))
