"""`make from-nothing`: install Carom as somebody does who has nothing yet, in each of the ways there are.

    python tools/packaging/from_nothing.py [WAY...] [--python PYTHON] [--revision REVISION] [--compiled KEEP]

For each way: what is committed (and, without `--revision`, what has changed since) is unpacked into a folder
of its own, without `.git`. Home and caches are empty, and no variable of ours or of a virtual environment is
set, but for `CAROM_CACHE_PATH` where what is compiled is to be kept: an empty folder, too. Then a script
makes a step, a contact and an image with another empty home, where nothing may be written.

Needs Python 3.10, git and a package index, and nothing that is installed.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

_ROOT = Path(__file__).parents[2]
_FIRST_STEPS = Path(__file__).with_name("first_steps.py")
# The first pip that installs a `pyproject.toml` as editable.
_OLDEST_PIP = "pip==21.3.1"
# Variables that lead to what is installed or cached here.
_LEADING = (
    "CAROM_",
    "PYTHON",
    "XDG_",
    "WARP_",
    "ZIG_",
    "VIRTUAL_ENV",
    "CONDA",
    "UV_",
    "PIP_CACHE",
    "MAKE",
    "MFLAGS",
)


class Failed(Exception):
    """A command failed; what it printed is in the message."""


class Nothing:
    """A folder with the sources, an empty home, and a virtual environment with pip alone."""

    def __init__(self, folder: Path, python: str, revision: str, compiled: Path | None = None) -> None:
        self.folder = folder
        self.source = folder / "source"
        self._environment = _variables(folder / "home")
        if compiled:
            self._environment["CAROM_CACHE_PATH"] = str(compiled)
        self.source.mkdir()
        archive = folder / "source.tar"
        _run(["git", "-C", _ROOT, "archive", "--output", archive, revision], folder, dict(os.environ))
        shutil.unpack_archive(archive, self.source)
        self.python = self.virtual_environment("venv", python)

    def virtual_environment(self, name: str, python: str) -> Path:
        """A new virtual environment beside the sources; its Python."""
        self.run(python, "-m", "venv", self.folder / name)
        return self.folder / name / ("Scripts" if os.name == "nt" else "bin") / "python"

    def pip(self, *arguments: str | Path) -> str:
        """Run pip in the folder of the sources; what it printed."""
        return self.run(self.python, "-m", "pip", *arguments)

    def tool(self, *requirements: str) -> Path:
        """A Python with tools that must not be where Carom is installed."""
        python = self.virtual_environment("tools", str(self.python))
        self.run(python, "-m", "pip", "install", *requirements)
        return python

    def run(self, *command: str | Path) -> str:
        """Run a command in the folder of the sources; what it printed."""
        return _run(command, self.source, self._environment)

    def first_steps(self) -> str:
        """Simulate, from an empty folder and with another empty home."""
        empty = self.folder / "empty"
        home = empty / "home"
        home.mkdir(parents=True)
        said = _run([self.python, "-I", _FIRST_STEPS], empty, _variables(home))
        written = sorted(str(path.relative_to(empty)) for path in home.rglob("*"))
        if written:
            raise Failed(f"the first steps have written {', '.join(written)}")
        return said.strip()


def _from_clone(here: Nothing) -> None:
    here.pip("install", ".")


def _editable(here: Nothing) -> None:
    here.pip("install", "--editable", ".")


def _source_distribution(here: Nothing) -> None:
    here.run(here.tool("build"), "-m", "build", "--sdist", "--outdir", "made", ".")
    (archive,) = (here.source / "made").glob("*.tar.gz")
    here.pip("install", archive)


def _wheel(here: Nothing) -> None:
    here.run(here.tool("build"), "-m", "build", "--wheel", "--outdir", "made", ".")
    (wheel,) = (here.source / "made").glob("*.whl")
    here.pip("install", "--only-binary=:all:", wheel)


def _by_uv(here: Nothing) -> None:
    here.run(here.tool("uv"), "-m", "uv", "pip", "install", "--python", here.python, ".")


def _by_oldest_pip(here: Nothing) -> None:
    here.pip("install", _OLDEST_PIP)
    here.pip("install", ".")


def _by_newest_pip(here: Nothing) -> None:
    here.pip("install", "--upgrade", "pip")
    said = here.pip("install", "--verbose", ".")
    prepared, _, built = said.partition("Building wheel for carom")
    if (
        "compiling" in prepared
        or "takes about" not in built
        or "compiled the physics kernels in" not in built
    ):
        raise Failed(f"pip did not say that it compiles while it builds the wheel, and how long:\n{said}")


WAYS: dict[str, Callable[[Nothing], None]] = {
    "clone": _from_clone,
    "editable": _editable,
    "sdist": _source_distribution,
    "wheel": _wheel,
    "uv": _by_uv,
    "oldest-pip": _by_oldest_pip,
    "newest-pip": _by_newest_pip,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Install in the ways that the command line names; the number of those that failed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("ways", nargs="*", metavar="WAY", help=f"of {', '.join(WAYS)}; if not given, all")
    parser.add_argument("--python", default=sys.executable, help="the Python to install for")
    parser.add_argument("--revision", help="what to install; if not given, what is here")
    parser.add_argument("--compiled", type=Path, help="keep what is compiled in this folder, for one way")
    asked = parser.parse_args(arguments)
    if asked.compiled and (
        len(asked.ways) != 1 or (asked.compiled.exists() and any(asked.compiled.iterdir()))
    ):
        parser.error("--compiled needs one way and a folder that is empty: nothing must be compiled before")
    if unknown := set(asked.ways) - set(WAYS):
        parser.error(f"there is no way {', '.join(sorted(unknown))}; expected {', '.join(WAYS)}")
    revision = asked.revision or _what_is_here()
    failures = 0
    for way in asked.ways or WAYS:
        began = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="carom-from-nothing-") as folder:
            try:
                here = Nothing(Path(folder), asked.python, revision, asked.compiled)
                WAYS[way](here)
                installed = time.monotonic() - began
                print(f"{way}: installed in {installed:.0f} s; {here.first_steps()}", flush=True)
            except Failed as problem:
                print(f"{way}: FAILED after {time.monotonic() - began:.0f} s: {problem}", flush=True)
                failures += 1
    return failures


def _what_is_here() -> str:
    """A revision with the last commit and what has changed since in files that git knows."""
    author = ["-c", "user.name=nobody", "-c", "user.email=nobody@localhost"]
    return _run(["git", *author, "stash", "create"], _ROOT, dict(os.environ)).strip() or "HEAD"


def _variables(home: Path) -> dict[str, str]:
    """Variables of somebody whose home is empty; how to reach the package index is kept."""
    home.mkdir(parents=True, exist_ok=True)
    kept = {name: value for name, value in os.environ.items() if not name.startswith(_LEADING)}
    return kept | {"HOME": str(home), "USERPROFILE": str(home), "LOCALAPPDATA": str(home)}


def _run(command: Sequence[str | Path], folder: Path, environment: dict[str, str]) -> str:
    """Run a command; what it printed.

    Raises:
        Failed: It returned another status than 0.
    """
    done = subprocess.run(
        command,
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode:
        raise Failed(f"{' '.join(map(str, command))} returned {done.returncode}:\n{done.stdout}")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
