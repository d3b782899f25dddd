"""A Laikago with a slider for each joint: `python -m pybullet_robots.laikago.laikago`.

PyBullet's script first plays a recorded gait (`data1.txt`), which Carom does not include.
"""

from __future__ import annotations

import pybullet
import pybullet_data
from pybullet_robots._sliders import follow_sliders


def main() -> None:
    """Runs until the window is closed."""
    pybullet.connect(pybullet.GUI)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath())
    pybullet.setPhysicsEngineParameter(enableConeFriction=0)
    pybullet.setGravity(0, 0, -9.8)
    pybullet.setTimeStep(1.0 / 500)
    pybullet.loadURDF("plane.urdf")
    flags = pybullet.URDF_USE_SELF_COLLISION
    robot = pybullet.loadURDF("laikago/laikago_toes.urdf", [0, 0, 0.5], [0, 0.5, 0.5, 0], flags=flags)
    follow_sliders(robot, 20.0)


if __name__ == "__main__":
    main()
