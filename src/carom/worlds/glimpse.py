"""What is seen of some of many worlds: poses of their links, and the state of one as a `World`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.engine.engine import Engine
from carom.engine.presence import absent_links
from carom.engine.task import Task
from carom.engine.threads import WORLDS_PER_THREAD
from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs, Launch
from carom.worlds.lone import refill

if TYPE_CHECKING:
    from carom.world.world import World


class Glimpses:
    """Copies what is seen of some worlds. Its methods are called between steps.

    Only the links of these worlds are placed and copied, so it costs the same for any number of others.

    Args:
        engine: The engine of the worlds.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._place: Task = engine.task(_launches, WORLDS_PER_THREAD)

    def poses(self, worlds: np.ndarray) -> NDArray[np.float32]:
        """Present poses of the inertial frames of all links of some worlds, by index: (n, links, 7)."""
        self._place(worlds)
        return np.asarray(self._engine.arrays.state.numpy["link_pose"])[worlds].astype(np.float32)

    def absent(self, worlds: np.ndarray, links: np.ndarray) -> NDArray[np.bool_] | None:
        """Which links, by their rows, belong to bodies that are absent: (n, links); None if none is."""
        return absent_links(self._engine.arrays, links, worlds)

    def push(self, world: int, link: int, force: np.ndarray, torque: np.ndarray) -> None:
        """Apply a force [N] and a torque [N m] (3,) to a link of a world, by its row, in the next step."""
        wrench = self._engine.arrays.state.numpy["link_wrench"]
        wrench[np.array([world]), link] += np.concatenate([force, torque])[np.newaxis]

    def put(self, name: str, world: int, row: int, values: float | np.ndarray) -> None:
        """Set a row of an array of the state, as "dof_motor", in one world."""
        array = self._engine.arrays.state.numpy[name]
        array[np.array([world]), row] = np.asarray(values)[np.newaxis]

    def refill(self, world: World, number: int, *, parameters: bool) -> None:
        """Give a `World` of `extract` the state and, if wanted, the parameters of another of the worlds."""
        refill(world, self._engine, number, parameters=parameters)


def _launches(structs: KernelStructs) -> list[Launch]:
    return [structs.launch(link_poses_kernel, first_world=0)]
