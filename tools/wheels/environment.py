"""A virtual environment of its own for a wheel."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Environment:
    """A virtual environment with the wheel.

    Attributes:
        folder: The environment.
    """

    folder: Path

    @property
    def python(self) -> Path:
        """Its Python."""
        return self.folder / "bin" / "python"

    def install(self, *what: str) -> None:
        """Install packages."""
        quiet = ("--quiet", "--disable-pip-version-check")
        command = [sys.executable, "-m", "pip", "--python", str(self.python), *quiet, "install", *what]
        subprocess.run(command, check=True)

    def packages(self) -> Path:
        """Where packages are installed."""
        command = [self.python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
        return Path(subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip())
