"""An empty distribution named `pybullet`, for packages that require PyBullet: `python -m carom stand-in`.

A distribution meets only requirements of its own name, so an extra of Carom could not do this; and on public
indexes the name belongs to PyBullet. So Carom writes the wheel where it is needed.
"""

from __future__ import annotations

import base64
import hashlib
import shutil
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from tempfile import mkdtemp
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from carom.conflicts import cure
from carom.errors import CaromError
from carom.writing import write_whole

# The PyBullet whose interface Carom has. `pybullet==3.2.7` allows for any local version.
VERSION = "3.2.7+carom"
_NAME = f"pybullet-{VERSION}-py3-none-any.whl"
_METADATA = f"""Metadata-Version: 2.1
Name: pybullet
Version: {VERSION}
Summary: Stands in for PyBullet: an empty distribution that requires Carom, which has the modules.
Requires-Dist: carom
"""
_WHEEL = """Wheel-Version: 1.0
Generator: carom
Root-Is-Purelib: true
Tag: py3-none-any
"""


def write(folder: Path) -> Path:
    """Write the wheel of the stand-in; the same bytes at every call.

    Args:
        folder: The folder to write it to; created if it does not exist.

    Returns:
        The wheel's path.
    """
    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / _NAME
    metadata = f"pybullet-{VERSION}.dist-info"
    record = f"{metadata}/RECORD"
    files = {f"{metadata}/METADATA": _METADATA, f"{metadata}/WHEEL": _WHEEL}
    lines = [f"{name},{_digest(text)},{len(text)}" for name, text in files.items()]
    files[record] = "".join(f"{line}\n" for line in [*lines, f"{record},,"])
    content = BytesIO()
    with ZipFile(content, "w") as archive:
        for name, text in files.items():
            entry = ZipInfo(name)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text, ZIP_DEFLATED)
    write_whole(wheel, content.getvalue())
    return wheel


def install() -> None:
    """Install the stand-in for the running Python, with pip or uv.

    Raises:
        CaromError: PyBullet itself is installed, there is neither pip nor uv, or they have failed.
    """
    if (present := _pybullet()) is not None:
        raise CaromError(f"PyBullet {present} is installed.\n{cure()}")
    folder = Path(mkdtemp(prefix="carom-"))
    wheel = write(folder)
    installer = _installer()
    if installer is None:
        raise CaromError(
            f"This Python has no pip, and there is no uv. Install {wheel} with what installs packages for it."
        )
    command = [*installer, "--quiet", "--no-deps", "--no-index", str(wheel)]
    if subprocess.run(command, check=False).returncode != 0:
        raise CaromError(f"The stand-in has not been installed. The command was: {' '.join(command)}")
    shutil.rmtree(folder)


def _pybullet() -> str | None:
    """The version of PyBullet itself, if it is installed."""
    try:
        present = version("pybullet")
    except PackageNotFoundError:
        return None
    return None if present == VERSION else present


def _installer() -> list[str] | None:
    """The beginning of a command that installs for the running Python."""
    if find_spec("pip") is not None:
        return [sys.executable, "-m", "pip", "install"]
    if (uv := shutil.which("uv")) is not None:
        return [uv, "pip", "install", "--python", sys.executable]
    return None


def _digest(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return "sha256=" + base64.urlsafe_b64encode(digest).rstrip(b"=").decode()
