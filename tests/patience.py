"""Waiting for other threads and processes: by the clock, since busy machines are slow and steps are fast."""

from collections.abc import Callable
from time import monotonic, sleep
from typing import Any

PATIENCE = 60.0
"""Long enough for the busiest machine [s]; nothing waits for it when all is well."""


def until(condition: Callable[[], Any]) -> Any:
    """Waits for something to hold; returns what it is in the end."""
    give_up = monotonic() + PATIENCE
    while not (result := condition()) and monotonic() < give_up:
        sleep(0.01)
    return result
