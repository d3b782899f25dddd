"""A table of what the kernels of a step, and of queries, are on a GPU: seconds to compile, registers, spills.

It needs no GPU, and says nothing of how fast they are on one.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from tools.gpu.compile import ARCHITECTURE, compile_modules
from tools.gpu.resources import find_assembler, resources_of

from carom.native.kernel_modules import CUDA_MODULES


def main() -> None:
    """Compile everything and print the table."""
    assembler = find_assembler()
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        compiled = compile_modules(CUDA_MODULES, Path(folder))
        elapsed = time.perf_counter() - start
        print(f"Compiled for sm_{ARCHITECTURE} in {elapsed:.0f} s.\n")
        print(f"{'module and kernel':44}{'PTX':>8}{'seconds':>9}{'registers':>11}{'stack':>8}{'spills':>14}")
        for module in compiled:
            size = f"{module.ptx.stat().st_size / 1000:.0f} kB"
            print(f"{module.module:44}{size:>8}{module.seconds:9.1f}")
            for kernel in resources_of(module.ptx, assembler) if assembler else []:
                spills = f"{kernel.spill_stores} / {kernel.spill_loads}"
                print(f"    {kernel.kernel:40}{'':17}{kernel.registers:11}{kernel.stack:8}{spills:>14}")
    if assembler is None:
        print("\nOf registers and spills only ptxas knows; the package nvidia-cuda-nvcc has it.")


if __name__ == "__main__":
    main()
