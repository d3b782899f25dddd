"""Changing mass, centre of mass and inertia of a link at once: where its inertial frame is."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import finite, vector
from carom.description.pose import Pose
from carom.description.transform import rotation_matrix
from carom.layouts.codes import UserConstraintKind
from carom.layouts.flags import LoadFlags
from carom.linearization.turns import rotation_of
from carom.native.change import Change
from carom.native.products import product

if TYPE_CHECKING:
    from carom.scene.body import Body

# Constraints between joints, which do not depend on where links are.
_OF_JOINTS = (UserConstraintKind.GEAR, UserConstraintKind.COUPLING)


def set_link_inertia(body: Body, link: int, mass: float, centre: ArrayLike, inertia: ArrayLike) -> None:
    """Set mass, centre of mass and inertia of a link; its shapes stay where they are.

    The inertial frame of the link turns to the principal axes. Velocities of joints stay as they are.

    Args:
        body: The body.
        link: Index of the link; -1 is the base of a free body.
        mass: [kg].
        centre: Centre of mass in the link frame [m], (3,).
        inertia: About the centre of mass, along the axes of the link frame [kg m²], (3, 3).

    Raises:
        ValueError: A number is not finite, or the mass or a principal moment is not positive.
        NotImplementedError: It is a fixed base; or something is fixed to the inertial frame of a link of the
            body, such as a tendon, an actuator of a tendon or a site, or a constraint.
    """
    _check(body, link)
    middle = vector(centre, 3, "centre")
    matrix = finite(inertia, "inertia")
    if matrix.shape != (3, 3):
        raise ValueError(f"inertia must have shape (3, 3), not {matrix.shape}")
    moments, axes = _principal(matrix, np.array(rotation_matrix(body.link_inertial_frame(link).orientation)))
    if not (0.0 < mass < np.inf and moments.min() > 0.0):
        raise ValueError(f"mass and moments of inertia must be positive, not {mass} and {moments}")
    world, spec = body.world, body.link_spec(link)
    base, velocity = body.pose, body.velocity
    x, y, z = middle.tolist()
    before, frame = spec.inertial_frame, Pose((x, y, z), _quaternion(axes))
    a, b, c = moments.tolist()
    changed = replace(spec, mass=float(mass), inertia=(a, b, c), inertial_frame=frame)
    links = list(body.spec.links)
    if link >= 0:
        links[link] = changed
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    row = body.first_link + 1 + link
    change = Change()
    world.contact_arrays.shapes.replace_pieces(change, row, changed, implicit_cylinder=implicit)
    spec = replace(body.spec, links=links) if link >= 0 else replace(body.spec, base=changed)
    change.set(body, "spec", spec)
    change.set(body, "derived", {})
    change.set(body.dynamics(link), "mass", changed.mass)
    change.set(body.dynamics(link), "inertia", changed.inertia)
    world.arrays.note_inertia(change, row, changed.mass, changed.inertia)
    world.arrays.note_joints(change, body.rows, spec)
    world.contact_arrays.part(change, [row])
    world.note_link_poses(change, body)
    world.change_scene(change)
    change.commit()
    if link < 0:
        # The base is where it was, and moves as it did: its centre of mass is at another place of it.
        arm = rotation_of(base.orientation) @ (np.array(frame.position) - np.array(before.position))
        angular = np.array(velocity.angular)
        body.set_pose(base)
        body.set_velocity(np.array(velocity.linear) + np.cross(angular, arm), angular)


def _check(body: Body, link: int) -> None:
    if not (0 if body.fixed_base else -1) <= link < body.joint_count:
        raise NotImplementedError(f"{body.name!r} has no link {link} whose inertial frame can change")
    spec = body.spec
    tied = any(
        it.kind not in _OF_JOINTS and (body, link) in ((it.parent, it.parent_link), (it.child, it.child_link))
        for it in body.world.user_constraints.all
    )
    fixed_to_it = {
        "tendons": bool(list(body.tendons)),
        "actuators of sites": any(not it.joint for it in spec.actuators),
        "a constraint": tied,
    }
    for what, is_there in fixed_to_it.items():
        if is_there:
            raise NotImplementedError(
                f"{body.name!r} has {what}, so the centre of {body.link_spec(link).name!r} cannot be moved"
            )


def _principal(inertia: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Principal moments, and the axes as columns, a rotation: the present axes if they are principal."""
    along = product(product(axes.T, inertia), axes)
    off = along - np.diag(np.diag(along))
    if np.abs(off).max() <= 1e-12 * np.abs(along).max():
        return np.diag(along).copy(), axes
    moments, found = np.linalg.eigh(0.5 * (inertia + inertia.T))
    if np.linalg.det(found) < 0.0:
        found[:, 0] *= -1.0
    return moments, found


def _quaternion(turn: np.ndarray) -> tuple[float, float, float, float]:
    """The unit quaternion (x, y, z, w) of a rotation, by the eigenvector of Bar-Itzhack's matrix."""
    (a, b, c), (d, e, f), (g, h, i) = turn.tolist()
    matrix = np.array(
        [
            [a - e - i, d + b, g + c, h - f],
            [d + b, e - a - i, h + f, c - g],
            [g + c, h + f, i - a - e, d - b],
            [h - f, c - g, d - b, a + e + i],
        ]
    )
    x, y, z, w = np.linalg.eigh(matrix)[1][:, 3].tolist()
    return (x, y, z, w) if w >= 0.0 else (-x, -y, -z, -w)
