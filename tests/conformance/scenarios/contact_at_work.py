"""Robots that do what they are for: grasp and lift, drive, stand."""

from __future__ import annotations

from typing import Any

from ..scenario import ASSETS, load_asset, movable_joints, scenario, simulate

FINGERS = (9, 10)
HOME = (0.0, -0.3, 0.0, -2.3, 0.0, 2.0, 0.785398)
WRIST = 11


def _panda(p: Any) -> int:
    panda = load_asset(p, "franka_panda/panda.urdf", useFixedBase=True)
    for joint, angle in enumerate(HOME):
        p.resetJointState(panda, joint, angle)
    for finger in FINGERS:
        p.resetJointState(panda, finger, 0.04)
    return panda


def _reach(p: Any, panda: int, height: float, opening: float) -> None:
    """Move the hand over the cube to a height, and the fingers apart."""
    down = p.getQuaternionFromEuler([3.141592653589793, 0, 0])
    angles = p.calculateInverseKinematics(
        panda, WRIST, [0.5, 0, height], down, maxNumIterations=100, residualThreshold=1e-8
    )
    for joint in range(7):
        p.setJointMotorControl2(
            panda, joint, p.POSITION_CONTROL, angles[joint], force=87 if joint < 4 else 12, maxVelocity=1.0
        )
    for finger in FINGERS:
        p.setJointMotorControl2(panda, finger, p.POSITION_CONTROL, opening, force=20)


@scenario(tolerance=2e-2)
def panda_grasps_and_lifts(p: Any) -> dict[str, Any]:
    """The Panda closes its fingers on a cube, lifts it by 20 cm and holds it.

    Measured 2e-4 for the height of the cube, 1.3 % for the opening of the fingers as they close.
    """
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    panda = _panda(p)
    cube = load_asset(p, "cube_small.urdf", basePosition=[0.5, 0, 0.025])
    p.changeDynamics(cube, -1, lateralFriction=1.0)

    def act(step: int) -> None:
        if step < 480:
            _reach(p, panda, 0.2 if step < 240 else 0.025, 0.04)
        elif step < 720:
            _reach(p, panda, 0.025, 0.0)
        else:
            _reach(p, panda, 0.225, 0.0)

    def observe() -> dict[str, Any]:
        (_, _, height), _ = p.getBasePositionAndOrientation(cube)
        opening = sum(p.getJointState(panda, finger)[0] for finger in FINGERS)
        return {"cube": height, "opening": opening, "hand": p.getLinkState(panda, WRIST)[0]}

    return simulate(p, 6.0, observe, act, stride=24)


def _heading(p: Any, body: int) -> dict[str, Any]:
    """Where a vehicle is on the floor, and where it points."""
    (x, y, _), turn = p.getBasePositionAndOrientation(body)
    return {"place": (x, y), "heading": p.getEulerFromQuaternion(turn)[2]}


def _spin(p: Any, body: int, speeds: dict[int, float], force: float) -> None:
    for wheel, speed in speeds.items():
        p.setJointMotorControl2(body, wheel, p.VELOCITY_CONTROL, targetVelocity=speed, force=force)


@scenario(tolerance=1e-2)
def rover_drives(p: Any) -> dict[str, Any]:
    """The husky drives straight for a second, and then turns for another.

    It turns by scrubbing its wheels sideways, which is delicate: PyBullet's own turn changes by 3 % if it
    starts a micrometre above 2 cm, so it starts higher. Measured 0.4 % for the turn, 2e-4 for the place.
    """
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    rover = load_asset(p, "husky/husky.urdf", basePosition=[0, 0, 0.03])

    def act(step: int) -> None:
        left = 6.0 if step < 240 else 3.0
        _spin(p, rover, {2: left, 4: left, 3: 6.0, 5: 6.0}, 20.0)

    return simulate(p, 2.0, lambda: _heading(p, rover), act)


@scenario(tolerance=1e-2)
def car_drives_a_curve(p: Any) -> dict[str, Any]:
    """A car with steered front wheels drives a curve."""
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    car = load_asset(p, "racecar/racecar.urdf", basePosition=[0, 0, 0.03])

    def act(step: int) -> None:
        for hinge in (4, 6):
            p.setJointMotorControl2(car, hinge, p.POSITION_CONTROL, targetPosition=0.3, force=10)
        _spin(p, car, {2: 20.0, 3: 20.0}, 5.0)
        _spin(p, car, {5: 0.0, 7: 0.0}, 0.0)

    return simulate(p, 2.0, lambda: _heading(p, car), act)


@scenario(tolerance=2e-3)
def walking_robot_stands(p: Any) -> dict[str, Any]:
    """The A1 is put on its feet and holds its legs bent for three seconds.

    How the feet slip as they land depends on the points of contact: measured 3e-4.
    """
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    robot = load_asset(p, "a1/a1.urdf", basePosition=[0, 0, 0.32])
    pose = {"hip": 0.0, "upper": 0.75, "lower": -1.5}
    joints: list[tuple[int, float]] = []
    for joint in movable_joints(p, robot):
        name = p.getJointInfo(robot, joint)[1].decode()
        angle = next(value for part, value in pose.items() if part in name)
        joints.append((joint, angle))
        p.resetJointState(robot, joint, angle)

    def act(step: int) -> None:
        for joint, angle in joints:
            p.setJointMotorControl2(robot, joint, p.POSITION_CONTROL, angle, force=30, positionGain=0.5)

    def observe() -> dict[str, Any]:
        place, turn = p.getBasePositionAndOrientation(robot)
        return {
            "place": place,
            "orientation": turn,
            "angles": [p.getJointState(robot, j)[0] for j, _ in joints],
        }

    return simulate(p, 3.0, observe, act, stride=24)


@scenario()
def humanoid_holds_its_pose(p: Any) -> dict[str, Any]:
    """The humanoid of MJCF keeps its joints stiff and lands on its feet, which are balls."""
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    (robot,) = p.loadMJCF(str(ASSETS / "mjcf/humanoid_symmetric.xml"))

    def act(step: int) -> None:
        for joint in movable_joints(p, robot):
            p.setJointMotorControl2(robot, joint, p.POSITION_CONTROL, 0.0, force=100)

    def observe() -> dict[str, Any]:
        place, _ = p.getBasePositionAndOrientation(robot)
        return {"place": place}

    return simulate(p, 0.5, observe, act)
