"""A scene in this process: images and heights without a program and files in between."""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy

from .array import Array
from .errors import Error, error_of
from .overrides import settings, toml_text

EXIT_CODES = {"input": 2, "device": 3, "run": 4}


@dataclass(frozen=True)
class Topography:
    """Heights of a stack, as Arrays. NaN: not measured. `truth` is None where the specimen's heights are not known."""

    heights: Array  # um
    height_uncertainty: Array  # um, standard uncertainty including noise
    height_noise: Array  # um, standard deviation by the images' noise
    contrast: Array
    measured: Array
    truth: Array | None  # um


def map_of(found: Mapping[str, Any], key: str, name: str, unit: str) -> Array:
    """The array of `key` with its coordinates, without a copy. The library's first row has the lowest y, an Array's the highest."""
    values = found[key][::-1]
    rows, columns = values.shape
    x = found["x0_um"] + found["pitch_um"] * numpy.arange(columns)
    y = found["y0_um"] + found["pitch_um"] * numpy.arange(rows)[::-1]
    return Array(values, ("y", "x"), {"y": y, "x": x}, unit, name)


class Scene:
    """A configuration with its device, specimen and instrument, which stay from call to call.

    `set` makes again only what depends on the key. Errors are `vkfv.InputError`, `DeviceError` and `RunError`; their
    `problems` list place, key, found, expectation and remedy. Scenes may work in several threads.
    """

    def __init__(self, config: str | os.PathLike, overrides: Mapping[str, Any] | None = None):
        try:
            from . import _core
        except ImportError as error:
            raise ImportError("vkfv._core is not installed: build vkfv with -DVKFV_PYTHON_MODULE=ON") from error
        self._core = _core
        self._file = os.fspath(config)
        self._scene = self._do(_core.Scene, self._file)
        for setting in settings(overrides or {}):
            key, _, value = setting.partition("=")
            self._do(self._scene.set, key, value)

    def __repr__(self):
        z = self.positions
        return f"<vkfv.Scene {self._file}: {len(z)} images from {z[0]:.6g} to {z[-1]:.6g} um>"

    def _do(self, work: Callable, *arguments: Any) -> Any:
        try:
            return work(*arguments)
        except self._core.Failure as failure:
            message, cause, problems = failure.args
            error: Error = error_of(EXIT_CODES[cause], message)
            error.problems = problems
            raise error from None

    def set(self, key: str, value: Any) -> None:
        """Sets a key such as "specimen.material.g". If it is refused, the scene stays as it was."""
        self._do(self._scene.set, key, toml_text(value))

    @property
    def positions(self) -> numpy.ndarray:
        """Heights of the scan's focal planes, um."""
        return numpy.array(self._scene.positions_um())

    @property
    def configuration(self) -> str:
        """All keys, as TOML."""
        return self._scene.configuration()

    def image(self, z_um: float) -> Array:
        """The exposure with the focal plane at `z_um`: radiant flux in W a pixel."""
        return map_of(self._do(self._scene.image, float(z_um)), "flux", "image", "W")

    def stack(self, progress: Callable[[int, int], None] | None = None) -> list[Array]:
        """The scan's images. `progress` is called with the images done and their number; an interrupt ends the stack."""
        return [map_of(image, "flux", "image", "W") for image in self._do(self._scene.stack, progress)]

    def evaluate(self, images: Iterable[Any], **topography: Any) -> Topography:
        """Heights of the scan's images, which may be changed ones. Keys of [topography], such as `focus_measure`, stay set."""
        for key, value in topography.items():
            self.set(f"topography.{key}", value)
        found = self._do(self._scene.evaluate, [numpy.asarray(image, dtype=numpy.float32)[::-1] for image in images])
        return Topography(
            heights=map_of(found, "heights_um", "height", "um"),
            height_uncertainty=map_of(found, "height_uncertainty_um", "height uncertainty", "um"),
            height_noise=map_of(found, "height_noise_um", "height noise", "um"),
            contrast=map_of(found, "contrast", "contrast", ""),
            measured=map_of({**found, "measured": found["measured"].view(bool)}, "measured", "measured", ""),
            truth=map_of(found, "truth_um", "truth", "um") if "truth_um" in found else None,
        )


def load(config: str | os.PathLike, **overrides: Any) -> Scene:
    """The scene of a configuration of `vkfv stack`; keys are given as to `vkfv.run`."""
    return Scene(config, overrides)
