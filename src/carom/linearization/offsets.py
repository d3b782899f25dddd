"""Places of joints in their parents as parameters: how forces change with them, and differences of steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import link_motions_of
from carom.algorithms.sweeps import sweeps_of
from carom.layouts.linearization import CONTACT_ROW
from carom.layouts.mechanism import LINK_MOTION
from carom.linearization.inputs import OFFSET_FIELD, OFFSETS, Input
from carom.linearization.spatial import Spatial, decay
from carom.linearization.taken_step import motion_questions
from carom.linearization.turns import cross, inverse, matrix_of, multiplied
from carom.native.kernels import link_motions_kernel

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace
    from carom.native.tables import ArrayTable
    from carom.scene.core.body_core import BodyCore


def offset_direction(body: BodyCore, given: Input) -> np.ndarray:
    """The direction of an offset in the inertial frame of the parent, (3,)."""
    parent = body.spec.links[given.row - body.first_link - 1].parent
    turn = matrix_of(np.array(body.link_inertial_frame(parent).orientation))
    return turn[given.place[1]]


class OffsetForces:
    """Forces of a body in a step by offsets of its joints.

    An offset moves a link and all links after it, without a turn, with the parent. So all of them get the
    same change of velocity and of acceleration, and what their forces do to the joints before them changes
    with their arms.

    Args:
        body: The body.
        taken: The step.
        own: Dofs of the body in the tangent space.
        accelerations: Of these dofs, (n,), those of a free base in world axes.
        spatial: Motion subspaces.
    """

    def __init__(
        self, body: BodyCore, taken: TakenStep, own: slice, accelerations: np.ndarray, spatial: Spatial
    ) -> None:
        self._body, self._spatial = body, spatial
        links = slice(body.first_link, body.first_link + 1 + body.joint_count)
        model = taken.model
        self._masses: np.ndarray = model["link_mass"][links]
        sweeps = sweeps_of(body)
        question = motion_questions(body, taken, own, accelerations[None])
        answer = sweeps.answers(
            link_motions_kernel, int(LINK_MOTION) * sweeps.links, sweeps.links, questions=question
        )[0]
        motions = link_motions_of(answer, list(range(-1, body.joint_count)))
        self._spin, self._twist = motions.angular_velocities, motions.angular_accelerations
        frames = [body.link_inertial_frame(link) for link in range(-1, body.joint_count)]
        local = multiplied(
            taken.link_pose[links, 3:], inverse(np.array([frame.orientation for frame in frames]))
        )
        arms = np.array([frame.position for frame in frames])
        arms = (matrix_of(local) @ arms[:, :, None])[:, :, 0]
        self._parents = matrix_of(taken.link_pose[links, 3:])
        # Forces that the motion of the links takes, less those applied to them.
        carried = cross(self._twist, arms) + cross(self._spin, cross(self._spin, arms))
        pulled = (1.0 - model["link_gravity_compensation"][links])[:, None] * taken.gravity
        forces = self._masses[:, None] * (motions.linear_accelerations + carried - pulled)
        speed = motions.linear_velocities + cross(self._spin, arms)
        rate, slope = decay(float(model["tree_linear_damping"][body.rows.tree]), speed)
        forces += (self._masses * rate)[:, None] * speed - taken.link_wrench[links, :3]
        self._forces = forces
        dragged = rate[:, None, None] * np.eye(3) + speed[:, :, None] * slope[:, None]
        self._drag = self._masses[:, None, None] * dragged
        self._after = _links_after(body)

    def derivative(self, given: Input) -> np.ndarray:
        """Generalized forces, less those that the motion takes, by an offset, (n,)."""
        link = given.row - self._body.first_link
        parent = self._body.spec.links[link - 1].parent + 1
        direction = self._parents[parent] @ offset_direction(self._body, given)
        spin, members = self._spin[parent], self._after[link]
        moved = cross(spin, direction)
        pushed = cross(self._twist[parent], direction) + cross(spin, moved)
        spatial = self._spatial
        total = np.zeros(len(spatial.angular))
        for member in members:
            force = self._masses[member] * pushed + self._drag[member] @ moved
            about = spatial.linear + cross(spatial.angular, spatial.centres[member])
            total -= spatial.moves[member] * (about @ force)
        moment = cross(direction, self._forces[members].sum(axis=0))
        return total - spatial.moves[parent] * (spatial.angular @ moment)


def _links_after(body: BodyCore) -> dict[int, list[int]]:
    """Each link and all links after it, by rows in the body."""
    found: dict[int, list[int]] = {row: [row] for row in range(1, 1 + body.joint_count)}
    for row in range(1, 1 + body.joint_count):
        before = body.spec.links[row - 1].parent + 1
        while before > 0:
            found[before].append(row)
            before = body.spec.links[before - 1].parent + 1
    return found


def refuse_rows(
    space: TangentSpace, inputs: Sequence[Input], kinds: np.ndarray, jacobian: np.ndarray
) -> None:
    """Refuse offsets of bodies that rows between links push, whose points move with them.

    Args:
        space: The tangent space.
        inputs: Controls and parameters.
        kinds: What the rows of a step are of, (rows,).
        jacobian: Their Jacobian, (rows, n).

    Raises:
        NotImplementedError: There is one.
    """
    pushed: np.ndarray = np.any(jacobian[kinds >= CONTACT_ROW], axis=0)
    for body, (first, size) in zip(space.bodies, space.places, strict=True):
        rows = range(body.first_link, body.first_link + 1 + body.joint_count)
        if np.any(pushed[first : first + size]) and any(
            it.kind == OFFSETS and it.row in rows for it in inputs
        ):
            raise NotImplementedError(
                f"offsets of {body.name!r} have no exact derivatives where it touches or is held: "
                'use method="differences"'
            )


def shift_offset(model: ArrayTable, body: BodyCore, given: Input, change: float) -> None:
    """Change an offset in the model of copies of a world, which share it."""
    model.numpy[OFFSET_FIELD][given.row] += change * offset_direction(body, given)
    model.written(OFFSET_FIELD)
