"""Torques of a motion, which are linear in inertial parameters, friction, damping, armature and stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.algorithms.regressor import inertial_parameters, joint_torque_regressors
from carom.checks import Array
from carom.identification.unknowns import SMALL_FRICTION, Unknowns
from carom.identification.writing import read_value
from carom.layouts.codes import BASE_POSITIONS
from carom.linearization.inputs import INERTIAL, PARAMETERS, chosen_inputs

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_TERMS = ("armature", "damping", "stiffness", "joint_friction")


def torque_design(
    world: World, body: Body, unknowns: Unknowns, positions: Array, velocities: Array, accelerations: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Torques (m, n) of a motion at the world's parameters, and their derivatives by what is fitted.

    Args:
        world: A copy of the world.
        body: The body there.
        unknowns: What is fitted, as many as np.
        positions: (m, n), of a free body after position and quaternion of the base.
        velocities: Before each step, likewise after those of the base in its own axes, angular before linear.
        accelerations: Means over each step, likewise.

    Returns:
        Torques (m, n), their derivatives (m, n, np), and which joints have friction, (n,).
    """
    h = world.parameters.substep_time
    after = velocities + h * accelerations
    terms = {
        "armature": accelerations,
        "damping": velocities if body.spec.is_held else after,
        "stiffness": _stretch(world, body, positions) + h * after,
        "joint_friction": np.sign(after),
    }
    count, joints = velocities.shape
    regressors = joint_torque_regressors(body, positions, velocities, accelerations)
    constant = regressors @ inertial_parameters(body).ravel()
    first = unknowns.space.places[unknowns.space.bodies.index(body)][0]
    rubbing = np.zeros(joints, dtype=bool)
    for it in chosen_inputs(world, unknowns.space, PARAMETERS, _TERMS, "parameter"):
        joint = it.row - first
        if 0 <= joint < joints:
            value = read_value(world, it)
            constant[:, joint] += value * terms[it.kind][:, joint]
            rubbing[joint] |= it.kind == "joint_friction" and (
                it.name in unknowns.names or value > SMALL_FRICTION
            )
    design = np.zeros((count, joints, len(unknowns.names)))
    for place, it in enumerate(unknowns.inputs):
        if it is None:
            continue
        if it.kind == INERTIAL:
            link = it.row - body.first_link
            design[:, :, place] = regressors[:, :, 10 * link + it.place[1]]
        else:
            design[:, it.row - first, place] = terms[it.kind][:, it.row - first]
    return constant, design, rubbing


def _stretch(world: World, body: Body, positions: Array) -> Array:
    """By how much springs of joints are stretched, with columns of 0 for a free base, (m, dofs)."""
    rows = [body.position_index[j] for j, count in enumerate(body.velocity_count) if count]
    free = 0 if body.fixed_base else int(BASE_POSITIONS)
    found = positions[:, free:] - world.arrays.model.numpy["position_spring"][0, rows]
    return np.concatenate([np.zeros((len(found), 6 if free else 0)), found], axis=1)


def check_torques(world: World, body: Body, unknowns: Unknowns) -> None:
    """Raise `ValueError` unless torques of the body are linear in what is to be fitted."""
    if any(count > 1 for count in body.velocity_count):
        raise ValueError(
            f"{body.name!r} has spherical or planar joints: torques identify robots with hinges and sliders"
        )
    tree, model = body.rows.tree, world.arrays.model.numpy
    if model["tree_linear_damping"][0, tree] or model["tree_angular_damping"][0, tree]:
        raise ValueError(
            f"air damps {body.name!r}, as in PyBullet: torques are no linear functions of its inertia then; "
            "set linear_damping and angular_damping to 0 by change_dynamics"
        )
    for name, it in zip(unknowns.names, unknowns.inputs, strict=True):
        if it is None or it.kind not in (INERTIAL, *_TERMS):
            raise ValueError(f'{name!r} cannot be fitted to torques: use residuals="prediction"')
