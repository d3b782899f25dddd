"""The clock of a world, which the native library lets go on with each step."""

from __future__ import annotations

import ctypes
from ctypes import c_double


class Clock(ctypes.Structure):
    """Time of a world [s]: that which has been simulated, and the part that no substep has covered yet."""

    time: float
    unspent_time: float
    _fields_ = (("time", c_double), ("unspent_time", c_double))

    @property
    def addresses(self) -> tuple[int, int]:
        """Where the numbers are."""
        address = ctypes.addressof(self)
        return address, address + type(self).unspent_time.offset  # type: ignore[attr-defined]
