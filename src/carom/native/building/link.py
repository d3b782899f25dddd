"""Linking object files to a shared library."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path

from carom.native.building.zig import Zig
from carom.native.targets import Target

# The library is not linked against a C library, so that it does not depend on a certain version.
_FLAGS = {
    ".so": ("-shared", "-nostdlib", "-Wl,--gc-sections", "-Wl,--build-id=none", "-Wl,-z,relro", "-Wl,-z,now"),
    ".dylib": ("-dynamiclib", "-Wl,-dead_strip"),
    ".dll": ("-shared", "-nostdlib", "-Wl,--gc-sections"),
}


def link_command(zig: Zig, target: Target, level: str, objects: Sequence[Path], output: Path) -> list[str]:
    """The command that links the library.

    Its bytes depend on the order of the objects. `output` is in an empty folder: linkers leave other files
    beside it.
    """
    # Zig would compile the runtime library of sanitizers first, were it not for the last flag.
    flags = [*_FLAGS[target.suffix], "-g0", "-s", "-fsanitize-trap=undefined"]
    if target.suffix == ".so":
        flags.append(f"-Wl,-soname,{output.name}")
    if target.suffix == ".dylib":
        flags.extend(("-install_name", f"@rpath/{output.name}"))
    return zig.command("c++", target, level, [*flags, "-o", output, *objects])


def remove_time(library: Path) -> None:
    """Set the time of linking to 0, which Windows libraries have in their header: builds are to be the same.

    Zig's linker has no option for it. Libraries of other formats have no such time.
    """
    with library.open("r+b") as file:
        if file.read(2) != b"MZ":
            return
        file.seek(0x3C)
        (header,) = struct.unpack("<I", file.read(4))
        # After the signature, the machine and the number of sections.
        file.seek(header + 8)
        file.write(bytes(4))
