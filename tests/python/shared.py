"""Stacks that all tests share: each is made once, when it is first asked for."""

import functools
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tools" / "python"))

import vkfv  # noqa: E402

TILT_X_DEG, TILT_Y_DEG = 3.0, 1.5
COLUMNS, ROWS = 48, 40

CONFIGURATION = f"""
[source]
radius_mm = 1.5
wavelength_um = 0.5876
[illumination]
prescription = "koehler"
field_stop_radius_mm = 0.5
[objective]
kind = "ideal"
focal_length_mm = 20.0
numerical_aperture = 0.28
[tube_lens]
kind = "ideal"
focal_length_mm = 200.0
[detector]
pixels = [{COLUMNS}, {ROWS}]
pixel_um = 20.0
[specimen]
kind = "plane"
size_mm = 0.2
tilt_x_deg = {TILT_X_DEG}
tilt_y_deg = {TILT_Y_DEG}
[specimen.roughness]
noise_um = 1.0
kernel_um = 1.0
pitch_um = 1.0
seed = 7
[specimen.material]
g = 0.8
[scan]
z_start_um = -12.0
z_stop_um = 12.0
z_step_um = 2.0
[trace]
estimator = "backward"
rays = 1.2e5
[diffraction]
model = "none"
[output]
directory = "out"
"""

WITH_CAMERA_AND_STAGE = {
    "specimen": {"kind": "step", "height_um": 4.0},
    "detector.pixels": [20, 16],
    "scan": {"z_start_um": -6, "z_stop_um": 6, "z_step_um": 3},
    "trace": {"rays": 5e3, "device": "host"},
    "diffraction": {"model": "waves", "cells": 2},
    "camera": {"preset": "IMX250"},
    "stage": {"jitter_um": 0.1, "evaluate": "read"},
    "output.images": "uint16",
    "output.image_files": "stack",
}


# Without a device: kernels take longer to make ready than so few rays to trace.
SMALL = {"detector.pixels": [16, 12], "trace": {"rays": 4e3, "device": "host"}}


@functools.cache
def _temporary() -> tempfile.TemporaryDirectory:
    return tempfile.TemporaryDirectory(prefix="vkfv_python_")


def folder() -> Path:
    """The folder of this run of the tests, which is removed at its end."""
    return Path(_temporary().name)


@functools.cache
def configuration() -> Path:
    file = folder() / "tilted.toml"
    file.write_text(CONFIGURATION, encoding="utf-8")
    return file


@functools.cache
def step_configuration() -> Path:
    """As above with a step in place of the plane."""
    file = folder() / "step.toml"
    text = CONFIGURATION.replace(f"tilt_x_deg = {TILT_X_DEG}\ntilt_y_deg = {TILT_Y_DEG}\n", "")
    file.write_text(text, encoding="utf-8")
    return file


@functools.cache
def events() -> list[dict]:
    """The events of the log while tilted() was traced."""
    return []


@functools.cache
def tilted() -> vkfv.Stack:
    """A plane that rises along x and, less, along y; its folder is that of the configuration."""
    return vkfv.run(configuration(), on_event=events().append)


@functools.cache
def with_camera_and_stage() -> vkfv.Stack:
    """A step, as a camera and a stage with errors take it, by waves."""
    return vkfv.run(step_configuration(), out=folder() / "camera", **WITH_CAMERA_AND_STAGE)


@functools.cache
def small_image() -> vkfv.Image:
    """An image of the tilted plane, 2 um above best focus."""
    return vkfv.image(configuration(), 2, out=folder() / "small.tif", **SMALL)


@functools.cache
def evaluated() -> vkfv.Stack:
    """The images of tilted() again: blurred by an Airy pattern too, with filters, with a flat taken off."""
    stack = tilted()
    flat = stack.folder / "topography.x3p"
    topography = {"l_filter_um": 40, "flatness_file": flat, "place_by_texture": False}
    return vkfv.evaluate(
        stack.folder,
        out=folder() / "evaluated",
        topography=topography,
        diffraction={"model": "airy"},
        output={"surfaces": ["x3p", "sur", "sdf", "ply", "gwy", "gsf", "npy", "csv"]},
    )


@functools.cache
def foreign() -> vkfv.Stack:
    """The same images, as if another instrument had taken them from above downwards, by steps of 1 um, with an image of
    no light and one of even light."""
    even = {}
    for name, value in (("dark", 0.0), ("flat", 1.0)):
        even[name] = folder() / f"{name}.pfm"
        even[name].write_bytes(b"Pf\n%d %d\n-1.0\n" % (COLUMNS, ROWS) + struct.pack("<f", value) * (COLUMNS * ROWS))
    return vkfv.evaluate(
        tilted().folder / "images",
        out=folder() / "foreign",
        z_step_um=-1,
        pitch_um=0.5,
        dark=even["dark"],
        flat_field=even["flat"],
        topography={"registration": "shift"},
    )


@functools.cache
def repaired() -> vkfv.Stack:
    """with_camera_and_stage() after its stack.toml was edited and written again."""
    copy = folder() / "repaired"
    shutil.copytree(with_camera_and_stage().folder, copy)
    with (copy / "stack.toml").open("a", encoding="utf-8") as file:
        file.write("# edited\n")
    subprocess.run([vkfv.find_program(), "verify", copy, "--repair"], check=True, capture_output=True)
    return vkfv.evaluate(copy, out=copy)


def stacks() -> tuple[vkfv.Stack, ...]:
    """Between them they have all files and figures that there are."""
    return tilted(), with_camera_and_stage(), evaluated(), foreign(), repaired()


def program_environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(SOURCE / "tools" / "python")}
