"""Links of a body in many worlds: poses, velocities, external forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.model.body_spec import BASE, LinkSpec
from carom.native.gates import gated
from carom.pose import Pose as WorldPose
from carom.pose import Velocity, turned
from carom.scene.common.link import CommonLink, Frame
from carom.scene.named import Grouped
from carom.worlds.batch import Batch
from carom.worlds.chosen import Where
from carom.worlds.frames import link_frames
from carom.worlds.parts.looks import LinkLooks
from carom.worlds.parts.part import Part

if TYPE_CHECKING:
    from carom.worlds.parts.joint import JointBatch
    from carom.worlds.parts.shapes import ShapeBatch


class LinkBatch(CommonLink["JointBatch"], Part):
    """One rigid part of a body in all worlds; get it from `worlds[body].links`.

    Names are those of `Link`; arrays have the world as their first axis. Methods take `where`: a mask
    (count,) of worlds, or their indices; None for all. Values are (n, ...) for the n worlds chosen, or
    without that axis for all.

    Attributes:
        index: Its number, also that of the joint that moves it; the base is -1.
        name: Its name in the file.
    """

    __slots__ = ()

    @property
    def spec(self) -> LinkSpec:
        """The specification of the link, from the file."""
        return self._batch._body.link_spec(self.index)

    @property
    def shapes(self) -> list[ShapeBatch]:
        """Its collision shapes."""
        from carom.worlds.parts.shapes import ShapeBatch

        shapes = self._batch._body.shapes
        return [ShapeBatch(self._batch, shape) for shape in shapes if shape._link == self.index]

    @property
    def colour(self) -> Array:
        """Red, green, blue and alpha of what is seen of it in each world, a copy (count, 4) from 0 to 1.

        Setting it gives all its visible shapes a colour, one for all worlds or one for each, also by three
        numbers. An alpha of 0 hides only where all worlds have it from the original one.

        Raises:
            ValueError: What is set is no colour, or there are not as many as worlds.
        """
        return self._looks.colour(None)

    @colour.setter
    def colour(self, value: ArrayLike) -> None:
        self._looks.set_colour(None, value, None)

    @property
    def _looks(self) -> LinkLooks:
        batch = self._batch
        return LinkLooks(batch._scene, batch._engine, batch._body, self.index)

    @property
    def mass(self) -> Array:
        """Present mass [kg], a copy (count,); 0 for a fixed base. `change_dynamics` sets it."""
        return self._batch.dynamics(self.index).get("mass", np.zeros(self._batch._count))

    @property
    def inertia(self) -> Array:
        """Present principal moments of inertia [kg m²] about the axes of the inertial frame, (count, 3)."""
        found = self._batch.dynamics(self.index).get("inertia")
        return (
            np.tile(self._batch._body.dynamics(BASE).inertia, (self._batch._count, 1))
            if found is None
            else found
        )

    # State

    @property
    @gated("_batch._scene.call_lock")
    def pose(self) -> WorldPose:
        """World poses of the link frame of the file: positions (count, 3) and quaternions (count, 4).

        Copies, for the present coordinates, as the other poses are.
        """
        frames = link_frames(self._inertial()[:, np.newaxis], [self.spec])[:, 0]
        return WorldPose(frames[:, :3], frames[:, 3:])

    @property
    @gated("_batch._scene.call_lock")
    def inertial_pose(self) -> WorldPose:
        """World poses of the inertial frame: centre of mass and principal axes."""
        found = self._inertial().copy()
        return WorldPose(found[:, :3], found[:, 3:])

    @property
    @gated("_batch._scene.call_lock")
    def velocity(self) -> Velocity:
        """Velocities of the centre of mass and angular velocities, in world axes, (count, 3) each."""
        found = self._batch._poses.velocities()[:, self._row].copy()
        return Velocity(found[:, :3], found[:, 3:])

    def _inertial(self) -> Any:
        return self._batch._poses.poses()[:, self._row]

    def _joint(self, number: int) -> JointBatch:
        return self._batch._parts_of_it.joints(self._batch)[number]

    def _other(self, number: int) -> LinkBatch:
        return LinkBatch(self._batch, number)

    @property
    def _row(self) -> int:
        return self._batch._body.first_link + 1 + self.index

    # Forces

    @gated("_batch._scene.call_lock")
    def apply_force(
        self,
        force: ArrayLike,
        point: ArrayLike | None = None,
        *,
        frame: Frame = "world",
        where: Where | None = None,
    ) -> None:
        """Apply a force in the next step, in addition to other forces, as `Link.apply_force`.

        Args:
            force: [N], (n, 3) for the n worlds chosen, or (3,) for all.
            point: Point of application [m], likewise; the centre of mass by default.
            frame: Frame of both: the world or the link frame.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or the frame is unknown.
        """
        batch, worlds = self._batch, self._batch._chosen(where)
        forces = self._in_world(worlds.values(batch._take(force), (3,), "force"), worlds.rows, frame)
        torques = np.zeros((len(worlds), 3))
        if point is not None:
            place = worlds.values(batch._take(point), (3,), "point")
            if frame == "link":
                poses = self.pose
                place = poses.position[worlds.rows] + turned(poses.orientation[worlds.rows], place)
            torques = np.cross(place - batch._poses.poses()[worlds.rows, self._row, :3], forces)
        # One statement.
        batch._state["link_wrench"][worlds.rows, self._row] += np.concatenate([forces, torques], axis=1)

    @gated("_batch._scene.call_lock")
    def apply_torque(self, torque: ArrayLike, *, frame: Frame = "world", where: Where | None = None) -> None:
        """Apply a torque in the next step, in addition to other torques, as `Link.apply_torque`.

        Args:
            torque: [N m], (n, 3) for the n worlds chosen, or (3,) for all.
            frame: Axes of the torque: those of the world or of the link frame.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or the frame is unknown.
        """
        batch, worlds = self._batch, self._batch._chosen(where)
        torques = self._in_world(worlds.values(batch._take(torque), (3,), "torque"), worlds.rows, frame)
        wrench = np.concatenate([np.zeros((len(worlds), 3)), torques], axis=1)
        # One statement.
        batch._state["link_wrench"][worlds.rows, self._row] += wrench

    def _in_world(self, directions: Array, rows: slice | np.ndarray, frame: Frame) -> Array:
        if frame == "world":
            return directions
        if frame == "link":
            return turned(np.asarray(self.pose.orientation)[rows], np.asarray(directions))
        raise ValueError(f"frame must be 'world' or 'link', not {frame!r}")


class LinkGroupBatch(Grouped[LinkBatch, "LinkGroupBatch"]):
    """Some links of a body in all worlds, one by one or as arrays over them.

    Get one as in a lone world: `links[:3]`, `links["*_foot"]`, `links[["left_foot", "right_foot"]]`.
    """

    def __init__(self, batch: Batch, links: Sequence[LinkBatch], first: int = 0) -> None:
        self._batch = batch
        super().__init__("link", links, first)
        numbers = [link.index for link in links if link.index != BASE or first != BASE]
        self._specs = [batch._body.link_spec(number) for number in numbers]
        row = batch._body.first_link + 1
        is_slice = numbers == [*range(numbers[0], numbers[0] + len(numbers))] if numbers else False
        self._rows: slice | np.ndarray = (
            slice(row + numbers[0], row + numbers[0] + len(numbers))
            if is_slice
            else row + np.array(numbers, dtype=np.int64)
        )

    def __repr__(self) -> str:
        names = ", ".join(map(repr, self.names)) or "none"
        return f"<{type(self).__name__} of {self._batch.name!r} in {self._batch._count} worlds: {names}>"

    def _group(self, items: list[LinkBatch]) -> LinkGroupBatch:
        return LinkGroupBatch(self._batch, items)

    @property
    @gated("_batch._scene.call_lock")
    def poses(self) -> Array:
        """World poses of the link frames, as `Link.pose`, for the present coordinates: (count, links, 7).

        A copy: position of the frame's origin [m] and quaternion (x, y, z, w); of all links of a body without
        that of the base, as in the arrays below.
        """
        return link_frames(self._batch._poses.poses()[:, self._rows], self._specs)

    @property
    @gated("_batch._scene.call_lock")
    def inertial_poses(self) -> Array:
        """World poses of the inertial frames, as `Link.inertial_pose`: a copy (count, links, 7), likewise."""
        return self._batch._poses.poses()[:, self._rows].copy()

    @property
    @gated("_batch._scene.call_lock")
    def velocities(self) -> Array:
        """Linear velocity of the centres of mass [m/s], then angular velocity [rad/s]: a copy, likewise.

        Shape (count, links, 6), in world axes.
        """
        return self._batch._poses.velocities()[:, self._rows].copy()


class LinkBatches(LinkGroupBatch):
    """All links of a body in all worlds: `links["hand"]`, groups, and arrays over all but the base."""

    def __init__(self, batch: Batch) -> None:
        numbers = range(BASE, batch._body.joint_count)
        super().__init__(batch, [LinkBatch(batch, number) for number in numbers], BASE)

    @property
    def base(self) -> LinkBatch:
        """The root link."""
        return self._items[0]

    @property
    def stepped_poses(self) -> Array:
        """`inertial_poses` as `pybullet.getLinkState` has them after a step; a view (count, links, 7).

        They are the poses at the start of the last substep. Reading other poses or velocities of links
        updates them in all worlds, `update_poses` in chosen worlds.
        """
        return self._batch._state["link_pose"][:, self._batch._links]

    @property
    @gated("_batch._scene.call_lock")
    def stepped_velocities(self) -> Array:
        """`velocities` as `pybullet.getLinkState` has them after a step: a view (count, links, 6).

        They are computed from `stepped_poses` and the present velocities of the joints. The next call
        overwrites the same array.
        """
        return self._batch._poses.velocities_at_step()[:, self._batch._links]

    @gated("_batch._scene.call_lock")
    def update_poses(self, where: Where | None = None) -> None:
        """Update `stepped_poses` from the coordinates, in all worlds or in some."""
        self._batch._poses.update(self._batch._chosen(where).numbers)
