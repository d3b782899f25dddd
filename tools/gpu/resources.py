"""What kernels need of a GPU, as NVIDIA's assembler tells it: registers, stack and spills."""

from __future__ import annotations

import re
import shutil
import subprocess
import sysconfig
from dataclasses import dataclass
from pathlib import Path

from tools.gpu.compile import ARCHITECTURE

_SECTION = re.compile(r"Function properties for (\S+)\n\s+(.*)")
_FRAME = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
_KERNEL = re.compile(r"(\w+?)_[0-9a-f]+_cuda_kernel_forward")
_REGISTERS = re.compile(r"Used (\d+) registers")


@dataclass(frozen=True)
class Resources:
    """What a thread of a kernel needs.

    Attributes:
        kernel: Its name.
        registers: 32-bit registers; 255 are the most there can be.
        stack: Stack, the functions it calls included [bytes].
        spill_stores: What it and the functions it calls put aside for want of registers [bytes].
        spill_loads: What they read back [bytes].
    """

    kernel: str
    registers: int
    stack: int
    spill_stores: int
    spill_loads: int


def find_assembler() -> Path | None:
    """The assembler `ptxas`: of the package `nvidia-cuda-nvcc`, or of a CUDA toolkit on the path."""
    packages = Path(sysconfig.get_path("purelib")) / "nvidia"
    for file in sorted(packages.glob("*/bin/ptxas*")):
        return file
    found = shutil.which("ptxas")
    return Path(found) if found else None


def resources_of(ptx: Path, assembler: Path) -> list[Resources]:
    """What the kernels of a module need, by having them assembled.

    Raises:
        RuntimeError: The assembler does not take the module; the message has what it says.
    """
    done = subprocess.run(
        [assembler, "-v", f"-arch=sm_{ARCHITECTURE}", ptx, "-o", ptx.with_suffix(".cubin")],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"ptxas does not take {ptx}:\n{done.stdout}{done.stderr}")
    return parse_report(done.stdout + done.stderr)


def parse_report(report: str) -> list[Resources]:
    """What `ptxas -v` says of kernels; spills in functions they call count for each kernel before them."""
    kernels: list[Resources] = []
    for part in report.split("Compiling entry function")[1:]:
        frames = [
            (name, [int(number) for number in frame.groups()])
            for name, text in _SECTION.findall(part)
            if (frame := _FRAME.search(text))
        ]
        registers = _REGISTERS.search(part)
        name = _KERNEL.match(frames[0][0]) if frames else None
        if registers is None or name is None:
            raise RuntimeError(f"no kernel in what ptxas says:\n{part}")
        cumulative = re.search(r"(\d+) bytes cumulative stack size", part)
        kernels.append(
            Resources(
                name[1],
                int(registers[1]),
                int(cumulative[1]) if cumulative else 0,
                sum(frame[1] for _, frame in frames),
                sum(frame[2] for _, frame in frames),
            )
        )
    return kernels
