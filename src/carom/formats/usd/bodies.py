"""Rigid bodies of a stage as links, and colliders that belong to none."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from carom.description import Collision, Link, Pose, Visual
from carom.description.pose import Vector3
from carom.formats.robot.link import MASSLESS
from carom.formats.usd.exact import numbers
from carom.formats.usd.geometry import is_shape, read_shape
from carom.formats.usd.mass import Solid, read_inertial
from carom.formats.usd.materials import Surface, read_colour, read_surface_of
from carom.formats.usd.stage import Matrix, Stage, homogeneous, rigid


@dataclass(eq=False, slots=True)
class Part:
    """A rigid body of a stage, or a collider that does not move.

    Attributes:
        prim: Its prim.
        pose: Its frame in the world.
        scale: (3, 3): pose · scale is its frame with scale.
        moves: It is simulated or moved by users.
        kinematic: It is moved by users only.
        link: The link made from it.
        colliders: Its colliders.
        looks: Shapes that are seen.
        velocity: Of its origin [m/s].
        angular_velocity: [rad/s].
    """

    prim: Any
    pose: Pose
    scale: Matrix
    moves: bool
    kinematic: bool = False
    link: Link = field(default_factory=lambda: Link(""))
    colliders: list[Any] = field(default_factory=list)
    looks: list[Any] = field(default_factory=list)
    velocity: Vector3 = (0.0, 0.0, 0.0)
    angular_velocity: Vector3 = (0.0, 0.0, 0.0)

    @property
    def path(self) -> str:
        """Path of its prim."""
        return str(self.prim.GetPath())


class Parts:
    """The bodies of a stage, in its order, and then the colliders that do not move.

    Attributes:
        stage: The stage.
        moving: Rigid bodies.
        still: Colliders of none.
    """

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.moving: list[Part] = []
        self.still: list[Part] = []
        self._by_path: dict[str, Part] = {}
        for prim in stage.prims():
            if _is_body(stage, prim):
                self._add(prim, moves=True)
        for prim in stage.prims():
            self._sort(prim)
        for part in (*self.moving, *self.still):
            self._read(part)

    def of(self, prim: Any) -> Part | None:
        """The rigid body that a prim belongs to; None if that is none, or it does not move."""
        for it in self.stage.above(prim):
            if it.HasAPI(self.stage.pxr.UsdPhysics.RigidBodyAPI):
                return self._by_path.get(str(it.GetPath()))
        return None

    def named(self, prim: Any) -> list[Part]:
        """What a prim stands for as something that collides: a body, that of a collider, or all inside it."""
        own = self._by_path.get(str(prim.GetPath()))
        if own is None and is_shape(prim):
            own = self.of(prim)
        if own is not None:
            return [own]
        path = prim.GetPath()
        return [part for part in (*self.moving, *self.still) if part.prim.GetPath().HasPrefix(path)]

    def _add(self, prim: Any, *, moves: bool) -> Part:
        pose, scale = rigid(self.stage.matrix(prim))
        part = Part(prim, pose, scale, moves)
        (self.moving if moves else self.still).append(part)
        if moves:
            self._by_path[part.path] = part
        return part

    def _sort(self, prim: Any) -> None:
        """Give a shape to the body that has it."""
        collides = prim.HasAPI(self.stage.pxr.UsdPhysics.CollisionAPI)
        if collides and not self.stage.value(prim, "physics:collisionEnabled", True):
            collides = False
        if not is_shape(prim):
            if collides:
                self.stage.leave_out(prim, "it does not collide", "this shape is not built", "CollisionAPI")
            return
        owner = self.of(prim)
        if collides:
            owner = owner or self._add(prim, moves=False)
            owner.colliders.append(prim)
        if owner is not None and self._is_seen(prim):
            owner.looks.append(prim)

    def _is_seen(self, prim: Any) -> bool:
        shown = self.stage.pxr.UsdGeom.Imageable(prim)
        for it in self.stage.above(prim):
            for name in ("visibility", "purpose"):
                self.stage.note(it, name)
        return (
            str(shown.ComputePurpose()) in ("default", "render")
            and str(shown.ComputeVisibility()) != "invisible"
        )

    def _read(self, part: Part) -> None:
        stage, name = self.stage, self.stage.name_of(part.prim)
        inwards = np.linalg.inv(homogeneous(part.pose))
        surface: Surface | None = None
        collisions: list[Collision] = []
        solids: list[Solid] = []
        for prim in part.colliders:
            matrix = inwards @ stage.matrix(prim)
            pieces = read_shape(stage, prim, matrix, moves=part.moves)
            own = read_surface_of(stage, prim)
            surface = surface or own
            contact = None if own.contact == surface.contact else own.contact
            collisions += [Collision(it, pose, str(prim.GetName()), contact=contact) for it, pose in pieces]
            pose, scale = rigid(matrix)
            solids.append(Solid(prim, pieces, own.density, scale, pose))
        visuals = [
            Visual(it, pose, str(prim.GetName()), read_colour(stage, prim))
            for prim in part.looks
            for it, pose in read_shape(
                stage, prim, inwards @ stage.matrix(prim), moves=part.moves, looks=True
            )
        ]
        inertial = read_inertial(stage, part.prim, part.scale, solids) if part.moves else MASSLESS
        floats = part.moves and bool(stage.value(part.prim, "physxRigidBody:disableGravity", False))
        part.link = Link(
            name,
            inertial,
            tuple(collisions),
            tuple(visuals),
            (surface or Surface()).contact,
            gravity_compensation=1.0 if floats else 0.0,
        )
        if part.moves:
            self._read_motion(part)

    def _read_motion(self, part: Part) -> None:
        stage, prim = self.stage, part.prim
        part.kinematic = bool(stage.value(prim, "physics:kinematicEnabled", False))
        if stage.value(prim, "physics:startsAsleep", False):
            stage.leave_out(
                prim, "it is awake at once", "bodies fall asleep by their motion", "physics:startsAsleep"
            )
        around = stage.matrix(prim.GetParent())[:3, :3] if not prim.GetParent().IsPseudoRoot() else None
        frame = stage.world_matrix()[:3, :3] if around is None else around
        turn = frame / np.linalg.norm(frame, axis=0)
        linear = np.array(numbers(stage.value(prim, "physics:velocity", (0.0,) * 3)))
        angular = np.radians(numbers(stage.value(prim, "physics:angularVelocity", (0.0,) * 3)))
        x, y, z = (frame @ linear).tolist()
        part.velocity = (x, y, z)
        x, y, z = (turn @ angular).tolist()
        part.angular_velocity = (x, y, z)


def _is_body(stage: Stage, prim: Any) -> bool:
    """Whether a prim is a rigid body that is switched on."""
    if not prim.HasAPI(stage.pxr.UsdPhysics.RigidBodyAPI):
        return False
    return bool(stage.value(prim, "physics:rigidBodyEnabled", True))
