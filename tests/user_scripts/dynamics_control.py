"""Computed torques hold an arm on its course; a log of it is written."""

import numpy as np

import pybullet as p
import pybullet_data


def main(log_file: str, seconds: float = 0.25) -> float:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    arm = p.loadURDF(
        "kuka_iiwa/model.urdf", [0, 0, 0], [0, 0, 0, 1], useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE
    )
    freedoms = range(p.computeDofCount(arm))
    for joint in freedoms:
        p.changeDynamics(arm, joint, linearDamping=0, angularDamping=0, jointDamping=0)
    p.setJointMotorControlArray(arm, freedoms, p.VELOCITY_CONTROL, forces=[0] * len(freedoms))
    p.enableJointForceTorqueSensor(arm, 6)
    log = p.startStateLogging(p.STATE_LOGGING_GENERIC_ROBOT, log_file, objectUniqueIds=[arm])
    target = np.full(len(freedoms), 0.3)
    q, v = np.zeros(len(freedoms)), np.zeros(len(freedoms))
    for _ in range(int(240 * seconds)):
        states = p.getJointStates(arm, freedoms)
        assert states is not None
        q = np.array([state[0] for state in states])
        v = np.array([state[1] for state in states])
        wanted = 100.0 * (target - q) - 20.0 * v
        torques = p.calculateInverseDynamics(arm, q.tolist(), v.tolist(), wanted.tolist())
        p.setJointMotorControlArray(arm, freedoms, p.TORQUE_CONTROL, forces=torques)
        p.stepSimulation()
    linear, angular = p.calculateJacobian(arm, 6, [0, 0, 0], q.tolist(), v.tolist(), [0.0] * len(freedoms))
    mass = np.array(p.calculateMassMatrix(arm, q.tolist()))
    assert np.array(linear).shape == np.array(angular).shape == (3, len(freedoms))
    assert np.linalg.det(mass) > 0
    p.stopStateLogging(log)
    p.disconnect()
    return float(np.abs(target - q).max())


if __name__ == "__main__":
    print(main("arm.bin", 2.0))
