"""Reports of what a file says and the simulation lacks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

_HEADER = ("element", "attributes", "count", "where", "touches", "consequence", "reason")
_MAX_NAMES = 4
# What the simulation lacks, the gravest first.
_EFFECTS = ("motion", "sensing", "looks", "nothing")
# Parts of the names of elements, and attributes, that say what an entry touches besides motion.
_OF_SENSING = frozenset(
    (
        *("sensor", "camera", "imu", "lidar", "ray", "gpu_ray", "gpu_lidar", "depth_camera", "altimeter"),
        *("magnetometer", "navsat", "gps", "force_torque"),
    )
)
_OF_LOOKS = frozenset(
    (
        *("visual", "material", "texture", "light", "skin", "scene", "gui", "projector", "layer", "rgba"),
        *("emission", "metallic", "reflectance", "roughness", "shininess", "texrepeat", "texuniform"),
        *("castshadow", "width"),
    )
)


@dataclass(frozen=True, slots=True)
class Ignored:
    """Something in a file that is not simulated.

    Attributes:
        element: Name of the element, with that of the one around it, as in `joint/mimic`.
        file: The file that contains it.
        line: Line of the first one there, counted from 1.
        attributes: The attributes concerned; none if it is the whole element, with all inside it.
        count: How many there are in this file.
        consequence: What the simulation lacks.
        reason: Why.
    """

    element: str
    file: Path
    line: int
    attributes: tuple[str, ...]
    count: int
    consequence: str
    reason: str

    @property
    def effect(self) -> str:
        """What the simulation lacks something of: `motion`, `sensing`, `looks` or `nothing`."""
        names = {*self.element.split("/"), *self.attributes}
        if not names.isdisjoint(_OF_LOOKS) and ("visual" in names or self.consequence.startswith("none")):
            return "looks"
        if self.consequence.startswith("none"):
            return "nothing"
        return "motion" if names.isdisjoint(_OF_SENSING) else "sensing"

    @property
    def matters(self) -> bool:
        """Whether motion or what sensors measure would be another; looks do not count."""
        return self.effect in ("motion", "sensing")

    def __str__(self) -> str:
        attributes = f" {', '.join(self.attributes)}" if self.attributes else ""
        times = f" ({self.count} times)" if self.count > 1 else ""
        return (
            f"{self.file}:{self.line}: {self.element}{attributes}{times}: {self.consequence} ({self.reason})"
        )


class IgnoredList(list[Ignored]):
    """What of a file is not simulated: the gravest first, then by file and line; prints as a table."""

    @classmethod
    def of(cls, found: Iterable[Ignored]) -> IgnoredList:
        """A list in which entries of one file that differ only in their lines are one, with their count."""
        first: dict[tuple[object, ...], Ignored] = {}
        counts: dict[tuple[object, ...], int] = {}
        for one in sorted(found, key=lambda it: (str(it.file), it.line)):
            key = (one.element, one.file, one.attributes, one.consequence, one.reason)
            first.setdefault(key, one)
            counts[key] = counts.get(key, 0) + one.count
        entries = (
            Ignored(one.element, one.file, one.line, one.attributes, counts[key], one.consequence, one.reason)
            for key, one in first.items()
        )
        return cls(sorted(entries, key=lambda it: _EFFECTS.index(it.effect)))

    @property
    def total(self) -> int:
        """Number of elements in files that are concerned."""
        return sum(one.count for one in self)

    @property
    def that_matter(self) -> IgnoredList:
        """Those without which something moves or is measured otherwise."""
        return IgnoredList(one for one in self if one.matters)

    def summary(self) -> str:
        """Counts by element, the most frequent first, as in `3 joint/mimic, 1 robot/gazebo`."""
        counts: dict[str, int] = {}
        for one in self:
            counts[one.element] = counts.get(one.element, 0) + one.count
        names = sorted(counts, key=lambda name: -counts[name])
        listed = [f"{counts[name]} {name}" for name in names[:_MAX_NAMES]]
        if len(names) > _MAX_NAMES:
            listed.append(f"{sum(counts[name] for name in names[_MAX_NAMES:])} others")
        return ", ".join(listed)

    def __str__(self) -> str:
        if not self:
            return "Nothing is ignored."
        told = [one for one in self if one.effect != "nothing"]
        without = IgnoredList(one for one in self if one.effect == "nothing")
        last = f"{without.total} more without effect: {without.summary()}" if without else ""
        if not told:
            return f"Nothing that is simulated is ignored; {last}"
        rows = [_HEADER, *map(_cells, told)]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        rows.insert(1, tuple("-" * width for width in widths))
        lines = [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in rows
        ]
        return "\n".join([*lines, last] if last else lines)


def _cells(one: Ignored) -> tuple[str, ...]:
    where = f"{one.file.name}:{one.line}"
    told = " ".join(one.attributes), str(one.count), where, one.effect, one.consequence, one.reason
    return (one.element, *told)
