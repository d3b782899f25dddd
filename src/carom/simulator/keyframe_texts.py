"""Keyframes as texts to copy: the `<key>` of an MJCF file, or code for bodies of other files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from carom.description.keyframe import BodyKeyframe
from carom.description.transform import rotate

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled import CompiledModel
    from carom.scene.body import Body
    from carom.simulator.loading import LoadedFile

_FREE = "free"
_DIGITS = 9


def keyframe_text(name: str, files: Sequence[LoadedFile]) -> str:
    """A keyframe of this name of the bodies of files, as a text.

    An MJCF file that is alone has the `<key>` element that states it there; else it is Python, for the bodies
    of a world that are found by their names.
    """
    if len(files) == 1 and files[0].model is not None:
        return _key(name, files[0].bodies, files[0].model)
    lines = [
        "from carom.description.keyframe import BodyKeyframe",
        "from carom.description.pose import Pose",
        "",
    ]
    for body in (body for file in files for body in file.bodies):
        keyframe = _of(body, name)
        if keyframe is not None and (not body.fixed_base or any(body.velocity_count)):
            lines.append(f"world[{body.name!r}].add_keyframe({_code(keyframe)})")
    return "\n".join(lines)


def _of(body: Body, name: str) -> BodyKeyframe | None:
    return next((it for it in body.spec.keyframes if it.name == name), None)


def _code(keyframe: BodyKeyframe) -> str:
    parts = [repr(keyframe.name)]
    if keyframe.time:
        parts.append(f"time={round(keyframe.time, _DIGITS)}")
    if keyframe.pose is not None:
        parts.append(f"pose=Pose({_tuple(keyframe.pose.position)}, {_tuple(keyframe.pose.orientation)})")
    for field in (
        "linear_velocity", "angular_velocity", "positions", "velocities", "controls", "activations"
    ):  # fmt: skip
        values = getattr(keyframe, field)
        if values:
            parts.append(f"{field}={_tuple(values)}")
    return f"BodyKeyframe({', '.join(parts)})"


def _tuple(values: Sequence[float]) -> str:
    return repr(tuple(round(it, _DIGITS) + 0.0 for it in values))


def _key(name: str, bodies: Sequence[Body], model: CompiledModel) -> str:
    """The `<key>` of a state of all joints and actuators of an MJCF file, in its order."""
    bases = {body.spec.name: body for body in bodies}
    joints = {
        link.joint_name: (body, index)
        for body in bodies
        for index, link in enumerate(body.spec.links)
        if body.velocity_count[index]
    }
    actuators = {it.name: index for body in bodies for index, it in enumerate(body.spec.actuators)}
    positions: list[float] = []
    velocities: list[float] = []
    for joint, body_name, kind in model.joints:
        if kind == _FREE:
            _add_base(_of(bases[body_name], name), positions, velocities)
        elif joint in joints:
            _add_joint(*joints[joint], name, positions, velocities)
    states = {it.name: _of(body, name) for body in bodies for it in body.spec.actuators}
    controls: list[float] = []
    activations: list[float] = []
    for it in model.actuators:
        index = actuators[it.name]
        state = states[it.name]
        controls.append(state.controls[index] if state is not None and state.controls else 0.0)
        if it.has_activation:
            activations.append(state.activations[index] if state is not None and state.activations else 0.0)
    time = max((it.time for body in bodies if (it := _of(body, name)) is not None), default=0.0)
    attributes = [f"name={quoteattr(name)}"]
    if time:
        attributes.append(f'time="{time:.9g}"')
    for attribute, values in (
        ("qpos", positions), ("qvel", velocities), ("act", activations), ("ctrl", controls)
    ):  # fmt: skip
        if values and (attribute == "qpos" or any(values)):
            attributes.append(f'{attribute}="{" ".join(f"{it + 0.0:.9g}" for it in values)}"')
    return f"<key {' '.join(attributes)}/>"


def _add_base(keyframe: BodyKeyframe | None, positions: list[float], velocities: list[float]) -> None:
    if keyframe is None or keyframe.pose is None:
        positions += [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        velocities += [0.0] * 6
        return
    x, y, z, w = keyframe.pose.orientation
    positions += [*keyframe.pose.position, w, x, y, z]
    angular = rotate((-x, -y, -z, w), keyframe.angular_velocity or (0.0, 0.0, 0.0))
    velocities += [*(keyframe.linear_velocity or (0.0, 0.0, 0.0)), *angular]


def _add_joint(body: Body, joint: int, name: str, positions: list[float], velocities: list[float]) -> None:
    keyframe = _of(body, name)
    before, rates_before = sum(body.position_count[:joint]), sum(body.velocity_count[:joint])
    count, rates = body.position_count[joint], body.velocity_count[joint]
    stated = None if keyframe is None else keyframe.positions
    q = list(stated[before : before + count]) if stated else [0.0] * (count - 1) + [float(count > 1)]
    if count > 1:
        q = [q[3], *q[:3]]
    positions += q
    speeds = None if keyframe is None else keyframe.velocities
    velocities += speeds[rates_before : rates_before + rates] if speeds else [0.0] * rates
