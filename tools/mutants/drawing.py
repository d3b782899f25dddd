"""Drawing mutants by chance: the same number from every room, one of a line at most."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from tools.mutants.change import Change
from tools.mutants.copies import ROOT
from tools.mutants.names import named
from tools.mutants.rooms import CHANGES

KINDS = ("operator", "constant", "branch", "statement")


@dataclass(frozen=True)
class Drawn:
    """A change of a file.

    Attributes:
        room: The room of the file.
        file: Its path from the root.
        change: What is changed.
        name: What it is called, by what it changes; see `named`.
    """

    room: str
    file: str
    change: Change
    name: str

    @property
    def source(self) -> str:
        """The file as it is."""
        return (ROOT / self.file).read_text(encoding="utf-8")


def draw(rooms: Mapping[str, Sequence[str]], count: int, seed: int) -> list[Drawn]:
    """Some mutants of each room; those of one seed stay when other lines are changed.

    The seed and the names give every possible change its place in a row, and the first ones are taken.

    Rooms take turns, so that a part of the list has some of each. In each room all kinds of changes are as
    frequent, and files count by the changes that they allow.

    Args:
        rooms: Files by rooms.
        count: How many, of all rooms together.
        seed: Decides which.
    """
    shares = {room: -(-count // len(rooms)) for room in rooms}
    drawn = {room: _of_a_room(room, files, shares[room], seed) for room, files in rooms.items()}
    turns = [
        mutants[turn]
        for turn in range(max(shares.values()))
        for mutants in drawn.values()
        if turn < len(mutants)
    ]
    return turns[:count]


def _of_a_room(room: str, files: Sequence[str], count: int, seed: int) -> list[Drawn]:
    kinds: dict[str, list[Drawn]] = {kind: [] for kind in KINDS}
    for file in files:
        source = (ROOT / file).read_text(encoding="utf-8")
        for name, change in named(file, source, CHANGES[Path(file).suffix](source)):
            kinds[change.kind].append(Drawn(room, file, change, name))
    for candidates in kinds.values():
        candidates.sort(key=lambda drawn: sha256(f"{seed} {drawn.name}".encode()).digest())
        candidates.reverse()
    taken: list[Drawn] = []
    lines: set[tuple[str, int]] = set()
    while len(taken) < count and any(kinds.values()):
        for candidates in kinds.values():
            if candidates and len(taken) < count:
                drawn = candidates.pop()
                if (drawn.file, drawn.change.line) not in lines:
                    lines.add((drawn.file, drawn.change.line))
                    taken.append(drawn)
    return taken
