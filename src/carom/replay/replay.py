"""What a replay holds: bodies, links and joints by name, and arrays over its frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description import Pose
from carom.replay.poses import composed

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ReplayMesh:
    """Triangles of a shape.

    Attributes:
        positions: (vertices, 3) before the shape's scale.
        normals: (vertices, 3) unit vectors.
        uvs: (vertices, 2) texture coordinates; v points up.
        triangles: (triangles, 3) indices of vertices.
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uvs: NDArray[np.float32]
    triangles: NDArray[np.uint32]


@dataclass(frozen=True, slots=True)
class ReplayTexture:
    """An image that shapes have on them.

    Attributes:
        media_type: `image/png` or `image/jpeg`.
        data: The file; its top row has v = 1.
    """

    media_type: str
    data: bytes


@dataclass(frozen=True, slots=True)
class ReplayShape:
    """A shape as it is seen.

    Attributes:
        link: Name of its link.
        mesh: Its triangles.
        pose: Its pose in the frame of the link.
        scale: Factors on the mesh along its axes.
        rgba: Its colour, each part from 0 to 1, as screens show it (sRGB).
        texture: Its image; None without one.
        two_sided: Whether it is seen from behind.
        collision: Whether it is one that collides; they are stored if the page has shown them.
    """

    link: str
    mesh: ReplayMesh
    pose: Pose
    scale: tuple[float, float, float]
    rgba: tuple[float, float, float, float]
    texture: ReplayTexture | None
    two_sided: bool
    collision: bool


@dataclass(frozen=True, slots=True)
class ReplayLook:
    """The shapes of a body from one frame on until before another one.

    Attributes:
        begin: Number of the first frame.
        end: Number of the frame after the last one.
        shapes: The shapes.
    """

    begin: int
    end: int
    shapes: tuple[ReplayShape, ...]


@dataclass(frozen=True, slots=True)
class ReplayLink:
    """A link over the frames of a replay.

    Poses of links that joints move are those that the last step began with, as in PyBullet's `getLinkState`;
    joints have the positions that it ended with.

    Attributes:
        name: Its name.
        parent: Name of the link that it hangs on; None for the base.
        inertial_pose: (frames, 7) position [m] and quaternion (x, y, z, w) of its inertial frame in the
            world, to the last bit as they were recorded; NaN while the body is not there.
        velocity: (frames, 6) velocity of its centre of mass [m/s] and angular velocity [rad/s] in the world;
            NaN where they are not recorded, None if they are in no frame.
        joint_load: (frames, 6) force [N] and moment [N m] that the force-torque sensor of its joint shows;
            NaN and None as with `velocity`.
    """

    name: str
    parent: str | None
    inertial_pose: NDArray[np.float32]
    velocity: Floats | None
    joint_load: Floats | None
    _frames: tuple[tuple[int, Pose], ...] = field(default=(), repr=False)

    @property
    def pose(self) -> Floats:
        """(frames, 7) position [m] and quaternion (x, y, z, w) of its frame in the world.

        NaN while the body is not there.
        """
        poses = self.inertial_pose.astype(np.float64)
        ends = [begin for begin, _ in self._frames[1:]] + [len(poses)]
        for (begin, frame), end in zip(self._frames, ends, strict=True):
            poses[begin:end] = composed(poses[begin:end], frame)
        return poses

    def __repr__(self) -> str:
        return f"<ReplayLink {self.name!r}: {len(self.inertial_pose)} frames>"


@dataclass(frozen=True, slots=True)
class ReplayJoint:
    """A joint of one degree of freedom over the frames of a replay; NaN where nothing is recorded.

    Attributes:
        name: Its name.
        link: Name of the link that it moves.
        kind: `revolute`, `prismatic` and so on.
        position: (frames,) [rad or m].
        velocity: (frames,) [rad/s or m/s].
        torque: (frames,) torque or force of motor and script together [N m or N].
        position_target: (frames,) what its motor was told to reach; NaN without a target.
        velocity_target: (frames,) the same of velocities.
        torque_target: (frames,) torque or force that the script applied itself; NaN where it is not recorded.
    """

    name: str
    link: str
    kind: str
    position: Floats
    velocity: Floats
    torque: Floats
    position_target: Floats
    velocity_target: Floats
    torque_target: Floats


@dataclass(frozen=True, slots=True)
class ReplayActuator:
    """An actuator over the frames of a replay; NaN where nothing is recorded.

    Attributes:
        name: Its name.
        control: (frames,) its control.
        force: (frames,) its force in the last step [N or N m].
        activation: (frames,) its activation; NaN without one.
    """

    name: str
    control: Floats
    force: Floats
    activation: Floats


