"""Keyframes of MJCF files: the states of all joints, as states of the bodies they belong to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from carom.description.keyframe import BodyKeyframe
from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import compose, inverse, rotate
from carom.formats.mjcf.compiled.actuation.hanging import SLIDES, TURN
from carom.formats.mjcf.compiled.model import NODE
from carom.model.body_spec import BASE
from carom.scene.handles import present_link_frame
from carom.scene.keyframes.changes import add_keyframe

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import CompiledModel, FileKeyframe
    from carom.scene.core.body_core import BodyCore

_FREE, _BALL = "free", "spherical"
_ORIGIN = (0.0, 0.0, 0.0)
# Numbers of a joint in `qpos` and `qvel`.
_COUNTS = {_FREE: (7, 6), _BALL: (4, 3)}


@dataclass
class _Part:
    """What a keyframe says of one body: of its base if that is free, and of joints by index."""

    pose: Pose | None = None
    linear: Vector3 | None = None
    angular: Vector3 | None = None
    positions: dict[int, list[float]] = field(default_factory=dict)
    velocities: dict[int, list[float]] = field(default_factory=dict)


def give_keyframes(bodies: Sequence[BodyCore], model: CompiledModel) -> None:
    """Add the keyframes of a file to its bodies, to those that can move or have actuators."""
    for state in model.keyframes.values():
        controls_of = _by_name([it.name for it in model.actuators], state.controls)
        activation_of = _by_name([it.name for it in model.actuators if it.has_activation], state.activations)
        for body, part in zip(bodies, _parts(bodies, model, state), strict=True):
            names = [it.name for it in body.spec.actuators]
            # None if the body has no actuators.
            controls = tuple(controls_of.get(name, 0.0) for name in names) if names else None
            activations = tuple(activation_of.get(name, 0.0) for name in names) if names else None
            if part.positions or part.velocities or part.pose or part.linear or controls:
                add_keyframe(
                    body,
                    BodyKeyframe(
                        state.name, state.time, part.pose, part.linear, part.angular,
                        _in_order(part.positions), _in_order(part.velocities), controls, activations,
                    ),
                )  # fmt: skip


def _parts(bodies: Sequence[BodyCore], model: CompiledModel, state: FileKeyframe) -> list[_Part]:
    places = {
        link.joint_name: (number, index)
        for number, body in enumerate(bodies)
        for index, link in enumerate(body.spec.links)
    }
    free = {body.spec.name: number for number, body in enumerate(bodies)}
    parts = [_Part() for _ in bodies]
    position = velocity = 0
    positions = state.positions or model.reference
    for name, body_name, kind in model.joints:
        counts = _COUNTS.get(kind, (1, 1))
        q = list(positions[position : position + counts[0]])
        v = list(state.velocities[velocity : velocity + counts[1]])
        rest = model.reference[position : position + counts[0]]
        position, velocity = position + counts[0], velocity + counts[1]
        if kind == NODE:
            continue
        if kind == _FREE:
            if body_name in free:
                _put_base(bodies[free[body_name]], parts[free[body_name]], q, v)
                continue
            number, joint = places[body_name + SLIDES[0]]
            _put_hanging(parts[number], joint, places[body_name + TURN][1], q, v, rest)
            continue
        number, joint = places[name]
        if q:
            parts[number].positions[joint] = [*_unit((q[1], q[2], q[3], q[0]))] if kind == _BALL else q
        if v:
            parts[number].velocities[joint] = v
    return parts


def _unit(quaternion: Quaternion) -> Quaternion:
    """A quaternion of length 1; without rotation if it has none."""
    x, y, z, w = quaternion
    size = hypot(x, y, z, w)
    return (x / size, y / size, z / size, w / size) if size > 0.0 else (0.0, 0.0, 0.0, 1.0)


def _put_base(body: BodyCore, part: _Part, q: list[float], v: list[float]) -> None:
    """The state of a free body: that of its link frame, its angular velocity in its own axes."""
    if q:
        px, py, pz, w, x, y, z = q
        part.pose = Pose((px, py, pz), _unit((x, y, z, w)))
    if v:
        x, y, z, wx, wy, wz = v
        pose = present_link_frame(body, BASE) if part.pose is None else part.pose
        part.linear, part.angular = (x, y, z), rotate(pose.orientation, (wx, wy, wz))


def _put_hanging(
    part: _Part, slide: int, ball: int, q: list[float], v: list[float], rest: list[float]
) -> None:
    """The state of a free body that hangs from the world, relative to its pose at `rest`.

    Its slides are the joints from `slide` on; its velocities are those of a free joint.
    """
    if q:
        for axis in range(3):
            part.positions[slide + axis] = [q[axis] - rest[axis]]
        (w, x, y, z), (rw, rx, ry, rz) = q[3:], rest[3:]
        turn = compose(inverse(Pose(_ORIGIN, (rx, ry, rz, rw))), Pose(_ORIGIN, _unit((x, y, z, w))))
        part.positions[ball] = [*_unit(turn.orientation)]
    if v:
        for axis in range(3):
            part.velocities[slide + axis] = [v[axis]]
        part.velocities[ball] = v[3:]


def _by_name(names: Sequence[str], values: Sequence[float]) -> dict[str, float]:
    return dict(zip(names, values, strict=True)) if values else {}


def _in_order(of_joints: dict[int, list[float]]) -> tuple[float, ...] | None:
    if not of_joints:
        return None
    return tuple(np.concatenate([of_joints[joint] for joint in sorted(of_joints)]).tolist())
