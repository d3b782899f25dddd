"""Maths functions of our own, with the same bits on every platform.

They are musl's, whose sources come with Zig, except for the outermost layer of sine, cosine and tangent. They
are compiled with the flags of the kernels and linked into the library under names of our own; only functions
that are called are included.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from carom.native.building.flags import MATHS, PREFIX

_ERRORS = ("__math_divzero.c", "__math_invalid.c", "__math_oflow.c", "__math_uflow.c", "__math_xflow.c")
_EXP = ("exp.c", "exp_data.c", *_ERRORS)
_OWN = "circular.c"
_CIRCULAR = (_OWN, "__sin.c", "__cos.c", "__tan.c", "__rem_pio2.c", "__rem_pio2_large.c", "scalbn.c")
# Sources of each function.
_SOURCES = {
    "sin": _CIRCULAR,
    "cos": _CIRCULAR,
    "tan": _CIRCULAR,
    "asin": ("asin.c",),
    "acos": ("acos.c",),
    "atan": ("atan.c",),
    "atan2": ("atan2.c", "atan.c"),
    "exp": _EXP,
    "log": ("log.c", "log_data.c", *_ERRORS),
    "pow": ("pow.c", "pow_data.c", "exp_data.c", *_ERRORS),
    "fmod": ("fmod.c",),
    "cbrt": ("cbrt.c",),
    "hypot": ("hypot.c",),
}
_HERE = Path(__file__).parent / "libm"


def called_functions(objects: Iterable[Path]) -> set[str]:
    """The maths functions that object files refer to.

    Objects of any format contain the names of symbols, each followed by a zero byte.
    """
    contents = [path.read_bytes() for path in objects]
    return {name for name in MATHS if any(f"{PREFIX}{name}\0".encode() in content for content in contents)}


def maths_sources(functions: Iterable[str], zig_library: Path) -> list[Path]:
    """The C sources of maths functions, each once and sorted by name, in the `lib` folder of Zig."""
    musl = zig_library / "libc" / "musl" / "src" / "math"
    names = {source for function in functions for source in _SOURCES[function]}
    return [_HERE / name if name == _OWN else musl / name for name in sorted(names)]


def include_folders(zig_library: Path) -> list[Path]:
    """The folders of the sources' headers, our own first."""
    musl = zig_library / "libc" / "musl" / "src"
    return [_HERE, musl / "internal", musl / "math"]
