"""Joint forces as linear functions of masses, first moments and inertias."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.questions import sweep_question
from carom.algorithms.sweeps import sweeps_of
from carom.checks import Array
from carom.description.transform import rotation_matrix
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import INERTIAL_PARAMETERS
from carom.model.body_spec import BASE
from carom.native.gates import gated
from carom.native.kernels import regressor_kernel
from carom.native.products import product

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


_REGRESSOR = sweep_question(
    regressor_kernel,
    lambda sweeps: sweeps.dofs * int(INERTIAL_PARAMETERS) * sweeps.links,
    lambda answer, of: [answer.reshape(of.dofs, int(INERTIAL_PARAMETERS) * of.links)],
    lambda sweeps: sweeps.links,
)


def joint_torque_regressor(
    body: Body, positions: Numbers, velocities: Numbers, accelerations: Numbers
) -> Array:
    """The matrix Y with forces = Y p, for the inertial parameters p of all links.

    Each column is the derivative of the forces by a parameter. The forces are those of `inverse_dynamics`
    without armature, in the order of the velocities: those of a free base are torque before force. The
    derivative by the armature of a joint is its acceleration, by its damping its rate. Accelerations of
    `forward_dynamics` have the derivatives -M⁻¹ Y, with Y for these accelerations.

    Args:
        body: The body.
        positions: As in `inverse_dynamics_derivatives`.
        velocities: Likewise.
        accelerations: Likewise.

    Returns:
        Matrix (dofs, 10 (1 + joints)): ten columns for the base, then for each link, in the order of
            `inertial_parameters`.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the entries overflow.
    """
    return _REGRESSOR(body, positions, velocities, accelerations)


@gated("world.call_lock")
def joint_torque_regressors(
    body: Body, positions: np.ndarray, velocities: np.ndarray, accelerations: np.ndarray
) -> Array:
    """As `joint_torque_regressor`, at N states in one call.

    Args:
        body: The body.
        positions: (N, coordinates), for a free body after position and quaternion of the base.
        velocities: (N, dofs).
        accelerations: (N, dofs).

    Returns:
        (N, dofs, 10 (1 + joints)).

    Raises:
        ValueError: The entries overflow.
    """
    sweeps = sweeps_of(body)
    width = int(INERTIAL_PARAMETERS) * sweeps.links
    questions = sweep_questions(body, positions, velocities, accelerations)
    answers = sweeps.answers(regressor_kernel, sweeps.dofs * width, sweeps.links, questions=questions)
    return answers.reshape(len(positions), sweeps.dofs, width)


def sweep_questions(
    body: Body, positions: np.ndarray, velocities: np.ndarray, accelerations: np.ndarray
) -> np.ndarray:
    """Questions for `Sweeps.answers` about N states, as `joint_torque_regressors` has them."""
    gravity = body.world.parameters.gravity
    first = body.first_position
    held = body.world.position[first : first + BASE_POSITIONS] if body.fixed_base else ()
    same = np.ones((len(positions), 1)) * np.concatenate([gravity, held])
    return np.concatenate([same, positions, velocities, accelerations], axis=1)


@gated("world.call_lock")
def inertial_parameters(body: Body) -> Array:
    """Inertial parameters of the base and all links, (1 + joints, 10), about and along their link frames.

    They are mass [kg], mass times centre of mass x, y, z [kg m], and inertia xx, xy, yy, xz, yz, zz about the
    frame's origin [kg m²].
    """
    found = np.zeros((1 + body.joint_count, int(INERTIAL_PARAMETERS)))
    for link in range(BASE, body.joint_count):
        frame, dynamics = body.link_inertial_frame(link), body.dynamics(link)
        turn, centre = np.array(rotation_matrix(frame.orientation)), np.array(frame.position)
        about_centre = product(turn * np.array(dynamics.inertia), turn.T)
        squares = (centre * centre).sum() * np.eye(3) - np.multiply.outer(centre, centre)
        inertia = about_centre + dynamics.mass * squares
        rows, columns = (0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)
        found[1 + link] = [dynamics.mass, *(dynamics.mass * centre), *inertia[rows, columns]]
    return found
