"""What keeps a wheel, or the native library in it, from being published."""

from __future__ import annotations

from tools.wheels.structure import Library

from carom.native.targets import Target

# The only library that a native library may be loaded with, and what it may take from there.
_SYSTEM_LIBRARY = "/usr/lib/libSystem.B.dylib"
_SYSTEM_NAMES = {"memcpy", "memmove", "memset", "bzero", "__bzero", "dyld_stub_binder", "yld_stub_binder"}
# Made up by the linker for macOS.
_LINKER_NAMES = {"__dso_handle", "_mh_dylib_header"}
_FORMATS = {".so": "ELF", ".dylib": "Mach-O", ".dll": "PE"}


class Unfit(Exception):
    """A wheel is not to be published."""


def faults(library: Library, target: Target, level: str) -> list[str]:
    """What is wrong with a native library.

    Args:
        library: The library.
        target: The platform it is for.
        level: The CPU level it is for.

    Returns:
        Sentences; none if all is well.
    """
    name = target.library_name(level)
    macos = target.suffix == ".dylib"
    strangers = {
        one for one in library.exported if one != "carom_digest" and not one.startswith("carom_")
        and not one.endswith("_cpu_forward")
    } - _LINKER_NAMES  # fmt: skip
    checks = {
        f"it is {library.format}": library.format == _FORMATS[target.suffix],
        f"it is for {library.machine}": library.machine == target.triple.split("-")[0],
        f"it calls itself {library.name!r}": library.name == (f"@rpath/{name}" if macos else name),
        f"it needs {library.needed}": library.needed == ([_SYSTEM_LIBRARY] if macos else []),
        f"it takes {sorted(library.undefined)}": library.undefined <= (_SYSTEM_NAMES if macos else set()),
        f"it exports {sorted(strangers)}": not strangers,
        "it has no digest": "carom_digest" in library.exported,
        "it is not signed": library.signed or target.name != "arm64-macos",
        f"it needs macOS {library.oldest_system}": library.oldest_system == ((11, 0) if macos else (0, 0)),
        "it asks for an executable stack": not library.executable_stack,
    }
    return [fault for fault, well in checks.items() if not well]
