"""The description of structures at the end of a file of Bullet ("DNA", an idea of Blender's files).

Four tables, each after a tag of four bytes and aligned to four bytes:

    SDNA
    NAME  count (int32), then names of members, each ended by a zero byte: "m_mass", "*m_links", "m_pos[7]"
    TYPE  count (int32), then names of types, likewise
    TLEN  the size of each type in bytes (int16)
    STRC  count (int32), then for each structure its type, the number of its members, and the type and the
          name of each member (int16 all of them)

Members follow each other without gaps; Bullet's structures contain explicit ones.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass

_COUNT = re.compile(r"\[(\d{1,9})\]")
_ALIGNMENT = 4


class Damaged(ValueError):
    """A file contradicts itself; the message says how."""


@dataclass(frozen=True, slots=True)
class Member:
    """A member of a structure.

    Attributes:
        type: Name of its type.
        offset: Place in the structure [bytes].
        count: Number of elements; 1 unless it is an array.
        size: Size of one element [bytes].
        pointer: Whether it is a pointer to its type.
    """

    type: str
    offset: int
    count: int
    size: int
    pointer: bool


@dataclass(frozen=True, slots=True)
class Structure:
    """A structure: its name, size in bytes, and members by name, without `*` and `[n]`."""

    name: str
    size: int
    members: dict[str, Member]


class _Table:
    """Reads numbers and names in order; raises `Damaged` where the data end."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data = data
        self.order = order
        self.place = 0

    def tag(self, wanted: bytes) -> None:
        self.place += -self.place % _ALIGNMENT
        found = self.data[self.place : self.place + len(wanted)]
        if found != wanted:
            raise Damaged(f"its description of structures has {found!r} where {wanted!r} is expected")
        self.place += len(wanted)

    def integers(self, kind: str, count: int) -> tuple[int, ...]:
        size = struct.calcsize(kind) * count
        if not 0 <= size <= len(self.data) - self.place:
            raise Damaged(f"its description of structures ends before {count} numbers that it announces")
        numbers = struct.unpack_from(f"{self.order}{count}{kind}", self.data, self.place)
        self.place += size
        return numbers

    def names(self) -> list[str]:
        (count,) = self.integers("i", 1)
        names: list[str] = []
        # A negative number has no names; each name takes a byte at least, so that the data limit a large one.
        for _ in range(count):
            end = self.data.find(b"\0", self.place)
            if end < 0:
                raise Damaged(f"its description of structures ends before {count} names that it announces")
            names.append(self.data[self.place : end].decode("latin-1"))
            self.place = end + 1
        return names


def read_structures(data: bytes, order: str, pointer_size: int) -> list[Structure]:
    """The structures that a description contains, in its order, which chunks refer to by number.

    Args:
        data: The description, from its first tag on.
        order: Order of bytes as in the module `struct`, "<" or ">".
        pointer_size: Size of pointers in the file [bytes].

    Raises:
        Damaged: The description ends too early or contradicts itself.
    """
    table = _Table(data, order)
    table.tag(b"SDNA")
    table.tag(b"NAME")
    names = table.names()
    table.tag(b"TYPE")
    types = table.names()
    table.tag(b"TLEN")
    sizes = table.integers("h", len(types))
    table.tag(b"STRC")
    (count,) = table.integers("i", 1)
    structures: list[Structure] = []
    for _ in range(count):
        kind, member_count = table.integers("h", 2)
        pairs = table.integers("h", 2 * member_count)
        if not 0 <= kind < len(types):
            raise Damaged(f"its description of structures has no type {kind}")
        members: dict[str, Member] = {}
        offset = 0
        for of, called in zip(pairs[::2], pairs[1::2], strict=True):
            if not (0 <= of < len(types) and 0 <= called < len(names)):
                raise Damaged(
                    f"its description of {types[kind]} refers to a type or name that it does not have"
                )
            member = _member(names[called], types[of], sizes[of], offset, pointer_size)
            members[names[called].lstrip("*").partition("[")[0]] = member
            offset += member.size * member.count
        if offset != sizes[kind]:
            raise Damaged(
                f"it says that {types[kind]} has {sizes[kind]} bytes, but its members have {offset}"
            )
        structures.append(Structure(types[kind], offset, members))
    return structures


def _member(name: str, kind: str, size: int, offset: int, pointer_size: int) -> Member:
    count = 1
    for found in _COUNT.findall(name):
        count *= int(found)
    # A pointer to a function is written "(*name)()".
    pointer = name[:1] in ("*", "(")
    return Member(kind, offset, count, pointer_size if pointer else size, pointer)
