"""Drawing mutants by chance: the same number from every room, one of a line at most."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from tools.mutants.change import Change
from tools.mutants.copies import ROOT
from tools.mutants.rooms import CHANGES

KINDS = ("operator", "constant", "branch", "statement")


@dataclass(frozen=True)
class Drawn:
    """A change of a file.

    Attributes:
        room: The room of the file.
        file: Its path from the root.
        change: What is changed.
    """

    room: str
    file: str
    change: Change

    @property
    def source(self) -> str:
        """The file as it is."""
        return (ROOT / self.file).read_text(encoding="utf-8")

    @property
    def name(self) -> str:
        """What it is called: the file, the line, and what is there before and after."""
        old = self.source[self.change.start : self.change.end]
        return f"{self.file}:{self.change.line} {_brief(old)} -> {_brief(self.change.new)}"


def draw(rooms: Mapping[str, Sequence[str]], count: int, seed: int) -> list[Drawn]:
    """Some mutants of each room; those of one seed are the same as long as the files are.

    Rooms take turns, so that a part of the list has some of each. In each room all kinds of changes are as
    frequent, and files count by the changes that they allow.

    Args:
        rooms: Files by rooms.
        count: How many, of all rooms together.
        seed: Decides which.
    """
    shares = {room: -(-count // len(rooms)) for room in rooms}
    drawn = {
        room: _of_a_room(room, files, shares[room], Random(f"{seed} {room}")) for room, files in rooms.items()
    }
    turns = [
        mutants[turn]
        for turn in range(max(shares.values()))
        for mutants in drawn.values()
        if turn < len(mutants)
    ]
    return turns[:count]


def _of_a_room(room: str, files: Sequence[str], count: int, random: Random) -> list[Drawn]:
    kinds: dict[str, list[Drawn]] = {kind: [] for kind in KINDS}
    for file in files:
        source = (ROOT / file).read_text(encoding="utf-8")
        for change in CHANGES[Path(file).suffix](source):
            kinds[change.kind].append(Drawn(room, file, change))
    for candidates in kinds.values():
        random.shuffle(candidates)
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


def _brief(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= 60 else f"{words[:57]}..."
