"""A body in many worlds."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, pair
from carom.engine.engine import Engine
from carom.engine.presence import change_presence, is_present
from carom.engine.queries.extents import Extent, extent_of
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES, Activity
from carom.layouts.magnitudes import UNIT_ROUNDING
from carom.model.body_spec import BodySpec
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.pose import Pose as WorldPose
from carom.pose import Velocity, numbers_of
from carom.scene.body import Body
from carom.world.world import World
from carom.worlds.algorithms.derivatives import DerivativeBatch
from carom.worlds.algorithms.searches import InverseKinematicsBatch
from carom.worlds.batch import AnyLink, Batch, Kinds
from carom.worlds.chosen import Mask, Where
from carom.worlds.frames import inertial_frames, link_frames
from carom.worlds.mechanics import AlgorithmBatch
from carom.worlds.parts.actuators import ActuatorBatches
from carom.worlds.parts.joint import JointBatch
from carom.worlds.parts.joints import JointGroupBatch
from carom.worlds.parts.links import LinkBatch, LinkBatches
from carom.worlds.parts.sensors import SensorBatches, SiteBatches
from carom.worlds.parts.shapes import ShapeBatches
from carom.worlds.parts.tendons import TendonBatches
from carom.worlds.sensors import BatchSource
from carom.worlds.writing import assign


class BodyBatch(AlgorithmBatch):
    """The same body in all worlds; get it from `worlds[body]`.

    Names are those of `Body`, and arrays have the world as their first axis. Setters take `where`: a mask
    (count,) of worlds, or their indices; None for all.

    Attributes:
        name: Name of the robot.
    """

    def __init__(self, body: Body, scene: World, engine: Engine, source: BatchSource, threads: int) -> None:
        super().__init__(body, scene, engine, threads)
        self._source = source
        # Parts refer to this one, not to the body that keeps them.
        self._parts = Batch(body, scene, engine, threads)
        self._parts._kinds = Kinds(JointBatch, JointGroupBatch, LinkBatch)

    def __repr__(self) -> str:
        return f"<BodyBatch {self.name!r} in {self._count} worlds>"

    @property
    def id(self) -> int:
        """Number of the body in each world."""
        return self._body.id

    @property
    def spec(self) -> BodySpec:
        """The specification it was loaded from, with the values of the file."""
        return self._body.spec

    @property
    def fixed_base(self) -> bool:
        """The base is fixed in the world."""
        return self._body.fixed_base

    @property
    def joint_count(self) -> int:
        """Number of joints, fixed ones included; also the number of links besides the base."""
        return self._body.joint_count

    # Parts

    @cached_property
    def joints(self) -> JointGroupBatch:
        """The joints by index or name, groups of them, and arrays over all that move."""
        return JointGroupBatch(self._parts)

    @cached_property
    def links(self) -> LinkBatches:
        """The links by index or name; -1 is the base."""
        return LinkBatches(self._parts)

    @property
    def base(self) -> LinkBatch:
        """The root link."""
        return self.links.base

    @cached_property
    def shapes(self) -> ShapeBatches:
        """The collision shapes, by index or name: `shapes["foot"].friction`."""
        return ShapeBatches(self._parts)

    @cached_property
    def actuators(self) -> ActuatorBatches:
        """The actuators by index or name, and arrays over all of them."""
        return ActuatorBatches(self._parts, self._source)

    @cached_property
    def sensors(self) -> SensorBatches:
        """The sensors by index or name; `sensors.read()` reads all of them."""
        return SensorBatches(self._parts, self._source)

    @cached_property
    def sites(self) -> SiteBatches:
        """The sites, frames on links, by index or name."""
        return SiteBatches(self._parts, self._source)

    @cached_property
    def tendons(self) -> TendonBatches:
        """The tendons by index or name."""
        return TendonBatches(self._parts, self._source)

    # Algorithms

    @cached_property
    def algorithms(self) -> DerivativeBatch:
        """Further algorithms for states of one's choice: derivatives, momenta, forces of gravity and more."""
        return DerivativeBatch(self._body, self._scene, self._engine, self._threads)

    def inverse_kinematics(  # pyright: ignore[reportIncompatibleMethodOverride]
        self,
        links: AnyLink | Sequence[AnyLink],
        positions: Any,
        orientations: ArrayLike | None = None,
        *,
        where: Where | None = None,
        **options: Any,
    ) -> InverseKinematicsBatch:
        """Joint positions at which links reach target poses, as `Body.inverse_kinematics`.

        The search of each world starts at its present joint positions. The bodies do not move.

        Args:
            links: A link, its index (-1 is the base) or name, or k of them.
            positions: Of one link its targets, positions (n, 3) for the n worlds chosen, or (3,) for all, or
                a `Pose` of one or of each; of k links positions (n, k, 3) or (k, 3), in world axes [m].
            orientations: Target orientations, quaternions (n, 4) or (4,), of k links (n, k, 4) or (k, 4).
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            **options: Those of `algorithms.inverse_kinematics`. Without `lower` and `upper` the limits of the
                joints hold in each world; None lifts them.

        Returns:
            The joint positions in each world, and what is left of the way to the targets.

        Raises:
            ValueError: A shape does not fit, or something is not finite.
        """
        if options.keys().isdisjoint(("lower", "upper")) and all(n < 2 for n in self._body.velocity_count):
            chosen = self._chosen(where).numbers
            lower, upper = self.joints.limits
            options.update(lower=lower[chosen], upper=upper[chosen])
        return super().inverse_kinematics(links, positions, orientations, where=where, **options)

    def forward_dynamics(
        self,
        forces: ArrayLike = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        where: Where | None = None,
    ) -> Array:
        """Accelerations for forces in n worlds, (n, dofs), as `Body.forward_dynamics`; without contacts."""
        return self.algorithms.forward_dynamics(forces, positions, velocities, where)

    # Presence

    @property
    @gated("_scene.call_lock")
    def present(self) -> Mask:
        """In which worlds the body is present, a copy (count,); see `set_present`."""
        return is_present(self._engine.arrays, self._body_rows)

    @present.setter
    def present(self, value: ArrayLike) -> None:
        self.set_present(value)

    @gated("_scene.call_lock", section=True)
    def set_present(self, present: ArrayLike, where: Where | None = None) -> None:
        """Let the body come or go in each world, or in some.

        Where it is absent, it does not move, nothing touches or sees it, and constraints on it do nothing;
        the others move bit for bit as in a world made without it. Its coordinates and velocities stay as they
        are and can be set; forces on it are lost. Sleeping bodies wake where it comes or goes.

        Args:
            present: Whether it is present: one value, or one for each of the n worlds chosen, (n,).
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: The number of values differs from that of the worlds chosen, the worlds are on a GPU,
                the body is soft, or a soft body is anchored to it.
        """
        engine = self._engine
        if not engine.allows_absence:
            raise ValueError("bodies cannot be absent in worlds on a GPU yet; use device='cpu'")
        worlds = self._chosen(where)
        wanted = worlds.values(np.asarray(present, dtype=bool), (), "present") != 0.0
        change_presence(engine.arrays, engine.contact_arrays, self._body_rows, worlds.numbers, wanted)
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

    # State of the base, and of the whole body

    @property
    @gated("_scene.call_lock")
    def pose(self) -> WorldPose:
        """World poses of the base's link frame, copies: positions (count, 3) and quaternions (count, 4).

        Setting it moves the body, with its velocities as they are.
        """
        frames = self._frames()
        return WorldPose(frames[:, :3], frames[:, 3:])

    @pose.setter
    def pose(self, value: Any) -> None:
        self.set_pose(value)

    @gated("_scene.call_lock")
    def set_pose(self, pose: Any, *, where: Where | None = None) -> None:
        """Put the base's link frame somewhere, in all worlds or in some; velocities do not change.

        Args:
            pose: A `Pose`, a position [m] and a quaternion (x, y, z, w), or an array (7,) of both; one for
                all, or one for each of the n worlds chosen: (n, 3) and (n, 4), or (n, 7).
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or a quaternion is 0.
        """
        worlds = self._chosen(where)
        position, turn = numbers_of(self._take(pose))
        wanted = np.empty((len(worlds), BASE_POSITIONS))
        wanted[:, :3] = worlds.values(position, (3,), "position")
        wanted[:, 3:] = worlds.values(turn, (4,), "orientation")
        inertial = inertial_frames(wanted[:, np.newaxis], [self._body.spec.base])[:, 0]
        # What is written back as it was read changes nothing, not even in the last digit.
        present = np.asarray(self._take(self.base_inertial_poses))[worlds.numbers]
        same = (wanted == self._frames()[worlds.numbers]).all(axis=1, keepdims=True)
        inertial = np.where(same, present, inertial)
        self.set_base_inertial_poses(inertial[:, :3], inertial[:, 3:], where)

    def _frames(self) -> Array:
        poses = np.asarray(self._take(self.base_inertial_poses))
        return link_frames(poses[:, np.newaxis], [self._body.spec.base])[:, 0]

    @property
    def velocity(self) -> Velocity:
        """Velocity of the base's centre of mass and angular velocity, in world axes, copies (count, 3) each.

        Setting it takes both, as `set_velocity`.
        """
        found = self.base_velocities
        return Velocity(found[:, :3], found[:, 3:])

    @velocity.setter
    def velocity(self, value: tuple[ArrayLike, ArrayLike]) -> None:
        self.set_velocity(*pair(value, "velocity", "a linear and an angular velocity, in world axes"))

    @gated("_scene.call_lock")
    def set_velocity(
        self,
        linear: ArrayLike = (0.0, 0.0, 0.0),
        angular: ArrayLike = (0.0, 0.0, 0.0),
        *,
        where: Where | None = None,
    ) -> None:
        """Set the velocity of the base's centre of mass and its angular velocity, in world axes.

        Args:
            linear: [m/s], (n, 3) for the n worlds chosen, or (3,) for all.
            angular: [rad/s], likewise.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        worlds = self._chosen(where)
        first = worlds.values(np.asarray(self._take(linear)), (3,), "linear")
        second = worlds.values(np.asarray(self._take(angular)), (3,), "angular")
        self.set_base_velocities(np.concatenate([first, second], axis=1), where)

    @property
    def mass(self) -> Array:
        """Mass of all its links [kg], (count,); a fixed base counts as in the file."""
        total = np.full(self._count, self._body.spec.base.mass if self._body.fixed_base else 0.0)
        for link in self.links:
            total += link.mass
        return total

    @property
    def com(self) -> Array:
        """Centre of mass in world axes [m], (count, 3); a fixed base counts as in the file."""
        masses = np.stack([link.mass for link in self.links], axis=1)
        if self._body.fixed_base:
            masses[:, 0] = self._body.spec.base.mass
        places = np.concatenate(
            [self.base.com[:, np.newaxis], np.asarray(self._take(self.links.inertial_poses))[:, :, :3]],
            axis=1,
        )
        return (masses[:, :, np.newaxis] * places).sum(axis=1) / masses.sum(axis=1, keepdims=True)

    @property
    def bounds(self) -> Extent:
        """Bounds of its collision shapes in world axes, now: `lower`, `upper` (count, 3), `size`, `centre`.

        Of a soft body they are those of its nodes.
        """
        if self._body.spec.soft is not None:
            return Extent(self.nodes.min(axis=1), self.nodes.max(axis=1))
        rows = range(self._body.first_link, self._body.first_link + 1 + self._body.joint_count)
        poses = np.concatenate(
            [
                self.base.inertial_pose.array[:, np.newaxis],
                np.asarray(self._take(self.links.inertial_poses)).reshape(self._count, -1, 7),
            ],
            axis=1,
        )
        sizes = self._engine.contact_arrays.shapes.table.numpy["shape_size"]
        return extent_of(self._scene.contact_arrays.shapes, rows, poses, sizes=sizes)

    @property
    @gated("_scene.call_lock")
    def asleep(self) -> Mask:
        """In which worlds the body slept in the last step, (count,)."""
        return np.array(self._state["tree_activity"][:, self._body_rows.tree] == Activity.ASLEEP)

    @property
    def base_inertial_poses(self) -> Array:
        """Poses of the base's inertial frame, a view (count, 7): position [m] and quaternion (x, y, z, w).

        `pose` is of the link frame. Quaternions written here must have unit length, which
        `set_base_inertial_poses` sees to.
        """
        first = self._body.first_position
        return self._state["position"][:, first : first + BASE_POSITIONS]

    @gated("_scene.call_lock")
    def set_base_inertial_poses(
        self,
        positions: ArrayLike,
        orientations: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        where: Where | None = None,
    ) -> None:
        """Set the pose of the base's inertial frame; velocities do not change.

        Args:
            positions: [m], (3,) or (n, 3) for the n worlds chosen.
            orientations: Quaternions (x, y, z, w), (4,) or (n, 4); normalised here.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

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
            assign((self.base_inertial_poses, rows, poses), cold)

    @property
    @gated("_scene.call_lock")
    def base_velocities(self) -> Array:
        """Linear velocity of the base's centre of mass [m/s], angular velocity [rad/s]: a copy (count, 6)."""
        first = self._body.first_velocity
        velocity = self._state["dof_velocity"][:, first : first + BASE_VELOCITIES]
        return np.concatenate([velocity[:, 3:], velocity[:, :3]], axis=1)

    @base_velocities.setter
    def base_velocities(self, value: ArrayLike) -> None:
        self.set_base_velocities(value)

    @gated("_scene.call_lock")
    def set_base_velocities(self, velocities: ArrayLike, where: Where | None = None) -> None:
        """Set linear and angular velocities of the base in world axes.

        Args:
            velocities: (6,) or (n, 6) for the n worlds chosen, ordered as in `base_velocities`.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        worlds = self._chosen(where)
        values = worlds.values(self._take(velocities), (BASE_VELOCITIES,), "velocities")
        first = self._body.first_velocity
        turned = np.concatenate([values[:, 3:], values[:, :3]], axis=1)
        # One statement.
        self._state["dof_velocity"][worlds.rows, first : first + BASE_VELOCITIES] = turned
