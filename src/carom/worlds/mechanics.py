"""Kinematics and dynamics of a body in many worlds: the part of `BodyBatch` that is about algorithms."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms.inverse_kinematics import (
    DEFAULT_DAMPING,
    DEFAULT_ITERATIONS,
    DEFAULT_THRESHOLD,
    MIN_DAMPING,
)
from carom.checks import Array
from carom.description.transform import conjugate, rotate
from carom.layouts.chain import DAMPED, NULL_SPACE, SELECTIVE
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.native.gates import gated
from carom.pose import product
from carom.scene.core.body_algorithms import targets_of
from carom.worlds.algorithms.mechanics import MechanicsBatch
from carom.worlds.algorithms.poses import PoseBatch
from carom.worlds.algorithms.searches import InverseKinematicsBatch, Searcher, SearchOptions
from carom.worlds.batch import AnyLink, Batch
from carom.worlds.chosen import Chosen, Where
from carom.worlds.frames import link_frames


class AlgorithmBatch(Batch):
    """The part of `BodyBatch` that computes kinematics and dynamics for states of one's choice.

    Everything is computed on the processor, in one native call on each thread, and is the same, bit for bit,
    for any number of threads.
    """

    @gated("_scene.call_lock")
    def forward_kinematics(
        self,
        positions: ArrayLike,
        links: Sequence[AnyLink] | None = None,
        where: Where | None = None,
    ) -> Array:
        """World poses of link frames at joint positions of your choice; the bodies do not move.

        Args:
            positions: Joint positions, (n, coordinates) for the n worlds chosen, or (coordinates,) for all.
            links: The links by index (-1 is the base) or name; None for all but the base.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Returns:
            Position of the frame's origin [m] and quaternion (x, y, z, w), as `link_poses`: (n, links, 7).
        """
        worlds = self._chosen(where)
        poses = self._find_poses(self._bases(worlds), self._joints(worlds, positions))
        body = self._body
        numbers = range(body.joint_count) if links is None else [self._link_index(link) for link in links]
        specs = [body.spec.base if link < 0 else body.spec.links[link] for link in numbers]
        return link_frames(poses[:, [1 + link for link in numbers]], specs)

    @gated("_scene.call_lock")
    def jacobian(
        self,
        link: AnyLink,
        point: ArrayLike = (0.0, 0.0, 0.0),
        positions: ArrayLike | None = None,
        where: Where | None = None,
    ) -> tuple[Array, Array]:
        """Linear and angular Jacobians of a point on a link, as `carom.algorithms.jacobian`.

        Args:
            link: The link by index (-1 is the base) or name.
            point: Offset from the link frame's origin (for the base: from its centre of mass) along the axes
                of the inertial frame [m], (n, 3) for the n worlds chosen, or (3,) for all.
            positions: Joint positions, (n, coordinates) or (coordinates,); None for the present ones.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Returns:
            Matrices J with velocity = J rates, in axes of the base's inertial frame, each (n, 3, dofs); for a
                free body (n, 3, 6 + dofs), the base first: angular, then linear velocity in its own axes.

        Raises:
            ValueError: A shape does not fit, or entries overflow.
        """
        worlds = self._chosen(where)
        points = worlds.values(np.asarray(self._take(point)), (3,), "point")
        found = self._mechanics.jacobians(self._link_index(link), points, self._joints(worlds, positions))
        return found[:, :3], found[:, 3:]

    @gated("_scene.call_lock")
    def mass_matrix(self, positions: ArrayLike | None = None, where: Where | None = None) -> Array:
        """Joint-space inertia matrices, as `carom.algorithms.mass_matrix`; armature is included.

        Args:
            positions: Joint positions, (n, coordinates) for the n worlds chosen, or (coordinates,) for all;
                None for the present ones.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Returns:
            Symmetric matrices (n, dofs, dofs); for a free body (n, 6 + dofs, 6 + dofs), the base first:
                angular, then linear velocity in its own axes.

        Raises:
            ValueError: A shape does not fit, or entries overflow.
        """
        worlds = self._chosen(where)
        return self._mechanics.mass_matrices(self._joints(worlds, positions), worlds.numbers)

    @gated("_scene.call_lock")
    def inverse_dynamics(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Generalized forces for given accelerations, as `carom.algorithms.inverse_dynamics`.

        Gravity of each world and the armature of joints are included; damping, springs, friction and applied
        forces are not. With accelerations of 0 these are the forces that gravity and velocities call for.

        Args:
            accelerations: Derivatives of the velocities, (n, dofs) for the n worlds chosen, (dofs,) or one
                number for all. For a free body 6 + dofs numbers, those of the base first: angular, then
                linear, in its own axes.
            positions: Joint positions, (n, coordinates) or (coordinates,), for a free body after position (3)
                and quaternion (4) of the base's inertial frame; None for the present ones.
            velocities: Joint rates, likewise, for a free body after angular and linear velocity of the base
                in its own axes; None for the present ones.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Returns:
            Joint forces [N m or N], (n, dofs); for a free body (n, 6 + dofs), force (3) and torque (3) on the
                base in its own axes before them.

        Raises:
            ValueError: A shape does not fit, a number is not finite, or forces overflow.
        """
        worlds, dofs = self._chosen(where), self._mechanics.dofs
        bases, free = self._bases(worlds), not self._body.fixed_base
        if positions is None:
            joints = self._joints(worlds, None)
            state = np.concatenate([bases, joints], axis=1) if free else joints
        else:
            length = self._joints(worlds, None).shape[1] + (int(BASE_POSITIONS) if free else 0)
            state = worlds.values(np.asarray(self._take(positions)), (length,), "positions")
        if velocities is None:
            rates = self._present_rates(worlds, bases)
        else:
            rates = worlds.values(np.asarray(self._take(velocities)), (dofs,), "velocities")
        changes = worlds.values(np.asarray(self._take(accelerations)), (dofs,), "accelerations")
        if not dofs:
            return np.zeros((len(worlds), 0))
        gravity = np.asarray(self._engine.parameter("model", "gravity_vector", 0))[worlds.numbers]
        if not free:
            gravity = _turned_back(bases[:, 3:], gravity)
        questions = np.concatenate([gravity, state, rates, changes], axis=1)
        return self._mechanics.forces(questions, worlds.numbers)

    @gated("_scene.call_lock")
    def inverse_kinematics(
        self,
        links: AnyLink | Sequence[AnyLink],
        positions: Any,
        orientations: ArrayLike | None = None,
        *,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        ranges: ArrayLike | None = None,
        rest: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        selective: bool = False,
        start: ArrayLike | None = None,
        in_base_frame: bool = False,
        iterations: int = DEFAULT_ITERATIONS,
        further: int | None = None,
        threshold: float = DEFAULT_THRESHOLD,
        patience: float = 0.0,
        where: Where | None = None,
    ) -> InverseKinematicsBatch:
        """Joint positions at which links reach target poses, as `carom.algorithms.inverse_kinematics`.

        The search of each world starts at its present joint positions, or at `start`: give it the last
        result to follow targets that move (a warm start). The bodies do not move.

        Args:
            links: A link, its index (-1 is the base) or name, or k of them.
            positions: Target positions of the origins of the link frames [m], world axes, (n, k, 3) for the n
                worlds chosen, or (k, 3) for all. Of a single link (n, 3) or (3,), or a `Pose` of it, or of
                each world.
            orientations: Target orientations of the link frames, quaternions (x, y, z, w), of any length
                except 0, (n, k, 4) or (k, 4); of a single link (n, 4) or (4,).
            lower: Lower limits of the result [rad or m], (n, dofs) or (dofs,). A joint whose lower limit is
                above the upper one has no limits.
            upper: Upper limits, likewise.
            ranges: Together with `lower`, `upper` and `rest`: ranges of the joints, likewise.
            rest: Preferred joint positions, likewise.
            damping: Damping of each joint in the search, > 0, likewise; default 0.5.
            selective: Selectively damped least squares, without rest positions.
            start: Joint positions to start from, (n, coordinates) or (coordinates,).
            in_base_frame: Targets are in the inertial frame of the base instead of the world's.
            iterations: Maximum number of steps of PyBullet's method.
            further: Maximum number of steps of the other method; by default the same, with limits at least
                300.
            threshold: Tolerance of distances [m] and angles [rad].
            patience: See `carom.algorithms.inverse_kinematics`.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Returns:
            The joint positions in each world, and what is left of the way to the targets.

        Raises:
            ValueError: A shape does not fit, or something is not finite.
        """
        worlds = self._chosen(where)
        several, positions, orientations = targets_of(links, positions, orientations)
        numbers = [self._link_index(link) for link in several]
        searcher = self._searcher(tuple(numbers))
        number, dofs = len(numbers), (searcher.dofs,)

        def given(value: ArrayLike, inner: tuple[int, ...], name: str, *, finite: bool = True) -> Array:
            return worlds.values(np.asarray(self._take(value)), inner, name, finite=finite)

        bounded = lower is not None and upper is not None
        lowest, highest = (
            given(value if bounded and value is not None else sign * np.inf, dofs, name, finite=False)
            for value, sign, name in ((lower, -1.0, "lower"), (upper, 1.0, "upper"))
        )
        crossed = lowest > highest
        step = SELECTIVE if selective else DAMPED
        resting = bounded and ranges is not None and rest is not None
        if resting:
            step = NULL_SPACE
        bases = np.tile((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), (len(worlds), 1))
        turns = given(
            (0.0, 0.0, 0.0, 1.0) if orientations is None else orientations, (number, 4), "orientations"
        )
        if orientations is not None:
            # The search is for inertial frames, as PyBullet's.
            frames = [self._body.link_inertial_frame(link).orientation for link in numbers]
            turns = product(turns, np.array(frames))
        softness = DEFAULT_DAMPING if damping is None else damping
        questions = {
            "base_pose": bases if in_base_frame else self._bases(worlds),
            "end_position": given(positions, (number, 3), "positions"),
            "end_rotation": turns,
            "start": self._joints(worlds, start, "start"),
            "damping": np.maximum(given(softness, dofs, "damping"), MIN_DAMPING),
            "lower": np.where(crossed, -np.inf, lowest),
            "upper": np.where(crossed, np.inf, highest),
            "range": given(ranges if resting and ranges is not None else 0.0, dofs, "ranges"),
            "rest": given(rest if resting and rest is not None else 0.0, dofs, "rest"),
        }
        more = iterations if further is None else further
        options = (orientations is not None, step, bounded, iterations, more, threshold, patience)
        return searcher(questions, SearchOptions(*options))

    def _bases(self, worlds: Chosen) -> np.ndarray:
        """Present poses of the base's inertial frame, (n, 7)."""
        first = self._body.first_position
        return np.asarray(self._state["position"][worlds.rows, first : first + BASE_POSITIONS])

    def _joints(self, worlds: Chosen, given: ArrayLike | None, name: str = "positions") -> np.ndarray:
        """Joint positions (n, coordinates); None for the present ones."""
        if given is None:
            return np.asarray(self._state["position"][worlds.rows, self._coordinates])
        length = self._coordinates.stop - self._coordinates.start
        return np.asarray(worlds.values(np.asarray(self._take(given)), (length,), name))

    def _present_rates(self, worlds: Chosen, bases: np.ndarray) -> np.ndarray:
        """Present joint rates, for a free body after the velocities of the base in its own axes."""
        velocity = np.asarray(self._state["dof_velocity"])[worlds.rows]
        joints = velocity[:, self._dofs]
        if self._body.fixed_base:
            return joints
        first = self._body.first_velocity
        own = [
            _turned_back(bases[:, 3:], velocity[:, first + k : first + k + 3])
            for k in range(0, int(BASE_VELOCITIES), 3)
        ]
        return np.concatenate([*own, joints], axis=1)

    @cached_property
    def _find_poses(self) -> PoseBatch:
        return PoseBatch(self._body, self._threads)

    @cached_property
    def _mechanics(self) -> MechanicsBatch:
        return MechanicsBatch(self._body, self._engine, self._threads)

    @cached_property
    def _searchers(self) -> dict[tuple[int, ...], Searcher]:
        return {}

    def _searcher(self, links: tuple[int, ...]) -> Searcher:
        if links not in self._searchers:
            self._searchers[links] = Searcher(self._body, links, self._threads)
        return self._searchers[links]


def _turned_back(turns: Array, vectors: Array) -> Array:
    """Vectors (n, 3) in the axes of frames with orientations (n, 4), as `rotate` computes one of them."""
    x, y, z, w = turns.T
    a, b, c = vectors.T
    return np.stack(rotate(conjugate((x, y, z, w)), (a, b, c)), axis=1)
