"""Folders with Carom and what PyBullet leaves beside it, and scripts that import from there."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import carom
from carom.conflicts import SHARED

SOURCE = Path(carom.__file__).parents[1]
EXTENSION_MODULE = f"pybullet{EXTENSION_SUFFIXES[0]}"
# What PyBullet's own packages begin with: nothing of Carom.
FOREIGN = "import os\ndef getDataPath():\n  return os.path.dirname(__file__)\n"


def carom_in(folder: Path) -> Path:
    """Carom's packages in a folder that is as `site-packages`."""
    folder.mkdir()
    for package in ("carom", "pybullet", *SHARED):
        (folder / package).symlink_to(SOURCE / package, target_is_directory=True)
    return folder


def replace(site: Path, package: str, content: str | None) -> None:
    """Let a package have other content, or, without content, lack its `__init__.py`."""
    (site / package).unlink()
    (site / package).mkdir()
    (site / package / "py.typed").touch()
    if content is not None:
        (site / package / "__init__.py").write_text(content, encoding="utf-8")


def run(statement: str, *path: Path) -> subprocess.CompletedProcess[str]:
    """Run a statement that can import from these folders and the standard library only."""
    return subprocess.run(
        [sys.executable, "-S", "-c", statement],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path))},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
