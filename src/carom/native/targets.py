"""The platforms that the native library is built for."""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence
from typing import NamedTuple


class NoTarget(Exception):
    """There is no native library for this platform."""


class Target(NamedTuple):
    """A platform.

    Attributes:
        name: Its name in the library's file name, such as `x86_64-linux`.
        triple: Its name for Zig.
        levels: CPU levels by name, with their names for Zig, the oldest first.
        prefix: Beginning of the file names of its libraries.
        suffix: End of these file names.
        wheel_tags: Platform tags of the wheels that contain its libraries.
        left_out: Levels that are not in wheels, because they are no faster than the level before.
    """

    name: str
    triple: str
    levels: dict[str, str]
    prefix: str
    suffix: str
    wheel_tags: tuple[str, ...]
    left_out: tuple[str, ...] = ()

    @property
    def shipped(self) -> list[str]:
        """The CPU levels that are in wheels, the oldest first."""
        return [level for level in self.levels if level not in self.left_out]

    def usable_levels(self, offered: Sequence[str]) -> list[str]:
        """Those of a processor's CPU levels that there are libraries for, in the same order.

        Levels that are not in wheels are among them only if no other is offered, as where `CAROM_CPU_LEVEL`
        names one.
        """
        shipped = [level for level in offered if level in self.shipped]
        return shipped or [level for level in offered if level in self.levels]

    def library_name(self, level: str) -> str:
        """File name of the library for a CPU level."""
        return f"{self.prefix}carom-{self.name}-{level}{self.suffix}"


_X86_LEVELS = {"v2": "x86_64_v2", "v3": "x86_64_v3", "v4": "x86_64_v4"}
# The library needs only functions of libc that every process has loaded, so one library works with both glibc
# and musl.
TARGETS = {
    target.name: target
    for target in (
        Target(
            "x86_64-linux",
            "x86_64-linux-gnu.2.28",
            _X86_LEVELS,
            "lib",
            ".so",
            ("manylinux_2_28_x86_64", "musllinux_1_2_x86_64"),
            ("v4",),
        ),
        Target(
            "aarch64-linux",
            "aarch64-linux-gnu.2.28",
            {"v8": "generic"},
            "lib",
            ".so",
            ("manylinux_2_28_aarch64", "musllinux_1_2_aarch64"),
        ),
        Target(
            "x86_64-macos",
            "x86_64-macos.11.0",
            {"v2": "x86_64_v2", "v3": "x86_64_v3"},
            "lib",
            ".dylib",
            ("macosx_11_0_x86_64",),
        ),
        Target(
            "arm64-macos", "aarch64-macos.11.0", {"v8": "apple_m1"}, "lib", ".dylib", ("macosx_11_0_arm64",)
        ),
        Target("x86_64-windows", "x86_64-windows-gnu", _X86_LEVELS, "", ".dll", ("win_amd64",), ("v4",)),
        Target("aarch64-windows", "aarch64-windows-gnu", {"v8": "generic"}, "", ".dll", ("win_arm64",)),
    )
}
_MACHINES = {"amd64": "x86_64", "x64": "x86_64", "arm64": "aarch64"}
_SYSTEMS = {"linux": "linux", "darwin": "macos", "win32": "windows"}


def this_target() -> Target:
    """The platform that this Python runs on.

    Raises:
        NoTarget: There is no library for it.
    """
    machine = platform.machine().lower()
    machine = _MACHINES.get(machine, machine)
    system = _SYSTEMS.get(sys.platform, sys.platform)
    name = "arm64-macos" if (machine, system) == ("aarch64", "macos") else f"{machine}-{system}"
    if name not in TARGETS or sys.maxsize < 2**32:
        raise NoTarget(
            f"Carom's native library is built for {', '.join(TARGETS)}; this is {sys.platform} on "
            f"{platform.machine()}, with a Python of {64 if sys.maxsize > 2**32 else 32} bits"
        )
    return TARGETS[name]
