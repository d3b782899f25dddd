"""Compiler flags.

The same sources have to give the same bits on every platform and CPU level. So nothing here lets a compiler
round differently: no contraction of products and sums, no reordering, no processor of the machine that
builds. And it must not know what sines are, or it would work out some of them by the libm of that machine.
"""

from __future__ import annotations

# Functions that a libm has and processors do not. They are called by names of our own; see `libm`.
MATHS = (
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "log",
    "pow",
    "fmod",
    "cbrt",
    "hypot",
)
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
# For kernels and hand-written C++: `<stdint.h>` is there, and no other header.
CPP_FLAGS = (
    "-std=c++17",
    "-fno-exceptions",
    "-fno-rtti",
    "-nostdlibinc",
    *_ALL,
)
# For the libm. Where there are fused products, it would use them.
C_FLAGS = ("-std=c99", "-nostdlibinc", "-ffreestanding", "-U__FP_FAST_FMA", *_ALL)
# By how names of libraries end. Windows unwinds stacks by tables, and Warp's headers expect words of
# Microsoft's.
PLATFORM_FLAGS = {
    ".so": ("-fPIC", "-fno-asynchronous-unwind-tables"),
    ".dylib": ("-fPIC", "-fno-asynchronous-unwind-tables"),
    ".dll": ("-fms-extensions",),
}
