"""The one exception of the module, and the warnings it logs."""

from __future__ import annotations

from functools import cache
from typing import NoReturn

from carom.logger import Logger


class error(Exception):
    """Anything PyBullet itself reports: a wrong id, a missing file, no connection.

    The message starts with PyBullet's own text; what follows says what exactly was wrong. Arguments
    that are missing, misspelt or of the wrong type raise `TypeError`, as in PyBullet.
    """


error.__module__ = "pybullet"


def fail(text: str, particulars: str = "") -> NoReturn:
    """Raises `error` with PyBullet's text first and the particulars after it."""
    raise error(f"{text} {particulars}" if particulars else text)


logger = Logger("pybullet")


@cache
def warn_once(message: str) -> None:
    """Logs a warning, the first time only: control loops make the same call in every step."""
    logger.warning(message)
