"""The state of a world for users to read and write: views of the engine's arrays."""

from __future__ import annotations

from carom.checks import Array
from carom.native.change import Change
from carom.native.tables import ArrayTable

# Flat arrays of the state for users: attribute of `StateViews`, field of `State`.
VIEWS = {
    "position": "position",
    "velocity": "dof_velocity",
    "motor": "dof_motor",
    "pd": "dof_pd",
    "joint_torque": "dof_torque",
    "motor_impulse": "dof_motor_impulse",
    "link_pose": "link_pose",
    "link_velocity": "link_twist",
    "link_force": "link_wrench",
    "joint_reaction": "link_reaction",
}


class StateViews:
    """The flat arrays of `VIEWS` as NumPy views, and the same memory as flat `memoryview` of numbers.

    They may be replaced when bodies are added or removed.
    """

    position: Array
    velocity: Array
    motor: Array
    pd: Array
    joint_torque: Array
    motor_impulse: Array
    link_pose: Array
    link_velocity: Array
    link_force: Array
    joint_reaction: Array
    position_memory: memoryview[float]
    velocity_memory: memoryview[float]
    motor_memory: memoryview[float]
    pd_memory: memoryview[float]
    joint_torque_memory: memoryview[float]
    motor_impulse_memory: memoryview[float]
    link_pose_memory: memoryview[float]
    link_velocity_memory: memoryview[float]
    link_force_memory: memoryview[float]
    joint_reaction_memory: memoryview[float]

    def view_state(self, change: Change, state: ArrayTable) -> None:
        """Make the views of the arrays that there are after a change."""
        numpy = change.content(state.numpy)
        for name, field in VIEWS.items():
            array = numpy[field][0]
            change.set(self, name, array)
            change.set(self, f"{name}_memory", memoryview(array.reshape(-1)))
