"""The exception and the warnings of the module `pybullet`."""

from __future__ import annotations

import sys
from functools import cache
from typing import NoReturn

from carom.logger import Logger


class error(Exception):
    """An error that PyBullet itself reports: a wrong id, a missing file, no connection.

    The message starts with PyBullet's own text, followed by the details. Arguments that are missing, misspelt
    or of the wrong type raise `TypeError`, as in PyBullet.
    """


error.__module__ = "pybullet"

NOT_CONNECTED = "Not connected to physics server."


def no_body(body_id: int) -> str:
    """Error message: no such body."""
    return f"There is no body {body_id}."


def fail(text: str, particulars: str = "") -> NoReturn:
    """Raises `error` with PyBullet's text first and the particulars after it."""
    raise error(f"{text} {particulars}" if particulars else text)


logger = Logger("pybullet")

# Places in scripts that were warned, with the message; not more, since scripts can make lines without end.
_warned: set[tuple[str, int, str]] = set()
_MAX_WARNED = 10_000


@cache
def warn_once(message: str) -> None:
    """Logs a warning only the first time, because control loops make the same call in every step."""
    logger.warning(message)


def warn_once_here(message: str) -> None:
    """Logs a warning the first time that a line of the script causes it."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "pybullet":
        frame = frame.f_back
    place = frame.f_code.co_filename, frame.f_lineno, message
    if place not in _warned:
        if len(_warned) >= _MAX_WARNED:
            _warned.clear()
        _warned.add(place)
        logger.warning("%s", message)
