"""Robots from compiled bodies: links, and joints between them.

All joints of a body share its frame: each moves the body about an anchor in it. A link has its joint at its
own origin, so all but the last joint of a body get a massless link in between, and the last one as well if
its anchor is not at the origin of the body, which is then fixed to that link; likewise if it is a ball and
the body's principal axes are not its own. Each ellipsoid on which the
fluid acts is a massless link as well, fixed to that of its body.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from carom.description import Inertial, Joint, JointType, Link, Pose, Robot
from carom.description.fluid import SHELTERED
from carom.description.joint import SLIDES
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import Matrix3, compose, quaternion_from_matrix
from carom.formats.mjcf.compiled.elements import WORLD
from carom.formats.mjcf.compiled.inertia import BodyInertia
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint, CompiledModel
from carom.formats.placed import PlacedRobot
from carom.formats.robot.link import MASSLESS
from carom.native.products import length, turned_tensor
from carom.native.trigonometry import cos, sin

_ORIGIN = (0.0, 0.0, 0.0)
# A centre of mass that is nearer to the origin of its frame is there [m].
_AT_ORIGIN = 1e-9


def robot_of_world(world: CompiledBody) -> PlacedRobot | None:
    """The geoms of the world as one static robot; None if there are none."""
    if not world.collisions and not world.visuals:
        return None
    link = Link(WORLD, MASSLESS, tuple(world.collisions), tuple(world.visuals), world.contact)
    return PlacedRobot(Robot(WORLD, (link,), ()), fixed_base=True)


def robot_of_body(body: CompiledBody, *, moves_by_frame: bool = False) -> PlacedRobot:
    """The robot whose root is a body of the world.

    A body with joints hangs from a massless link, fixed in the world, with the frame of the world. A free
    body with damping, armature, a spring or friction is fixed to a massless link with its frame, as is one
    that `moves_by_frame`.
    """
    maker = _Maker()
    if body.joints:
        maker.links.append(Link(WORLD, MASSLESS))
        maker.add(body, 0)
        pose = IDENTITY
    elif moves_by_frame or _has_terms_of_frame(body):
        # These are of the motion of the body's frame, not of its centre of mass: so that frame is the base.
        maker.links.append(Link(f"{body.name}@free", MASSLESS))
        maker.add(body, 0, IDENTITY)
        pose = body.pose
    else:
        maker.add(body, None)
        pose = body.pose
    robot = Robot(
        body.name,
        tuple(maker.links),
        tuple(maker.joints),
        is_mocap=body.is_mocap,
        base_damping=body.free_damping,
        base_armature=body.free_armature,
        base_stiffness=body.free_stiffness,
    )
    return PlacedRobot(robot, pose, fixed_base=not body.is_free)


def _has_terms_of_frame(body: CompiledBody) -> bool:
    return any((body.free_damping, body.free_armature, body.free_stiffness, body.free_friction))


def let_held_bodies_move_by_frames(model: CompiledModel, bodies: Iterable[CompiledBody]) -> None:
    """Let free bodies that connects or welds hold move in each step by their frames, not centres of mass.

    Within a step MuJoCo moves the origin of a free body's frame along a straight line. Both are of first
    order, but where a weld far from the centre of mass holds a body that spins by a third of a radian in a
    step, one of them loses energy and the other one gains it. Bodies with others in them stay as they are.
    """
    held = {name for it in model.connections for name in (it.first, it.second)}
    makes = {
        body.name: body
        for body in bodies
        if body.name in held and body.is_free and not body.children and not _has_terms_of_frame(body)
        if body.inertia.mass > 0.0 and length(np.array(body.inertia.centre)) > _AT_ORIGIN
    }
    model.robots = [
        robot_of_body(makes[it.robot.name], moves_by_frame=True) if it.robot.name in makes else it
        for it in model.robots
    ]


def robot_of_bodies(bodies: list[CompiledBody], name: str) -> PlacedRobot:
    """One robot of several bodies of the world, none free by now, which hang from a link of the world."""
    maker = _Maker()
    maker.links.append(Link(WORLD, MASSLESS))
    for body in bodies:
        maker.add(body, 0)
    return PlacedRobot(Robot(name, tuple(maker.links), tuple(maker.joints)), IDENTITY, fixed_base=True)


class _Maker:
    def __init__(self) -> None:
        self.links: list[Link] = []
        self.joints: list[Joint] = []

    def add(self, body: CompiledBody, parent: int | None, frame: Pose | None = None) -> None:
        """Add a body and all bodies in it; `parent` is the link of the body around it.

        Its frame in that of the parent is `frame` if it is not that of the body.
        """
        frame = body.pose if frame is None else frame
        for number, joint in enumerate(body.joints):
            assert parent is not None, "only the root has no parent, and it has no joints then"
            is_last = number == len(body.joints) - 1
            place = compose(frame, Pose(joint.anchor))
            is_body = is_last and joint.anchor == _ORIGIN
            link = _link(body) if is_body else Link(f"{body.name}@{joint.joint.name}", MASSLESS)
            parent = self._hang(link, joint, parent, place)
            x, y, z = joint.anchor
            frame = Pose((-x, -y, -z))
            if is_body:
                frame = IDENTITY
        own = parent
        if not body.joints or frame is not IDENTITY:
            self.links.append(_link(body))
            own = len(self.links) - 1
            if parent is not None:
                self.joints.append(Joint(f"{body.name}@fixed", JointType.FIXED, parent, own, frame))
        assert own is not None, "the body has a link now"
        for number, (fluid, place) in enumerate(body.fluids):
            self.links.append(Link(f"{body.name}@fluid{number}", MASSLESS, fluid=fluid))
            name = f"{body.name}@fluid{number}@fixed"
            self.joints.append(Joint(name, JointType.FIXED, own, len(self.links) - 1, place))
        for child in body.children:
            self.add(child, own)

    def _hang(self, link: Link, joint: CompiledJoint, parent: int, place: Pose) -> int:
        """Add a link on a joint whose frame in the parent is `place` where the joint is at its reference."""
        self.links.append(link)
        index = len(self.links) - 1
        described = joint.joint
        frame = compose(place, _moved_back(described, joint.reference))
        self.joints.append(replace(described, parent=parent, child=index, frame=frame))
        return index


def _moved_back(joint: Joint, reference: float) -> Pose:
    """The pose at position 0 of a joint, in the frame that it has at a reference position."""
    if reference == 0.0:
        return IDENTITY
    x, y, z = joint.axis
    if joint.type in SLIDES:
        return Pose((-reference * x, -reference * y, -reference * z))
    s = sin(-0.5 * reference)
    return Pose(_ORIGIN, (s * x, s * y, s * z, cos(-0.5 * reference)))


def _link(body: CompiledBody) -> Link:
    return Link(
        body.name,
        _inertial(body.inertia),
        tuple(body.collisions),
        tuple(body.visuals),
        body.contact,
        body.gravity_compensation,
        SHELTERED if body.fluids else None,
    )


def _inertial(inertia: BodyInertia) -> Inertial:
    x, y, z = (float(value) for value in inertia.centre)
    position: Vector3 = (x, y, z)
    if inertia.axes is not None:
        rows: Matrix3 = tuple(tuple(float(value) for value in row) for row in inertia.axes)  # pyright: ignore
        turned = turned_tensor(inertia.axes.T, inertia.tensor)
        a, b, c = (float(turned[i, i]) for i in range(3))
        frame = Pose(position, quaternion_from_matrix(rows))
        return Inertial(inertia.mass, frame, (a, 0.0, 0.0, b, 0.0, c))
    t = [[float(value) for value in row] for row in inertia.tensor]
    return Inertial(inertia.mass, Pose(position), (t[0][0], t[0][1], t[0][2], t[1][1], t[1][2], t[2][2]))
