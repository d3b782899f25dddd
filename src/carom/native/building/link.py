"""Objects to one shared library."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from carom.native.building.zig import Zig
from carom.native.targets import Target

# Nothing of what a platform's C library has is taken, so that a library needs no certain one.
_FLAGS = {
    ".so": ("-shared", "-nostdlib", "-Wl,--gc-sections", "-Wl,--build-id=none", "-Wl,-z,relro", "-Wl,-z,now"),
    ".dylib": ("-dynamiclib", "-Wl,-dead_strip"),
    ".dll": ("-shared", "-nostdlib", "-Wl,--gc-sections"),
}


def link_command(zig: Zig, target: Target, level: str, objects: Sequence[Path], output: Path) -> list[str]:
    """The command that makes the library.

    Args:
        zig: What links.
        target: For which platform.
        level: For which of its CPU levels.
        objects: Object files; their order counts for the bytes of the library.
        output: The library, in an empty folder: linkers leave other files beside it.
    """
    flags = [*_FLAGS[target.suffix], "-g0", "-s"]
    if target.suffix == ".so":
        flags.append(f"-Wl,-soname,{output.name}")
    if target.suffix == ".dylib":
        flags.extend(("-install_name", f"@rpath/{output.name}"))
    return zig.command("c++", target, level, [*flags, "-o", output, *objects])
