"""Compiling kernel modules for a GPU, on a machine that needs none.

Run with the name of a module and a folder it writes the module's PTX there, and prints where that is and how
much time of a core it took.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

ARCHITECTURE = 90
"""Compute capability of H100 and H200, times ten."""


@dataclass(frozen=True)
class Compiled:
    """A module that has been compiled.

    Attributes:
        module: Its name.
        ptx: File with the result.
        seconds: Time of one core that took.
    """

    module: str
    ptx: Path
    seconds: float


class CompilationError(RuntimeError):
    """A module cannot be compiled for a GPU; the message has what the compiler says."""


def compile_modules(modules: Sequence[str], folder: Path) -> list[Compiled]:
    """Compile modules to PTX, each in a process of its own, as many at a time as there are cores.

    Raises:
        CompilationError: One of them cannot be compiled.
    """
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        return list(pool.map(lambda module: _compile_elsewhere(module, folder), modules))


def _compile_elsewhere(module: str, folder: Path) -> Compiled:
    done = subprocess.run(
        [sys.executable, "-m", "tools.gpu.compile", module, str(folder / module)],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise CompilationError(f"{module} does not compile for sm_{ARCHITECTURE}:\n{done.stderr}")
    result = json.loads(done.stdout.splitlines()[-1])
    return Compiled(module, Path(result["ptx"]), result["seconds"])


def compile_here(module: str, folder: Path) -> Compiled:
    """Compile a module to PTX, in this process."""
    import warp as wp

    import_module(module)
    start = time.process_time()
    (written,) = wp.compile_aot_module(
        wp.get_module(module), device=None, arch=ARCHITECTURE, module_dir=folder, use_ptx=True
    )
    seconds = time.process_time() - start
    # Warp ends the text as C does, which the assembler does not like.
    ptx = folder / "module.ptx"
    ptx.write_bytes(Path(written).read_bytes().rstrip(b"\0"))
    return Compiled(module, ptx, seconds)


if __name__ == "__main__":
    one = compile_here(sys.argv[1], Path(sys.argv[2]))
    print(json.dumps({"ptx": str(one.ptx), "seconds": one.seconds}))
