"""Links of a body: poses, velocities, external forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, vector
from carom.description.pose import Pose, Vector3
from carom.description.transform import compose, rotate
from carom.model.body_spec import BASE
from carom.native.change import first_change
from carom.native.gates import gated
from carom.pose import Pose as WorldPose
from carom.pose import Velocity
from carom.scene.common.link import CommonLink, Frame
from carom.scene.handles import present_inertial_frame, present_link_frame, world_of
from carom.scene.named import Grouped

if TYPE_CHECKING:
    from carom.model.body_spec import LinkSpec
    from carom.scene.body import Body
    from carom.scene.joint import Joint
    from carom.scene.shapes import BodyShape


class Link(CommonLink["Joint"]):
    """One rigid part of a body.

    Attributes:
        body: The body it belongs to.
        index: Its number, also that of the joint that moves it; the base is -1.
    """

    __slots__ = ("body", "index")

    def __init__(self, body: Body, index: int) -> None:
        self.body: Body = body
        self.index: int = index

    def __repr__(self) -> str:
        return f"<Link {self.index} {self.name!r} of {self.body.name!r}>"

    @property
    def spec(self) -> LinkSpec:
        """The specification of the link, from the file."""
        return self.body.link_spec(self.index)

    @property
    def name(self) -> str:
        """Its name in the file."""
        return self.spec.name

    @property
    def shapes(self) -> list[BodyShape]:
        """Its collision shapes."""
        return [shape for shape in self.body.shapes if shape.link.index == self.index]

    @property
    def colour(self) -> Array:
        """Red, green, blue and alpha of what is seen of it, (4,) from 0 to 1; settable, also by three.

        Setting it gives all its visible shapes this colour.

        Raises:
            ValueError: What is set is no colour.
        """
        return self.body.world._colour(self.body, self.index, None)

    @colour.setter
    def colour(self, value: ArrayLike) -> None:
        self.body.world._set_colour(self.body, self.index, None, value)

    @property
    def mass(self) -> float:
        """Present mass [kg]; 0 for a fixed base."""
        return self.body.dynamics(self.index).mass

    @property
    def inertia(self) -> Array:
        """Present principal moments of inertia [kg m²] about the axes of the inertial frame, shape (3,)."""
        return np.array(self.body.dynamics(self.index).inertia)

    # State

    @property
    @gated("body.world.call_lock")
    def pose(self) -> WorldPose:
        """World pose of the link frame, as defined by the file."""
        return _as_arrays(self._link_frame())

    @property
    @gated("body.world.call_lock")
    def inertial_pose(self) -> WorldPose:
        """World pose of the inertial frame: centre of mass and principal axes."""
        return _as_arrays(present_inertial_frame(self.body, self.index))

    @property
    @gated("body.world.call_lock")
    def velocity(self) -> Velocity:
        """Velocity of the centre of mass and angular velocity, in world axes."""
        world = world_of(self.body)
        self.body.update_link_poses()
        self.body.update_link_velocities()
        row = world.link_velocity[self._row]
        return Velocity(row[:3].copy(), row[3:].copy())

    # Forces

    @gated("body.world.call_lock", commits=True)
    def apply_force(
        self, force: ArrayLike, point: ArrayLike | None = None, *, frame: Frame = "world"
    ) -> None:
        """Apply a force in the next step, in addition to other forces.

        Args:
            force: [N], shape (3,).
            point: Point of application [m], shape (3,); the centre of mass by default.
            frame: Frame of both: the world or the link frame.

        Raises:
            ValueError: A vector is not three finite numbers, or the frame is unknown.
        """
        change = first_change()
        centre = np.array(present_inertial_frame(self.body, self.index).position)
        world_force = self._in_world(vector(force, 3, "force"), frame)
        arm = np.zeros(3)
        if point is not None:
            place = vector(point, 3, "point")
            if frame == "link":
                place = np.array(compose(self._link_frame(), Pose(_triple(place))).position)
            arm = place - centre
        row = world_of(self.body).link_force[self._row]
        change.write(row, row + np.append(world_force, np.cross(arm, world_force)))
        change.commit()

    @gated("body.world.call_lock", commits=True)
    def apply_torque(self, torque: ArrayLike, *, frame: Frame = "world") -> None:
        """Apply a torque in the next step, in addition to other torques.

        Args:
            torque: [N m], shape (3,).
            frame: Axes of the torque: those of the world or of the link frame.

        Raises:
            ValueError: It is not three finite numbers, or the frame is unknown.
        """
        change = first_change()
        row = world_of(self.body).link_force[self._row, 3:]
        change.write(row, row + self._in_world(vector(torque, 3, "torque"), frame))
        change.commit()

    def _joint(self, number: int) -> Joint:
        return self.body.joints[number]

    def _other(self, number: int) -> Link:
        return self.body.links[number]

    @property
    def _row(self) -> int:
        return self.body.first_link + 1 + self.index

    def _link_frame(self) -> Pose:
        return present_link_frame(self.body, self.index)

    def _in_world(self, direction: Array, frame: Frame) -> Array:
        if frame == "world":
            return direction
        if frame == "link":
            return np.array(rotate(self._link_frame().orientation, _triple(direction)))
        raise ValueError(f"frame must be 'world' or 'link', not {frame!r}")


class LinkGroup(Grouped[Link, "LinkGroup"]):
    """Some links of a body, one by one or as arrays over them.

    Get one by a slice, which leaves out the base, by a pattern of names, or by several numbers and names:
    `links[:3]`, `links["*_foot"]`, `links[["left_foot", "right_foot"]]`.
    """

    def __init__(self, body: Body, links: Sequence[Link], first: int = 0) -> None:
        super().__init__("link", links, first)
        self._body = body

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"

    def _group(self, items: list[Link]) -> LinkGroup:
        return LinkGroup(self._body, items)

    @property
    def poses(self) -> Array:
        """World poses of the link frames, positions and quaternions (x, y, z, w): (links, 7).

        Of all links of a body without that of the base, as in the arrays below.
        """
        return self._all(lambda link: link.pose.array, 7)

    @property
    def inertial_poses(self) -> Array:
        """World poses of the inertial frames, likewise."""
        return self._all(lambda link: link.inertial_pose.array, 7)

    @property
    def velocities(self) -> Array:
        """Linear velocities of their centres of mass, then angular velocities: (links, 6)."""
        return self._all(lambda link: np.concatenate(link.velocity), 6)

    def _all(self, of: Callable[[Link], Array], size: int) -> Array:
        with self._body.world.call_lock:
            return np.array([of(link) for link in self._shown()]).reshape(-1, size)

    def _shown(self) -> Sequence[Link]:
        return self._items


class Links(LinkGroup):
    """All links of a body: `links["hand"]`, `links[3]`, groups of them; the base is `links[-1]`."""

    def __init__(self, body: Body) -> None:
        super().__init__(body, [Link(body, index) for index in range(BASE, body.joint_count)], BASE)

    @property
    def base(self) -> Link:
        """The root link."""
        return self._items[0]

    def _shown(self) -> Sequence[Link]:
        return self._items[1:]


_new = tuple.__new__


def _as_arrays(pose: Pose) -> WorldPose:
    # They are arrays already, which `WorldPose` would look at again.
    return _new(WorldPose, (np.array(pose.position), np.array(pose.orientation)))


def _triple(array: Array) -> Vector3:
    x, y, z = array.tolist()
    return (x, y, z)
