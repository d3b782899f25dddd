"""Tendons, as descriptions: a path over joints, or through points and around spheres and cylinders."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from carom.description.compliance import Compliance
from carom.description.link import Rgba
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.errors import DescriptionError
from carom.layouts.codes import PathKind

WORLD = -2
"""The link of a part of a path that is in the world."""
_OF_JOINTS = (PathKind.JOINT, PathKind.BALL)


@dataclass(frozen=True, slots=True)
class PathPart:
    """A part of the path of a tendon.

    Attributes:
        kind: What it is.
        link: Index of the link that has it, -1 for the base, -2 for the world; of a joint that of its child.
        pose: Where it is in the frame of the link, or in the world; a cylinder is along its z axis.
        size: Of a joint: length per position; of a spherical one per angle by which it is turned, which is
            from 0 to pi, whatever the axis. Of a slider: length of its rod [m]. Of a sphere or cylinder:
            radius [m]. Of a pulley: by how much the length of the branch after it is divided.
        side_link: The link of a point that a path around a sphere or cylinder has on its side.
        side: This point; None for the shorter way. If it is inside, the path is held inside.
    """

    kind: PathKind
    link: int = WORLD
    pose: Pose = IDENTITY
    size: float = 0.0
    side_link: int = WORLD
    side: Vector3 | None = None


Path = tuple[PathPart, ...]


@dataclass(frozen=True, slots=True)
class TendonLook:
    """How a tendon is drawn.

    Attributes:
        width: Radius [m].
        rgba: Its colour.
        group: Number of its group, which windows show or hide.
    """

    width: float = 0.003
    rgba: Rgba = (0.5, 0.5, 0.5, 1.0)
    group: int = 0


@dataclass(frozen=True, slots=True)
class TendonSpec:
    """A tendon of a body: a spring, a damper, dry friction and a limit along a path.

    Attributes:
        name: Its name among the tendons of the body.
        path: Its parts in order: only joints, or branches of sites, between which there may be spheres and
            cylinders, with pulleys between branches.
        stiffness: [N/m], or N m/rad for joints.
        damping: [N s/m].
        spring_range: Lengths between which the spring is slack; None for the length where it is added.
        range: Least and greatest length [m].
        friction: Greatest force of dry friction [N].
        armature: Inertia along it [kg]; that moment arms of parts around spheres and cylinders change with
            time does not count.
        limit_compliance: How its limit yields; None for a rigid one.
        limit_margin: Distance from its limit at which it begins to act [m].
        look: How it is drawn; None as windows like it.
        stiffness_terms: What is added to the stiffness per stretch x [N/m²], and per its square [N/m³]: the
            force of the spring is -(k x + a x² + b x³).
    """

    name: str
    path: Path
    stiffness: float = 0.0
    damping: float = 0.0
    spring_range: tuple[float, float] | None = None
    range: tuple[float, float] = (-inf, inf)
    friction: float = 0.0
    limit_compliance: Compliance | None = None
    limit_margin: float = 0.0
    armature: float = 0.0
    look: TendonLook | None = None
    stiffness_terms: tuple[float, float] = (0.0, 0.0)

    def check(self) -> None:
        """Raise `DescriptionError` unless the path and the numbers have a meaning."""
        if not self.path:
            raise self._error("its path is empty")
        has_joints = any(part.kind in _OF_JOINTS for part in self.path)
        if has_joints and not all(part.kind in _OF_JOINTS for part in self.path):
            raise self._error("its path is over joints, or through sites, not both")
        if self.path[0].kind is PathKind.CRANK:
            if [part.kind for part in self.path] != [PathKind.CRANK, PathKind.SITE] or self.path[
                0
            ].size <= 0.0:
                raise self._error("a slider needs a rod and one site after it")
        elif not has_joints:
            self._check_branches()
        for name in ("stiffness", "damping", "friction", "armature"):
            if not 0.0 <= getattr(self, name) < inf:
                raise self._error(f"its {name} must be 0 or more")
        if not all(abs(term) < inf for term in self.stiffness_terms):
            raise self._error("its stiffness_terms must be finite")
        for name in ("range", "spring_range"):
            bounds = getattr(self, name)
            if bounds is not None and not bounds[0] <= bounds[1]:
                raise self._error(f"its {name} is empty")

    def _check_branches(self) -> None:
        site, pulley = PathKind.SITE, PathKind.PULLEY
        kinds = [pulley, *(part.kind for part in self.path), pulley]
        for before, kind, after in zip(kinds, kinds[1:], kinds[2:], strict=False):
            if kind not in (site, pulley) and (before, after) != (site, site):
                raise self._error("a sphere or cylinder needs a site before and one after it")
            if kind is site and before is pulley and after is pulley:
                raise self._error("a branch of its path needs two sites")
            if kind is pulley and after is pulley:
                raise self._error("after a pulley its path ends")
        for part in self.path:
            if part.kind is not site and not 0.0 < part.size < inf:
                raise self._error("radii and divisors must be greater than 0")

    def _error(self, problem: str) -> DescriptionError:
        return DescriptionError(f"tendon {self.name!r}: {problem}")
