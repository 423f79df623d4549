"""The folder of a capability map."""

import json
import os
from functools import cached_property
from pathlib import Path
from typing import NamedTuple


class Node(NamedTuple):
    """A sinusoid of a map and how it is measured. None: nothing was measured. docs/outputs.md tells more."""

    stack: str
    wavelength_um: float
    amplitude_um: float
    steepest_slope: float
    measured_share: float
    bias: float | None
    bias_uncertainty: float | None
    rms_error_um: float | None
    noise_um: float | None
    uncertainty_um: float | None
    beyond_uncertainty_share: float | None
    robust: bool
    beyond_limits: list[str]


class Capability:
    """A folder that `vkfv capability` wrote. Raises FileNotFoundError if it has no capability.json."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self.content: dict = json.loads((self.folder / "capability.json").read_text(encoding="utf-8"))
        self.specimen: dict | None = self.content["specimen"]

    def __repr__(self):
        robust = sum(node.robust for node in self.nodes)
        return f"vkfv.Capability({str(self.folder)!r}: {robust} of {len(self.nodes)} sinusoids robust)"

    @cached_property
    def nodes(self) -> list[Node]:
        """The sinusoids, the shortest wavelengths first."""
        return [Node(**node) for node in self.content["nodes"]]
