"""The exception and the warnings of the module `pybullet`."""

from __future__ import annotations

from functools import cache
from typing import NoReturn

from carom.logger import Logger


class error(Exception):
    """An error that PyBullet itself reports: a wrong id, a missing file, no connection.

    The message starts with PyBullet's own text, followed by the details. Arguments that are missing, misspelt
    or of the wrong type raise `TypeError`, as in PyBullet.
    """


error.__module__ = "pybullet"


def fail(text: str, particulars: str = "") -> NoReturn:
    """Raises `error` with PyBullet's text first and the particulars after it."""
    raise error(f"{text} {particulars}" if particulars else text)


logger = Logger("pybullet")


@cache
def warn_once(message: str) -> None:
    """Logs a warning only the first time, because control loops make the same call in every step."""
    logger.warning(message)
