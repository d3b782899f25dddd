"""Forces on links as functions of a motion: what is applied to links, and what sensors of forces show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.algorithms.answers import link_derivatives_of, link_motions_of
from carom.algorithms.forward_kinematics import many_link_frames
from carom.algorithms.regressor import sweep_questions
from carom.algorithms.sweeps import sweeps_of
from carom.checks import Array
from carom.description.sensor import SensorKind, SensorObject, SensorSpec
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import INERTIAL_PARAMETERS, LINK_MOTION
from carom.linearization.turns import cross_matrix, matrix_of
from carom.native.kernels import link_derivatives_kernel, link_motions_kernel

if TYPE_CHECKING:
    from carom.scene.body import Body

OF_LOADS = (SensorKind.FORCE, SensorKind.TORQUE)
_TEN = int(INERTIAL_PARAMETERS)


class States(NamedTuple):
    """States of a body and its accelerations, N of each, as `joint_torque_regressors` has them."""

    positions: Array
    velocities: Array
    accelerations: Array


def joint_forces_of(body: Body, states: States, forces: Mapping[int, Array]) -> Array:
    """Generalized forces (N, dofs) of forces and torques (N, 6) on links, at their frames' origins.

    Args:
        body: The body.
        states: Its states.
        forces: By the index of the link, -1 for the base: forces [N] and torques [N m] in world axes.
    """
    sweeps, questions = sweeps_of(body), sweep_questions(body, *states)
    found = np.zeros(states.velocities.shape)
    for link, wrenches in forces.items():
        answers = sweeps.answers(link_derivatives_kernel, 4 * 6 * sweeps.dofs, 1 + link, questions=questions)
        found += np.einsum("nij,ni->nj", link_derivatives_of(answers, sweeps.dofs).dv_dv, wrenches)
    return found


class LinkLoads:
    """What the joints of a body transmit in a motion, as linear functions of inertial parameters.

    Args:
        body: The body.
        states: Its states.
    """

    def __init__(self, body: Body, states: States) -> None:
        self._body = body
        sweeps, links = sweeps_of(body), range(-1, body.joint_count)
        answers = sweeps.answers(
            *(link_motions_kernel, int(LINK_MOTION) * sweeps.links, sweeps.links),
            questions=sweep_questions(body, *states),
        )
        motion = link_motions_of(answers, list(links))
        self._places, self._turns = _poses(body, states.positions)
        falling = motion.linear_accelerations - np.array(body.world.parameters.gravity)
        back = np.swapaxes(self._turns, -1, -2)
        self._pulls, self._rates, self._changes = (
            (back @ it[..., None])[..., 0]
            for it in (falling, motion.angular_velocities, motion.angular_accelerations)
        )

    def shown(self, sensor: SensorSpec, forces: Mapping[int, Array]) -> tuple[Array, Array]:
        """What a sensor of force or torque shows: what is applied to links adds to it, and parameters do.

        Args:
            sensor: The sensor, whose object is a site.
            forces: As in `joint_forces_of`.

        Returns:
            What it would show without masses (N, 3), and derivatives by the inertial parameters of all links,
                in the order of `inertial_parameters`, (N, 3, 10 (1 + joints)).

        Raises:
            ValueError: It has no such site, or that is on the base.
        """
        body = self._body
        site = next((it for it in body.spec.sites if it.name == sensor.object), None)
        if site is None or sensor.object_type is not SensorObject.SITE or site.link < 0:
            raise ValueError(f"sensor {sensor.name!r} is not at a site of a link with a joint")
        count = len(self._places)
        turn = self._turns[:, 1 + site.link] @ matrix_of(np.array(site.pose.orientation))
        origin = self._places[:, 1 + site.link] + self._turns[:, 1 + site.link] @ np.array(site.pose.position)
        design = np.zeros((count, 3, _TEN * (1 + body.joint_count)))
        applied = np.zeros((count, 3))
        torque = sensor.kind is SensorKind.TORQUE
        for link in _subtree(body, site.link):
            row = 1 + link
            arm = cross_matrix(self._places[:, row] - origin)
            force, moment = (self._turns[:, row] @ it for it in self._regressors(row))
            design[:, :, _TEN * row : _TEN * (row + 1)] = moment + arm @ force if torque else force
            if link in forces:
                pushed = forces[link]
                lever = (arm @ pushed[:, :3, None])[..., 0]
                applied -= pushed[:, 3:] + lever if torque else pushed[:, :3]
        back = np.swapaxes(turn, 1, 2)
        return (back @ applied[..., None])[..., 0], back @ design

    def _regressors(self, row: int) -> tuple[Array, Array]:
        """Force and torque about the origin that a link needs, in its axes, by its parameters, (N, 3, 10)."""
        pull, rate, change = self._pulls[:, row], self._rates[:, row], self._changes[:, row]
        spin = cross_matrix(rate)
        force, moment = np.zeros((2, len(pull), 3, _TEN))
        force[:, :, 0] = pull
        force[:, :, 1:4] = cross_matrix(change) + spin @ spin
        moment[:, :, 1:4] = -cross_matrix(pull)
        moment[:, :, 4:] = _of_inertia(change) + spin @ _of_inertia(rate)
        return force, moment


def _of_inertia(vectors: Array) -> Array:
    """Matrices (N, 3, 6) by which inertias xx, xy, yy, xz, yz, zz become products with vectors (N, 3)."""
    found = np.zeros((len(vectors), 3, 6))
    x, y, z = vectors.T
    found[:, 0, 0], found[:, 0, 1], found[:, 0, 3] = x, y, z
    found[:, 1, 1], found[:, 1, 2], found[:, 1, 4] = x, y, z
    found[:, 2, 3], found[:, 2, 4], found[:, 2, 5] = x, y, z
    return found


def _subtree(body: Body, link: int) -> list[int]:
    """A link and all after it."""
    found = [link]
    for other in range(link + 1, body.joint_count):
        if body.spec.links[other].parent in found:
            found.append(other)
    return found


def _poses(body: Body, positions: Array) -> tuple[Array, Array]:
    """Origins (N, links, 3) of the link frames in world axes, that of the base first, and their turns."""
    free = 0 if body.fixed_base else int(BASE_POSITIONS)
    poses = many_link_frames(body, positions[:, free:], positions[:, :free] if free else None)
    return poses[..., :3], matrix_of(poses[..., 3:])