@dataclass(frozen=True, slots=True)
class ReplayBody:
    """A body over the frames of a replay.

    Attributes:
        name: Its name in the replay: its own, with a number after it if others before it have the same.
        number: Its number in the simulation.
        file: Folder and name of the file that it came from; None for others.
        present: (frames,) whether it is there.
        links: Its links by name, the base first.
        joints: Its joints of one degree of freedom by name.
        actuators: Its actuators by name.
        sensors: (frames, numbers) what its sensors showed, by name; NaN where it is not recorded.
        looks: Its shapes over time.
    """

    name: str
    number: int
    file: str | None
    present: NDArray[np.bool_]
    links: Mapping[str, ReplayLink]
    joints: Mapping[str, ReplayJoint]
    actuators: Mapping[str, ReplayActuator]
    sensors: Mapping[str, Floats]
    looks: tuple[ReplayLook, ...]

    def __repr__(self) -> str:
        there = int(self.present.sum())
        return (
            f"<ReplayBody {self.name!r}: {len(self.links)} links, {len(self.joints)} joints, {there} frames>"
        )


@dataclass(frozen=True, slots=True)
class ReplayContacts:
    """The contacts of all frames, in rows.

    Attributes:
        frame: (contacts,) number of the frame.
        body_a: (contacts,) name of the first body; "" if it is not in the frame.
        link_a: (contacts,) name of its link.
        body_b: (contacts,) name of the second body.
        link_b: (contacts,) name of its link.
        position: (contacts, 3) the point on b [m].
        normal: (contacts, 3) the normal on b, towards a.
        normal_force: (contacts,) force along the normal on a [N].
        friction_force: (contacts, 3) friction on a [N].
        friction_coefficient: (contacts,) friction coefficient.
        distance: (contacts,) distance of the surfaces, negative where they penetrate [m].
    """

    frame: NDArray[np.int64]
    body_a: NDArray[np.str_]
    link_a: NDArray[np.str_]
    body_b: NDArray[np.str_]
    link_b: NDArray[np.str_]
    position: Floats
    normal: Floats
    normal_force: Floats
    friction_force: Floats
    friction_coefficient: Floats
    distance: Floats


@dataclass(frozen=True, slots=True)
class ReplayTendons:
    """The straight pieces of the tendons of all frames, in rows; there are none unless a page has shown them.

    Attributes:
        frame: (pieces,) number of the frame.
        body: (pieces,) name of the body.
        start: (pieces, 3) where the piece begins [m].
        end: (pieces, 3) where it ends [m].
        force: (pieces,) force of the tendon [N].
        at_limit: (pieces,) whether the tendon is at its limit.
    """

    frame: NDArray[np.int64]
    body: NDArray[np.str_]
    start: Floats
    end: Floats
    force: Floats
    at_limit: NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class ReplayEvent:
    """Anything else that a replay tells: drawings and controls of scripts, masses, constraints, rays.

    Attributes:
        frame: Number of the first frame that it is shown with.
        kind: What it is: `line`, `text`, `points`, `slider`, `dynamics`, `constraints`; or that one has
            ended: `no line` and so on.
        facts: Its fields; `carom.viewer.protocol.to_page` says what they mean.
        data: What follows them in binary.
    """

    frame: int
    kind: str
    facts: Mapping[str, Any]
    data: bytes


@dataclass(frozen=True, slots=True)
class Replay:
    """A replay: `carom.replay.read` makes it.

    Attributes:
        title: Its title.
        times: (frames,) simulated time of each frame [s]; it goes back where the script reset the world.
        clock: (frames,) time since the first frame as the page's time bar counts it [s]: it goes on by a 60th
            of a second where simulated time stands still or goes back.
        bodies: The bodies by name.
        contacts: The contacts of all frames.
        tendons: The tendons of all frames.
        values: (frames,) values that the script plotted, by name; NaN before the first one.
        events: All else, in order.
        camera: The view that it opens with: distance [m], yaw and pitch [degrees], target [m]; None if the
            page finds one.
        options: The display options of the script; None if it set none.
    """

    title: str
    times: Floats
    clock: Floats
    bodies: Mapping[str, ReplayBody]
    contacts: ReplayContacts
    tendons: ReplayTendons
    values: Mapping[str, Floats]
    events: tuple[ReplayEvent, ...]
    camera: Mapping[str, Any] | None
    options: Mapping[str, Any] | None

    def __repr__(self) -> str:
        length = float(self.clock[-1]) if len(self.clock) else 0.0
        names = ", ".join(map(repr, self.bodies)) or "no body"
        return f"<Replay {self.title!r}: {len(self.times)} frames, {length:.3f} s, with {names}>"
