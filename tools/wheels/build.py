"""`make wheels`: the wheels of all platforms and the source distribution, twice, and what is in them.

Everything is built on this machine, the second time with an empty cache; the bytes have to be the same.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from tools.wheels.structure import Library, read_library

from carom.native.targets import TARGETS, Target

_ROOT = Path(__file__).parents[2]
_MOST_BYTES = 15_000_000
# The only library that a native library may be loaded with, and what it may take from there.
_SYSTEM_LIBRARY = "/usr/lib/libSystem.B.dylib"
_SYSTEM_NAMES = {"memcpy", "memmove", "memset", "bzero", "__bzero", "dyld_stub_binder", "yld_stub_binder"}
# Made up by the linker for macOS.
_LINKER_NAMES = {"__dso_handle", "_mh_dylib_header"}
_FORMATS = {".so": "ELF", ".dylib": "Mach-O", ".dll": "PE"}


class Unfit(Exception):
    """A wheel is not to be published."""


def main() -> None:
    """Build what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--target", choices=TARGETS, action="append", help="only this platform")
    parser.add_argument("--output", type=Path, default=_ROOT / "dist")
    parser.add_argument("--once", action="store_true", help="do not build a second time")
    asked = parser.parse_args()
    asked.output.mkdir(parents=True, exist_ok=True)
    for name in asked.target or TARGETS:
        wheel = build_wheel(TARGETS[name], asked.output)
        check_wheel(wheel, TARGETS[name])
        if not asked.once:
            check_again(wheel, TARGETS[name])
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB, {_digest(wheel)}", flush=True)
    if not asked.target:
        _hatchling("sdist", asked.output, {})


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
    with tempfile.TemporaryDirectory(dir=output) as folder:
        _hatchling("wheel", Path(folder), environment)
        (wheel,) = Path(folder).glob("*.whl")
        return wheel.rename(output / wheel.name)


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
    if wheel.stat().st_size > _MOST_BYTES:
        raise Unfit(f"{wheel.name}: {wheel.stat().st_size} bytes; at most {_MOST_BYTES} are allowed")
    with zipfile.ZipFile(wheel) as archive, tempfile.TemporaryDirectory() as folder:
        for level in target.shipped:
            name = f"carom/native/libraries/{target.library_name(level)}"
            if name not in archive.namelist():
                raise Unfit(f"{wheel.name}: there is no {name}")
            path = Path(archive.extract(name, folder))
            for fault in faults(read_library(path), target, level):
                raise Unfit(f"{wheel.name}: {path.name}: {fault}")


def faults(library: Library, target: Target, level: str) -> list[str]:
    """What is wrong with a native library.

    Args:
        library: The library.
        target: The platform it is for.
        level: The CPU level it is for.

    Returns:
        Sentences; none if all is well.
    """
    name = target.library_name(level)
    macos = target.suffix == ".dylib"
    strangers = {
        one for one in library.exported if one != "carom_digest" and not one.startswith("carom_")
        and not one.endswith("_cpu_forward")
    } - _LINKER_NAMES  # fmt: skip
    checks = {
        f"it is {library.format}": library.format == _FORMATS[target.suffix],
        f"it is for {library.machine}": library.machine == target.triple.split("-")[0],
        f"it calls itself {library.name!r}": library.name == (f"@rpath/{name}" if macos else name),
        f"it needs {library.needed}": library.needed == ([_SYSTEM_LIBRARY] if macos else []),
        f"it takes {sorted(library.undefined)}": library.undefined <= (_SYSTEM_NAMES if macos else set()),
        f"it exports {sorted(strangers)}": not strangers,
        "it has no digest": "carom_digest" in library.exported,
        "it is not signed": library.signed or target.name != "arm64-macos",
        f"it needs macOS {library.oldest_system}": library.oldest_system == ((11, 0) if macos else (0, 0)),
        "it asks for an executable stack": not library.executable_stack,
    }
    return [fault for fault, well in checks.items() if not well]


def _hatchling(kind: str, output: Path, environment: dict[str, str]) -> None:
    command = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(output)]
    subprocess.run(command, cwd=_ROOT, env={**os.environ, **environment}, stdout=sys.stderr, check=True)


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


if __name__ == "__main__":
    try:
        main()
    except Unfit as problem:
        sys.exit(str(problem))
