"""A replay as an MCAP file with Foxglove's schemas."""

# pyright: reportMissingImports=false

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from carom.replay.draft import draft
from carom.replay.losses import COLLISIONS, EVENTS, SENSORS, TENDONS, TEXTURES, VELOCITIES, lost
from carom.replay.replay import Replay, ReplayBody, ReplayLook, ReplayShape

_WORLD = "world"


def write_mcap(replay: Replay, path: Path) -> tuple[str, ...]:
    """Write a replay; times are those of `Replay.clock`, from 0 on.

    Topics are `/tf` (FrameTransforms: a frame `body/link` for each link), `/scene/BODY` (SceneUpdate),
    `/joints/BODY` (JointStates), and in JSON `/contacts` and `/values`, what the script plotted.

    Returns:
        What the file lacks.

    Raises:
        ImportError: `foxglove-sdk` is not installed.
        OSError: The file cannot be written.
    """
    try:
        import foxglove
    except ImportError as problem:
        raise ImportError(
            f"{path}: MCAP is written by foxglove-sdk: pip install 'carom[foxglove]'"
        ) from problem
    context = foxglove.Context()
    # Its writer takes the name of a file: what it would write to memory may be large.
    with draft(path) as unfinished, foxglove.open_mcap(unfinished, context=context):
        _Writer(replay, context).write()
    return lost(replay, TEXTURES, TENDONS, SENSORS, VELOCITIES, COLLISIONS, EVENTS)


class _Writer:
    def __init__(self, replay: Replay, context: Any) -> None:
        from foxglove import Channel, channels

        self._replay = replay
        self._moments = np.rint(1e9 * (replay.clock - replay.clock[0])).astype(np.int64).tolist()
        self._tf = channels.FrameTransformsChannel("/tf", context=context)
        bodies = replay.bodies.items()
        self._scenes = {
            name: channels.SceneUpdateChannel(f"/scene/{name}", context=context) for name, _ in bodies
        }
        self._joints = {
            name: channels.JointStatesChannel(f"/joints/{name}", context=context)
            for name, body in bodies
            if any(not np.isnan(joint.position).all() for joint in body.joints.values())
        }

        self._contacts = self._values = None
        if len(replay.contacts.frame):
            self._contacts = Channel("/contacts", schema=_in_json("carom.Contacts"), context=context)
        if replay.values:
            self._values = Channel("/values", schema=_in_json("carom.Values"), context=context)

    def write(self) -> None:
        poses = {
            (name, link): found.pose
            for name, body in self._replay.bodies.items()
            for link, found in body.links.items()
        }
        for frame, moment in enumerate(self._moments):
            self._tell_poses(frame, moment, poses)
            for name, body in self._replay.bodies.items():
                self._tell_looks(frame, moment, name, body)
                if name in self._joints and body.present[frame]:
                    self._tell_joints(frame, moment, name, body)
            if self._contacts is not None:
                self._contacts.log({"contacts": self._contacts_of(frame)}, log_time=moment)
            if self._values is not None:
                values = {name: float(value[frame]) for name, value in self._replay.values.items()}
                told = {name: value for name, value in values.items() if not np.isnan(value)}
                self._values.log(told, log_time=moment)

    def _tell_poses(self, frame: int, moment: int, poses: dict[tuple[str, str], Any]) -> None:
        from foxglove.messages import FrameTransform, FrameTransforms

        rows = ((place, found[frame].tolist()) for place, found in poses.items())
        transforms = [
            FrameTransform(
                timestamp=_timestamp(moment),
                parent_frame_id=_WORLD,
                child_frame_id=f"{body}/{link}",
                translation=_vector(row[:3]),
                rotation=_quaternion(row[3:]),
            )
            for (body, link), row in rows
            if row[0] == row[0]
        ]
        self._tf.log(FrameTransforms(transforms=transforms), log_time=moment)

    def _tell_looks(self, frame: int, moment: int, name: str, body: ReplayBody) -> None:
        from foxglove.messages import SceneEntityDeletion, SceneEntityDeletionType, SceneUpdate

        for look in body.looks:
            if look.begin == frame:
                # Complete, for players show the last message of a topic before the moment.
                gone = SceneEntityDeletion(timestamp=_timestamp(moment), type=SceneEntityDeletionType.All)
                update = SceneUpdate(deletions=[gone], entities=_entities(look, name, body, moment))
                self._scenes[name].log(update, log_time=moment)
            elif look.end == frame and not any(other.begin == frame for other in body.looks):
                gone = SceneEntityDeletion(timestamp=_timestamp(moment), type=SceneEntityDeletionType.All)
                self._scenes[name].log(SceneUpdate(deletions=[gone]), log_time=moment)

    def _tell_joints(self, frame: int, moment: int, name: str, body: ReplayBody) -> None:
        from foxglove.messages import JointState, JointStates

        states = []
        for joint in body.joints.values():
            if not np.isnan(joint.position[frame]):
                position, velocity = float(joint.position[frame]), float(joint.velocity[frame])
                effort = float(joint.torque[frame])
                states.append(
                    JointState(name=joint.name, position=position, velocity=velocity, effort=effort)
                )
        self._joints[name].log(JointStates(timestamp=_timestamp(moment), joints=states), log_time=moment)

    def _contacts_of(self, frame: int) -> list[dict[str, Any]]:
        contacts = self._replay.contacts
        first, last = np.searchsorted(contacts.frame, (frame, frame + 1)).tolist()
        return [
            {
                "bodies": [str(contacts.body_a[row]), str(contacts.body_b[row])],
                "links": [str(contacts.link_a[row]), str(contacts.link_b[row])],
                "position": contacts.position[row].tolist(),
                "normal": contacts.normal[row].tolist(),
                "normal_force": float(contacts.normal_force[row]),
                "friction_force": contacts.friction_force[row].tolist(),
                "distance": float(contacts.distance[row]),
            }
            for row in range(first, last)
        ]


