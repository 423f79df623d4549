"""The program's commands as functions. Keyword arguments that are not named are keys of the configuration:

    vkfv.run("c.toml", trace={"rays": 1e6}, **{"specimen.height_um": 5})

They override what the file says, as the option --set does; a misspelt key raises InputError with the nearest name.
Every function takes `program`, the path of vkfv (None: see find_program()), turns warnings of the program into
RunWarning, and raises InputError, DeviceError, RunError or FolderInUse if the program fails.
"""

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from .array import Array
from .budget import Budget
from .capability import Capability
from .certificate import Certificate
from .fit import Fit
from .overrides import settings
from .program import Event, Outcome, call
from .stack import Stack
from .sweep import Sweep
from .tiff import read_map

PathLike = str | os.PathLike


def _path(path: PathLike) -> str:
    """The path as an argument that is not taken for an option, even if the name begins with a dash."""
    text = os.fspath(path)
    return os.path.join(os.curdir, text) if text.startswith("-") else text


def _call(
    command: str,
    operand: PathLike,
    overrides: dict,
    *,
    out: PathLike | None,
    options: tuple[str, ...] = (),
    program: PathLike | None,
    on_event: Callable[[Event], None] | None,
) -> Outcome:
    arguments = [command, _path(operand), *options]
    for setting in settings(overrides):
        arguments += ["--set", setting]
    if out is not None:
        arguments += ["--out", _path(out)]
    return call(arguments, program=program, on_event=on_event)


