"""Run a Python program here while another program has the native library.

`make wine` does it with Wine and the libraries for Windows. Everything but the kernels, and what calls them
in turn, is the Python of this machine:
`python -m tools.wheels.elsewhere.run --level v3 pytest tests/conformance`.
"""

from __future__ import annotations

import argparse
import runpy
import shlex
import subprocess
import sys
from pathlib import Path

from tools.wheels.elsewhere.library import Elsewhere, use

from carom.native.building.cache import cache_folder, work_folder
from carom.native.building.library import build
from carom.native.building.zig import find_zig
from carom.native.digest import source_digest
from carom.native.targets import TARGETS, Target

_SOURCE = Path(__file__).with_name("calls.c")
_ROOT = Path(__file__).parents[3] / "src"


def compile_calls(target: Target, output: Path) -> Path:
    """Compile `calls.c` for a platform.

    Args:
        target: The platform.
        output: A folder for it.

    Returns:
        The program.
    """
    zig = find_zig(cache_folder() / "zig")
    program = output / ("calls.exe" if target.suffix == ".dll" else "calls")
    oldest = next(iter(target.levels))
    command = zig.command("cc", target, oldest, ["-O2", "-o", program, _SOURCE])
    subprocess.run(command, env=zig.environment(), check=True)
    return program


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--target", choices=TARGETS, default="x86_64-windows")
    parser.add_argument("--level", required=True, help="CPU level of the library")
    parser.add_argument(
        "--with", dest="starter", default="wine", help="what programs of the target start with"
    )
    parser.add_argument("module", help="the Python module to run, as with `python -m`")
    parser.add_argument("arguments", nargs=argparse.REMAINDER)
    asked = parser.parse_args()
    target = TARGETS[asked.target]
    path = build(_ROOT, target, asked.level)
    with work_folder(cache_folder()) as folder:
        program = compile_calls(target, folder)
        library = Elsewhere([*shlex.split(asked.starter), str(program)], path, source_digest(_ROOT))
        try:
            use(library)
            sys.argv = [asked.module, *asked.arguments]
            runpy.run_module(asked.module, run_name="__main__", alter_sys=True)
        finally:
            library.close()
            print(f"{library.calls} calls of {path.name}", file=sys.stderr)


if __name__ == "__main__":
    main()
