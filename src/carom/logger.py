"""Loggers that import `logging` at first use, because importing it takes as long as ten modules of Carom."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    import logging


class Logger:
    """A logger of the module `logging`, found by name when it is first used.

    Args:
        name: The logger's name.

    Attributes:
        count: Number of messages of all loggers so far.
    """

    __slots__ = ("_name",)

    count: ClassVar[int] = 0

    def __init__(self, name: str) -> None:
        self._name = name

    def info(self, message: str, *values: object) -> None:
        """As `logging.Logger.info`, but only if `logging` has been imported: else there are no handlers."""
        if "logging" in sys.modules:
            self._logger().info(message, *values, stacklevel=2)

    def warning(self, message: str, *values: object) -> None:
        """As `logging.Logger.warning`."""
        self._logger().warning(message, *values, stacklevel=2)

    def log(self, level: int, message: str, *values: object) -> None:
        """As `logging.Logger.log`."""
        self._logger().log(level, message, *values, stacklevel=2)

    def exception(self, message: str, *values: object) -> None:
        """As `logging.Logger.exception`."""
        self._logger().exception(message, *values, stacklevel=2)

    def _logger(self) -> logging.Logger:
        from logging import getLogger

        Logger.count += 1
        return getLogger(self._name)
