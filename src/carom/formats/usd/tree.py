"""Robots from the bodies and joints of a stage: one for each tree of bodies that joints connect."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

from carom.description import Joint, JointType, Link, Pose, Robot
from carom.description.joint import BALL_TYPES, HINGES, SLIDES
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import compose, inverse, rotate
from carom.formats.placed import PlacedRobot
from carom.formats.robot.link import MASSLESS
from carom.formats.usd.bodies import Part, Parts
from carom.formats.usd.joints import End, Motion, UsdJoint, position_of
from carom.formats.usd.scene import UsdRobot
from carom.formats.usd.stage import Stage, homogeneous

WORLD = "world"
_NEAR = 1e-9
"""Distance from the axis of a joint below which the origin of a link is on it [m]."""
_MOVED = 1e-5
"""Position of a joint, or error of a pose, below which it is rounding of the file [rad or m]."""


class Tree:
    """One robot in the making.

    Attributes:
        parts: Its bodies, the root first, in the order in which joints reach them.
        names: The name of the link of each, by path.
        robot: The robot, once it is made.
        joined: Paths of bodies that a joint connects and that so do not collide.
        loops: Joints that would close a loop.
        hung: Joints that carry bodies.
    """

    def __init__(self, stage: Stage, parts: list[Part], joints: list[UsdJoint]) -> None:
        self.stage = stage
        self.joined: set[frozenset[str]] = set()
        self.loops: list[UsdJoint] = []
        self.hung: list[UsdJoint] = []
        self._joints = joints
        self._links: list[Link] = []
        self._made: list[Joint] = []
        self._index: dict[str, int] = {}
        self.names = _names(stage, parts)
        self.parts: list[Part] = []
        fixed, root = self._root(parts)
        self.robot = UsdRobot(PlacedRobot(Robot("", (), ())))
        if root is None:
            self._links.append(Link(WORLD, MASSLESS))
        else:
            self._add(root)
        self._grow(root)
        pose = IDENTITY if root is None else self._root_pose(root, fixed=fixed)
        name = self._name(parts)
        robot = Robot(
            name,
            tuple(self._links),
            tuple(self._made),
            source=stage.file,
            is_mocap=root is not None and root.kinematic,
        )
        self.robot.placed = PlacedRobot(robot, pose, fixed)
        if root is not None and not fixed:
            self.robot.velocity, self.robot.angular_velocity = root.velocity, root.angular_velocity

    def _name(self, parts: list[Part]) -> str:
        """That of the articulation, else that of the root."""
        joint, api = self.stage.pxr.UsdPhysics.Joint, self.stage.pxr.UsdPhysics.ArticulationRootAPI
        prims = [*(part.prim for part in parts), *(joint.prim for joint in self._joints)]
        for prim in prims:
            for it in self.stage.above(prim):
                if it.HasAPI(api):
                    return self.stage.name_of(it.GetParent() if it.IsA(joint) else it)
        return self.stage.name_of(self.parts[0].prim)

    def _root(self, parts: list[Part]) -> tuple[bool, Part | None]:
        """Whether the root is fixed, and what it is; None for the world, to which joints lead."""
        kinematic = [part for part in parts if part.kinematic]
        if kinematic:
            for part in kinematic[1:]:
                self.stage.leave_out(part.prim, "joints move it", "one body of a robot is moved by users")
            return True, kinematic[0]
        held = [joint for joint in self._joints if None in (joint.ends[0].part, joint.ends[1].part)]
        if len(held) == 1 and not held[0].motions:
            return True, held[0].ends[0].part or held[0].ends[1].part
        if held:
            return True, None
        api = self.stage.pxr.UsdPhysics.ArticulationRootAPI
        seconds = {id(joint.ends[1].part) for joint in self._joints if not joint.outside}
        first = [part for part in parts if part.prim.HasAPI(api)]
        first += [part for part in parts if id(part) not in seconds]
        return False, (first or parts)[0]

    def _root_pose(self, root: Part, *, fixed: bool) -> Pose:
        """Where the joint to the world holds the root, else where the stage has it."""
        if not fixed or root.kinematic:
            return root.pose
        joint = next(it for it in self._joints if None in (it.ends[0].part, it.ends[1].part))
        world, own = joint.ends if joint.ends[0].part is None else joint.ends[::-1]
        held = compose(world.frame, inverse(own.frame))
        # Exactly where the stage has it, if that is the same but for the rounding of the joint's frames.
        return root.pose if _distance(held, root.pose) < _MOVED else held

    def _add(self, part: Part) -> int:
        self._index[part.path] = index = len(self._links)
        self._links.append(replace(part.link, name=self.names[part.path]))
        self.parts.append(part)
        return index

    def _grow(self, root: Part | None) -> None:
        """Hang bodies on the root, those nearest first; articulated joints come before others."""
        used: set[int] = set()
        ways: dict[int, list[UsdJoint]] = {}
        for joint in self._joints:
            for end in joint.ends:
                ways.setdefault(id(end.part), []).append(joint)
            if not joint.collide:
                self.joined.add(
                    frozenset(end.part.path if end.part is not None else "" for end in joint.ends)
                )
        for outside in (False, True):
            pending: list[Part | None] = [root, *(part for part in self.parts if part is not root)]
            while pending:
                at = pending.pop(0)
                for joint in ways.get(id(at), ()):
                    if id(joint) in used or (joint.outside and not outside):
                        continue
                    forwards = joint.ends[0].part is at
                    near, far = joint.ends if forwards else joint.ends[::-1]
                    if far.part is None or far.part.path in self._index:
                        continue
                    used.add(id(joint))
                    self.hung.append(joint)
                    self._hang(joint, near, far, forwards=forwards)
                    pending.append(far.part)
        holding = [
            it for it in self._joints if root is not None and None in (it.ends[0].part, it.ends[1].part)
        ]
        used.update(id(it) for it in holding[:1] if not it.motions and not root.kinematic)  # pyright: ignore
        self.loops = [joint for joint in self._joints if id(joint) not in used]

    def _hang(self, joint: UsdJoint, near: End, far: End, *, forwards: bool) -> None:
        """Add a body and the joints to it, with massless links between them."""
        assert far.part is not None
        parent = 0 if near.part is None else self._index[near.part.path]
        near_pose = IDENTITY if near.part is None else near.part.pose
        between = compose(inverse(compose(near_pose, near.frame)), compose(far.part.pose, far.frame))
        own, name = self.names[far.part.path], self.stage.name_of(joint.prim)
        motions = joint.motions if forwards else _turned(joint.motions)
        frame, offset = near.frame, inverse(far.frame)
        for number, motion in enumerate(motions):
            frame = compose(frame, motion.shift)
            is_last = number == len(motions) - 1
            axis = rotate(far.frame.orientation, motion.axis) if is_last else motion.axis
            if is_last and not _is_off(motion, far.frame.position, axis):
                self._join(replace(motion, axis=axis), parent, self._add(far.part), compose(frame, offset))
                break
            self._links.append(Link(f"{own}@{motion.name}", MASSLESS))
            self._join(motion, parent, len(self._links) - 1, frame)
            parent, frame = len(self._links) - 1, IDENTITY
        else:
            fixed = Motion(f"{name}@" if motions else name, JointType.FIXED)
            exact = compose(inverse(near_pose), far.part.pose) if not motions else None
            held = compose(frame, offset)
            self._join(fixed, parent, self._add(far.part), _exactly(held, exact))
        self._place(joint, motions, between)

    def _place(self, joint: UsdJoint, motions: list[Motion], between: Pose) -> None:
        """Note where the joint is in the stage, and report what it does not reach."""
        if len(motions) > 1 or not motions:
            at_zero = IDENTITY
            for motion in motions:
                at_zero = compose(at_zero, motion.shift)
            if _distance(between, at_zero) > _MOVED:
                self.stage.leave_out(
                    joint.prim, "its bodies begin where the joint is at 0", "they are elsewhere"
                )
            return
        motion = motions[0]
        position, turn = position_of(motion, between)
        if motion.type in BALL_TYPES:
            if max(map(abs, turn[:3])) > _MOVED:
                self.robot.turns[motion.name] = turn
        elif abs(position) > _MOVED:
            self.robot.positions[motion.name] = position

    def _join(self, motion: Motion, parent: int, child: int, frame: Pose) -> None:
        self._made.append(
            Joint(
                motion.name,
                motion.type,
                parent,
                child,
                frame,
                motion.axis,
                limit=motion.limit,
                damping=motion.damping,
                friction=motion.friction,
                armature=motion.armature,
                stiffness=motion.stiffness,
                spring_reference=motion.reference,
                mimic=motion.mimic,
            )
        )
        if motion.drive is not None:
            self.robot.drives.append(motion.drive)


def _exactly(held: Pose, exact: Pose | None) -> Pose:
    """A pose by the frames of a joint, or where the stage has it if that is the same but for rounding."""
    return exact if exact is not None and _distance(held, exact) < _MOVED else held


def _distance(a: Pose, b: Pose) -> float:
    """The greatest difference between the matrices of two poses."""
    return float(np.abs(homogeneous(a) - homogeneous(b)).max())


def _turned(motions: list[Motion]) -> list[Motion]:
    """The same motions, of the first body from the second."""
    found = []
    shift = IDENTITY
    for motion in reversed(motions):
        x, y, z = motion.axis
        found.append(replace(motion, axis=(-x, -y, -z), shift=shift))
        shift = IDENTITY if motion.shift == IDENTITY else inverse(motion.shift)
    return found


def _is_off(motion: Motion, place: Vector3, axis: Vector3) -> bool:
    """Whether the origin of a link is off the axis of its joint, which is at `place` in its frame."""
    if motion.type in SLIDES:
        return False
    arm = np.array(place)
    if motion.type in HINGES:
        arm = arm - np.array(axis) * np.dot(arm, axis)
    return float(np.linalg.norm(arm)) > _NEAR


def _names(stage: Stage, parts: list[Part]) -> dict[str, str]:
    """Names of links by path: those of the prims, with those of prims around them where they are the same."""
    words = {part.path: [*part.path.strip("/").split("/")[:-1], stage.name_of(part.prim)] for part in parts}
    count = dict.fromkeys(words, 1)
    while True:
        names = {path: "/".join(it[-count[path] :]) for path, it in words.items()}
        times = Counter(names.values())
        same = [path for path, name in names.items() if times[name] > 1 and count[path] < len(words[path])]
        if not same:
            return names
        for path in same:
            count[path] += 1


def make_trees(stage: Stage, parts: Parts, joints: list[UsdJoint]) -> list[Tree]:
    """The robots of a stage, in the order of their first bodies."""
    group: dict[str, str] = {part.path: part.path for part in parts.moving}

    def top(path: str) -> str:
        while group[path] != path:
            group[path] = group[group[path]]
            path = group[path]
        return path

    joints = [joint for joint in joints if not joint.is_free]
    for joint in joints:
        first, second = (end.part for end in joint.ends)
        if first is not None and second is not None:
            group[top(first.path)] = top(second.path)
    members: dict[str, list[Part]] = {}
    for part in parts.moving:
        members.setdefault(top(part.path), []).append(part)
    own: dict[str, list[UsdJoint]] = {}
    for joint in joints:
        part: Any = joint.ends[0].part or joint.ends[1].part
        own.setdefault(top(part.path), []).append(joint)
    return [Tree(stage, them, own.get(key, [])) for key, them in members.items()]
