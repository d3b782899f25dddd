"""What a shared library exports and needs, read from its bytes, on any platform for any other."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from pathlib import Path


class Malformed(Exception):
    """A file is no shared library of a known kind."""


@dataclass
class Library:
    """What loaders see of a shared library.

    Attributes:
        format: `ELF`, `Mach-O` or `PE`.
        machine: `x86_64` or `aarch64`.
        exported: Names that it has.
        undefined: Names that it expects of others.
        needed: Libraries that it is loaded with.
        name: What it calls itself, if it does.
        signed: Whether it carries a signature (Mach-O).
        oldest_system: The oldest version of macOS that loads it (Mach-O).
        executable_stack: Whether it asks for one (ELF).
    """

    format: str
    machine: str
    exported: set[str] = field(default_factory=set)
    undefined: set[str] = field(default_factory=set)
    needed: list[str] = field(default_factory=list)
    name: str = ""
    signed: bool = False
    oldest_system: tuple[int, int] = (0, 0)
    executable_stack: bool = False


def read_library(path: Path) -> Library:
    """Read a shared library for a 64-bit little-endian platform.

    Args:
        path: The file.

    Raises:
        Malformed: It is none.
    """
    data = path.read_bytes()
    try:
        if data.startswith(b"\x7fELF\x02\x01"):
            return _read_elf(data)
        if data.startswith(b"\xcf\xfa\xed\xfe"):
            return _read_macho(data)
        if data.startswith(b"MZ"):
            return _read_pe(data)
    except (struct.error, KeyError, IndexError, ValueError) as problem:
        raise Malformed(f"{path}: {problem}") from problem
    raise Malformed(f"{path} is no shared library for a 64-bit platform")


def _text(data: bytes, offset: int) -> str:
    return data[offset : data.index(b"\0", offset)].decode()


# --- Linux ---

_ELF_MACHINES = {62: "x86_64", 183: "aarch64"}
_PT_DYNAMIC, _PT_GNU_STACK = 2, 0x6474E551
_SHT_DYNSYM = 11
_DT_NEEDED, _DT_SONAME = 1, 14


def _read_elf(data: bytes) -> Library:
    library = Library("ELF", _ELF_MACHINES[struct.unpack_from("<H", data, 18)[0]])
    section_start = struct.unpack_from("<Q", data, 40)[0]
    section_size, section_count = struct.unpack_from("<HH", data, 58)
    sections = [
        struct.unpack_from("<IIQQQQIIQQ", data, section_start + i * section_size)
        for i in range(section_count)
    ]
    symbols = next(section for section in sections if section[1] == _SHT_DYNSYM)
    strings = sections[symbols[6]][4]
    for offset in range(symbols[4] + 24, symbols[4] + symbols[5], 24):
        name, info, _, section = struct.unpack_from("<IBBH", data, offset)
        if info >> 4:  # not local
            (library.exported if section else library.undefined).add(_text(data, strings + name))
    header_start = struct.unpack_from("<Q", data, 32)[0]
    header_size, header_count = struct.unpack_from("<HH", data, 54)
    for i in range(header_count):
        kind, flags, offset, _, _, size = struct.unpack_from("<IIQQQQ", data, header_start + i * header_size)
        if kind == _PT_GNU_STACK:
            library.executable_stack = bool(flags & 1)
        elif kind == _PT_DYNAMIC:
            for entry in range(offset, offset + size, 16):
                tag, value = struct.unpack_from("<QQ", data, entry)
                if tag == _DT_NEEDED:
                    library.needed.append(_text(data, strings + value))
                elif tag == _DT_SONAME:
                    library.name = _text(data, strings + value)
    return library


# --- macOS ---

_MACHO_MACHINES = {0x01000007: "x86_64", 0x0100000C: "aarch64"}
_LC_SYMTAB, _LC_LOAD_DYLIB, _LC_ID_DYLIB, _LC_CODE_SIGNATURE, _LC_BUILD_VERSION = 0x2, 0xC, 0xD, 0x1D, 0x32
_LC_VERSION_MIN_MACOSX = 0x24
_N_EXT, _N_TYPE = 0x01, 0x0E


def _read_macho(data: bytes) -> Library:
    library = Library("Mach-O", _MACHO_MACHINES[struct.unpack_from("<I", data, 4)[0]])
    offset = 32
    for _ in range(struct.unpack_from("<I", data, 16)[0]):
        command, size = struct.unpack_from("<II", data, offset)
        if command in (_LC_LOAD_DYLIB, _LC_ID_DYLIB):
            name = _text(data, offset + struct.unpack_from("<I", data, offset + 8)[0])
            if command == _LC_ID_DYLIB:
                library.name = name
            else:
                library.needed.append(name)
        elif command == _LC_CODE_SIGNATURE:
            library.signed = True
        elif command in (_LC_BUILD_VERSION, _LC_VERSION_MIN_MACOSX):
            place = 12 if command == _LC_BUILD_VERSION else 8
            version = struct.unpack_from("<I", data, offset + place)[0]
            library.oldest_system = version >> 16, version >> 8 & 0xFF
        elif command == _LC_SYMTAB:
            start, count, strings, _ = struct.unpack_from("<IIII", data, offset + 8)
            for i in range(count):
                name, kind = struct.unpack_from("<IB", data, start + 16 * i)
                if kind & _N_EXT:
                    names = library.exported if kind & _N_TYPE else library.undefined
                    # C's names have an underscore in front.
                    names.add(_text(data, strings + name)[1:])
        offset += size
    return library


# --- Windows ---

_PE_MACHINES = {0x8664: "x86_64", 0xAA64: "aarch64"}


def _read_pe(data: bytes) -> Library:
    header = struct.unpack_from("<I", data, 0x3C)[0]
    if data[header : header + 4] != b"PE\0\0":
        raise ValueError("no PE header")
    machine, section_count = struct.unpack_from("<HH", data, header + 4)
    library = Library("PE", _PE_MACHINES[machine])
    optional = header + 24
    sections = optional + struct.unpack_from("<H", data, header + 20)[0]

    def place(address: int) -> int:
        for i in range(section_count):
            size, start, raw_size, raw = struct.unpack_from("<IIII", data, sections + 40 * i + 8)
            if start <= address < start + max(size, raw_size):
                return address - start + raw
        raise ValueError("an address outside all sections")

    exports, _, imports, _ = struct.unpack_from("<IIII", data, optional + 112)
    if exports:
        table = place(exports)
        library.name = _text(data, place(struct.unpack_from("<I", data, table + 12)[0]))
        count = struct.unpack_from("<I", data, table + 24)[0]
        names = place(struct.unpack_from("<I", data, table + 32)[0])
        for i in range(count):
            library.exported.add(_text(data, place(struct.unpack_from("<I", data, names + 4 * i)[0])))
    if imports:
        entry = place(imports)
        while name := struct.unpack_from("<I", data, entry + 12)[0]:
            library.needed.append(_text(data, place(name)))
            entry += 20
    return library
