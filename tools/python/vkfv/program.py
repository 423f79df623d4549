"""The program vkfv: where it is, and how it is run."""

import json
import os
import shutil
import signal
import subprocess
import threading
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .errors import RunWarning, error_of

CHECKOUT = Path(__file__).resolve().parents[3]

Event = dict[str, Any]


def find_program(program: str | os.PathLike | None = None) -> Path:
    """The path of the program: the one given, that of the environment variable VKFV, `vkfv` of PATH, or that built here.

    Raises FileNotFoundError if there is none.
    """
    for asked, by in ((program, "the argument `program`"), (os.environ.get("VKFV"), "the environment variable VKFV")):
        if asked:
            found = shutil.which(asked)
            if found is None:
                raise FileNotFoundError(f"{asked}, named by {by}, is no program that can be run")
            return Path(found)
    on_path = shutil.which("vkfv")
    if on_path is not None:
        return Path(on_path)
    for preset in ("release", "dev"):
        built = CHECKOUT / "build" / preset / "vkfv"
        if os.access(built, os.X_OK):
            return built
    raise FileNotFoundError(
        "vkfv is not on PATH, nor built in this checkout. Build it (tools/demo), or name it by the argument `program` or "
        "the environment variable VKFV"
    )


@dataclass
class Outcome:
    """The text that a command printed, and the events of its log (docs/cluster.md lists them)."""

    text: str
    events: list[Event] = field(default_factory=list)

    @property
    def folder(self) -> Path:
        """The folder that holds the results, by the last event of `stack` or `sweep`."""
        return Path(next(event["folder"] for event in reversed(self.events) if event.get("event") == "results"))


class _Log:
    """The lines of the program's standard error, each a JSON object, sorted into events, warnings and errors."""

    def __init__(self, on_event: Callable[[Event], None] | None):
        self.events: list[Event] = []
        self._errors: list[str] = []
        self._others: list[str] = []
        self._on_event = on_event

    def take(self, line: str) -> None:
        try:
            entry = json.loads(line)
        except ValueError:
            entry = None
        if not isinstance(entry, dict):
            self._others.append(line.rstrip("\n"))
        elif "event" in entry:
            self.events.append(entry)
            if self._on_event is not None:
                self._on_event(entry)
        elif entry.get("level") == "warning":
            warnings.warn(entry["text"], RunWarning, stacklevel=5)
        elif entry.get("level") in ("error", "critical"):
            self._errors.append(entry["text"])

    def message(self) -> str:
        """The message of a failure: the errors of the log, else the last other lines."""
        return "\n".join(self._errors or self._others[-20:]) or "the program ended without a message"


def _end(process: subprocess.Popen, log: _Log) -> None:
    """Asks for the end as Ctrl-C does, and takes what the program says of it. A second Ctrl-C kills it."""
    log._on_event = None
    try:
        process.send_signal(signal.SIGINT)
        for line in process.stderr:
            log.take(line)
        process.wait()
    except KeyboardInterrupt:
        process.kill()


def call(
    arguments: list[str],
    *,
    program: str | os.PathLike | None = None,
    on_event: Callable[[Event], None] | None = None,
) -> Outcome:
    """Runs a command to its end.

    Its warnings become RunWarning, its failure an Error. Ctrl-C (KeyboardInterrupt), or an exception of `on_event`, is
    passed on to the program, which keeps what it has and says so: KeyboardInterrupt then carries that message.
    """
    command = [str(find_program(program)), *arguments, "--log-json"]
    with subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"
    ) as process:
        printed: list[str] = []
        reader = threading.Thread(target=lambda: printed.append(process.stdout.read()))
        reader.start()
        log = _Log(on_event)
        try:
            for line in process.stderr:
                log.take(line)
            process.wait()
        except KeyboardInterrupt:
            _end(process, log)
            raise KeyboardInterrupt(log.message()) from None
        except BaseException:
            _end(process, log)
            raise
        finally:
            reader.join()
    if process.returncode != 0:
        raise error_of(process.returncode, log.message())
    return Outcome(printed[0], log.events)
