"""Which torque balances gravity? A slider sets it, and the needed value stands beside the robot.

The one-joint arm needs m·g·r·sin θ; for the Panda inverse dynamics say it, for each joint. With the needed
torque the arm stays where it is; with more it rises, with less it falls. The button puts it back.
"""

import math

import pybullet as p
import pybullet_data
from carom.examples import robot_file
from carom.examples.window import button, connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER, ELBOW, GRAVITY = 0, 3, 9.81
POSE = [0, -0.4, 0, -2, 0, 1.8, 0.8]


def needed_by_arm(arm, angle):
    mass, _, _, centre = p.getDynamicsInfo(arm, SHOULDER)[:4]
    return mass * GRAVITY * math.hypot(centre[0], centre[2]) * math.sin(angle)


def needed_by_panda(panda):
    joints = [joint for joint in range(p.getNumJoints(panda)) if p.getJointInfo(panda, joint)[3] > -1]
    positions = [p.getJointState(panda, joint)[0] for joint in joints]
    rest = [0.0] * len(joints)
    return joints, p.calculateInverseDynamics(panda, positions, rest, rest)


def main(duration=math.inf, window=True, degrees=65, torque=None):
    connect(window)
    p.setGravity(0, 0, -GRAVITY)
    p.resetDebugVisualizerCamera(2.6, 40, -20, [0.4, 0.4, 0.7])
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    arm = p.loadURDF(ARM, [0, 1, 0], useFixedBase=True)
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    angle = math.radians(degrees)
    p.resetJointState(arm, SHOULDER, angle)
    for joint, position in enumerate(POSE):
        p.resetJointState(panda, joint, position)
    for body in (arm, panda):
        for joint in range(p.getNumJoints(body)):
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)

    exact = needed_by_arm(arm, angle)
    chosen = slider("torque of the arm [N m]", 0, 20, exact if torque is None else torque)
    share = slider("share of the Panda's torques", 0, 2, 1)
    again = button("put them back")
    texts, record = [-1, -1], {"angle": [], "elbow": [], "needed": exact}
    for step in steps(duration, window):
        p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=chosen())
        joints, torques = needed_by_panda(panda)
        forces = [share() * value for value in torques]
        p.setJointMotorControlArray(panda, joints, p.TORQUE_CONTROL, forces=forces)
        p.stepSimulation()
        record["angle"].append(p.getJointState(arm, SHOULDER)[0])
        record["elbow"].append(p.getJointState(panda, ELBOW)[0])
        if step % 24 == 0:
            now = needed_by_arm(arm, record["angle"][-1])
            lines = [f"needs {now:.2f} N m", f"elbow needs {torques[ELBOW]:.2f} N m"]
            places = [(arm, SHOULDER), (panda, ELBOW)]
            for i, (body, link) in enumerate(places):
                more = {"replaceItemUniqueId": texts[i]} if texts[i] >= 0 else {}
                texts[i] = p.addUserDebugText(
                    lines[i], [0.1, 0, 0], [0.1, 0.2, 0.6], 1.3, 0, None, body, link, **more
                )
        if again():
            p.resetJointState(arm, SHOULDER, angle)
            for joint, position in enumerate(POSE):
                p.resetJointState(panda, joint, position)
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 3)
