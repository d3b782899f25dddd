"""Free bodies that hang from the world on three slides along its axes and a ball, and move as freely.

A tendon or an actuator between two trees of joints acts within one robot, whose base is the world. A free
body in it can't be a base of its own. Its joints are called `BODY@x`, `BODY@y`, `BODY@z` and `BODY@turn`;
their positions count from the pose that the file states.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.description import Joint
from carom.description.compliance import Compliance
from carom.description.joint import BALL, SLIDER
from carom.description.transform import rotation_matrix
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint, CompiledModel

SLIDES = ("@x", "@y", "@z")
"""What the names of the slides have behind that of the body, in the order of axes; the ball follows them."""
TURN = "@turn"
"""What the name of the ball has behind that of the body."""


def hang(body: CompiledBody, model: CompiledModel, context: CompiledContext) -> None:
    """Give a free body of the world joints with the damping, spring and friction of its free joint."""
    turn = np.array(rotation_matrix(body.pose.orientation))
    shared = Joint(
        "",
        SLIDER,
        0,
        0,
        damping=body.free_damping,
        armature=body.free_armature,
        stiffness=body.free_stiffness,
        friction=body.free_friction,
    )
    yielding = body.free_compliance
    mass, inertia = model.free_weights[body.name]

    def along(number: int, name: str) -> Joint:
        # Axes of the world in those of the body.
        x, y, z = (float(value) for value in turn[number])
        return replace(
            shared, name=body.name + name, axis=(x, y, z), friction_compliance=_weighed(yielding, mass)
        )

    joints = [along(number, name) for number, name in enumerate(SLIDES)]
    ball = replace(shared, name=body.name + TURN, type=BALL)
    joints.append(replace(ball, friction_compliance=_weighed(yielding, inertia)))
    body.joints = [CompiledJoint(joint, (0.0, 0.0, 0.0), 0.0, body.element, context) for joint in joints]
    body.is_free = False
    model.frictions = [it for it in model.frictions if it.body != body.name]


def _weighed(compliance: Compliance | None, inverse_mass: float) -> Compliance | None:
    return None if compliance is None else replace(compliance, inverse_mass=inverse_mass)
