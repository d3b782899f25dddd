"""Shared code of the examples with a window: sliders, buttons, real time and `--headless`."""

import sys
import time

import pybullet as p

TIME_STEP = 1 / 240


def connect(window):
    """Opens the window, or a world without one."""
    return p.connect(p.GUI if window else p.DIRECT)


def slider(name, lower, upper, start):
    """Returns a function for the value of a slider; without a window that is its start value."""
    number = p.addUserDebugParameter(name, lower, upper, start)
    return (lambda: p.readUserDebugParameter(number)) if number >= 0 else (lambda: start)


def button(name):
    """Returns a function: whether a button was pressed since the last call; never without a window."""
    number = p.addUserDebugParameter(name, 1, 0, 0)
    seen = 0.0

    def pressed():
        nonlocal seen
        before, seen = seen, p.readUserDebugParameter(number) if number >= 0 else 0.0
        return seen > before

    return pressed


def steps(duration, window):
    """Counts steps until the duration is over or the user presses ESC; with a window, in real time."""
    began, count = time.perf_counter(), 0
    while p.isConnected() and count * TIME_STEP < duration:
        if 27 in p.getKeyboardEvents():
            return
        yield count
        count += 1
        if window:
            time.sleep(max(0.0, began + count * TIME_STEP - time.perf_counter()))


def wants_window():
    """Whether the example was started without --headless."""
    return "--headless" not in sys.argv
