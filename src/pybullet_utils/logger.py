"""Tables of the values that a learning script measures in each iteration."""

from __future__ import annotations

import atexit
import time
from pathlib import Path
from typing import Any, TextIO

from pybullet_utils import mpi_util

_COLUMN = 25
_RULE = "-" * 37


class Logger:
    """A table with a row for each iteration, printed and written to a file by the root process of MPI only.

    The first row determines the columns.
    """

    @staticmethod
    def print2(str: object) -> None:
        """Prints a text in the root process only."""
        if mpi_util.is_root_proc():
            print(str)

    def __init__(self) -> None:
        self.output_file: TextIO | None = None
        self.first_row = True
        self.log_headers: list[str] = []
        self.log_current_row: dict[str, Any] = {}

    def reset(self) -> None:
        """Clears the table and, if there is one, the file."""
        self._forget_rows()
        if self.output_file is not None:
            self.configure_output_file(self.output_file.name)

    def configure_output_file(self, filename: str | None = None) -> None:
        """Creates the file, by default `output/log_<seconds>.txt`, and its folder if needed."""
        self._forget_rows()
        if not mpi_util.is_root_proc():
            return
        if self.output_file is not None:
            self.output_file.close()
        path = Path(filename or f"output/log_{int(time.time())}.txt")
        path.parent.mkdir(parents=True, exist_ok=True)
        self.output_file = path.open("w", encoding="utf-8")
        atexit.register(self.output_file.close)
        self.print2(f"Logging data to {self.output_file.name}")

    def log_tabular(self, key: str, val: Any) -> None:
        """Sets a value of the present row.

        Raises:
            AssertionError: The first row, which is complete, has no such column.
        """
        if key not in self.log_headers:
            assert self.first_row, f"{key} is a new column; the first row had none of this name"
            self.log_headers.append(key)
        self.log_current_row[key] = val

    def get_num_keys(self) -> int:
        """The number of columns."""
        return len(self.log_headers)

    def print_tabular(self) -> None:
        """Prints the present row, a line for each column."""
        self.print2(_RULE)
        for key in self.log_headers:
            self.print2(f"| {key:>15} | {_shown(self.log_current_row.get(key, '')):>15} |")
        self.print2(_RULE)

    def dump_tabular(self) -> None:
        """Writes the present row, before the first one also the column names, and starts the next row."""
        if self.output_file is not None:
            if self.first_row:
                self.output_file.write(_line(self.log_headers))
            self.output_file.write(_line([self.log_current_row.get(key, "") for key in self.log_headers]))
            self.output_file.flush()
        self.log_current_row.clear()
        self.first_row = False

    def _forget_rows(self) -> None:
        self.first_row = True
        self.log_headers = []
        self.log_current_row = {}


def _line(values: list[Any]) -> str:
    return "".join(f"{value!s:<{_COLUMN}}" for value in values) + "\n"


def _shown(value: Any) -> str:
    return f"{value:8.3g}" if isinstance(value, float) else str(value)
