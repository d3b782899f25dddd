"""Why an answer about the dynamics of a body is not finite: which joint, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mechanism import mechanism_of
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

# Inertia left for a joint, when all after it move freely, below this share of its own is rounding.
_SHARE = 1e-12
# A number above this overflows when it is multiplied with others.
_LARGE = 1e60


def not_finite(
    body: BodyCore, positions: Sequence[float] | np.ndarray, *rates: Sequence[float] | np.ndarray
) -> ValueError:
    """An error that says why an answer is not finite; arguments are those of `reason`."""
    return ValueError(f"the answer is not finite: {reason(body, positions, *rates)}")


def reason(
    body: BodyCore, positions: Sequence[float] | np.ndarray, *rates: Sequence[float] | np.ndarray
) -> str:
    """Why an answer is not finite, with the joint.

    Args:
        body: The body.
        positions: Joint positions, for a free body after the position and quaternion of its base.
        rates: Velocities, and then accelerations or forces if there are any, (dofs,) each.
    """
    names = dof_names(body)
    for what, values in zip(("velocity", "acceleration or force"), rates, strict=False):
        sizes = np.abs(np.asarray(values, dtype=float))
        worst = int(np.argmax(sizes)) if len(sizes) else 0
        if len(sizes) and sizes[worst] > _LARGE:
            return f"{what} {float(values[worst]):g} of {names[worst]} of {body.name!r} is too large"
    light = joints_without_inertia(body, positions)
    if light:
        return (
            f"{' and '.join(light)} of {body.name!r} moves nothing with inertia; give the links after it a "
            "mass and moments of inertia, or the joint an armature"
        )
    return f"entries of {body.name!r} overflow"


def joints_without_inertia(body: BodyCore, positions: Sequence[float] | np.ndarray) -> list[str]:
    """Names of joints that move nothing with inertia when all joints after them are free.

    Args:
        body: The body.
        positions: As in `reason`.
    """
    mechanism = mechanism_of(body)
    own = list(positions)[BASE_POSITIONS if mechanism.free else 0 :]
    try:
        matrix = np.array(mechanism.mass_matrix(own)).reshape(mechanism.dofs, mechanism.dofs)
    except ValueError:
        return []
    names, found = dof_names(body), []
    diagonal = matrix.diagonal().copy()
    # Pivots from the ends of the tree to its base are the inertias that its joints feel.
    for dof in range(mechanism.dofs - 1, -1, -1):
        pivot = matrix[dof, dof]
        if not pivot > _SHARE * diagonal[dof]:
            found.append(names[dof])
            continue
        row = matrix[dof, :dof]
        matrix[:dof, :dof] -= np.outer(row, row) / pivot
    return list(dict.fromkeys(reversed(found)))


def dof_names(body: BodyCore) -> list[str]:
    """What each velocity coordinate is of: "joint 'elbow'", or "the base"."""
    names = [] if body.fixed_base else ["the base"] * BASE_VELOCITIES
    for link, count in zip(body.spec.links, body.velocity_count, strict=True):
        names += [f"joint {link.joint_name!r}"] * count
    return names
