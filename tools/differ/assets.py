"""Files of `pybullet_data` that programs load, with the joints that PyBullet says they have.

`env -u PYTHONPATH .oracle/bin/python tools/differ/record_assets.py` writes `tables`: the bodies of each
file, as the types of their joints, and more.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

REVOLUTE, PRISMATIC, SPHERICAL, PLANAR, FIXED = range(5)
POINT, GEAR = 5, 6


@dataclass(frozen=True)
class Joint:
    """A joint of a body; only its type matters."""

    type: int


_TABLES = Path(__file__).with_name("tables")


def _read() -> dict[str, tuple[tuple[Joint, ...], ...]]:
    files = json.loads((_TABLES / "assets.json").read_text(encoding="utf-8"))
    return {name: tuple(tuple(map(Joint, types)) for types in bodies) for name, bodies in files.items()}


FILES = _read()
"""The joints of the bodies in each file."""
URDFS = [name for name in FILES if name.endswith(".urdf")]
ROBOTS = [name for name in URDFS if FILES[name][0]]
SMALL = [name for name in URDFS if len(FILES[name][0]) < 2 and "plane" not in name]
SCENES = [name for name in FILES if not name.endswith(".urdf")]


def _names(table: str) -> frozenset[str]:
    return frozenset(json.loads((_TABLES / table).read_text(encoding="utf-8")))


AT_LIMITS = _names("at_limits.json")
"""Files with a joint that stands exactly at one of its limits when it is loaded."""
BARE = _names("bare.json")
"""Files with a link that has a joint to move and no collision shape."""
CHILDREN_FIRST = _names("children_first.json")
"""Files that list a link before its parent."""
FINE = _names("fine.json")
"""Files with a hull of very many corners, and meshes that make one."""
SWEPT: dict[str, tuple[float, float]] = {
    name: (least, greatest)
    for name, (least, greatest) in json.loads((_TABLES / "swept.json").read_text(encoding="utf-8")).items()
}
"""The least radius [m] of capsules that MJCF files give by two points, and the greatest of round shapes."""
THIN: dict[str, float] = json.loads((_TABLES / "thin.json").read_text(encoding="utf-8"))
"""How thin boxes of files are [m], if thinner than 5 cm."""
TIED: dict[str, tuple[list[int], list[int]]] = {
    name: (numbered, listed)
    for name, (numbered, listed) in json.loads((_TABLES / "tied.json").read_text(encoding="utf-8")).items()
}
"""Of URDF files with fixed joints, of each link the one from which on fixed joints lead to it.

First as links are numbered without flags, then as they are with `URDF_MAINTAIN_LINK_ORDER`."""
