"""A scene whose logs are compared with those that PyBullet writes.

`.oracle/bin/python tests/pybullet/logs/log_scene.py` records them anew. Real PyBullet loads the
same files, those of the folder `src/pybullet_data`.
"""

from pathlib import Path
from typing import Any

LOGS = Path(__file__).parents[1] / "logs"
DATA = Path(__file__).parents[3] / "src" / "pybullet_data"
NAMES = ("all", "torques", "too_many_joints", "controllers", "contacts", "minitaur", "substeps")


MOTORS = tuple(
    f"motor_{place}{side}_joint" for place in ("front_left", "back_left") for side in "RL"
) + tuple(f"motor_{place}{side}_joint" for place in ("front_right", "back_right") for side in "LR")
_LEG = (
    '<link name="{name}_link"><inertial><origin xyz="0 0 -0.1"/><mass value="0.5"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="{name}" type="revolute"><parent link="base"/><child link="{name}_link"/>'
    '<origin xyz="0.1 {y} 0"/><axis xyz="0 1 0"/>'
    '<limit lower="-4" upper="4" effort="9" velocity="9"/></joint>'
)


def minitaur() -> str:
    """A robot whose motors have the names of a Minitaur's."""
    legs = "".join(_LEG.format(name=name, y=0.1 * place - 0.4) for place, name in enumerate(MOTORS))
    return (
        '<robot name="minitaur"><link name="base"><inertial><mass value="3"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        f"{legs}</robot>"
    )


def write_logs(p: Any, folder: Path) -> None:
    """Runs the scene in a new connection and writes the logs."""
    (folder / "minitaur.urdf").write_text(minitaur())
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
    _write_logs_of_substeps(p, folder)
    p.disconnect(client)


def _write_logs_of_substeps(p: Any, folder: Path) -> None:
    """A Minitaur in the air, with substeps."""
    p.resetSimulation()
    p.setGravity(0, 0, -10)
    p.setPhysicsEngineParameter(numSubSteps=3)
    robot = p.loadURDF(str(folder / "minitaur.urdf"), [0, 0, 1])
    for joint in range(len(MOTORS)):
        p.resetJointState(robot, joint, 0.1 * joint, 0.2 * joint)
        p.setJointMotorControl2(robot, joint, p.POSITION_CONTROL, 0.3, force=2)
    p.resetBaseVelocity(robot, [1, 2, 3], [0.1, 0.2, 0.3])
    logs = (
        p.startStateLogging(p.STATE_LOGGING_MINITAUR, str(folder / "minitaur.bin"), [robot]),
        p.startStateLogging(
            p.STATE_LOGGING_GENERIC_ROBOT,
            str(folder / "substeps.bin"),
            logFlags=p.STATE_LOG_JOINT_MOTOR_TORQUES | p.STATE_LOG_JOINT_USER_TORQUES,
        ),
    )
    for _ in range(2):
        p.setJointMotorControl2(robot, 0, p.TORQUE_CONTROL, force=0.5)
        p.stepSimulation()
    for log in logs:
        p.stopStateLogging(log)


if __name__ == "__main__":
    import pybullet

    LOGS.mkdir(exist_ok=True)
    write_logs(pybullet, LOGS)
