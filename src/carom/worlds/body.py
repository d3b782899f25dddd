"""A body in many worlds."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.engine.presence import change_presence, is_present
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.layouts.magnitudes import UNIT_ROUNDING
from carom.native.gates import alone, in_section
from carom.native.uninterrupted import uninterrupted
from carom.worlds.actuators import ActuatorBatch
from carom.worlds.algorithms.derivatives import DerivativeBatch
from carom.worlds.batch import assign
from carom.worlds.chosen import Mask
from carom.worlds.dynamics import change_dynamics, dynamics_of
from carom.worlds.frames import inertial_frames, link_frames
from carom.worlds.joints import JointBatch
from carom.worlds.sensors import SensorBatch
from carom.worlds.shapes import ShapeBatches


class BodyBatch(JointBatch, ActuatorBatch, DerivativeBatch, SensorBatch):
    """The same body in all worlds; get it from `Worlds[body]`.

    The first axis of arrays is the world, the second joint coordinates or links. Coordinates leave out fixed
    joints, and have four positions and three velocities for a spherical joint, as in `Joints`. Views are the
    state itself: writing to them changes it.

    Attributes:
        name: Name of the robot.
        rows: Its rows in the arrays of the engine.
        joint_names: Names of all joints, in order; joint j moves link j.
        link_names: Names of the links except the base.
        limits: Minimum and maximum positions of movable joints in each world, to which targets are clipped.
    """

    def __repr__(self) -> str:
        return f"<BodyBatch {self.name!r} in {self._count} worlds>"

    # Presence

    @property
    @alone("_scene.call_lock")
    def present(self) -> Mask:
        """In which worlds the body is present, a copy (count,); see `set_present`."""
        return is_present(self._engine.arrays, self.rows)

    @present.setter
    def present(self, value: ArrayLike) -> None:
        self.set_present(value)

    @in_section("_scene.call_lock")
    def set_present(self, present: ArrayLike, where: ArrayLike | None = None) -> None:
        """Let the body come or go in each world, or in some.

        Where it is absent, it does not move, nothing touches or sees it, and constraints on it do nothing;
        the others move bit for bit as in a world made without it. Its coordinates and velocities stay as they
        are and can be set; forces on it are lost. Sleeping bodies wake where it comes or goes.

        Args:
            present: Whether it is present: one value, or one for each of the n worlds chosen, (n,).
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: The number of values differs from that of the worlds chosen, the worlds are on a GPU,
                the body is soft, or a soft body is anchored to it.
        """
        engine = self._engine
        if not engine.allows_absence:
            raise ValueError("bodies cannot be absent in worlds on a GPU yet; use device='cpu'")
        worlds = self._chosen(where)
        wanted = worlds.values(np.asarray(present, dtype=bool), (), "present") != 0.0
        change_presence(engine.arrays, engine.contact_arrays, self.rows, worlds.numbers, wanted)
        engine.activity_changed()

    # Nodes of soft bodies

    @property
    def nodes(self) -> Array:
        """Positions of the nodes of a soft body in world axes [m], a view (count, nodes, 3)."""
        return self._state["node_position"][:, self._nodes]

    @property
    def node_velocities(self) -> Array:
        """Velocities of these nodes [m/s], a view (count, nodes, 3)."""
        return self._state["node_velocity"][:, self._nodes]

    @property
    def node_forces(self) -> Array:
        """Forces that act on these nodes in the next step and are cleared by it [N], a view."""
        return self._state["node_force"][:, self._nodes]

    # Base and links

    @property
    def id(self) -> int:
        """Number of the body in each world."""
        return self._body.id

    @property
    @alone("_scene.call_lock")
    def pose(self) -> Array:
        """World poses of the base's link frame, position [m] and quaternion (x, y, z, w): a copy (count, 7).

        Setting it moves the body, with its velocities as they are; one pose, (7,), is for all worlds.
        """
        poses = np.asarray(self._take(self.base_poses))
        return link_frames(poses[:, np.newaxis], [self._body.spec.base])[:, 0]

    @pose.setter
    def pose(self, value: ArrayLike) -> None:
        self.set_pose(value)

    @alone("_scene.call_lock")
    def set_pose(self, poses: ArrayLike, where: ArrayLike | None = None) -> None:
        """Put the base's link frame somewhere, in all worlds or in some; velocities do not change.

        Args:
            poses: Position [m] and quaternion (x, y, z, w), normalised here: (7,), or (n, 7) for the n worlds
                chosen.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or a quaternion is 0.
        """
        worlds = self._chosen(where)
        wanted = worlds.values(np.asarray(self._take(poses)), (BASE_POSITIONS,), "poses")
        base = [self._body.spec.base]
        inertial = inertial_frames(wanted[:, np.newaxis], base)[:, 0]
        # What is written back as it was read changes nothing, not even in the last digit.
        present = np.asarray(self._take(self.base_poses))[worlds.numbers]
        same = (wanted == link_frames(present[:, np.newaxis], base)[:, 0]).all(axis=1, keepdims=True)
        inertial = np.where(same, present, inertial)
        self.set_base_poses(inertial[:, :3], inertial[:, 3:], where)

    @property
    def base_poses(self) -> Array:
        """Poses of the base's inertial frame, a view (count, 7): position [m] and quaternion (x, y, z, w).

        `pose` is of the link frame.

        Quaternions written here must have unit length; `set_base_poses` normalises them.
        """
        first = self._body.first_position
        return self._state["position"][:, first : first + BASE_POSITIONS]

    @alone("_scene.call_lock")
    def set_base_poses(
        self,
        positions: ArrayLike,
        orientations: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        where: ArrayLike | None = None,
    ) -> None:
        """Set the pose of the base's inertial frame; velocities do not change.

        Args:
            positions: [m], (3,) or (n, 3) for the n worlds chosen.
            orientations: Quaternions (x, y, z, w), (4,) or (n, 4); normalised here.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or a quaternion is 0.
        """
        worlds = self._chosen(where)
        position = worlds.values(np.asarray(self._take(positions)), (3,), "positions")
        turn = worlds.values(np.asarray(self._take(orientations)), (4,), "orientations")
        squared = np.square(turn).sum(axis=1, keepdims=True)
        if not squared.all():
            raise ValueError("orientations must be quaternions other than 0")
        # A pose that was read and is written back must not change in the last digit, as in a single world.
        scale = np.where(abs(squared - 1.0) < UNIT_ROUNDING, 1.0, 1.0 / np.sqrt(squared))
        poses = np.concatenate([position, turn * scale], axis=1)
        self._put_base_poses(worlds.rows, poses)

    def _put_base_poses(self, rows: slice | np.ndarray, poses: np.ndarray) -> None:
        with uninterrupted:
            cold = self._engine.contact_arrays.cold_starts(rows)
            assign((self.base_poses, rows, poses), cold)

    @property
    @alone("_scene.call_lock")
    def base_velocities(self) -> Array:
        """Linear velocity of the base's centre of mass [m/s], angular velocity [rad/s]: a copy (count, 6)."""
        first = self._body.first_velocity
        velocity = self._state["dof_velocity"][:, first : first + BASE_VELOCITIES]
        return np.concatenate([velocity[:, 3:], velocity[:, :3]], axis=1)

    @base_velocities.setter
    def base_velocities(self, value: ArrayLike) -> None:
        self.set_base_velocities(value)

    @alone("_scene.call_lock")
    def set_base_velocities(self, velocities: ArrayLike, where: ArrayLike | None = None) -> None:
        """Set linear and angular velocities of the base in world axes.

        Args:
            velocities: (6,) or (n, 6) for the n worlds chosen, ordered as in `base_velocities`.
            where: Which worlds: a mask (count,) or their indices; None for all.
        """
        worlds = self._chosen(where)
        values = worlds.values(self._take(velocities), (BASE_VELOCITIES,), "velocities")
        first = self._body.first_velocity
        turned = np.concatenate([values[:, 3:], values[:, :3]], axis=1)
        # One statement.
        self._state["dof_velocity"][worlds.rows, first : first + BASE_VELOCITIES] = turned

    @property
    @alone("_scene.call_lock")
    def link_poses(self) -> Array:
        """World poses of the link frames, as `Link.pose`, for the present coordinates: (count, links, 7).

        A copy: position of the frame's origin [m] and quaternion (x, y, z, w); the base is not among them.
        """
        return link_frames(self._poses.poses()[:, self._links], self._body.spec.links)

    @property
    @alone("_scene.call_lock")
    def link_inertial_poses(self) -> Array:
        """World poses of the links' inertial frames, as `Link.inertial_pose`: a copy (count, links, 7).

        Position of the centre of mass [m] and quaternion (x, y, z, w), for the present coordinates; the base
        is not among them.
        """
        return self._poses.poses()[:, self._links].copy()

    @property
    @alone("_scene.call_lock")
    def link_velocities(self) -> Array:
        """Linear velocity of the links' centres of mass [m/s], then their angular velocity [rad/s].

        A copy (count, links, 6), in world axes, for the present coordinates.
        """
        return self._poses.velocities()[:, self._links].copy()

    @property
    def stepped_link_poses(self) -> Array:
        """`link_inertial_poses` as `pybullet.getLinkState` has them after a step; a view (count, links, 7).

        They are the poses at the start of the last substep. Reading `link_poses`, `link_inertial_poses`
        or `link_velocities` updates them in all worlds, `update_link_poses` in chosen worlds.
        """
        return self._state["link_pose"][:, self._links]

    @property
    @alone("_scene.call_lock")
    def stepped_link_velocities(self) -> Array:
        """`link_velocities` as `pybullet.getLinkState` has them after a step: a view (count, links, 6).

        They are computed from `stepped_link_poses` and the present velocities of the joints. The next call
        overwrites the same array.
        """
        return self._poses.velocities_at_step()[:, self._links]

    @alone("_scene.call_lock")
    def update_link_poses(self, where: ArrayLike | None = None) -> None:
        """Update `stepped_link_poses` from the coordinates.

        Args:
            where: In which worlds: a mask (count,) or their indices; None for all.
        """
        self._poses.update(self._chosen(where).numbers)

    @alone("_scene.call_lock")
    def apply_forces(
        self,
        link: int | str,
        forces: ArrayLike,
        points: ArrayLike | None = None,
        torques: ArrayLike = 0.0,
        where: ArrayLike | None = None,
    ) -> None:
        """Apply forces to a link in the next step, in addition to other forces.

        Args:
            link: The link by index (-1 is the base) or name.
            forces: [N] in world axes, (n, 3) for the n worlds chosen, or (3,) for all.
            points: Points of application in world axes [m], likewise; None for the centre of mass.
            torques: [N m] in world axes, likewise.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: A shape does not fit, or something is not finite.
        """
        (row,) = self.link_rows(link)
        worlds = self._chosen(where)
        force = worlds.values(self._take(forces), (3,), "forces")
        torque = worlds.values(self._take(torques), (3,), "torques")
        if points is not None:
            place = worlds.values(self._take(points), (3,), "points")
            lever = place - self._poses.poses()[worlds.rows, row, :3]
            torque = torque + np.cross(lever, force)
        wrench = np.concatenate([force, torque], axis=1)
        # One statement.
        self._state["link_wrench"][worlds.rows, row] += wrench

    # Parameters

    @cached_property
    def shapes(self) -> ShapeBatches:
        """The collision shapes, by index or name: `shapes["foot"].friction`."""
        return ShapeBatches(self._body.shapes, self._scene, self._engine)

    @in_section("_scene.call_lock")
    def change_dynamics(
        self, link: int | str, *, where: ArrayLike | None = None, **changes: ArrayLike
    ) -> None:
        """Change inertia, contact or joint parameters of a link, or damping of the whole body, in each world.

        Args:
            link: The link by index (-1 is the base) or name.
            where: Which worlds: a mask (count,) or their indices; None for all.
            **changes: As for `Body.change_dynamics`, each one value for all, or one for each of the n worlds
                chosen (n,): `mass`, `inertia` (n, 3), `lateral_friction`, `rolling_friction`,
                `spinning_friction`, `restitution`, `contact_stiffness`, `contact_damping`, `linear_damping`,
                `angular_damping`, `max_joint_velocity`, `joint_damping`, `joint_armature`, `joint_stiffness`,
                `joint_spring_reference` (n, 4 for a spherical joint), `joint_friction` of a joint that has
                some, `joint_lower_limit`, `joint_upper_limit`. A `mass` without `inertia` scales the inertia
                that the link has in the original world in proportion, as if its density changed. Where a
                lower limit is greater than the upper one, the joint has no limits.

        Raises:
            ValueError: A number is out of range, there are not as many values as worlds chosen, or limits are
                set for a joint without limits.
            TypeError: There is no such parameter, or it cannot differ between worlds.
        """
        change_dynamics(self._engine, self._body, self.link_index(link), self._chosen(where), changes)

    @alone("_scene.call_lock")
    def dynamics(self, link: int | str) -> dict[str, Array]:
        """What `change_dynamics` changes of a link, as it is now in each world.

        Args:
            link: The link by index (-1 is the base) or name.

        Returns:
            A copy of each parameter by name, (count,); `inertia` is (count, 3). Those that the link does not
                have are missing: mass and inertia of a fixed base, damping and limits without a joint that
                has some.
        """
        return dynamics_of(self._engine, self._body, self.link_index(link))
