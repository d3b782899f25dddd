"""Shared code of the arm simulations: loading several objects, and setting the initial pose of an arm."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np


def load_all(client: Any, file: str, places: Iterable[Sequence[float]], offset: np.ndarray) -> list[int]:
    """Loads a file at several positions, relative to `offset` [m], and returns the ids of the bodies."""
    flags = client.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
    return [client.loadURDF(file, np.array(place) + offset, flags=flags) for place in places]


def put_in_pose(client: Any, robot: int, positions: Sequence[float]) -> None:
    """Sets the damping of all links to 0, and revolute and prismatic joints, in order, to `positions`."""
    remaining = iter(positions)
    for joint in range(client.getNumJoints(robot)):
        client.changeDynamics(robot, joint, linearDamping=0, angularDamping=0)
        if client.getJointInfo(robot, joint)[2] in (client.JOINT_REVOLUTE, client.JOINT_PRISMATIC):
            client.resetJointState(robot, joint, next(remaining))
