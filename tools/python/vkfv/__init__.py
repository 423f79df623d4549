"""vkfv from Python: run the virtual focus-variation microscope, and read what it wrote as arrays with units.

    import vkfv

    stack = vkfv.run("assets/stacks/demo.toml", out="demo", trace={"rays": 1e6})
    stack.heights.sel(x=10, y=-5)      # um, at the pixel nearest to x = 10 um and y = -5 um
    stack.results["rms_deviation_um"]

Everything is read from files; docs/python.md tells more.
"""

from .array import Array
from .budget import Budget
from .capability import Capability
from .certificate import Certificate
from .commands import Image, budget, calibrate, capability, check, evaluate, fit, image, run, sweep
from .errors import DeviceError, Error, FolderInUse, InputError, RunError, RunWarning
from .fit import Fit
from .focus import focus_curves
from .program import find_program
from .stack import PointState, Stack
from .sweep import Sweep
from .x3p import read_x3p

__version__ = "1.1.0"

__all__ = [
    "Array",
    "Budget",
    "Capability",
    "Certificate",
    "DeviceError",
    "Error",
    "Fit",
    "FolderInUse",
    "Image",
    "InputError",
    "PointState",
    "RunError",
    "RunWarning",
    "Stack",
    "Sweep",
    "budget",
    "calibrate",
    "capability",
    "check",
    "evaluate",
    "find_program",
    "fit",
    "focus_curves",
    "image",
    "read_x3p",
    "run",
    "sweep",
]
