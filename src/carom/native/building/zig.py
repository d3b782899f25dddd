"""Running Zig, which compiles and links C and C++ for any platform on any other."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import util
from pathlib import Path

from carom.native.targets import Target


class BuildError(Exception):
    """The native library could not be built; the message says why and what to do."""


@dataclass(frozen=True)
class Zig:
    """An installed Zig.

    Attributes:
        program: The executable.
        library: Its `lib` folder.
        version: Its version.
        cache: The folder for its cache.
    """

    program: Path
    library: Path
    version: str
    cache: Path

    def command(
        self, language: str, target: Target, level: str, arguments: Sequence[str | Path]
    ) -> list[str]:
        """The command that compiles or links C or C++, the `language` being `cc` or `c++`."""
        processor = ["-target", target.triple, f"-mcpu={target.levels[level]}"]
        return [str(self.program), language, *processor, *map(str, arguments)]

    def environment(self) -> dict[str, str]:
        """Environment variables for running it."""
        cache = str(self.cache)
        return {**os.environ, "ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}


def find_zig(cache: Path) -> Zig:
    """The Zig that is installed as the Python package `ziglang`, with a folder for its cache.

    Raises:
        BuildError: It is not installed, or does not run.
    """
    package = util.find_spec("ziglang")
    folders = list(package.submodule_search_locations or ()) if package else []
    if not folders:
        raise BuildError(
            "the native library is compiled with Zig, which is not installed here: "
            f"run {sys.executable} -m pip install 'carom[build]'"
        )
    folder = Path(folders[0])
    program = folder / ("zig.exe" if os.name == "nt" else "zig")
    try:
        version = subprocess.run(
            [program, "version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as failure:
        raise BuildError(f"Zig, which compiles the native library, does not run here: {failure}") from None
    return Zig(program, folder / "lib", version, cache)
