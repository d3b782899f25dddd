"""A scene whose logs are compared with those that PyBullet writes.

`.oracle/bin/python tests/pybullet/log_scene.py` records them anew. Real PyBullet loads the
same files, those of the folder `src/pybullet_data`.
"""

from pathlib import Path
from typing import Any

LOGS = Path(__file__).parent / "logs"
DATA = Path(__file__).parents[2] / "src" / "pybullet_data"
NAMES = ("all", "torques", "too_many_joints", "controllers", "contacts")


def write_logs(p: Any, folder: Path) -> None:
    """Runs the scene in a new connection and writes the logs."""
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(str(DATA))
    p.setGravity(0, 0, -10)
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=1)
    cart = p.loadURDF("cartpole.urdf", [2, 0, 1])
    cube = p.loadURDF("cube_small.urdf", [0.5, 0.5, 2.02])
    p.resetBasePositionAndOrientation(cube, [0, 1, 2], p.getQuaternionFromEuler([0.1, 0.2, 0.3]))
    for joint in range(7):
        p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
    p.setJointMotorControl2(arm, 1, p.POSITION_CONTROL, 0.5, force=20)

    def start(kind: int, name: str, *arguments: Any, **keywords: Any) -> int:
        return p.startStateLogging(kind, str(folder / f"{name}.bin"), *arguments, **keywords)

    robot = p.STATE_LOGGING_GENERIC_ROBOT
    both = p.STATE_LOG_JOINT_MOTOR_TORQUES | p.STATE_LOG_JOINT_USER_TORQUES
    logs = (
        start(robot, "all"),
        start(robot, "torques", [arm, cube], 7, logFlags=both),
        start(robot, "too_many_joints", [arm, cart], 3, logFlags=p.STATE_LOG_JOINT_MOTOR_TORQUES),
        start(p.STATE_LOGGING_VR_CONTROLLERS, "controllers"),
        start(p.STATE_LOGGING_CONTACT_POINTS, "contacts"),
    )
    for _ in range(5):
        p.setJointMotorControl2(arm, 3, p.TORQUE_CONTROL, force=5)
        p.stepSimulation()
    for log in logs:
        p.stopStateLogging(log)
    p.disconnect(client)


if __name__ == "__main__":
    import pybullet

    LOGS.mkdir(exist_ok=True)
    write_logs(pybullet, LOGS)
