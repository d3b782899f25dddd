"""A replay as a recording of Rerun."""

# pyright: reportMissingImports=false

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.replay.draft import draft
from carom.replay.losses import COLLISIONS, EVENTS, SENSORS, TENDONS, VELOCITIES, lost
from carom.replay.replay import Floats, Replay, ReplayBody, ReplayLook, ReplayShape

# Length of the arrow of a force [m/N].
_ARROW = 0.01


def write_rrd(replay: Replay, path: Path) -> tuple[str, ...]:
    """Write a replay on the timeline `time`, which is that of `Replay.clock`, from 0 on.

    Entities are `world/BODY/LINK` with its shapes below, `joints/BODY/JOINT/position` and so on,
    `values/NAME`, and `world/contacts`: arrows of the forces on the first body, 1 cm for each newton.

    Returns:
        What the file lacks.

    Raises:
        ImportError: `rerun-sdk` is not installed.
        OSError: The file cannot be written.
    """
    try:
        import rerun
    except ImportError as problem:
        raise ImportError(f"{path}: .rrd is written by rerun-sdk: pip install 'carom[rerun]'") from problem
    with draft(path) as unfinished:
        stream = rerun.RecordingStream("carom")
        try:
            stream.save(unfinished)
            stream.send_recording_name(replay.title)
            _Writer(replay, rerun, stream).write()
        finally:
            # It writes what is left.
            stream.disconnect()
    return lost(replay, TENDONS, SENSORS, VELOCITIES, COLLISIONS, EVENTS)


class _Writer:
    def __init__(self, replay: Replay, rerun: Any, stream: Any) -> None:
        self._replay = replay
        self._rerun = rerun
        self._stream = stream
        self._clock = replay.clock - replay.clock[0]

    def write(self) -> None:
        rerun, stream = self._rerun, self._stream
        stream.log("world", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        for name, body in self._replay.bodies.items():
            for link in body.links.values():
                poses = link.pose
                frames = np.flatnonzero(body.present)
                columns = rerun.Transform3D.columns(
                    translation=poses[frames, :3], quaternion=poses[frames, 3:]
                )
                self._columns(f"world/{_part(name)}/{_part(link.name)}", frames, columns)
            for number, look in enumerate(body.looks):
                self._tell_look(name, body, number, look)
            for joint in body.joints.values():
                for quantity in ("position", "velocity", "torque"):
                    entity = f"joints/{_part(name)}/{_part(joint.name)}/{quantity}"
                    self._tell_scalars(entity, getattr(joint, quantity))
        for name, values in self._replay.values.items():
            self._tell_scalars(f"values/{_part(name)}", values)
        self._tell_contacts()

    def _columns(self, entity: str, frames: NDArray[np.int64], columns: Any) -> None:
        if len(frames):
            time = self._rerun.TimeColumn("time", duration=self._clock[frames])
            self._stream.send_columns(entity, [time], columns)

    def _tell_scalars(self, entity: str, values: Floats) -> None:
        frames = np.flatnonzero(~np.isnan(values))
        self._columns(entity, frames, self._rerun.Scalars.columns(scalars=values[frames]))

    def _tell_look(self, name: str, body: ReplayBody, number: int, look: ReplayLook) -> None:
        rerun, stream = self._rerun, self._stream
        always = look.begin == 0 and look.end == len(self._clock)
        for place, shape in enumerate(look.shapes):
            if shape.collision or shape.rgba[3] <= 0.0 or not len(shape.mesh.triangles):
                continue
            entity = f"world/{_part(name)}/{_part(shape.link)}/look_{number}_{place}"
            pose = rerun.Transform3D(
                translation=shape.pose.position, quaternion=rerun.Quaternion(xyzw=shape.pose.orientation)
            )
            stream.set_time("time", duration=float(self._clock[look.begin]))
            stream.log(entity, pose, _mesh(rerun, shape), static=always)
            if look.end < len(self._clock):
                stream.set_time("time", duration=float(self._clock[look.end]))
                stream.log(entity, rerun.Clear(recursive=True))

    def _tell_contacts(self) -> None:
        contacts = self._replay.contacts
        if not len(contacts.frame):
            return
        forces = contacts.normal * contacts.normal_force[:, None] + contacts.friction_force
        for frame, moment in enumerate(self._clock.tolist()):
            first, last = np.searchsorted(contacts.frame, (frame, frame + 1)).tolist()
            self._stream.set_time("time", duration=moment)
            self._stream.log(
                "world/contacts",
                self._rerun.Arrows3D(
                    origins=contacts.position[first:last], vectors=_ARROW * forces[first:last]
                ),
            )


def _mesh(rerun: Any, shape: ReplayShape) -> Any:
    texture = None
    if shape.texture is not None:
        from PIL import Image

        with Image.open(BytesIO(shape.texture.data)) as image:
            texture = np.asarray(image.convert("RGB"))
    scale = np.array(shape.scale)
    return rerun.Mesh3D(
        vertex_positions=shape.mesh.positions * scale,
        # Scaled as normals are.
        vertex_normals=shape.mesh.normals / np.where(scale == 0.0, 1.0, scale),
        # Here v points down.
        vertex_texcoords=shape.mesh.uvs * np.array([1, -1], np.float32) + np.array([0, 1], np.float32),
        triangle_indices=shape.mesh.triangles,
        albedo_factor=shape.rgba,
        albedo_texture=texture,
    )


def _part(name: str) -> str:
    """A name as a part of the path of an entity, in which some signs have a meaning of their own."""
    return "".join(sign if sign.isalnum() or sign in "_-." else f"\\{sign}" for sign in name) or "_"
