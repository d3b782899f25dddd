"""An arm and a box, asked by a function of each kind; answers that are always there are never None."""

import pybullet as p
import pybullet_data


def answers(arm: int, box: int, floor: int) -> dict[str, float]:
    joints = list(range(p.getNumJoints(arm)))
    angles: list[float] = [state[0] for state in p.getJointStates(arm, joints)]
    zeros = [0.0] * len(joints)
    place, turn = p.getBasePositionAndOrientation(box)
    linear, angular = p.getBaseVelocity(box)
    tip = p.getLinkState(arm, 6, computeLinkVelocity=1)
    lower, upper = p.getAABB(box)
    overlaps = p.getOverlappingObjects(lower, upper)
    both = p.multiplyTransforms(place, turn, [0, 0, 1], [0, 0, 0, 1])
    view = p.computeViewMatrix([1, 1, 1], [0, 0, 0], [0, 0, 1])
    lens = p.computeProjectionMatrixFOV(60, 1, 0.1, 10)
    return {
        "rate": p.getJointState(arm, 0)[1],
        "speed": linear[0] + angular[0],
        "reach": tip[0][2] + tip[6][0],
        "elbow": p.getLinkStates(arm, [3, 6])[0][4][2],
        "solution": p.calculateInverseKinematics(arm, 6, [0.4, 0, 0.5])[0],
        "force": sum(point[9] for point in p.getContactPoints(floor, box)),
        "gap": min((point[8] for point in p.getClosestPoints(arm, box, 5.0)), default=5.0),
        "hit": p.rayTest([2, 0, 1], [2, 0, -1])[0][0],
        "width": p.getCameraImage(8, 8, view, lens)[0],
        "yaw": p.getEulerFromQuaternion(p.getQuaternionFromEuler([0, 0, 1]))[2],
        "entry": p.getMatrixFromQuaternion(p.invertTransform(both[0], both[1])[1])[0],
        "jacobian": p.calculateJacobian(arm, 6, [0, 0, 0], angles, zeros, zeros)[0][2][0],
        "torque": p.calculateInverseDynamics(arm, angles, zeros, zeros)[0],
        "inertia": p.calculateMassMatrix(arm, angles)[0][0],
        "friction": p.getDynamicsInfo(box, -1)[1],
        "height": upper[2] - lower[2],
        "overlaps": 0 if overlaps is None else len(overlaps),
        "red": p.getVisualShapeData(box)[0][7][0],
        "name": len(p.getBodyInfo(arm)[1].decode() + p.getJointInfo(arm, 0)[1].decode()),
    }


def main() -> dict[str, float]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    floor = p.loadURDF("plane.urdf")
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    look = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.1] * 3, rgbaColor=[1, 0, 0, 1])
    box = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3), look, [2, 0, 0.1])
    p.changeDynamics(box, -1, lateralFriction=0.8)
    p.setJointMotorControlArray(arm, list(range(7)), p.POSITION_CONTROL, targetPositions=[0.1] * 7)
    for _ in range(10):
        p.stepSimulation()
    found = answers(arm, box, floor)
    p.disconnect()
    return found
