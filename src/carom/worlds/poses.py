"""Poses and velocities of the links of a body in each world, for the present coordinates."""

from __future__ import annotations

import numpy as np

from carom.engine.engine import Engine
from carom.engine.task import Task
from carom.engine.threads import WORLDS_PER_THREAD
from carom.native.kernels import forward_kinematics_kernel, link_twist_kernel
from carom.native.launch import Kernel, KernelStructs, Launch


class PoseFinder:
    """Updates link poses and velocities of one tree in all worlds of an engine."""

    def __init__(self, engine: Engine, tree: int) -> None:
        self._state = engine.arrays.state.numpy
        scalars = {"tree": tree, "first_world": 0}

        def task(*kernels: Kernel) -> Task:
            def launches(structs: KernelStructs) -> list[Launch]:
                return [structs.launch(kernel, **scalars) for kernel in kernels]

            return engine.task(launches, WORLDS_PER_THREAD)

        self._place = task(forward_kinematics_kernel)
        self._twist = task(link_twist_kernel)
        self._move = task(forward_kinematics_kernel, link_twist_kernel)

    def update(self, worlds: np.ndarray) -> None:
        """Update `State.link_pose` of the tree in some worlds."""
        self._place(worlds)

    def velocities_at_step(self) -> np.ndarray:
        """`State.link_twist`, for the present velocities and the poses that are in `State.link_pose`."""
        self._twist()
        return self._state["link_twist"]

    def poses(self) -> np.ndarray:
        """`State.link_pose`, (worlds, links of all bodies, 7), valid for the links of the tree."""
        self._place()
        return self._state["link_pose"]

    def velocities(self) -> np.ndarray:
        """`State.link_twist`, (worlds, links of all bodies, 6), valid for the links of the tree."""
        self._move()
        return self._state["link_twist"]
