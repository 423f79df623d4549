"""The folder of an uncertainty budget."""

import json
import os
from functools import cached_property
from pathlib import Path
from typing import NamedTuple


class Contribution(NamedTuple):
    """An input of a budget: value and standard uncertainty in the unit of its key, contribution in that of the measurand.

    degrees_of_freedom: None: infinite.
    """

    value: float
    standard_uncertainty: float
    degrees_of_freedom: float | None
    distribution: str
    sensitivity: float
    contribution: float
    source: str


class Budget:
    """A folder that `vkfv budget` wrote, of a measurand in `unit`. Raises FileNotFoundError if it has no budget.json."""

    def __init__(self, folder: str | os.PathLike):
        self.folder = Path(folder)
        self.content: dict = json.loads((self.folder / "budget.json").read_text(encoding="utf-8"))
        self.name: str = self.content["measurand"]["name"]
        self.unit: str = self.content["measurand"]["unit"]
        self.measured: float = self.content["measured"]
        self.truth: float = self.content["truth"]
        self.error: float = self.content["error"]
        self.standard_uncertainty: float = self.content["by_parts"]["standard_uncertainty"]
        self.expanded_uncertainty_95: float = self.content["by_parts"]["expanded_uncertainty_95"]

    def __repr__(self):
        return f"vkfv.Budget({str(self.folder)!r}: {self.name} {self.measured:.6g} ± {self.expanded_uncertainty_95:.2g} {self.unit})"

    @cached_property
    def inputs(self) -> dict[str, Contribution]:
        """The uncertain numbers by their dotted keys."""
        return {row["key"]: Contribution(**{name: row[name] for name in Contribution._fields}) for row in self.content["inputs"]}

    @cached_property
    def errors(self) -> list[float | None]:
        """The errors of the trials in their order; None: failed. Empty without trials."""
        return (self.content["by_trials"] or {}).get("errors", [])
