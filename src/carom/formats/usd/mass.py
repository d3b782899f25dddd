"""`MassAPI`: mass and inertia of a rigid body, stated or from the volumes of its colliders."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from carom.description import (
    ConvexHull,
    Geometry,
    Inertial,
    Pose,
    TriangleMesh,
)
from carom.description.transform import rotation_matrix
from carom.formats.mjcf.compiled.shapes.mesh_mass import mass_enclosed
from carom.formats.robot.link import MASSLESS
from carom.formats.usd.exact import numbers
from carom.formats.usd.stage import Matrix, Stage

_LEAST_VOLUME = 1e-18
_WATER = 1000.0
"""Density where none is stated [kg/m³]."""
_REACH = 0.1
"""Radius of the ball whose inertia a body has that states none and has no volume [m]."""


@dataclass(frozen=True, eq=False, slots=True)
class Solid:
    """A collider of a body, as it counts for its mass.

    Attributes:
        prim: The collider.
        pieces: Its shapes with their poses in the frame of the body.
        density: That of its physics material; 0 for none.
        scale: Of its frame, by which its own centre of mass is multiplied.
        pose: Its frame in that of the body.
    """

    prim: Any
    pieces: list[tuple[Geometry, Pose]]
    density: float
    scale: Matrix
    pose: Pose


Moments = tuple[float, Matrix, Matrix]
"""Mass or volume, its centre, and the inertia about that centre for each unit."""


def read_inertial(stage: Stage, prim: Any, scale: Matrix, solids: list[Solid]) -> Inertial:
    """Mass and inertia of a body; raises `DescriptionError` if a number has no meaning.

    What is stated of the body counts before what follows from its colliders: their masses, else densities of
    the collider, of the body, of the material, else that of water.
    """
    stated = _Stated(stage, prim)
    massless = bool(stage.value(prim, "carom:massless", False))
    if massless and not stated.is_odd:
        return MASSLESS
    found = _together(
        [it for solid in solids if (it := _of_collider(stage, solid, stated.density)) is not None]
    )
    mass = stated.mass or (found[0] if found is not None else 0.0)
    if not mass:
        mass = stage.mass_unit
        stage.leave_out(prim, f"it has {mass:g} kg", "it states no mass, and has no colliders with a volume")
    centre = scale @ stated.centre if stated.centre is not None else None
    if centre is None:
        centre = found[1] if found is not None else np.zeros(3)
    x, y, z = centre.tolist()
    if stated.moments is not None:
        a, b, c = stated.moments
        return Inertial(0.0 if massless else mass, Pose((x, y, z), stated.axes), (a, 0.0, 0.0, b, 0.0, c))
    if found is not None:
        about = found[2]
    else:
        about = np.eye(3) * (0.4 * _REACH * _REACH)
        stage.leave_out(
            prim,
            f"it has the inertia of a ball of {_REACH} m",
            "it states none, and has no colliders with a volume",
        )
    t = (about * mass).tolist()
    return Inertial(mass, Pose((x, y, z)), (t[0][0], t[0][1], t[0][2], t[1][1], t[1][2], t[2][2]))


class _Stated:
    """What a prim says in `MassAPI`; numbers that the schema calls unset are None or 0."""

    def __init__(self, stage: Stage, prim: Any) -> None:
        unit, heavy = stage.unit, stage.mass_unit
        self.mass = self._positive(stage, prim, "mass") * heavy
        self.density = self._positive(stage, prim, "density") * heavy / unit**3
        centre = numbers(stage.value(prim, "physics:centerOfMass", (-np.inf,) * 3))
        self.centre = np.array(centre) if all(map(isfinite, centre)) else None
        moments = numbers(stage.value(prim, "physics:diagonalInertia", (0.0,) * 3))
        self.moments = None
        self.is_odd = is_odd = bool(stage.value(prim, "carom:oddInertia", False))
        if any(moments) or is_odd:
            if (min(moments) < 0.0 and not is_odd) or not all(map(isfinite, moments)):
                raise stage.error(
                    prim, f"physics:diagonalInertia is {tuple(moments)}; expected positive numbers"
                )
            self.moments = [moment * heavy * unit * unit for moment in moments]
        axes = numbers(stage.value(prim, "physics:principalAxes", (0.0,) * 4))
        length = float(np.linalg.norm(axes))
        x, y, z, w = (it / length for it in axes) if length > 0.0 else (0.0, 0.0, 0.0, 1.0)
        self.axes = (x, y, z, w)

    @staticmethod
    def _positive(stage: Stage, prim: Any, name: str) -> float:
        value = stage.number(prim, f"physics:{name}", 0.0)
        if not 0.0 <= value < np.inf:
            raise stage.error(prim, f"physics:{name} is {value:g}; expected a positive number")
        return value


def _of_collider(stage: Stage, solid: Solid, body_density: float) -> Moments | None:
    stated = _Stated(stage, solid.prim)
    volume = _together([it for piece in solid.pieces if (it := _of_piece(stage, *piece)) is not None])
    if volume is None and (not stated.mass or stated.moments is None):
        return None
    density = stated.density or body_density or solid.density or _WATER
    mass = stated.mass or density * (volume[0] if volume is not None else 0.0)
    centre, about = (volume[1], volume[2]) if volume is not None else (np.zeros(3), np.zeros((3, 3)))
    turn = np.array(rotation_matrix(solid.pose.orientation))
    if stated.centre is not None:
        centre = np.array(solid.pose.position) + turn @ (solid.scale @ stated.centre)
    if stated.moments is not None:
        axes = turn @ np.array(rotation_matrix(stated.axes))
        about = axes @ np.diag(stated.moments) @ axes.T / mass
    return mass, centre, about


def _together(parts: list[Moments]) -> Moments | None:
    """Several parts as one; None if they have no mass."""
    total = sum(mass for mass, _, _ in parts)
    if not total > 0.0:
        return None
    centre = sum((mass * middle for mass, middle, _ in parts), np.zeros(3)) / total
    about = np.zeros((3, 3))
    for mass, middle, own in parts:
        arm = middle - centre
        about += mass * (own + np.eye(3) * (arm @ arm) - np.outer(arm, arm))
    return total, centre, about / total


def _of_piece(stage: Stage, geometry: Geometry, pose: Pose) -> Moments | None:
    """Volume, centre and inertia of a shape; None for what encloses no volume."""
    found = geometry.solid()
    turn, place = np.array(rotation_matrix(pose.orientation)), np.array(pose.position)
    if found is not None:
        return found.measure, place + turn @ found.centre, turn @ found.tensor @ turn.T
    if isinstance(geometry, ConvexHull):
        points, triangles = stage.solids.hull(geometry.points)
    elif isinstance(geometry, TriangleMesh):
        points, triangles = geometry.vertices, geometry.triangles
    else:
        return None
    enclosed = mass_enclosed((points @ turn.T + place)[triangles], _LEAST_VOLUME)
    return None if enclosed is None else (enclosed.measure, enclosed.centre, enclosed.tensor)
