"""Shows one of the Panda simulations in a window."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pybullet
import pybullet_data


def show(make: Callable[[Any, list[float]], Any], time_step: float) -> None:
    """Steps a simulation in real time, until the window is closed.

    Args:
        make: Makes the simulation, given `pybullet` and the position of the arm's base [m].
        time_step: Time step of the simulation [s].
    """
    pybullet.connect(pybullet.GUI)
    pybullet.configureDebugVisualizer(pybullet.COV_ENABLE_Y_AXIS_UP, 1)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    pybullet.setTimeStep(time_step)
    pybullet.setGravity(0, -9.8, 0)
    panda = make(pybullet, [0.0, 0.0, 0.0])
    panda.control_dt = time_step
    while pybullet.isConnected():
        panda.step()
        pybullet.stepSimulation()
        time.sleep(time_step)
