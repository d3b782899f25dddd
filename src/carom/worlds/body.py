"""A body in many worlds."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, OnDevice, finite
from carom.description import JointType
from carom.engine.engine import Engine
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.scene.body import ROUNDING, Body
from carom.scene.joint_motor import Drives
from carom.world.world import World
from carom.worlds.checks import broadcast, choose, world_numbers
from carom.worlds.dynamics import change_dynamics
from carom.worlds.poses import PoseFinder


class BodyBatch:
    """The same body in all worlds; get it from `Worlds[body]`.

    The first axis of arrays is the world, the second joint coordinates or links. Coordinates leave out fixed
    joints, and have four positions and three velocities for a spherical joint, as in `Joints`. Views are the
    state itself: writing to them changes it.

    Attributes:
        name: Name of the robot.
        rows: Its rows in the arrays of the engine.
        joint_names: Names of all joints, in order; joint j moves link j.
        link_names: Names of the links except the base.
        limits: Minimum and maximum positions of movable joints, to which targets are clipped.
    """

    def __init__(self, body: Body, scene: World, engine: Engine) -> None:
        self._body = body
        self._scene = scene
        self._engine = engine
        self._state = engine.arrays.state.numpy
        self._take = engine.take
        self._count = engine.arrays.world_count
        self._poses = PoseFinder(engine, body.rows.tree)
        self.rows = body.rows
        self.name: str = body.name
        self.joint_names: list[str] = [link.joint_name for link in body.spec.links]
        self.link_names: list[str] = [link.name for link in body.spec.links]
        self._base_name = body.spec.base.name
        self._dofs = _following(body.first_velocity + BASE_VELOCITIES, sum(body.velocity_count))
        self._coordinates = _following(body.first_position + BASE_POSITIONS, sum(body.position_count))
        self._links = _following(body.first_link + 1, body.joint_count)
        self._nodes = _following(body.rows.first["node"], body.rows.count["node"])

    def __repr__(self) -> str:
        return f"<BodyBatch {self.name!r} in {self._count} worlds>"

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

    # Joints

    @property
    def joint_positions(self) -> Array:
        """Position coordinates of the joints [rad or m], a view (count, coordinates)."""
        return self._state["position"][:, self._coordinates]

    @joint_positions.setter
    def joint_positions(self, value: ArrayLike) -> None:
        view = self.joint_positions
        view[:] = broadcast(self._take(value), view.shape, "joint_positions")

    @property
    def joint_velocities(self) -> Array:
        """Velocity coordinates of the joints [rad/s or m/s], a view (count, dofs)."""
        return self._state["dof_velocity"][:, self._dofs]

    @joint_velocities.setter
    def joint_velocities(self, value: ArrayLike) -> None:
        view = self.joint_velocities
        view[:] = broadcast(self._take(value), view.shape, "joint_velocities")

    @property
    def joint_torques(self) -> Array:
        """Torques or forces to apply in the next step; a view (count, dofs)."""
        return self._state["dof_torque"][:, self._dofs]

    @property
    def motor_torques(self) -> Array:
        """Torques [N m] or forces [N] of the motors in the last substep, a copy (count, dofs)."""
        return self._state["dof_motor_impulse"][:, self._dofs] / self._scene.parameters.substep_time

    @property
    def limits(self) -> tuple[Array, Array]:
        """Minimum and maximum positions of movable joints, (dofs,); infinite without a limit."""
        return self._body.joints.limits

    def columns(self, joints: list[int | str] | None = None) -> slice | np.ndarray:
        """The columns of `joint_velocities` that belong to some joints with one degree of freedom.

        They have the same columns in `joint_positions` unless a spherical joint comes before them.

        Args:
            joints: Which joints, by index or name; None for all movable joints.

        Returns:
            A slice if they are contiguous, so that indexing gives a view.

        Raises:
            ValueError: A joint has more than one degree of freedom, or none.
        """
        dofs, _ = self._chosen(joints)
        if isinstance(dofs, slice):
            return slice(0, dofs.stop - dofs.start)
        columns = dofs - self._dofs.start
        if len(columns) and (np.diff(columns) == 1).all():
            return slice(int(columns[0]), int(columns[-1]) + 1)
        return columns

    def enable_sensors(self, *joints: int | str) -> None:
        """Switch the force-torque sensors of joints on in all worlds; all joints if none is named."""
        chosen = joints or tuple(range(self._body.joint_count))
        table = self._engine.arrays.model
        model = table.numpy
        for joint in chosen:
            row = self._body.first_link + 1 + choose("joint", self.joint_names, joint)
            model["link_sensor"][row] = 1
        links = slice(self._body.first_link, self._links.stop)
        model["tree_sensor_count"][self.rows.tree] = int(model["link_sensor"][links].sum())
        table.written("link_sensor")
        table.written("tree_sensor_count")

    @property
    def sensor_wrenches(self) -> Array:
        """Force [N] and torque [N m] measured by the joints' sensors in the last substep: (count, joints, 6).

        A view, in the inertial frame of the joint's link; 0 without a sensor.
        """
        return self._state["link_reaction"][:, self._links]

    # Drives

    def set_position_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 0.1,
        velocities: ArrayLike = 0.0,
        velocity_gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        max_velocities: ArrayLike = np.inf,
        joints: list[int | str] | None = None,
    ) -> None:
        """`Joint.set_position_target` for joints in all worlds.

        Args:
            targets: Positions, clipped to the limits: (count, dofs) or a shape that broadcasts to it.
            gains: Share of the position error corrected per substep.
            velocities: Target velocities.
            velocity_gains: Share of the velocity error corrected per substep.
            max_forces: Maximum forces; those of the file by default.
            max_velocities: Maximum velocities of the motors.
            joints: Which joints, by index or name; None for all movable joints.

        Raises:
            ValueError: A joint has more than one degree of freedom, or an argument does not fit.
        """
        dofs, places = self._chosen(joints)
        lower, upper = self.limits
        self._drives(dofs).aim_at_position(
            np.clip(self._numbers(targets), lower[places], upper[places]),
            self._take(velocities),
            self._take(gains),
            self._take(velocity_gains),
            self._forces(max_forces, places),
            self._take(max_velocities),
        )

    def set_velocity_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        joints: list[int | str] | None = None,
    ) -> None:
        """`Joint.set_velocity_target` for joints in all worlds; arguments as for `set_position_targets`."""
        dofs, places = self._chosen(joints)
        forces = self._forces(max_forces, places)
        self._drives(dofs).aim_at_velocity(self._take(targets), self._take(gains), forces)

    def set_springs(
        self,
        targets: ArrayLike,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
        joints: list[int | str] | None = None,
    ) -> None:
        """`Joint.set_spring` for joints in all worlds; arguments as for `set_position_targets`."""
        dofs, places = self._chosen(joints)
        rest, rate = self._take(targets), self._take(velocities)
        gains, forces = (self._take(stiffness), self._take(damping)), self._forces(max_forces, places)
        self._drives(dofs).pull_like_a_spring(rest, rate, *gains, forces)

    def set_torques(self, torques: ArrayLike, joints: list[int | str] | None = None) -> None:
        """`Joint.set_torque` for joints in all worlds: for the next step, replacing those set before.

        Args:
            torques: [N m or N], (count, dofs) or a shape that broadcasts to it.
            joints: Which joints, by index or name; None for all movable joints.
        """
        dofs, places = self._chosen(joints, one_freedom=joints is not None)
        count = len(places) if joints is not None else self._dofs.stop - self._dofs.start
        self._state["dof_torque"][:, dofs] = broadcast(self._take(torques), (self._count, count), "torques")

    def disable_motors(self, joints: list[int | str] | None = None) -> None:
        """Switch off the motors and springs of joints."""
        dofs, _ = self._chosen(joints, one_freedom=joints is not None)
        self._drives(dofs).switch_off()

    # Base and links

    @property
    def base_poses(self) -> Array:
        """Poses of the base's inertial frame, position [m] and quaternion (x, y, z, w); a view (count, 7).

        Quaternions written here must have unit length; `set_base_poses` normalises them.
        """
        first = self._body.first_position
        return self._state["position"][:, first : first + BASE_POSITIONS]

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
        worlds = world_numbers(self._take(where), self._count)
        position = broadcast(np.asarray(self._take(positions)), (len(worlds), 3), "positions")
        turn = broadcast(np.asarray(self._take(orientations)), (len(worlds), 4), "orientations")
        squared = np.square(turn).sum(axis=1, keepdims=True)
        if not squared.all():
            raise ValueError("orientations must be quaternions other than 0")
        # A pose that was read and is written back must not change in the last digit, as in a single world.
        scale = np.where(abs(squared - 1.0) < ROUNDING, 1.0, 1.0 / np.sqrt(squared))
        self.base_poses[worlds] = np.concatenate([position, turn * scale], axis=1)
        self._engine.contact_arrays.forget_warm_start(worlds)

    @property
    def base_velocities(self) -> Array:
        """Linear velocity of the base's centre of mass [m/s], angular velocity [rad/s]: a copy (count, 6)."""
        first = self._body.first_velocity
        velocity = self._state["dof_velocity"][:, first : first + BASE_VELOCITIES]
        return np.concatenate([velocity[:, 3:], velocity[:, :3]], axis=1)

    @base_velocities.setter
    def base_velocities(self, value: ArrayLike) -> None:
        self.set_base_velocities(value)

    def set_base_velocities(self, velocities: ArrayLike, where: ArrayLike | None = None) -> None:
        """Set linear and angular velocities of the base in world axes.

        Args:
            velocities: (6,) or (n, 6) for the n worlds chosen, ordered as in `base_velocities`.
            where: Which worlds: a mask (count,) or their indices; None for all.
        """
        worlds = world_numbers(self._take(where), self._count)
        values = broadcast(self._take(velocities), (len(worlds), BASE_VELOCITIES), "velocities")
        first = self._body.first_velocity
        self._state["dof_velocity"][worlds, first : first + 3] = values[:, 3:]
        self._state["dof_velocity"][worlds, first + 3 : first + BASE_VELOCITIES] = values[:, :3]

    @property
    def link_poses(self) -> Array:
        """World poses of the links' inertial frames, for the present coordinates: a copy (count, links, 7).

        Position of the centre of mass [m] and quaternion (x, y, z, w); the base is not among them.
        """
        return self._poses.poses()[:, self._links].copy()

    @property
    def link_velocities(self) -> Array:
        """Linear velocity of the links' centres of mass [m/s], then their angular velocity [rad/s].

        A copy (count, links, 6), in world axes, for the present coordinates.
        """
        return self._poses.velocities()[:, self._links].copy()

    @property
    def stepped_link_poses(self) -> Array:
        """`link_poses` as `pybullet.getLinkState` has them after a step; a view (count, links, 7).

        They are the poses at the start of the last substep. Reading `link_poses` or `link_velocities`
        updates them in all worlds, `update_link_poses` in chosen worlds.
        """
        return self._state["link_pose"][:, self._links]

    @property
    def stepped_link_velocities(self) -> Array:
        """`link_velocities` as `pybullet.getLinkState` has them after a step: a view (count, links, 6).

        They are computed from `stepped_link_poses` and the present velocities of the joints. The next call
        overwrites the same array.
        """
        return self._poses.velocities_at_step()[:, self._links]

    def update_link_poses(self, where: ArrayLike | None = None) -> None:
        """Update `stepped_link_poses` from the coordinates.

        Args:
            where: In which worlds: a mask (count,) or their indices; None for all.
        """
        self._poses.update(world_numbers(self._take(where), self._count))

    def apply_forces(
        self, link: int | str, forces: ArrayLike, points: ArrayLike | None = None, torques: ArrayLike = 0.0
    ) -> None:
        """Apply forces to a link in the next step, in addition to other forces.

        Args:
            link: The link by index (-1 is the base) or name.
            forces: [N] in world axes, (count, 3) or a shape that broadcasts to it.
            points: Points of application in world axes [m], likewise; None for the centre of mass.
            torques: [N m] in world axes, likewise.
        """
        (row,) = self.link_rows(link)
        force = broadcast(self._take(forces), (self._count, 3), "forces")
        torque = broadcast(self._take(torques), (self._count, 3), "torques")
        if points is not None:
            lever = (
                broadcast(self._take(points), (self._count, 3), "points") - self._poses.poses()[:, row, :3]
            )
            torque = torque + np.cross(lever, force)
        wrench = self._state["link_wrench"][:, row]
        wrench[:, :3] += force
        wrench[:, 3:] += torque

    # Parameters

    def change_dynamics(self, link: int | str, **changes: ArrayLike) -> None:
        """Change inertia, contact or joint parameters of a link, or damping of the whole body, in each world.

        Args:
            link: The link by index (-1 is the base) or name.
            **changes: As for `Body.change_dynamics`, each one value or one for each world: `mass`, `inertia`
                (count, 3), `lateral_friction`, `rolling_friction`, `spinning_friction`, `restitution`,
                `contact_stiffness`, `contact_damping`, `linear_damping`, `angular_damping`,
                `max_joint_velocity`, `joint_damping`, `joint_lower_limit`, `joint_upper_limit`. A `mass`
                without `inertia` sets the inertia of the collision shapes.

        Raises:
            ValueError: A number is out of range, a shape does not fit, or limits are set for a joint without
                limits.
            TypeError: There is no such parameter, or it cannot differ between worlds.
        """
        change_dynamics(self._engine, self._body, self._link_index(link), changes)

    def link_rows(self, link: int | str | None) -> np.ndarray:
        """Rows of a link in the arrays of the engine; None stands for the base and all links."""
        first = self._body.first_link
        if link is None:
            return np.arange(first, self._links.stop)
        return np.array([first + 1 + self._link_index(link)])

    def _link_index(self, link: int | str) -> int:
        if link in (-1, self._base_name):
            return -1
        return choose("link", self.link_names, link)

    def _numbers(self, value: ArrayLike) -> Array:
        """A user's numbers as doubles, left on the worlds' device if they are there."""
        taken = self._take(value)
        return taken if isinstance(taken, OnDevice) else np.asarray(taken, dtype=np.float64)  # type: ignore[return-value]

    def _chosen(
        self, joints: list[int | str] | None, *, one_freedom: bool = True
    ) -> tuple[slice | np.ndarray, np.ndarray]:
        """Velocity coordinates of some joints, and the indices of these joints among all movable ones."""
        body = self._body
        movable = [joint for joint in range(body.joint_count) if body.velocity_count[joint]]
        if joints is None:
            if one_freedom:
                self._require_one_freedom(movable)
            return self._dofs, np.arange(len(movable))
        chosen = [choose("joint", self.joint_names, joint) for joint in joints]
        self._require_one_freedom(chosen)
        return np.array([body.velocity_index[joint] for joint in chosen], dtype=np.int64), np.array(
            [movable.index(joint) for joint in chosen], dtype=np.int64
        )

    def _drives(self, dofs: slice | np.ndarray) -> Drives:
        substep_time = self._scene.parameters.substep_time
        return Drives(self._state["dof_motor"], self._state["dof_pd"], dofs, substep_time)

    def _require_one_freedom(self, joints: list[int]) -> None:
        for joint in joints:
            if self._body.velocity_count[joint] != 1:
                kind = JointType(self._body.spec.links[joint].joint_type).value
                raise ValueError(
                    f"joint {self.joint_names[joint]!r} is {kind}: it needs one degree of freedom"
                )

    def _forces(self, max_forces: ArrayLike | None, places: np.ndarray) -> ArrayLike:
        if max_forces is None:
            return self._body.joints.effort_limits[places]
        forces = self._take(max_forces)
        return finite(forces, "max_forces") if np.isscalar(forces) else forces


def _following(first: int, count: int) -> slice:
    return slice(first, first + count)
