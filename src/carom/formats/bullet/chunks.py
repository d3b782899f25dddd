"""The chunks of a file of Bullet, and values in them.

    12 bytes   "BULLET", "f" or "d" (single or double precision), "_" or "-" (pointers of 4 or 8 bytes),
               "V" or "v" (big- or little-endian), and three digits, the version
    chunks     code (4 bytes), size in bytes (int32), address that the data had in memory (a pointer),
               number of their structure (int32), number of structures (int32); then the data

The chunk "DNA1" describes the structures. A pointer is the address of another chunk.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from carom.files.budget import charge
from carom.formats.bullet.structures import Damaged, Member, Structure, read_structures

MAGIC = b"BULLET"
_HEADER_SIZE = 12
_PRECISIONS = (b"f", b"d")
_POINTER_SIZES = {b"_": 4, b"-": 8}
_ORDERS = {b"v": "<", b"V": ">"}
_DESCRIPTION = b"DNA1"
# How numbers of these types are read.
_NUMBERS = {"double": "d", "float": "f", "int": "i", "short": "h", "char": "b"}


@dataclass(frozen=True, slots=True)
class Chunk:
    """Structures of one kind, one after the other.

    Attributes:
        code: Four characters that say what the chunk contains.
        start: Place of its data in the file.
        size: Their size [bytes].
        address: Where they were in memory.
        structure: Number of their structure.
        count: Number of structures.
    """

    code: bytes
    start: int
    size: int
    address: int
    structure: int
    count: int


class Item:
    """One structure in a file."""

    def __init__(self, file: BulletFile, start: int, structure: Structure) -> None:
        self._file = file
        self._start = start
        self._structure = structure

    def numbers(self, path: Sequence[str], count: int) -> tuple[float, ...]:
        """The first `count` numbers of a member, or of the member of a member; more names lead further down.

        Raises:
            Damaged: There is no such member, or it has other numbers.
        """
        start, structure = self._start, self._structure
        for name in path[:-1]:
            member = self._member(structure, name)
            start += member.offset
            structure = self._file.structure_named(member.type)
            if member.pointer or structure.size != member.size:
                raise Damaged(f"{name} is not a structure")
        member = self._member(structure, path[-1])
        start += member.offset
        vectors = self._file.named.get(member.type)
        if vectors is None:
            return self._unpacked(member, path[-1], start, count)
        # Vectors are structures with one array of numbers, and the rows of a matrix are an array of vectors.
        if len(vectors.members) != 1 or member.pointer or vectors.size != member.size:
            raise Damaged(f"{path[-1]} is not made of numbers")
        inner = next(iter(vectors.members.values()))
        found: list[float] = []
        for place in range(min(member.count, count)):
            found += self._unpacked(inner, path[-1], start + place * vectors.size, inner.count)
        if len(found) < count:
            raise Damaged(f"{path[-1]} has {len(found)} numbers; {count} are expected")
        return tuple(found[:count])

    def integer(self, *path: str) -> int:
        """A member that is one integer; names as in `numbers`."""
        (number,) = self.numbers(path, 1)
        if not isinstance(number, int):
            raise Damaged(f"{path[-1]} is not an integer")
        return number

    def pointed(self, name: str, count: int) -> list[Item]:
        """The `count` structures that a pointer points to.

        Raises:
            Damaged: There are not as many.
        """
        member = self._member(self._structure, name)
        if not member.pointer:
            raise Damaged(f"{name} is not a pointer")
        (address,) = self._file.unpack("Q" if member.size == 8 else "I", self._start + member.offset)
        chunk = self._file.by_address.get(int(address)) if address else None
        there = 0 if chunk is None else chunk.count
        if chunk is None or there != count:
            raise Damaged(f"{name} leads to {there} structures instead of {count}")
        return list(self._file.items(chunk))

    def _member(self, structure: Structure, name: str) -> Member:
        member = structure.members.get(name)
        if member is None:
            raise Damaged(
                f"{structure.name} has no member {name}; it was written by another version of Bullet"
            )
        return member

    def _unpacked(self, member: Member, name: str, start: int, count: int) -> tuple[float, ...]:
        kind = _NUMBERS.get(member.type)
        if kind is None or member.pointer or struct.calcsize(kind) != member.size or member.count < count:
            raise Damaged(f"{name} does not consist of {count} numbers")
        return self._file.unpack(f"{count}{kind}", start)


class BulletFile:
    """The chunks of a file and their structures.

    Args:
        data: Content of the file.

    Attributes:
        chunks: All chunks but the description.
        by_address: The same by their address in memory.
        named: Structures by name.

    Raises:
        Damaged: It is not a file of Bullet, or is damaged.
    """

    def __init__(self, data: bytes) -> None:
        self._data = data
        precision, pointers, order = (data[place : place + 1] for place in (6, 7, 8))
        if data[: len(MAGIC)] != MAGIC or len(data) < _HEADER_SIZE:
            raise Damaged("it is not a file of Bullet")
        if precision not in _PRECISIONS or pointers not in _POINTER_SIZES or order not in _ORDERS:
            raise Damaged(f"its header {data[:_HEADER_SIZE]!r} is not one of Bullet's")
        self._order = _ORDERS[order]
        pointer_size = _POINTER_SIZES[pointers]
        self.chunks: list[Chunk] = []
        described: Chunk | None = None
        for chunk in self._found(pointer_size):
            if chunk.code == _DESCRIPTION:
                described = chunk
            else:
                self.chunks.append(chunk)
        if described is None:
            raise Damaged("it ends before the description of its structures; it was not written completely")
        description = data[described.start : described.start + described.size]
        self._structures = read_structures(description, self._order, pointer_size)
        self.named = {structure.name: structure for structure in self._structures}
        self.by_address = {chunk.address: chunk for chunk in self.chunks}

    def _found(self, pointer_size: int) -> Iterator[Chunk]:
        header = struct.Struct(f"{self._order}4si{'Q' if pointer_size == 8 else 'I'}ii")
        place = _HEADER_SIZE
        while place < len(self._data):
            if place + header.size > len(self._data):
                raise Damaged(f"the header of a chunk at byte {place} is incomplete")
            code, size, address, structure, count = header.unpack_from(self._data, place)
            place += header.size
            if not 0 <= size <= len(self._data) - place:
                left = len(self._data) - place
                raise Damaged(f"the chunk {code!r} before byte {place} has {size} bytes, but {left} are left")
            yield Chunk(code, place, size, address, structure, count)
            place += size

    def structure_named(self, name: str) -> Structure:
        """A structure by name."""
        structure = self.named.get(name)
        if structure is None:
            raise Damaged(f"it does not describe {name}")
        return structure

    def items(self, chunk: Chunk) -> Iterator[Item]:
        """The structures of a chunk."""
        if not 0 <= chunk.structure < len(self._structures):
            raise Damaged(f"the chunk {chunk.code!r} has structures that are not described")
        structure = self._structures[chunk.structure]
        if chunk.count < 0 or structure.size <= 0 or chunk.count * structure.size > chunk.size:
            raise Damaged(f"the chunk {chunk.code!r} is too short for {chunk.count} of {structure.name}")
        charge("elements", chunk.count)
        for number in range(chunk.count):
            yield Item(self, chunk.start + number * structure.size, structure)

    def unpack(self, kind: str, start: int) -> tuple[float, ...]:
        """Numbers at a place, in the file's order of bytes."""
        layout = struct.Struct(self._order + kind)
        if not 0 <= start <= len(self._data) - layout.size:
            raise Damaged(f"it ends before a value at byte {start}")
        return layout.unpack_from(self._data, start)
