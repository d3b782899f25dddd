"""Compiler flags.

The same sources have to give the same bits on every platform and CPU level. So no flag lets a compiler round
differently: products and sums are not fused or reordered, and code is not tuned to the machine that builds.
Maths functions have names that the compiler does not know; otherwise it would evaluate some calls by the libm
of that machine.
"""

from __future__ import annotations

# Functions of a libm that are not processor instructions. They get names of our own; see `libm`.
MATHS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "pow", "fmod", "cbrt", "hypot")
PREFIX = "carom_"

_RENAMED = tuple(f"-D{name}={PREFIX}{name}" for name in MATHS)
_ALL = (
    "-O2",
    "-g0",
    "-w",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fvisibility=hidden",
    "-ffunction-sections",
    "-fdata-sections",
    "-fno-stack-protector",
    "-fno-sanitize=all",
    *_RENAMED,
)
# For kernels and hand-written C++: the only standard header is `<stdint.h>`. Loops that clear a few numbers
# stay loops, which take less time than a call of `memset`.
CPP_FLAGS = ("-std=c++17", "-fno-builtin-memset", "-fno-exceptions", "-fno-rtti", "-nostdlibinc", *_ALL)
# For hand-written C++ only: kernels are generated. Functions in tables have the same parameters; few use all.
OWN_FLAGS = (
    *(flag for flag in CPP_FLAGS if flag != "-w"),
    *("-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter"),
)
# For the libm, which would otherwise use fused products on processors that have them.
C_FLAGS = ("-std=c99", "-nostdlibinc", "-ffreestanding", "-U__FP_FAST_FMA", *_ALL)
# Loops in these modules of kernels go over few rows or contacts, or over numbers that are lanes already.
# Vectorised they would only be longer code, and it does not fit the processor's nearest cache as it is.
_SHORT_LOOPS = ("carom.kernels.solver.", "carom.kernels.contact.", "carom.kernels.dynamics.lane_")
# By suffix of the library. Windows unwinds stacks by tables, and Warp's headers use Microsoft's keywords.
PLATFORM_FLAGS = {
    ".so": ("-fPIC", "-fno-asynchronous-unwind-tables"),
    ".dylib": ("-fPIC", "-fno-asynchronous-unwind-tables"),
    ".dll": ("-fms-extensions",),
}


def flags_of_module(name: str) -> tuple[str, ...]:
    """Flags for one module of kernels besides those for all."""
    return ("-fno-vectorize",) if name.startswith(_SHORT_LOOPS) else ()
