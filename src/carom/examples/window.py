"""Windows of the tutorials' scripts: sliders, buttons, real time and `--headless`."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator

import pybullet as p

TIME_STEP = 1 / 240
_ESC = 27


def connect(window: bool) -> int:
    """Open the window, or a world without one.

    Args:
        window: Whether to open the window.

    Returns:
        The number of the connection.
    """
    return p.connect(p.GUI if window else p.DIRECT)


def slider(name: str, lower: float, upper: float, start: float) -> Callable[[], float]:
    """Show a slider.

    Args:
        name: The text beside it.
        lower: Its least value.
        upper: Its greatest value.
        start: Its value at first.

    Returns:
        A function that returns its value; without a window that is its start value.
    """
    number = p.addUserDebugParameter(name, lower, upper, start)
    return (lambda: p.readUserDebugParameter(number)) if number >= 0 else (lambda: start)


def button(name: str) -> Callable[[], bool]:
    """Show a button.

    Args:
        name: The text on it.

    Returns:
        A function that returns whether it was pressed since the last call; never without a window.
    """
    number = p.addUserDebugParameter(name, 1, 0, 0)
    seen = 0.0

    def pressed() -> bool:
        nonlocal seen
        before, seen = seen, p.readUserDebugParameter(number) if number >= 0 else 0.0
        return seen > before

    return pressed


def steps(duration: float, window: bool) -> Iterator[int]:
    """Count steps until the duration is over or the user presses ESC; with a window, in real time.

    Args:
        duration: Simulated time [s], in steps of `TIME_STEP`.
        window: Whether there is a window.

    Yields:
        The numbers of the steps, from 0.
    """
    began, count = time.perf_counter(), 0
    while p.isConnected() and count * TIME_STEP < duration:
        if _ESC in p.getKeyboardEvents():
            return
        yield count
        count += 1
        if window:
            time.sleep(max(0.0, began + count * TIME_STEP - time.perf_counter()))


def wants_window() -> bool:
    """Return whether the script was started without `--headless`."""
    return "--headless" not in sys.argv
