"""Kinematics and dynamics of a body as methods of it; `carom.algorithms` has these and more as functions."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom.checks import Array
from carom.layouts.codes import BASE_VELOCITIES
from carom.model.body_spec import BASE
from carom.native.gates import gated
from carom.pose import Pose, is_pose, numbers_of, turned
from carom.scene.core.body_core import BodyCore

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.algorithms.inverse_kinematics import InverseKinematicsResult
    from carom.scene.body import Body
    from carom.scene.link import Link


_LIMITS = ("lower", "upper")
_DOUBLE = np.dtype(np.float64)


class BodyAlgorithms(BodyCore):
    """The part of `Body` that computes kinematics and dynamics for states of one's choice.

    Nothing moves. States that are left out are the present ones. Positions are those of the joints; where
    dynamics of a free body is asked for, after position (3) and quaternion (4) of the base's inertial frame.
    Velocities likewise are after angular (3) and linear (3) velocity of the base in its own axes.
    """

    @gated("world.call_lock")
    def inverse_kinematics(
        self,
        links: Link | int | str | Sequence[Link | int | str],
        positions: Any,
        orientations: ArrayLike | None = None,
        **options: Any,
    ) -> InverseKinematicsResult:
        """Joint positions at which links reach target poses, as `carom.algorithms.inverse_kinematics`.

            found = arm.inverse_kinematics("hand", target_pose)
            arm.joints.positions = found.positions

        Args:
            links: A link, its name or index, or several.
            positions: Of one link its target, a position (3,) [m] or a `Pose`, in world axes; of k links
                positions (k, 3), or a list of poses. They are those of link frames.
            orientations: Target orientations of the link frames, quaternions (4,), or (k, 4).
            **options: `lower`, `upper`, `rest`, `ranges`, `damping`, `start` and the others of that function.
                Without `lower` and `upper` the limits of the joints hold; None lifts them.

        Returns:
            The joint positions, `positions`, and what is left of the way to the targets.

        Raises:
            IndexError, KeyError: There is no such link.
            ValueError: Something has the wrong length.
        """
        from carom.algorithms.inverse_kinematics import inverse_kinematics

        numbers, targets, turns = targets_of(links, positions, orientations)
        if np.shape(targets) != (len(numbers), 3):
            what = "the target of one link" if len(numbers) == 1 else f"the targets of {len(numbers)} links"
            wanted = "a Pose or a position (3,)" if len(numbers) == 1 else f"positions ({len(numbers)}, 3)"
            raise ValueError(f"{what} must be {wanted} [m], not {positions!r}")
        if options.keys().isdisjoint(_LIMITS) and all(count < 2 for count in self.velocity_count):
            options.update(zip(_LIMITS, cast("Body", self).joints.limits, strict=True))
        return inverse_kinematics(cast("Body", self), numbers, targets, turns, **options)

    def forward_kinematics(
        self, positions: ArrayLike, links: Sequence[Link | int | str] | None = None
    ) -> Array:
        """World poses of link frames at joint positions of your choice.

        Args:
            positions: Joint positions, (coordinates,).
            links: The links; None for all but the base.

        Returns:
            Position of the frame's origin [m] and quaternion (x, y, z, w): (links, 7).
        """
        frames = _algorithm("forward_kinematics", "link_frames")(self, _numbers(positions))
        return frames[1:] if links is None else frames[[1 + self._link(link) for link in links]]

    def jacobian(
        self,
        link: Link | int | str,
        point: ArrayLike = (0.0, 0.0, 0.0),
        positions: ArrayLike | None = None,
    ) -> tuple[Array, Array]:
        """Linear and angular Jacobian of a point on a link, as `carom.algorithms.jacobian`.

        Args:
            link: The link, its index or name.
            point: Offset from the link frame's origin (for the base: from its centre of mass) along the axes
                of the inertial frame [m].
            positions: Joint positions, (coordinates,).

        Returns:
            Matrices J with velocity = J rates, in axes of the base's inertial frame, each (3, dofs); for a
                free body (3, 6 + dofs), the base first: angular, then linear velocity in its own axes.
        """
        jacobian = _algorithm("jacobian", "jacobian")
        return jacobian(self, self._link(link), _numbers(point), self._joint_positions(positions))

    def mass_matrix(self, positions: ArrayLike | None = None) -> Array:
        """Joint-space inertia matrix, as `carom.algorithms.mass_matrix`; armature is included.

        Args:
            positions: Joint positions, (coordinates,).

        Returns:
            Symmetric matrix (dofs, dofs); for a free body (6 + dofs, 6 + dofs), the base first: angular, then
                linear velocity in its own axes.
        """
        return _algorithm("mass_matrix", "mass_matrix")(self, self._joint_positions(positions))

    @gated("world.call_lock")
    def inverse_dynamics(
        self,
        accelerations: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
    ) -> Array:
        """Joint forces for given accelerations, as `carom.algorithms.inverse_dynamics`.

        Gravity and armature are included; damping, springs, friction and contacts are not. Without arguments
        these are the forces that balance gravity and velocities; of an arm that is fixed
        `arm.joints.torques = arm.inverse_dynamics()`.

        Args:
            accelerations: Derivatives of the velocities, (dofs,) or one number.
            positions: See the class.
            velocities: Likewise.

        Returns:
            [N m or N], (dofs,); for a free body (6 + dofs,), force (3) and torque (3) on the base first.
        """
        rates = self._rates(velocities)
        changes = _spread(accelerations, rates)
        inverse_dynamics = _algorithm("inverse_dynamics", "inverse_dynamics")
        return inverse_dynamics(self, self._state(positions), rates, changes)

    @gated("world.call_lock")
    def forward_dynamics(
        self,
        forces: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
    ) -> Array:
        """Accelerations for given joint forces, as `carom.algorithms.forward_dynamics`, without contacts.

        Args:
            forces: [N m or N], (dofs,) or one number; for a free body torque (3) and force (3) on the base
                come first.
            positions: See the class.
            velocities: Likewise.

        Returns:
            Derivatives of the velocities, (dofs,); for a free body (6 + dofs,), the base first.
        """
        rates = self._rates(velocities)
        given = _spread(forces, rates)
        forward_dynamics = _algorithm("dynamics_derivatives", "forward_dynamics")
        return forward_dynamics(self, self._state(positions), rates, given)

    def _link(self, link: Link | int | str) -> int:
        if type(link) is int and BASE <= link < self.joint_count:
            return link
        return self.link_number(link if isinstance(link, int | str) else link.index)

    def _joint_positions(self, given: ArrayLike | None) -> Array:
        if given is not None:
            return _numbers(given)
        return np.array(self.coordinates()[7:])

    def _state(self, given: ArrayLike | None) -> Array:
        if given is not None:
            return _numbers(given)
        return self._joint_positions(None) if self.fixed_base else np.array(self.coordinates())

    def _rates(self, given: ArrayLike | None) -> Array:
        if given is not None:
            return _numbers(given)
        first, count = self.first_velocity, self.rows.count["dof"]
        present = self.world.velocity[first : first + count].copy()
        if self.fixed_base:
            return present[BASE_VELOCITIES:]
        back = np.array(self.coordinates()[3:7]) * (-1.0, -1.0, -1.0, 1.0)
        present[:3], present[3:6] = turned(back, present[:3]), turned(back, present[3:6])
        return present


@cache
def _algorithm(module: str, name: str) -> Any:
    """A function of `carom.algorithms`, whose modules are loaded when they are first used."""
    return getattr(import_module(f"carom.algorithms.{module}"), name)


def _numbers(given: ArrayLike) -> Array:
    """Numbers as an array of doubles, which is not copied if it is one."""
    if type(given) is np.ndarray and given.dtype is _DOUBLE:
        return given
    return np.asarray(given, dtype=np.float64)


def _spread(given: ArrayLike, rates: Array) -> Array:
    """One number, or one for each rate, as an array like that of the rates."""
    numbers = _numbers(given)
    return numbers if numbers.shape == rates.shape else np.broadcast_to(numbers, rates.shape)


def targets_of(links: Any, positions: Any, orientations: Any) -> tuple[list[int | str], Any, Any]:
    """Links, target positions and orientations, of one link or of several, as lists of them."""
    is_one = isinstance(links, int | str | np.integer) or hasattr(links, "spec")
    several: list[Any] = [links] if is_one else list(links)  # pyright: ignore[reportArgumentType]
    numbers: list[int | str] = [
        link if isinstance(link, int | str) else int(getattr(link, "index", link)) for link in several
    ]
    if not is_one:
        if orientations is None and _are_poses(positions):
            positions, orientations = (
                np.stack(part) for part in zip(*map(numbers_of, positions), strict=True)
            )
            if positions.ndim > 2:
                # Of many worlds, which come first.
                positions, orientations = np.swapaxes(positions, 0, 1), np.swapaxes(orientations, 0, 1)
        return numbers, positions, orientations
    if orientations is None and is_pose(positions):
        positions, orientations = numbers_of(positions)
    where = np.asarray(positions, dtype=np.float64)[..., np.newaxis, :]
    turns = None if orientations is None else np.asarray(orientations, dtype=np.float64)[..., np.newaxis, :]
    return numbers, where, turns


def _are_poses(given: Any) -> bool:
    """Whether something is a list of poses, one for each link."""
    return isinstance(given, list | tuple) and len(given) > 0 and all(isinstance(it, Pose) for it in given)
