"""What the simulations of arms have in common: things in a tray, and an arm in its first pose."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np


def load_all(client: Any, file: str, places: Iterable[Sequence[float]], offset: np.ndarray) -> list[int]:
    """Loads a file at several places, given from `offset` on [m], and returns the ids of the bodies."""
    flags = client.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
    return [client.loadURDF(file, np.array(place) + offset, flags=flags) for place in places]


def put_in_pose(client: Any, robot: int, positions: Sequence[float]) -> None:
    """Takes the damping from all links and puts the moving joints, in their order, where they are to be."""
    remaining = iter(positions)
    for joint in range(client.getNumJoints(robot)):
        client.changeDynamics(robot, joint, linearDamping=0, angularDamping=0)
        if client.getJointInfo(robot, joint)[2] in (client.JOINT_REVOLUTE, client.JOINT_PRISMATIC):
            client.resetJointState(robot, joint, next(remaining))
