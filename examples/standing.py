"""A walking robot stands, takes a push, and sits down."""

from camera import picture

import pybullet as p
import pybullet_data

TIME_STEP = 1 / 240
STAND = {"hip": 0.0, "upper": 0.75, "lower": -1.5}
SIT = {"hip": 0.0, "upper": 1.2, "lower": -2.4}
PUSH = 60
"""Force of the push, which lasts a tenth of a second [N]."""


def load():
    """The floor and the robot, and for each of its joints the part of the leg it moves."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    robot = p.loadURDF("a1/a1.urdf", [0, 0, 0.32])
    joints = {}
    for joint in range(p.getNumJoints(robot)):
        info = p.getJointInfo(robot, joint)
        if info[2] == p.JOINT_REVOLUTE:
            joints[joint] = next(part for part in STAND if part in info[1].decode())
            p.resetJointState(robot, joint, STAND[joints[joint]])
    return robot, joints


def command(robot, joints, pose):
    for joint, part in joints.items():
        p.setJointMotorControl2(
            robot, joint, p.POSITION_CONTROL, pose[part], force=33, positionGain=0.2, maxVelocity=4
        )


def main(duration=3.0):
    """A third of the time each: standing, pushed from the side, sitting down; height and way aside."""
    p.connect(p.DIRECT)
    robot, joints = load()
    record = {"time": [], "height": [], "way aside": []}
    third = round(duration / TIME_STEP / 3)
    for step in range(3 * third):
        command(robot, joints, STAND if step < 2 * third else SIT)
        if third <= step < third + 24:
            p.applyExternalForce(robot, -1, [0, PUSH, 0], [0, 0, 0], p.LINK_FRAME)
        p.stepSimulation()
        place, _ = p.getBasePositionAndOrientation(robot)
        record["time"].append((step + 1) * TIME_STEP)
        record["height"].append(place[2])
        record["way aside"].append(place[1])
        if step == third - 1:
            record["image"] = picture([0, 0, 0.2], 1.3)
            contacts = p.getContactPoints(robot)
            print(f"{len(contacts)} feet bear {sum(contact[9] for contact in contacts):.1f} N")
    print(f"it sits at a height of {record['height'][-1]:.3f} m")
    p.disconnect()
    return record


if __name__ == "__main__":
    main()
