"""The exceptions that Carom raises. The drop-in turns them into `pybullet.error`."""

from __future__ import annotations

from pathlib import Path


class CaromError(Exception):
    """Base class of Carom's exceptions."""


class DescriptionError(CaromError):
    """A robot or mesh file cannot be used.

    Attributes:
        reason: Description of the error.
        file: The file at fault.
        line: Line in that file, counted from 1, if known.
        element: The XML element at fault, written as `robot > link "arm" > inertial`.
    """

    def __init__(
        self, reason: str, *, file: Path | None = None, line: int | None = None, element: str | None = None
    ) -> None:
        self.reason = reason
        self.file = file
        self.line = line
        self.element = element
        where = "" if file is None else str(file) if line is None else f"{file}:{line}"
        super().__init__(": ".join(part for part in (where, element, reason) if part))


class SimulationError(CaromError):
    """A step could not be completed; the world is as it was before it."""


class StateError(CaromError):
    """A change is not possible now; the world is unchanged.

    A saved state does not fit the present bodies, or the world is in the middle of a step.
    """


class SimulationWarning(RuntimeWarning):
    """One of the worlds of `carom.Worlds` has been halted."""


class NativeLibraryError(CaromError):
    """The compiled kernels are missing, damaged or of another version; the message explains what to do."""
