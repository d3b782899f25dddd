"""The processor's instruction sets, and the number of cores for this process."""

from __future__ import annotations

import ctypes
import os
import platform
import sys

_LEVEL = "CAROM_CPU_LEVEL"
# Instruction sets that the levels v3 and v4 of x86-64 add to the level below, by their names in Linux. A
# processor with these has the rest of the level, too.
_LINUX_FLAGS = {"v3": {"avx2", "bmi2", "fma", "f16c", "movbe"}, "v4": {"avx512bw", "avx512dq", "avx512vl"}}
_MACOS_NAMES = {"v3": "hw.optional.avx2_0", "v4": "hw.optional.avx512vl"}
# PF_AVX2_INSTRUCTIONS_AVAILABLE and PF_AVX512F_INSTRUCTIONS_AVAILABLE.
_WINDOWS_FEATURES = {"v3": 40, "v4": 41}


def core_count() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def cpu_levels() -> list[str]:
    """CPU levels of the libraries that run on this processor, the best first.

    If the environment variable `CAROM_CPU_LEVEL` is set, its value is the only one.
    """
    asked = os.environ.get(_LEVEL)
    if asked:
        return [asked]
    if platform.machine().lower() not in ("x86_64", "amd64", "x64"):
        return ["v8"]
    levels = ["v2"]
    for level, has in _x86_features().items():
        if not has:
            break
        levels.insert(0, level)
    return levels


def _x86_features() -> dict[str, bool]:
    """Whether the processor has the instruction sets of the levels v3 and v4."""
    if sys.platform == "linux":
        flags = _linux_flags()
        return {level: wanted <= flags for level, wanted in _LINUX_FLAGS.items()}
    if sys.platform == "win32":
        has_feature = ctypes.windll.kernel32.IsProcessorFeaturePresent
        return {level: bool(has_feature(feature)) for level, feature in _WINDOWS_FEATURES.items()}
    if sys.platform == "darwin":
        return {level: _macos_has(name) for level, name in _MACOS_NAMES.items()}
    return {}


def _linux_flags() -> set[str]:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as lines:
            return next((set(line.split()) for line in lines if line.startswith("flags")), set())
    except OSError:
        return set()


def _macos_has(name: str) -> bool:
    value, size = ctypes.c_int(0), ctypes.c_size_t(ctypes.sizeof(ctypes.c_int))
    found = ctypes.CDLL(None).sysctlbyname(name.encode(), ctypes.byref(value), ctypes.byref(size), None, 0)
    return found == 0 and value.value != 0