def _in_json(title: str) -> dict[str, Any]:
    return {"title": title, "type": "object"}


def _entities(look: ReplayLook, name: str, body: ReplayBody, moment: int) -> list[Any]:
    from foxglove.messages import SceneEntity

    entities = []
    for link in body.links:
        triangles = [
            _triangles(shape)
            for shape in look.shapes
            if shape.link == link and not shape.collision and shape.rgba[3] > 0.0
        ]
        if triangles:
            frame = f"{name}/{link}"
            entities.append(
                SceneEntity(
                    timestamp=_timestamp(moment),
                    frame_id=frame,
                    id=frame,
                    frame_locked=True,
                    triangles=triangles,
                )
            )
    return entities


def _triangles(shape: ReplayShape) -> Any:
    from foxglove.messages import Color, Point3, Pose, TriangleListPrimitive

    red, green, blue, alpha = shape.rgba
    points = shape.mesh.positions.astype(np.float64) * shape.scale
    return TriangleListPrimitive(
        pose=Pose(position=_vector(shape.pose.position), orientation=_quaternion(shape.pose.orientation)),
        points=[Point3(x=x, y=y, z=z) for x, y, z in points.tolist()],
        color=Color(r=red, g=green, b=blue, a=alpha),
        indices=shape.mesh.triangles.reshape(-1).tolist(),
    )


def _timestamp(moment: int) -> Any:
    from foxglove.messages import Timestamp

    return Timestamp(sec=moment // 10**9, nsec=moment % 10**9)


def _vector(values: Any) -> Any:
    from foxglove.messages import Vector3

    x, y, z = values
    return Vector3(x=x, y=y, z=z)


def _quaternion(values: Any) -> Any:
    from foxglove.messages import Quaternion

    x, y, z, w = values
    return Quaternion(x=x, y=y, z=z, w=w)
