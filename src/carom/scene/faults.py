"""The cause of a failed step: NaN that a script has written into the state."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_MOTOR = (
    "target position",
    "target velocity",
    "position gain",
    "velocity gain",
    "greatest impulse",
    "velocity clamp",
    "damping",
    "target orientation",
)
_PD = ("target position", "target velocity", "position gain", "velocity gain", "greatest force")


def cause_in(body: BodyCore) -> str:
    """Describe the first NaN among a body's drives and coordinates; an empty string if there is none.

    Infinite limits of drives are allowed.
    """
    world = body.world
    for joint in range(body.joint_count):
        first = body.velocity_index[joint]
        rows = slice(first, first + body.velocity_count[joint])
        for drive, table, names in (("motor", world.motor, _MOTOR), ("PD control", world.pd, _PD)):
            wrong = np.argwhere(np.isnan(table[rows, : len(names)]))
            if len(wrong):
                name = body.spec.links[joint].joint_name
                return f"the {names[wrong[0][1]]} of the {drive} of joint {joint} ({name!r}) is NaN"
    rows = body.rows
    for what, values, axis in (("position", world.position, "position"), ("velocity", world.velocity, "dof")):
        start = rows.first[axis]
        wrong = np.flatnonzero(np.isnan(values[start : start + rows.count[axis]]))
        if len(wrong):
            return f"entry {wrong[0]} of its {what} coordinates is NaN"
    return ""
