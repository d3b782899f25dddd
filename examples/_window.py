"""What the examples with a window share: how long they run, and whether anybody looks."""

import sys
import time

import pybullet as p

TIME_STEP = 1 / 240


def connect(window):
    """Opens the window, or a world without one."""
    return p.connect(p.GUI if window else p.DIRECT)


def slider(name, lower, upper, start):
    """A function that says where a slider is; without a window it stays at its start."""
    number = p.addUserDebugParameter(name, lower, upper, start)
    return (lambda: p.readUserDebugParameter(number)) if number >= 0 else (lambda: start)


def button(name):
    """A function that says whether a button was pressed since the last call; without a window it never is."""
    number = p.addUserDebugParameter(name, 1, 0, 0)
    seen = 0.0

    def pressed():
        nonlocal seen
        before, seen = seen, p.readUserDebugParameter(number) if number >= 0 else 0.0
        return seen > before

    return pressed


def steps(duration, window):
    """Counts steps until the time is over or the user ends it by ESC; with a window, in real time."""
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
