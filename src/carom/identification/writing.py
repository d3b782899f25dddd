"""Reading and setting parameters of a world, which `World.linearize` names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.linearization.inputs import Input
from carom.linearization.tangent import TangentSpace
from carom.scene.joint_terms.friction import set_friction

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore
    from carom.world.world import World

_JOINT_TERMS = {"damping": "joint_damping", "armature": "joint_armature", "stiffness": "joint_stiffness"}
_LINK_TERMS = {"masses": "mass", "friction": "lateral_friction"}


def _table(world: World, given: Input) -> np.ndarray:
    if given.table == "shapes":
        return world.contact_arrays.shapes.table.numpy[given.field]
    tables = world.arrays.state if given.table == "state" else world.arrays.model
    return tables.numpy[given.field]


def read_value(world: World, given: Input) -> float:
    """The present value of a parameter."""
    return float(_table(world, given)[(0, *given.place)]) / given.scale


def write_value(world: World, space: TangentSpace, given: Input, value: float) -> None:
    """Set a parameter of a world."""
    if given.kind in _JOINT_TERMS:
        body, joint = joint_of(space, int(space.dofs[given.row]))
        world.bodies[body.id].change_dynamics(joint, **{_JOINT_TERMS[given.kind]: value})
    elif given.kind == "joint_friction":
        set_friction(*joint_of(space, int(space.dofs[given.row])), value)
    elif given.kind in _LINK_TERMS:
        body, link = _link_of(world, given.row)
        kept = {"inertia": body.dynamics(link).inertia} if given.kind == "masses" else {}
        body.change_dynamics(link, **{_LINK_TERMS[given.kind]: value}, **kept)
    elif given.kind == "inertias":
        body, link = _link_of(world, given.row)
        moments = list(body.dynamics(link).inertia)
        moments[given.place[1]] = value
        body.change_dynamics(link, inertia=tuple(moments))
    else:
        for place in given.places():
            _table(world, given)[(0, *place)] = given.scale * value


def joint_of(space: TangentSpace, row: int) -> tuple[BodyCore, int]:
    """The body and the index of the joint with a row of `World.velocity`."""
    for body in space.bodies:
        for joint, (first, count) in enumerate(zip(body.velocity_index, body.velocity_count, strict=True)):
            if first <= row < first + count:
                return body, joint
    raise ValueError(f"no joint has the velocity {row}")


def _link_of(world: World, row: int) -> tuple[Body, int]:
    for body in world.bodies.values():
        if 0 <= row - body.first_link <= body.joint_count:
            return body, row - body.first_link - 1
    raise ValueError(f"no link has the row {row}")


def with_friction(body: Body, smallest: float) -> None:
    """Give joints without friction a tiny one, so that the engine has parameters for it."""
    for joint in body.joints.movable:
        if joint.friction_loss == 0.0:
            joint.friction_loss = smallest
