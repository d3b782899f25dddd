"""`make wheels`: the wheels of all platforms and the source distribution, and whether they can be published.

Everything is built on this machine, wheels a second time with an empty cache; the bytes have to be the same.
Then `twine check`, and from an index in a folder pip chooses for all platforms and installs for this one.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path

from tools.wheels.faults import Unfit, faults
from tools.wheels.index import check_downloads, check_installation, make_index
from tools.wheels.structure import read_library

from carom.native.targets import TARGETS, Target

_ROOT = Path(__file__).parents[2]
_MAX_BYTES = 15_000_000


def main() -> None:
    """Build what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--target", choices=TARGETS, action="append", help="only this platform")
    parser.add_argument("--output", type=Path, default=_ROOT / "dist")
    parser.add_argument("--once", action="store_true", help="do not build a second time")
    parser.add_argument(
        "--python",
        action="append",
        help="a Python to install for, more than once for several; if not given, this",
    )
    asked = parser.parse_args()
    asked.output.mkdir(parents=True, exist_ok=True)
    made: list[Path] = []
    for name in asked.target or TARGETS:
        wheel = build_wheel(TARGETS[name], asked.output)
        check_wheel(wheel, TARGETS[name])
        if not asked.once:
            check_again(wheel, TARGETS[name])
        made.append(wheel)
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB, {_digest(wheel)}", flush=True)
    if not asked.target:
        made.append(_build("sdist", asked.output, {}))
        check_publishing(made, asked.python or [sys.executable])


def check_publishing(made: Sequence[Path], pythons: Sequence[str]) -> None:
    """Do what an index and those who install from it will do.

    Args:
        made: All wheels and the source distribution.
        pythons: The Pythons to install for.

    Raises:
        Unfit: It does not work.
    """
    if subprocess.run([sys.executable, "-m", "twine", "check", "--strict", *made], check=False).returncode:
        raise Unfit("an index would refuse them")
    with tempfile.TemporaryDirectory(prefix="carom-index-") as folder:
        simple = make_index(made, Path(folder))
        print(
            f"pip finds the wheels of {check_downloads(simple)} platforms and versions of Python", flush=True
        )
        for python in pythons:
            print(check_installation(simple, python), flush=True)


def build_wheel(target: Target, output: Path, cache: Path | None = None) -> Path:
    """Build the wheel of a platform.

    Args:
        target: The platform.
        output: The folder for it.
        cache: Where compiled code is kept; None for the usual place.

    Returns:
        The wheel.
    """
    environment = {"CAROM_BUILD_TARGET": target.name}
    if cache:
        environment["CAROM_CACHE_PATH"] = str(cache)
    return _build("wheel", output, environment)


def check_again(wheel: Path, target: Target) -> None:
    """Build a wheel with an empty cache and compare.

    Args:
        wheel: The wheel.
        target: Its platform.

    Raises:
        Unfit: The bytes differ.
    """
    with tempfile.TemporaryDirectory() as folder:
        again = build_wheel(target, Path(folder), Path(folder) / "cache")
        if again.read_bytes() != wheel.read_bytes():
            with zipfile.ZipFile(wheel) as first, zipfile.ZipFile(again) as second:
                differing = [name for name in first.namelist() if first.read(name) != second.read(name)]
            raise Unfit(f"{wheel.name}: built again, it differs in {', '.join(differing) or 'its outside'}")


def check_wheel(wheel: Path, target: Target) -> None:
    """Look at what is in a wheel.

    Args:
        wheel: The wheel.
        target: Its platform.

    Raises:
        Unfit: It is too large, or something is missing, or a library is not as it should be.
    """
    if wheel.stat().st_size > _MAX_BYTES:
        raise Unfit(f"{wheel.name}: {wheel.stat().st_size} bytes; at most {_MAX_BYTES} are allowed")
    with zipfile.ZipFile(wheel) as archive, tempfile.TemporaryDirectory() as folder:
        for level in target.shipped:
            name = f"carom/native/libraries/{target.library_name(level)}"
            if name not in archive.namelist():
                raise Unfit(f"{wheel.name}: there is no {name}")
            path = Path(archive.extract(name, folder))
            for fault in faults(read_library(path), target, level):
                raise Unfit(f"{wheel.name}: {path.name}: {fault}")


def _build(kind: str, output: Path, environment: dict[str, str]) -> Path:
    """Build a `wheel` or an `sdist` in a folder; the file."""
    with tempfile.TemporaryDirectory(dir=output) as folder:
        command = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", folder]
        subprocess.run(command, cwd=_ROOT, env={**os.environ, **environment}, stdout=sys.stderr, check=True)
        (made,) = Path(folder).iterdir()
        return made.rename(output / made.name)


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


if __name__ == "__main__":
    try:
        main()
    except Unfit as problem:
        sys.exit(str(problem))
