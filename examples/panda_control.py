"""A Franka Panda follows one smooth path in three ways: by effort, by velocity, by position.

All three send one command for all joints in every step with setJointMotorControlArray:

- effort: the torque that inverse dynamics gives for the acceleration of the path plus a correction;
- velocity: the speed of the path plus a correction of the position error;
- position: the position on the path, for the joint motors to reach.

In the window the three take turns until ESC, and the slider says how long each takes.
"""

import numpy as np

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

HOME = np.array([0.0, -0.4, 0.0, -2.2, 0.0, 1.9, 0.8, 0.02, 0.02])
REACH = np.array([1.1, 0.5, -0.6, -1.1, 0.7, 2.6, -0.5, 0.04, 0.04])
MAX_FORCES = np.array([87, 87, 87, 87, 12, 12, 12, 20, 20])


def smooth_path(start, goal, duration, time):
    """Position, velocity and acceleration on a smooth way from rest at start to rest at goal."""
    s = time / duration
    way = goal - start
    return (
        start + way * s**3 * (10 - 15 * s + 6 * s**2),
        way * 30 * s**2 * (1 - s) ** 2 / duration,
        way * 60 * s * (1 - s) * (1 - 2 * s) / duration**2,
    )


def load_panda():
    """The Panda on its base at the home position, and the indices of its movable joints."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    robot = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    movable = [j for j in range(p.getNumJoints(robot)) if p.getJointInfo(robot, j)[2] != p.JOINT_FIXED]
    go_home(robot, movable)
    return robot, movable


def go_home(robot, joints):
    for joint, angle in zip(joints, HOME, strict=True):
        p.resetJointState(robot, joint, angle)


def command_effort(robot, joints, state, path):
    (q, v), (q_path, v_path, a_path) = state, path
    acceleration = a_path + 400 * (q_path - q) + 40 * (v_path - v)
    torques = p.calculateInverseDynamics(robot, list(q), list(v), list(acceleration))
    torques = np.clip(torques, -MAX_FORCES, MAX_FORCES)
    p.setJointMotorControlArray(robot, joints, p.TORQUE_CONTROL, forces=torques)


def command_velocity(robot, joints, state, path):
    (q, _), (q_path, v_path, _) = state, path
    speeds = v_path + 10 * (q_path - q)
    p.setJointMotorControlArray(robot, joints, p.VELOCITY_CONTROL, targetVelocities=speeds, forces=MAX_FORCES)


def command_position(robot, joints, state, path):
    q_path, v_path, _ = path
    p.setJointMotorControlArray(
        robot,
        joints,
        p.POSITION_CONTROL,
        targetPositions=q_path,
        targetVelocities=v_path,
        forces=MAX_FORCES,
    )


PHASES = {
    "effort": (HOME, REACH, command_effort),
    "velocity": (REACH, HOME, command_velocity),
    "position": (HOME, REACH, command_position),
}


def run_phase(robot, joints, name, duration, window=False):
    """Drive all joints along the phase's path; the positions on the path and as they were."""
    start, goal, command = PHASES[name]
    # Motors push only where they are asked to: off for effort, commanded in every step for the rest.
    p.setJointMotorControlArray(robot, joints, p.VELOCITY_CONTROL, forces=[0] * len(joints))
    wanted, measured = [], []
    for step in steps(duration, window):
        path = smooth_path(start, goal, duration, (step + 1) * TIME_STEP)
        states = p.getJointStates(robot, joints)
        state = np.array([[position, velocity] for position, velocity, *_ in states]).T
        command(robot, joints, state, path)
        p.stepSimulation()
        wanted.append(path[0])
        measured.append([position for position, *_ in p.getJointStates(robot, joints)])
    return np.array(wanted), np.array(measured)


def main(duration=2.0, window=False):
    """Run the three phases, `duration` seconds each; in the window again and again."""
    connect(window)
    robot, joints = load_panda()
    length = slider("seconds for each way", 1, 10, duration)
    record = run_phases(robot, joints, length, window)
    while window and p.isConnected():
        go_home(robot, joints)
        run_phases(robot, joints, length, window)
    p.disconnect()
    return record


def run_phases(robot, joints, length, window):
    """Run the three phases one after the other, and say how well the arm has kept to its path."""
    record = {}
    for name in PHASES:
        wanted, measured = run_phase(robot, joints, name, length(), window)
        if not p.isConnected():
            break
        times = np.arange(1, len(wanted) + 1) * TIME_STEP
        record[name] = {"time": times, "wanted": wanted, "measured": measured}
        error = np.abs(wanted - measured)[:, :7]
        print(f"{name:8}: at most {error.max():.4f} rad off the path, {error[-1].max():.5f} rad at its end")
    return record


if __name__ == "__main__":
    main(window=wants_window())
