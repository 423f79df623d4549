"""Python values as the TOML of the program's option --set."""

import json
import math
import os
from collections.abc import Iterator, Mapping
from typing import Any


def toml_text(value: Any) -> str:
    """A value as TOML. A pathlib.Path is relative to the current folder, a str is used as in the configuration file.

    Raises TypeError for what TOML cannot hold.
    """
    if hasattr(value, "tolist"):  # of numpy: an array or a scalar
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, os.PathLike):
        value = os.path.abspath(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {toml_text(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_text, value)) + "]"
    raise TypeError(f"{value!r} is no value of a configuration: a number, a text, true or false, a list or a table")


def settings(overrides: Mapping[str, Any], table: str = "") -> Iterator[str]:
    """KEY=VALUE of each key: {"trace": {"rays": 1e6}} and {"trace.rays": 1e6} are both "trace.rays=1000000.0"."""
    for key, value in overrides.items():
        if isinstance(value, Mapping):
            yield from settings(value, f"{table}{key}.")
        else:
            yield f"{table}{key}={toml_text(value)}"
