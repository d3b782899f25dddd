"""The file of a log: a failure to write it ends the log, and neither a step nor the connection."""

from __future__ import annotations

from pathlib import Path

from pybullet._calls.errors import fail, logger


class LogFile:
    """A file that is written from its beginning on.

    The disk may become full at any time. What cannot be written is dropped from then on, with a warning, and
    `close` says so.

    Args:
        path: The file.
        buffered: Whether bytes may be kept back; otherwise a killed process leaves all of them.

    Raises:
        OSError: The file cannot be opened.
    """

    def __init__(self, path: Path, *, buffered: bool = True) -> None:
        self._path = path
        self._stream = open(path, "wb", buffering=-1 if buffered else 0)  # noqa: SIM115 (closed by `close`)
        self._problem: OSError | None = None

    def write(self, data: bytes) -> None:
        """Adds bytes, unless that failed before."""
        if self._problem is None:
            try:
                self._stream.write(data)
            except OSError as problem:
                self._problem = problem
                logger.warning("The log %s ends here: %s.", self._path, problem)

    def close(self) -> None:
        """Finishes the file.

        Raises:
            pybullet.error: Not everything could be written.
        """
        try:
            self._stream.close()
        except OSError as problem:
            self._problem = self._problem or problem
        if self._problem is not None:
            fail("stopStateLogging failed.", f"{self._path} is incomplete: {self._problem}.")
