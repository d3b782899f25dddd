"""Keyframes: states of a file's bodies by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import Pose
from carom.description.transform import compose, rotation_matrix
from carom.model.body_spec import BASE
from carom.native.products import dots

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import CompiledModel, FileKeyframe
    from carom.scene.body import Body
    from carom.world.scene import Scene

_FREE, _BALL = "free", "spherical"


class Keyframe:
    """A state of the bodies of a scene.

    Attributes:
        name: Its name.
        time: [s], as the file states it.
        positions: Of all joints in the order of the file [rad or m]: of a free body 7 numbers, position and
            quaternion (w, x, y, z); of a spherical joint a quaternion (w, x, y, z). Empty if there are none.
        velocities: Of all joints in that order: of a free body the velocity of its frame in the world, and
            its angular velocity in its own axes. Empty if the file has none: the bodies are at rest.
        controls: Of all actuators in the order of the file. Empty if the file has none: they are 0.
        activations: Of all actuators with a state, in that order. Empty if the file has none: they are 0.
    """

    def __init__(self, state: FileKeyframe, scene: Scene, model: CompiledModel) -> None:
        self.name = state.name
        self.time = state.time
        self.positions: np.ndarray = np.array(state.positions)
        self.velocities: np.ndarray = np.array(state.velocities)
        self.controls: np.ndarray = np.array(state.controls)
        self.activations: np.ndarray = np.array(state.activations)
        self._bodies = tuple(scene.bodies)
        self._joints = tuple(model.joints)
        # By the order of controls, and by that of activations; None for one that is not built.
        self._actuators = [scene.actuators.get(it.name) for it in model.actuators]
        self._with_activation = [scene.actuators.get(it.name) for it in model.actuators if it.has_activation]

    def __repr__(self) -> str:
        return f"<Keyframe {self.name!r}: {len(self.positions)} positions>"

    def apply(self) -> None:
        """Put the bodies into this state; positions that the file does not state stay as they are."""
        places = {
            link.joint_name: (body, i) for body in self._bodies for i, link in enumerate(body.spec.links)
        }
        free = {body.spec.base.name: body for body in self._bodies}
        position = velocity = 0
        for name, body_name, kind in self._joints:
            counts = {_FREE: (7, 6), _BALL: (4, 3)}.get(kind, (1, 1))
            q = self.positions[position : position + counts[0]].tolist()
            v = self.velocities[velocity : velocity + counts[1]].tolist() or [0.0] * counts[1]
            position, velocity = position + counts[0], velocity + counts[1]
            if kind == _FREE:
                _place(free[body_name], q, v)
                continue
            body, joint = places[name]
            if kind == _BALL and q:
                w, x, y, z = q
                q = [x, y, z, w]
            body.set_joint_state(joint, q or None, v)
        for number, actuator in enumerate(self._actuators):
            if actuator is not None:
                actuator.control = self.controls[number] if len(self.controls) else 0.0
        for number, actuator in enumerate(self._with_activation):
            if actuator is not None:
                actuator.activation = self.activations[number] if len(self.activations) else 0.0
        for body in self._bodies:
            body.note_reset(moved=True)


def _place(body: Body, q: list[float], v: list[float]) -> None:
    """Put a free body at the pose of its link frame, with the velocity of that frame."""
    inertial = body.link_inertial_frame(BASE)
    if q:
        px, py, pz, w, x, y, z = q
        pose = compose(Pose((px, py, pz), (x, y, z, w)), inertial)
        body.set_base_pose(pose.position, pose.orientation)
    x, y, z = body.links[BASE].pose.orientation[:3]
    turn = np.array(rotation_matrix((x, y, z, body.links[BASE].pose.orientation[3])))
    spin = dots(turn, np.array(v[3:]))
    linear = v[:3] + np.cross(spin, dots(turn, np.array(inertial.position)))
    body.set_base_velocity(linear.tolist(), spin.tolist())
