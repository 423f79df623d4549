"""The folder of a virtual calibration."""

import json
import os
from functools import cached_property
from pathlib import Path
from typing import NamedTuple


class Figure(NamedTuple):
    """A figure of a certificate, in its unit. None: not determined, or infinite degrees of freedom."""

    value: float | None
    standard_uncertainty: float | None
    expanded_uncertainty_95: float | None
    degrees_of_freedom: float | None
    unit: str
    title: str


class Certificate:
    """A folder that `vkfv calibrate` wrote. Raises FileNotFoundError if it has no certificate.json."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self.content: dict = json.loads((self.folder / "certificate.json").read_text(encoding="utf-8"))

    def __repr__(self):
        return f"vkfv.Certificate({str(self.folder)!r})"

    @cached_property
    def figures(self) -> dict[str, Figure]:
        """The figures of all characteristics by key, "alpha_z" or "z_FLT_nm"."""
        return {
            figure["key"]: Figure(**{name: figure[name] for name in Figure._fields})
            for characteristic in self.content["characteristics"]
            for figure in characteristic["figures"]
        }
