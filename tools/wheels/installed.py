"""`make installed`: the tests with the wheel, as somebody has it who installed it and nothing else.

The wheel goes into a new virtual environment; the tests run there as a user who may write to no folder but a
temporary one, without Warp and without a compiler, from a copy of the repository whose `src` is what is
installed.
"""

from __future__ import annotations

import argparse
import os
import pwd
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tools.wheels.build import build_wheel
from tools.wheels.environment import Environment
from tools.wheels.faults import Unfit

from carom.native.targets import this_target

_ROOT = Path(__file__).parents[2]
_OLDEST = Path(__file__).with_name("oldest.txt")
_MAX_INSTALLED_BYTES = 150_000_000
# What the tests need beside what the wheel brings. The rest of them is skipped.
_TEST_NEEDS = ("pytest", "pytest-xdist", "hypothesis", "scipy", "gymnasium")
# What tests read besides; `src` is what is installed.
_COPIED = (
    "tests",
    "examples",
    "docs",
    "tools",
    "benchmarks",
    "pyproject.toml",
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Makefile",
    "mkdocs.yml",
)
_NOBODY = "nobody"


def main() -> int:
    """Do what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", default=sys.executable, help="the Python of the environment")
    parser.add_argument("--wheel", type=Path, help="a wheel; if not given, it is built")
    parser.add_argument("--oldest", action="store_true", help="with the oldest versions of what it requires")
    parser.add_argument(
        "--with", dest="extra", action="append", default=[], help="a package to install besides"
    )
    parser.add_argument("tests", nargs="*", default=["tests"], help="what to give pytest")
    asked, options = parser.parse_known_args()
    with tempfile.TemporaryDirectory(prefix="carom-installed-") as name:
        folder = Path(name)
        folder.chmod(0o755)
        wheel = asked.wheel or build_wheel(this_target(), folder)
        environment = Environment(folder / "environment")
        command = [asked.python, "-m", "venv", "--without-pip", environment.folder]
        subprocess.run(command, check=True)
        pins = ["--constraint", str(_OLDEST)] if asked.oldest else []
        environment.install(str(wheel), *pins)
        report(wheel, environment)
        environment.install(*_TEST_NEEDS, *asked.extra, *pins)
        return run_tests(environment, folder, [*asked.tests, *options])


def report(wheel: Path, environment: Environment) -> None:
    """Say what was installed.

    Args:
        wheel: The wheel.
        environment: Where it is installed, and nothing else yet.

    Raises:
        Unfit: It is too much.
    """
    packages = environment.packages()
    size = sum(path.stat().st_size for path in packages.rglob("*") if path.is_file())
    names = sorted(path.name.removesuffix(".dist-info") for path in packages.glob("*.dist-info"))
    print(
        f"wheel {wheel.stat().st_size / 1e6:.1f} MB, installed {size / 1e6:.1f} MB: {', '.join(names)}",
        flush=True,
    )
    if size > _MAX_INSTALLED_BYTES:
        raise Unfit(f"{size} bytes are installed; at most {_MAX_INSTALLED_BYTES} are allowed")


def run_tests(environment: Environment, folder: Path, arguments: Sequence[str]) -> int:
    """Run tests as somebody who may write nowhere.

    Args:
        environment: Where the wheel and pytest are installed.
        folder: Where to put what is needed for it.
        arguments: What pytest is given.

    Returns:
        Pytest's exit status.

    Raises:
        Unfit: Something has been written to the home folder, or that user cannot run this Python.
    """
    clone, home, temporary = folder / "clone", folder / "home", folder / "temporary"
    copy_repository(clone, environment.packages())
    home.mkdir(mode=0o555)
    temporary.mkdir()
    unprivileged: dict[str, Any] = {}
    if os.getuid() == 0:
        nobody = pwd.getpwnam(_NOBODY)
        os.chown(temporary, nobody.pw_uid, nobody.pw_gid)
        unprivileged = {"user": nobody.pw_uid, "group": nobody.pw_gid, "extra_groups": []}
    _let_read(folder)
    kept = ("PATH", "LANG", "LC_ALL", "CI", "CAROM_CPU_LEVEL")
    variables = {name: os.environ[name] for name in kept if name in os.environ}
    variables |= {"HOME": str(home), "TMPDIR": str(temporary), "PYTHONDONTWRITEBYTECODE": "1"}
    process: dict[str, Any] = {"cwd": clone, "env": variables, "stdin": subprocess.DEVNULL, **unprivileged}
    try:
        subprocess.run([environment.python, "-c", ""], **process, check=True)
    except (OSError, subprocess.CalledProcessError):
        raise Unfit(f"{_NOBODY} cannot run this Python; name another: make PYTHON=/usr/bin/python3") from None
    command = [environment.python, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    done = subprocess.run(command, **process, check=False)
    written = list(home.iterdir())
    if written:
        raise Unfit(f"written to the home folder: {written}")
    return done.returncode


def copy_repository(clone: Path, packages: Path) -> None:
    """Copy what tests read of the repository.

    Args:
        clone: The folder for it; must not be there.
        packages: Where the wheel is installed; tests that start processes of their own find it as `src`.
    """
    clone.mkdir()
    for name in _COPIED:
        copy = shutil.copytree if (_ROOT / name).is_dir() else shutil.copyfile
        copy(_ROOT / name, clone / name)
    (clone / "src").symlink_to(packages)


def _let_read(folder: Path) -> None:
    """Let everybody read and enter, and nobody else write, as where root has installed something."""
    for path in folder.rglob("*"):
        if not path.is_symlink():
            mode = path.stat().st_mode
            path.chmod((mode | 0o444 | (0o111 if path.is_dir() or mode & 0o100 else 0)) & ~0o022)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Unfit as problem:
        sys.exit(str(problem))
