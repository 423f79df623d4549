"""The folder of a fit."""

import json
import os
from functools import cached_property
from pathlib import Path
from typing import NamedTuple


class Parameter(NamedTuple):
    """A fitted number of a configuration, in the unit of its key. None: the stack holds no information on it, or the bound is not known."""

    unit: str
    start: float
    told: bool
    estimate: float | None
    standard_uncertainty: float | None
    low: float | None
    high: float | None
    cramer_rao_bound: float | None
    uncertainty_over_bound: float | None


class Fit:
    """A folder that `vkfv fit` wrote. Raises FileNotFoundError if it has no fit.json.

    covariance, correlation: a row a parameter, in the order of `parameters`.
    """

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self.content: dict = json.loads((self.folder / "fit.json").read_text(encoding="utf-8"))
        self.describes: bool = self.content["model_describes"]
        self.covariance: list[list[float | None]] = self.content["covariance"]
        self.correlation: list[list[float | None]] = self.content["correlation"]

    def __repr__(self):
        texts = (f"{key} {one.estimate:.6g} ± {one.standard_uncertainty:.2g}" if one.estimate is not None else f"{key} not told"
                 for key, one in self.parameters.items())
        return f"vkfv.Fit({str(self.folder)!r}: {', '.join(texts)})"

    @cached_property
    def parameters(self) -> dict[str, Parameter]:
        """The free parameters by their dotted keys."""
        return {row["key"]: Parameter(**{name: row[name] for name in Parameter._fields}) for row in self.content["parameters"]}
