"""A body in a world: a base, its links and the joints between them."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom.checks import Array, pair, vector
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose
from carom.model.body_rows import TreeRows
from carom.model.body_spec import BASE, BodySpec
from carom.native.products import length
from carom.pose import numbers_of
from carom.scene.core.body_algorithms import BodyAlgorithms
from carom.scene.core.body_core import Outline
from carom.scene.dynamics.changes import change_dynamics
from carom.scene.handles import world_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.description.actuator import Actuator
    from carom.description.keyframe import BodyKeyframe
    from carom.description.sensors import Sensor
    from carom.description.site import SiteShape
    from carom.description.tendon import TendonSpec
    from carom.engine.queries.extents import Extent
    from carom.pose import Pose as WorldPose
    from carom.pose import Velocity
    from carom.scene.actuators.actuator import BodyActuators
    from carom.scene.core.world_core import WorldCore
    from carom.scene.joints import Joints
    from carom.scene.link import Link, Links
    from carom.scene.sensors.sensor import BodySensors
    from carom.scene.sensors.site import BodySites
    from carom.scene.shapes import BodyShapes
    from carom.scene.tendons.tendon import BodyTendons
    from carom.world.world import World


class Body(BodyAlgorithms):
    """Handle of a body; stays valid until the body is removed.

    Attributes:
        id: Number of the body in its world.
        world: The world that contains it.
        spec: The specification it was loaded from, with the values of the file.
        joint_count: Number of joints, fixed ones included; also the number of links besides the base.
        fixed_base: The base is fixed in the world.
    """

    # A base class declares it for any world; all that have bodies are of this class.
    world: World  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(
        self, world: WorldCore, body_id: int, spec: BodySpec, rows: TreeRows, outline: Outline | None = None
    ) -> None:
        super().__init__(world, body_id, spec, rows, outline)
        self._close(Body)

    def __deepcopy__(self, memo: dict[int, Any]) -> Body:
        """The same body in a copy of its world."""
        world_of(self)
        return deepcopy(self.world, memo).bodies[self.id]

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled together with its world."""
        return _body_of, (world_of(self), self.id)

    def _repr_html_(self) -> str:
        """Its joints and links, for notebooks."""
        from carom.scene.html_tables import body_table

        return body_table(self)

    @property
    def pose(self) -> WorldPose:
        """World pose of the base's link frame, as `base.pose`; setting it is `set_pose`."""
        return self.links.base.pose

    @pose.setter
    def pose(self, value: Any) -> None:
        self.set_pose(value)

    def set_pose(self, pose: Any) -> None:
        """Put the base's link frame somewhere; velocities do not change, nor does what is there already.

        Args:
            pose: A `Pose`, a position [m] and a quaternion (x, y, z, w) of any length but 0, or an array (7,)
                of both, in world axes.

        Raises:
            ValueError: A number is not finite, there are too many or too few, or the quaternion is 0.
        """
        place, turn = numbers_of(pose)
        if place.shape != (3,) or turn.shape != (4,):
            raise ValueError(f"a body has one pose, a position (3,) and a quaternion (4,), not {pose!r}")
        size = length(turn)
        if size == 0.0:
            raise ValueError("orientation must be a quaternion other than 0")
        with self.world.call_lock:
            present = self.pose
            if np.array_equal(place, present.position) and np.array_equal(turn, present.orientation):
                return
            x, y, z = place.tolist()
            i, j, k, w = (turn / size).tolist()
            inertial = compose(Pose((x, y, z), (i, j, k, w)), self.link_inertial_frame(BASE))
            self.set_inertial_pose(inertial.position, inertial.orientation)

    @property
    def velocity(self) -> Velocity:
        """Velocity of the base's centre of mass and its angular velocity, in world axes; settable."""
        return self.links.base.velocity

    @velocity.setter
    def velocity(self, value: tuple[ArrayLike, ArrayLike]) -> None:
        self.set_velocity(*pair(value, "velocity", "a linear and an angular velocity, in world axes"))

    def set_velocity(self, linear: ArrayLike = (0.0, 0.0, 0.0), angular: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Set the velocity of the base's centre of mass and its angular velocity, in world axes.

        A fixed base moves with it, and as in Bullet the velocity turns with the base.

        Args:
            linear: [m/s], shape (3,).
            angular: [rad/s], shape (3,).
        """
        self.set_base_velocity(vector(linear, 3, "linear").tolist(), vector(angular, 3, "angular").tolist())

    @property
    def base(self) -> Link:
        """The root link."""
        return self.links.base

    @property
    def mass(self) -> float:
        """Mass of all its links [kg]; a fixed base counts as in the file."""
        return float(self._masses().sum())

    @property
    def com(self) -> Array:
        """Centre of mass in world axes [m], shape (3,); a fixed base counts as in the file."""
        masses = self._masses()
        with self.world.call_lock:
            places = np.array([link.com for link in self.links])
        return (masses[:, np.newaxis] * places).sum(axis=0) / masses.sum()

    @property
    def bounds(self) -> Extent:
        """Bounds of its collision shapes in world axes, now: `lower`, `upper`, `size` and `centre`.

        Of a soft body they are those of its nodes.
        """
        from carom.engine.queries.extents import Extent, extent_of

        with self.world.call_lock:
            if self.spec.soft is not None:
                nodes = np.asarray(cast("Any", self).nodes)
                return Extent(nodes.min(axis=0), nodes.max(axis=0))
            self.update_link_poses()
            rows = range(self.first_link, self.first_link + 1 + self.joint_count)
            poses = np.array(self.world.link_pose[rows.start : rows.stop])
            return extent_of(self.world.contact_arrays.shapes, rows, poses)

    def _masses(self) -> Array:
        masses = np.array([link.mass for link in self.links])
        if self.fixed_base:
            masses[0] = self.spec.base.mass
        return masses

    @cached_property
    def joints(self) -> Joints:
        """The joints by index or name."""
        from carom.scene.joints import Joints

        return Joints(self)

    @cached_property
    def links(self) -> Links:
        """The links by index or name; -1 is the base."""
        from carom.scene.link import Links

        return Links(self)

    @cached_property
    def actuators(self) -> BodyActuators:
        """The actuators by index or name."""
        from carom.scene.actuators.actuator import BodyActuators

        return BodyActuators(self)

    def add_actuator(self, name: str, actuator: Actuator) -> None:
        """Add an actuator to a joint, or to what else it acts on.

        Motors of the joint stay as they are: bodies that PyBullet's readings have loaded have some, which
        hold the joints until `joints.free`.

        Args:
            name: Its name among the actuators of the body.
            actuator: A `Motor`, `PositionActuator`, `VelocityActuator`, `IntegratedVelocityActuator`,
                `Damper`, `Cylinder`, `Adhesion` or `GeneralActuator`.

        Raises:
            DescriptionError: There is no such joint or link, the joint is neither revolute nor prismatic, the
                name is taken, or a number has no meaning.
        """
        from carom.scene.actuators.changes import add_actuator

        add_actuator(self, name, actuator)

    @property
    def tendons(self) -> BodyTendons:
        """The tendons by index or name."""
        from carom.scene.tendons.tendon import BodyTendons

        return BodyTendons(self)

    def add_tendon(self, tendon: TendonSpec) -> None:
        """Add a tendon.

        Args:
            tendon: Its name, its path over joints, or through points of links, and its spring and limits.

        Raises:
            DescriptionError: What it refers to does not exist, the name is taken, or a number has no meaning.
        """
        from carom.scene.tendons.changes import add_tendon

        add_tendon(self, tendon)

    @cached_property
    def shapes(self) -> BodyShapes:
        """The collision shapes of all links, by index or name."""
        from carom.scene.shapes import BodyShapes

        return BodyShapes(self)

    @cached_property
    def sites(self) -> BodySites:
        """The sites, frames on links, by index or name."""
        from carom.scene.sensors.site import BodySites

        return BodySites(self)

    def add_site(
        self,
        name: str,
        link: int | str = -1,
        pose: Pose = IDENTITY,
        *,
        shape: SiteShape | str = "sphere",
        size: Sequence[float] = (0.005,),
    ) -> None:
        """Add a site, a frame on a link.

        Args:
            name: Its name among the sites of the body.
            link: The link by index (-1 is the base) or name.
            pose: The frame in the link frame.
            shape: Shape of its volume: sphere, capsule, ellipsoid, cylinder or box.
            size: Of its volume [m]: a radius; radius and half length; or three half axes.

        Raises:
            DescriptionError: The name is taken, or a number has no meaning.
        """
        from carom.scene.sensors.changes import add_site

        add_site(self, name, self.links[link].index, pose, shape, size)

    @cached_property
    def sensors(self) -> BodySensors:
        """The sensors by index or name."""
        from carom.scene.sensors.sensor import BodySensors

        return BodySensors(self)

    def add_sensor(self, name: str, sensor: Sensor) -> None:
        """Add a sensor.

        Args:
            name: Its name among the sensors of the body.
            sensor: What it measures, such as `Gyro(site="imu")`; see `carom.description.sensors`.

        Raises:
            DescriptionError: What it refers to does not exist, the name is taken, or a number has no meaning.
        """
        from carom.scene.sensors.changes import add_sensor

        add_sensor(self, name, sensor)

    def add_keyframe(self, keyframe: BodyKeyframe | str) -> None:
        """Add a keyframe, a state with a name.

        Args:
            keyframe: The state; or a name, for the present state.

        Raises:
            DescriptionError: It does not fit the body, or the name is taken.
        """
        from carom.scene.keyframes.changes import add_keyframe

        add_keyframe(self, keyframe)

    def reset(self, name: str) -> None:
        """Reset the body to one of its keyframes; the time of the world stays.

        Raises:
            KeyError: There is no keyframe of this name.
        """
        from carom.scene.keyframes.changes import reset

        reset([self], name, with_time=False)

    def change_dynamics(self, link: int | str, **changes: Any) -> None:
        """Change inertia, surface or joint limits of a link, or damping of the whole body.

        Args:
            link: The link by index (-1 is the base) or name.
            **changes: Fields of `LinkDynamics` by name (a `mass` without `inertia` scales the inertia
                with it, as if the density changed), `joint_limit_force` [N m or N], and for the whole
                body `linear_damping`, `angular_damping` [1/s], `max_joint_velocity`
                [rad/s and m/s], `activation_state` (bits of `layouts.flags.ActivationChange`) and
                `sleep_threshold`, the sum of squared velocities below which it is at rest.
        """
        change_dynamics(self, self.links[link].index if isinstance(link, str) else link, changes)


def _body_of(world: World, number: int) -> Body:
    return world.bodies[number]
