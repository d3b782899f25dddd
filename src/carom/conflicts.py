"""PyBullet in the same environment as Carom: both distributions have files of the same names.

Installed after Carom, PyBullet overwrites them; uninstalled, it removes them. Carom calls `check` when it is
imported.
"""

from __future__ import annotations

import os
import sys
from importlib.machinery import EXTENSION_SUFFIXES, PathFinder

# The packages that both have. Those of Carom name it at the beginning of `__init__.py`.
SHARED = ("pybullet_data", "pybullet_envs", "pybullet_examples", "pybullet_robots", "pybullet_utils")
_MARK = b"Carom"
_BEGINNING = 512


def check() -> None:
    """Find out whether PyBullet has overwritten or removed files of Carom, or will.

    If all is well it reads the beginnings of five files and asks whether some others exist: 0.1 ms.

    Raises:
        ImportError: Packages of Carom are not complete, or are PyBullet's.

    Warns:
        RuntimeWarning: Carom's packages are complete, but PyBullet is installed in the same folder, or found
            first by `import pybullet`.
    """
    # In archives, compiled programs and the like there are no source files to look at.
    if getattr(sys, "frozen", False) or not (__file__.endswith(".py") and os.path.isfile(__file__)):
        return
    folder = os.path.dirname(os.path.dirname(__file__))
    states = {package: _state(f"{folder}/{package}") for package in SHARED}
    missing = [package for package in SHARED if states[package] == "missing"]
    foreign = [package for package in SHARED if states[package] == "foreign"]
    if missing or foreign:
        found = [f"files are missing in {', '.join(missing)}"] if missing else []
        found += [f"PyBullet has overwritten {', '.join(foreign)}"] if foreign else []
        raise ImportError(
            f"Carom in {folder} is not complete, because PyBullet has been installed or uninstalled there:"
            f" {'; '.join(found)}.\n{cure()}"
        )
    for suffix in EXTENSION_SUFFIXES:
        if os.path.exists(f"{folder}/pybullet{suffix}"):
            _warn(
                f"PyBullet and Carom are both installed in {folder}. `import pybullet` finds Carom;"
                " uninstalling PyBullet removes files that Carom needs."
            )
            return
    if (extension := _extension_module()) is not None:
        _warn(f"`import pybullet` finds PyBullet, {extension}, and not Carom, which is in {folder}.")


def cure() -> str:
    """The commands that remove PyBullet and make Carom complete, and what they are for."""
    return (
        "To have Carom in place of PyBullet:\n"
        "    pip uninstall -y pybullet\n"
        f"    pip install --force-reinstall --no-deps {_requirement()}\n"
        "If packages require PyBullet, then also: python -m carom stand-in"
    )


def _state(package: str) -> str:
    """Whether the package in a folder is `ours`, `missing` or `foreign`; `ours` if that cannot be seen."""
    try:
        # A third of the time that `open` takes.
        file = os.open(f"{package}/__init__.py", os.O_RDONLY)
        try:
            return "ours" if _MARK in os.read(file, _BEGINNING) else "foreign"
        finally:
            os.close(file)
    except FileNotFoundError:
        # A package that is not there at all has been left out on purpose: pip leaves a folder behind.
        return "missing" if os.path.isdir(package) else "ours"
    except OSError:
        return "ours"


def _extension_module() -> str | None:
    """The file of PyBullet's extension module, if `import pybullet` has loaded it or would do so."""
    if (module := sys.modules.get("pybullet")) is not None:
        file = getattr(module, "__file__", None)
    else:
        spec = PathFinder.find_spec("pybullet")
        file = None if spec is None else spec.origin
    return file if isinstance(file, str) and file.endswith(tuple(EXTENSION_SUFFIXES)) else None


def _warn(message: str) -> None:
    from warnings import warn_explicit

    # The line that imports Carom, or a package of the drop-in.
    site = os.path.dirname(os.path.dirname(__file__))
    ours = ("<frozen importlib", os.path.join(site, "carom"), os.path.join(site, "pybullet"))
    frame = sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(ours):
        frame = frame.f_back
    warn_explicit(f"{message}\n{cure()}", RuntimeWarning, frame.f_code.co_filename, frame.f_lineno)


def _requirement() -> str:
    """What pip installs this Carom again from: its name, or the file or folder that it came from."""
    from importlib.metadata import PackageNotFoundError, distribution
    from json import loads

    try:
        record = distribution("carom").read_text("direct_url.json")
    except PackageNotFoundError:
        record = None
    source = loads(record) if record else {}
    if not source.get("url", "").startswith("file:"):
        return "carom"
    return f"--editable {source['url']}" if source.get("dir_info", {}).get("editable") else source["url"]
