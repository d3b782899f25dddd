"""`make aarch64`: the wheel for aarch64 under emulation, in Debian's Python of that architecture.

Nothing is installed: Debian's packages are unpacked into a folder, and `qemu-aarch64` runs the Python in it.
Needs Debian 12 with `qemu-user`, and once `dpkg --add-architecture arm64` and `apt-get update`.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tools.wheels.build import build_wheel
from tools.wheels.installed import copy_repository

from carom.native.targets import TARGETS

_ROOT = Path(__file__).parents[2]
_EMULATOR = "qemu-aarch64"
_PYTHON = "3.11"
_DEBIAN_PACKAGES = (
    *(
        f"libpython{_PYTHON}-minimal",
        f"libpython{_PYTHON}-stdlib",
        f"python{_PYTHON}-minimal",
        f"python{_PYTHON}",
    ),
    *("libbz2-1.0", "libc6", "libcrypt1", "libexpat1", "libffi8", "libgcc-s1", "liblzma5", "libsqlite3-0"),
    *("libssl3", "libstdc++6", "libuuid1", "zlib1g"),
)
_TEST_NEEDS = ("pytest", "hypothesis", "scipy", "gymnasium")
_PLATFORMS = ("manylinux2014_aarch64", *(f"manylinux_2_{minor}_aarch64" for minor in (17, 26, 27, 28)))
# What scripts take for the Python that runs them, and start again: a program that the machine can execute.
_EXECUTABLE = "EMULATED_PYTHON"
_SITE = f'import os, sys\n\nsys.executable = os.environ.get("{_EXECUTABLE}", sys.executable)\n'


def main() -> int:
    """Make what is missing, and run the tests that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--folder", type=Path, default=_ROOT / "build" / "aarch64", help="kept for the next time"
    )
    parser.add_argument("--wheel", type=Path, help="a wheel; if not given, it is built")
    parser.add_argument("tests", nargs="*", default=["tests/conformance", "tests/native"])
    asked, options = parser.parse_known_args()
    if not shutil.which(_EMULATOR):
        sys.exit(f"needs {_EMULATOR}: Debian's package qemu-user")
    folder = asked.folder.resolve()
    root = folder / "root"
    if not root.exists():
        folder.mkdir(parents=True, exist_ok=True)
        unpack_debian(folder, root)
        install(root, *_TEST_NEEDS)
    with tempfile.TemporaryDirectory() as temporary:
        install(root, str(asked.wheel or build_wheel(TARGETS["aarch64-linux"], Path(temporary))))
        clone = Path(temporary) / "clone"
        copy_repository(clone, _packages(root))
        command = [launcher(folder, root), "-m", "pytest", "-p", "no:cacheprovider", *asked.tests, *options]
        return subprocess.run(
            command, cwd=clone, env={**os.environ, "PYTHONPATH": ""}, check=False
        ).returncode


def unpack_debian(folder: Path, root: Path) -> None:
    """Unpack Debian's Python and what it needs.

    Args:
        folder: Where to put the packages.
        root: Where to unpack them; made when all are there.
    """
    packages, made = folder / "packages", folder / "unpacked"
    packages.mkdir(exist_ok=True)
    names = [f"{name}:arm64" for name in _DEBIAN_PACKAGES]
    subprocess.run(["apt-get", "--quiet=2", "download", *names], cwd=packages, check=True)
    for package in sorted(packages.glob("*.deb")):
        subprocess.run(["dpkg", "-x", package, made], check=True)
    # Debian's own imports what only installed systems have.
    site = made / "usr" / "lib" / f"python{_PYTHON}" / "sitecustomize.py"
    site.unlink(missing_ok=True)
    site.write_text(_SITE)
    made.rename(root)


def install(root: Path, *what: str) -> None:
    """Install Python packages, wheels only.

    Args:
        root: Where Debian's Python has been unpacked.
        *what: Packages and wheels.
    """
    platforms = [f"--platform={platform}" for platform in _PLATFORMS]
    kind = ("--only-binary=:all:", f"--python-version={_PYTHON}", "--implementation=cp")
    command = [sys.executable, "-m", "pip", "--quiet", "install", "--upgrade", f"--target={_packages(root)}"]
    subprocess.run([*command, *platforms, *kind, *what], check=True)


def _packages(root: Path) -> Path:
    return root / "usr" / "lib" / "python3" / "dist-packages"


def launcher(folder: Path, root: Path) -> Path:
    """A program of this machine that runs the Python in the emulator.

    Args:
        folder: Where to write it.
        root: Where Debian's Python has been unpacked.
    """
    script = folder / "python"
    run = f'exec {_EMULATOR} -L "{root}" "{root}/usr/bin/python{_PYTHON}" "$@"'
    script.write_text(f'#!/bin/sh\n{_EXECUTABLE}="{script}" {run}\n')
    script.chmod(0o755)
    return script


if __name__ == "__main__":
    sys.exit(main())
