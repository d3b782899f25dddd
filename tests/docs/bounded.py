"""Python for scripts whose user presses Esc after some turns of their loops.

`python -m tests.docs.bounded first.py --fast` is `python first.py --fast`, and with `-m carom` in place of a
script it is a command of Carom. What knows no end, as a training, gets Ctrl-C after some seconds of processor
time. Sleeping is skipped.
"""

from __future__ import annotations

import runpy
import signal
import sys
import time
from itertools import count
from pathlib import Path
from threading import Event

# How often a script may look at its keys, and ask whether there still is a connection or a page.
TURNS, QUESTIONS = 40, 80
# Processor time after which Ctrl-C is pressed [s].
PATIENCE = 8.0
_ESC = 27
_PRESSED = 3  # KEY_IS_DOWN | KEY_WAS_TRIGGERED


def press_esc() -> None:
    """Let the functions that tell of the user's wishes say so after some calls, in this process."""
    import pybullet
    from carom.viewer import Viewer

    keys, connected = pybullet.getKeyboardEvents, pybullet.isConnected
    asked, looked, drawn = count(), count(), count()
    closed = Event()

    def pressed(*client: int, **named: int) -> dict[int, int]:
        if next(looked) < TURNS:
            return keys(*client, **named)
        closed.set()
        return {_ESC: _PRESSED}

    def still_connected(*client: int, **named: int) -> int:
        if next(asked) >= QUESTIONS:
            closed.set()
        return 0 if closed.is_set() else connected(*client, **named)

    def still_open(viewer: Viewer) -> bool:
        of_script = not sys._getframe(1).f_globals["__name__"].startswith(("carom.viewer", "pybullet"))
        return viewer.__dict__["open"] and not (of_script and next(drawn) >= QUESTIONS)

    def set_open(viewer: Viewer, is_open: bool) -> None:
        viewer.__dict__["open"] = is_open

    for name, replacement in (("getKeyboardEvents", pressed), ("isConnected", still_connected)):
        setattr(pybullet, name, replacement)
    Viewer.is_open = property(still_open, set_open)  # pyright: ignore[reportAttributeAccessIssue]
    sleep = time.sleep
    time.sleep = lambda seconds: sleep(min(float(seconds), 0.0005))


def press_ctrl_c() -> None:
    """Interrupt the main thread after some processor time, and again, should that be caught."""

    def interrupt(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGPROF, interrupt)
    signal.setitimer(signal.ITIMER_PROF, PATIENCE, PATIENCE)


def wait_for_no_page() -> None:
    """Interrupt what only waits for pages, by the clock."""
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 2.0 * PATIENCE, PATIENCE)


def main(words: list[str]) -> None:
    """Run what the words say; Ctrl-C is a good end."""
    press_esc()
    press_ctrl_c()
    if words[:3] == ["-m", "carom", "view"]:
        wait_for_no_page()
    try:
        if words[0] == "-m":
            sys.argv = words[1:]
            runpy.run_module(words[1], run_name="__main__", alter_sys=True)
        else:
            sys.argv = words
            sys.path.insert(0, str(Path(words[0]).resolve().parent))
            runpy.run_path(words[0], run_name="__main__")
    except KeyboardInterrupt:
        pass
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)


if __name__ == "__main__":
    main(sys.argv[1:])
