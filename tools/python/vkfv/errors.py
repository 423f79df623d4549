"""Exceptions for the ways in which the program can fail, with its message and exit code."""


class Error(Exception):
    """The program failed. `message` is its text, `exit_code` its exit code (128 + N if signal N ended it)."""

    def __init__(self, message: str, exit_code: int):
        super().__init__(message)
        self.message = message
        self.exit_code = exit_code


class InputError(Error):
    """Exit code 2: the configuration or an argument is wrong. The message names the place, the key and the remedy."""


class DeviceError(Error):
    """Exit code 3: there is no usable Vulkan device."""


class RunError(Error):
    """Exit code 4, or ended by a signal: the run failed, and the same call continues it."""


class FolderInUse(RunError):
    """Exit code 5: another run is writing to the same folder."""


class RunWarning(UserWarning):
    """A warning of the program."""


def error_of(exit_code: int, message: str) -> Error:
    """The exception for an exit code of subprocess, which is -N if signal N ended the program."""
    if exit_code < 0:
        return RunError(message, 128 - exit_code)
    kinds = {2: InputError, 3: DeviceError, 4: RunError, 5: FolderInUse}
    return kinds.get(exit_code, Error)(message, exit_code)