def run(
    config: PathLike,
    *,
    out: PathLike | None = None,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Stack:
    """Traces and measures a stack (`vkfv stack`), or continues one; returns its folder as a Stack.

    out: the folder; None: that of the configuration. on_event is called with each event of the log, for example
    {"event": "image", "done": 3, "images": 31, "seconds_left": 12.1, ...}; docs/cluster.md lists them.
    """
    outcome = _call("stack", config, overrides, out=out, options=("--json",), program=program, on_event=on_event)
    return Stack(outcome.folder)


class Image:
    """One exposure: `pixels`, an Array (y, x) in W or, with a camera, DN; `figures`, the dictionary that `vkfv image
    --json` prints (docs/outputs.md has the units); `file`, the TIFF."""

    def __init__(self, figures: dict):
        self.figures = figures
        self.file = Path(figures["file"])
        self.pixels: Array = read_map(self.file, f"image at z = {figures['z_um']:g} um")

    def __repr__(self):
        return f"<vkfv.Image {self.pixels!r}>"


def image(
    config: PathLike,
    z_um: float,
    *,
    out: PathLike | None = None,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Image:
    """Traces one exposure (`vkfv image`). z_um: height of the focal plane over best focus. out: a folder or a .tif file."""
    options = ("--json", "--z", repr(float(z_um)))
    outcome = _call("image", config, overrides, out=out, options=options, program=program, on_event=on_event)
    return Image(json.loads(outcome.text))


def sweep(
    config: PathLike,
    *,
    out: PathLike | None = None,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Sweep:
    """Measures every combination of the parameters in [sweep] (`vkfv sweep`), or continues a sweep. out: the folder."""
    outcome = _call("sweep", config, overrides, out=out, options=("--json",), program=program, on_event=on_event)
    return Sweep(outcome.folder)


def calibrate(
    config: PathLike,
    *,
    out: PathLike | None = None,
    only: Sequence[str] = (),
    small: bool = False,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Certificate:
    """Measures the metrological characteristics of an instrument on virtual standards (`vkfv calibrate`), or continues.

    only: names of characteristics; all if empty. small: a part of the field and of the scan, with fewer repetitions.
    """
    options = (*(("--only", ",".join(only)) if only else ()), *(("--small",) if small else ()), "--json")
    outcome = _call("calibrate", config, overrides, out=out, options=options, program=program, on_event=on_event)
    return Certificate(outcome.folder)


def budget(
    config: PathLike,
    measurand: str,
    *,
    out: PathLike | None = None,
    trials: int = 0,
    repeats: int = 10,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Budget:
    """Measures what the uncertain numbers of [uncertainty] do to a result (`vkfv budget`), or continues.

    measurand: a dimension of the specimen, as "groove depth", or a parameter of ISO 25178-2, as "Sq". trials: measurements in
    which all inputs deviate at once. repeats: measurements with no input changed, at least 2.
    """
    options = ("--measurand", measurand, "--trials", str(trials), "--repeats", str(repeats), "--json")
    outcome = _call("budget", config, overrides, out=out, options=options, program=program, on_event=on_event)
    return Budget(outcome.folder)


def capability(
    config: PathLike,
    *,
    out: PathLike | None = None,
    wavelengths: int | None = None,
    amplitudes: int | None = None,
    small: bool = False,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Capability:
    """Maps which sinusoids an instrument measures, and tells what keeps it from measuring a rough specimen (`vkfv capability`),
    or continues.

    wavelengths, amplitudes: their numbers, at least 2; None: 7 and 6. small: a part of the field and of the scan, with 3 and 3.
    """
    given = {"--wavelengths": wavelengths, "--amplitudes": amplitudes}
    options = tuple(word for name, value in given.items() if value is not None for word in (name, str(value)))
    options += (*(("--small",) if small else ()), "--json")
    outcome = _call("capability", config, overrides, out=out, options=options, program=program, on_event=on_event)
    return Capability(outcome.folder)


def fit(
    stack: PathLike,
    free: Sequence[str],
    *,
    config: PathLike | None = None,
    out: PathLike | None = None,
    start: Mapping[str, float] | None = None,
    replicates: int = 24,
    descending: bool = False,
    program: PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
    **overrides,
) -> Fit:
    """Finds the numbers of a configuration with which it makes stacks like this one (`vkfv fit`), or continues.

    stack: folder of a stack of vkfv; with config also images. free: keys that are numbers. start: where the search for a key
    begins. replicates: stacks of the model by which scatter is known. descending: the first of the images is the highest.
    """
    options = ("--free", ",".join(free), "--replicates", str(replicates), "--json")
    options += tuple(word for key, value in (start or {}).items() for word in ("--start", f"{key}={value!r}"))
    options += (*(("--config", os.fspath(config)) if config is not None else ()), *(("--descending",) if descending else ()))
    outcome = _call("fit", stack, overrides, out=out, options=options, program=program, on_event=on_event)
    return Fit(outcome.folder)


def evaluate(
    images: PathLike,
    *,
    out: PathLike,
    z_step_um: float | None = None,
    pitch_um: float | None = None,
    z_start_um: float | None = None,
    channel: int | None = None,
    frame: int | None = None,
    dark: PathLike | None = None,
    flat_field: PathLike | None = None,
    program: PathLike | None = None,
    **overrides,
) -> Stack:
    """Computes heights from existing images (`vkfv topography`).

    images: the folder of a stack, or the images of another instrument in a folder or a TIFF file. z_step_um, pitch_um and
    z_start_um: step from image to image, distance of neighbouring pixels and height of the first image; needed where the
    files do not state them. channel, frame: which of several, from 1. dark: an image without light, which is subtracted;
    flat_field: an image of an even surface, by which images are divided. out: the folder of the results, which must not be
    that of the images.
    """
    given = {"--z_step_um": z_step_um, "--pitch_um": pitch_um, "--z_start_um": z_start_um}
    options = tuple(word for name, value in given.items() if value is not None for word in (name, repr(float(value))))
    further = {"--channel": channel, "--frame": frame}
    options += tuple(word for name, value in further.items() if value is not None for word in (name, str(value)))
    files = {"--dark": dark, "--flat-field": flat_field}
    options += tuple(word for name, file in files.items() if file is not None for word in (name, _path(file)))
    _call("topography", images, overrides, out=out, options=options, program=program, on_event=None)
    return Stack(out)


def check(config: PathLike, *, program: PathLike | None = None, **overrides) -> dict:
    """The instrument's figures, with units in their names, and warnings (`vkfv check --json`). Needs no device."""
    outcome = _call("check", config, overrides, out=None, options=("--json",), program=program, on_event=None)
    return json.loads(outcome.text)
