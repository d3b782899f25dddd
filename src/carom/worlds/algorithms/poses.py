"""Poses of the links of a body in many worlds, at joint positions of one's choice."""

from __future__ import annotations

import numpy as np

from carom.engine.world_calls import WorldCalls
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.model import State
from carom.native.kernels import forward_kinematics_kernel
from carom.native.launch import Launch
from carom.native.tables import array_view
from carom.scene.body import Body


class PoseBatch:
    """Forward kinematics of a body of a scene, of which the worlds are copies.

    Args:
        body: The body.
        threads: Number of threads.
    """

    def __init__(self, body: Body, threads: int) -> None:
        self._body = body
        self._threads = threads
        self._calls = WorldCalls(threads)

    def __call__(self, bases: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """World poses of the inertial frames of the base and all links, (n, 1 + links, 7).

        Args:
            bases: Poses of the base's inertial frame, (n, 7).
            positions: Joint positions, (n, coordinates).
        """
        body, count = self._body, len(bases)
        rows = body.first_link + 1 + body.joint_count
        first = body.first_position
        coordinates = np.zeros((count, first + int(BASE_POSITIONS) + positions.shape[1]))
        coordinates[:, first : first + BASE_POSITIONS] = bases
        coordinates[:, first + BASE_POSITIONS :] = positions
        poses = np.zeros((count, rows, 7))
        # The kernel reads coordinates and writes poses; it needs nothing else of a state.
        state = State()
        state.position, state.link_pose = array_view(coordinates, 2), array_view(poses, 2)
        model = body.world.arrays.model.struct()
        # Threads write the number of the world into their launches.
        launches = [
            [Launch(forward_kinematics_kernel, 1, [model, state, body.rows.tree, 0])]
            for _ in range(self._threads)
        ]
        self._calls.run(count, launches)
        return poses[:, body.first_link :]
