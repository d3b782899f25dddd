"""The cases for engines with PyBullet's interface: Carom and PyBullet itself.

Every function prepares a world and returns the call to be timed, or a pair of that call and what
has to be done, untimed, with its result.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import crowds
import robots
import soft_bodies

import pybullet as p

# PyBullet has no derivatives.
if find_spec("carom"):
    from linearizing import (  # noqa: F401
        differentiate_pandas,
        linearize_ant,
        linearize_panda,
        linearize_pandas,
    )

ROOT = Path(__file__).resolve().parents[1]
ASSETS = ROOT / "src" / "pybullet_data"
PANDA = str(ASSETS / "franka_panda" / "panda.urdf")
PLANE = str(ASSETS / "plane.urdf")
R2D2 = str(ASSETS / "r2d2.urdf")
QUADRUPED = str(ASSETS / "a1" / "a1.urdf")
HUMANOID = str(ASSETS / "humanoid" / "humanoid.urdf")
KUKA = str(ASSETS / "kuka_iiwa" / "model.urdf")
TREE = str(ROOT / "tests" / "conformance" / "robots" / "random_tree.urdf")
MOVABLE = [0, 1, 2, 3, 4, 5, 6, 9, 10]
HOME = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8, 0.02, 0.02]
POINT, TURN, NO_TURN = [0.1, 0.2, 0.3], [0.0, 0.0, 0.6, 0.8], [0.0, 0.0, 0.0, 1.0]

Timed = Callable[[], Any]
Prepared = Timed | tuple[Timed, Callable[[Any], None]]


def _world() -> None:
    if not p.isConnected():
        p.connect(p.DIRECT)
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)


def _panda() -> int:
    _world()
    panda = p.loadURDF(PANDA, useFixedBase=True)
    for joint, position in zip(MOVABLE, HOME, strict=True):
        p.resetJointState(panda, joint, position)
    return panda


def _kuka() -> int:
    _world()
    return p.loadURDF(KUKA, useFixedBase=True)


def _release(body: int, joints: list[int]) -> None:
    for joint in joints:
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)


def step_panda(original_data: str) -> Prepared:
    _panda()
    return p.stepSimulation


def step_panda_free(original_data: str) -> Prepared:
    _release(_panda(), MOVABLE)
    return p.stepSimulation


def step_kuka(original_data: str) -> Prepared:
    _kuka()
    return p.stepSimulation


def step_kuka_free(original_data: str) -> Prepared:
    _release(_kuka(), list(range(7)))
    return p.stepSimulation


def _again_and_again(count: int) -> Timed:
    """A step that begins anew every `count` steps, so that all engines are timed over the same steps."""
    start = p.saveState()

    def step_again() -> None:
        if next(steps) % count == 0:
            p.restoreState(start)
        p.stepSimulation()

    steps = itertools.count(1)
    return step_again


def step_r2d2(original_data: str) -> Prepared:
    _world()
    p.loadURDF(PLANE)
    p.loadURDF(R2D2, [0.0, 0.0, 0.5])
    crowds.settle(300)
    # R2D2 creeps, and a step takes half as much time again later.
    return _again_and_again(1500)


def step_quadruped(original_data: str) -> Prepared:
    _world()
    robots.quadruped(PLANE, QUADRUPED)
    return p.stepSimulation


def step_humanoid(original_data: str) -> Prepared:
    _world()
    robots.humanoid(PLANE, HUMANOID)
    return p.stepSimulation


def step_27_boxes(original_data: str) -> Prepared:
    _world()
    crowds.towers(3)
    return p.stepSimulation


def step_125_boxes(original_data: str) -> Prepared:
    _world()
    crowds.towers(5)
    return p.stepSimulation


def step_1000_balls(original_data: str) -> Prepared:
    _world()
    crowds.pile(1000)
    # The pile spreads, so that a step takes less and less time.
    return _again_and_again(50)


def step_cloth(original_data: str) -> Prepared:
    _world()
    soft_bodies.cloth_on_a_ball(32)
    crowds.settle(120)
    return p.stepSimulation


def step_soft_cube(original_data: str) -> Prepared:
    _world()
    soft_bodies.soft_cube(PLANE, (5, 5, 7))
    crowds.settle(120)
    return p.stepSimulation


def step_towel(original_data: str) -> Prepared:
    _world()
    soft_bodies.towel_in_a_gripper(PANDA, HOME, MOVABLE, 33)
    crowds.settle(60)
    return p.stepSimulation


def _step_apart(count: int, original_data: str) -> Prepared:
    _world()
    crowds.scattered(count)
    return p.stepSimulation


step_100_apart = partial(_step_apart, 100)
step_200_apart = partial(_step_apart, 200)
step_500_apart = partial(_step_apart, 500)
step_1000_apart = partial(_step_apart, 1000)
step_2000_apart = partial(_step_apart, 2000)
step_5000_apart = partial(_step_apart, 5000)


def save_1000(original_data: str) -> Prepared:
    _world()
    crowds.scattered(1000)
    p.stepSimulation()
    return lambda: p.removeState(p.saveState())


def restore_1000(original_data: str) -> Prepared:
    _world()
    crowds.scattered(1000)
    p.stepSimulation()
    state = p.saveState()
    return lambda: p.restoreState(state)


def rays(original_data: str) -> Prepared:
    _world()
    crowds.pile(200)
    starts, ends = crowds.fans_of_rays(1024)
    return lambda: p.rayTestBatch(starts, ends)


def _tree() -> tuple[int, list[int], list[int]]:
    """The floating tree with its motors off, its joints of one dof, and those of three."""
    _world()
    tree = p.loadURDF(TREE)
    kinds = [p.getJointInfo(tree, joint)[2] for joint in range(p.getNumJoints(tree))]
    single = [joint for joint, kind in enumerate(kinds) if kind in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC)]
    spherical = [joint for joint, kind in enumerate(kinds) if kind == p.JOINT_SPHERICAL]
    _release(tree, single)
    for joint in spherical:
        p.setJointMotorControlMultiDof(
            tree, joint, p.POSITION_CONTROL, targetPosition=[0, 0, 0, 1], force=[0, 0, 0]
        )
    return tree, single, spherical


def step_tree(original_data: str) -> Prepared:
    _tree()
    return p.stepSimulation


def stable_pd(original_data: str) -> Prepared:
    tree, single, spherical = _tree()
    joints = single + spherical
    positions = [[0.1]] * len(single) + [[0.0, 0.0, 0.0, 1.0]] * len(spherical)
    forces = [[10.0]] * len(single) + [[10.0, 10.0, 10.0]] * len(spherical)
    gains, dampings = [5.0] * len(joints), [0.5] * len(joints)
    return lambda: p.setJointMotorControlMultiDofArray(
        tree,
        joints,
        p.STABLE_PD_CONTROL,
        targetPositions=positions,
        forces=forces,
        positionGains=gains,
        velocityGains=dampings,
    )


def control_loop(original_data: str) -> Prepared:
    panda = _panda()
    targets = [[q + 0.1 * math.sin(0.02 * step) for q in HOME] for step in range(314)]
    forces = [87.0] * 4 + [12.0] * 3 + [20.0] * 2
    step = 0

    def loop() -> None:
        nonlocal step
        step = (step + 1) % len(targets)
        p.setJointMotorControlArray(
            panda, MOVABLE, p.POSITION_CONTROL, targetPositions=targets[step], forces=forces
        )
        p.stepSimulation()
        p.getJointStates(panda, MOVABLE)

    return loop


def control_loop_one_by_one(original_data: str) -> Prepared:
    _world()
    p.loadURDF(f"{original_data}/plane.urdf")
    panda = p.loadURDF(f"{original_data}/franka_panda/panda.urdf", useFixedBase=True)
    for joint, position in zip(MOVABLE, HOME, strict=True):
        p.resetJointState(panda, joint, position)

    def loop() -> None:
        for joint, position in zip(MOVABLE, HOME, strict=True):
            p.setJointMotorControl2(panda, joint, p.POSITION_CONTROL, targetPosition=position, force=87)
        p.stepSimulation()
        for joint in MOVABLE:
            p.getJointState(panda, joint)

    return loop


def get_joint_state(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getJointState(panda, 3)


def get_joint_states(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getJointStates(panda, MOVABLE)


def get_link_state(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getLinkState(panda, 11, computeLinkVelocity=1)


def get_link_states(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getLinkStates(panda, MOVABLE, computeLinkVelocity=1)


def get_base_pose(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getBasePositionAndOrientation(panda)


def get_base_velocity(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.getBaseVelocity(panda)


def set_motor(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.setJointMotorControl2(panda, 3, p.POSITION_CONTROL, targetPosition=-1.9, force=87.0)


def set_motors(original_data: str) -> Prepared:
    panda = _panda()
    forces = [87.0] * 9
    return lambda: p.setJointMotorControlArray(
        panda, MOVABLE, p.POSITION_CONTROL, targetPositions=HOME, forces=forces
    )


def reset_joint(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.resetJointState(panda, 3, -1.9)


def reset_base_pose(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.resetBasePositionAndOrientation(box, [1.5, 0.0, 0.1], NO_TURN)


def reset_base_velocity(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.resetBaseVelocity(box, [0.1, 0.0, 0.0], [0.0, 0.0, 0.1])


def apply_force(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.applyExternalForce(box, -1, [0.1, 0.0, 0.0], [0.0, 0.0, 0.0], p.LINK_FRAME)


def apply_torque(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.applyExternalTorque(box, -1, [0.1, 0.0, 0.0], p.WORLD_FRAME)


def change_friction(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.changeDynamics(box, -1, lateralFriction=0.5)


def change_damping(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.changeDynamics(box, -1, linearDamping=0.1, angularDamping=0.1)


def change_mass(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.changeDynamics(box, -1, mass=1.0)


def multiply_transforms(original_data: str) -> Prepared:
    return lambda: p.multiplyTransforms(POINT, TURN, POINT, TURN)


def invert_transform(original_data: str) -> Prepared:
    return lambda: p.invertTransform(POINT, TURN)


def euler_and_back(original_data: str) -> Prepared:
    return lambda: p.getEulerFromQuaternion(p.getQuaternionFromEuler(POINT))


def matrix_from_quaternion(original_data: str) -> Prepared:
    return lambda: p.getMatrixFromQuaternion(TURN)


def slerp(original_data: str) -> Prepared:
    return lambda: p.getQuaternionSlerp(TURN, NO_TURN, 0.25)


def axis_angle_and_back(original_data: str) -> Prepared:
    return lambda: p.getQuaternionFromAxisAngle(*p.getAxisAngleFromQuaternion(TURN))


def difference_quaternion(original_data: str) -> Prepared:
    return lambda: p.getDifferenceQuaternion(TURN, NO_TURN)


def change_gravity(original_data: str) -> Prepared:
    _panda()
    values = itertools.cycle((-9.8, -9.9))

    def change_and_step() -> None:
        p.setGravity(0, 0, next(values))
        p.stepSimulation()

    return change_and_step


def _boxes_on_a_floor() -> list[int]:
    _world()
    p.loadURDF(PLANE)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    boxes = [p.createMultiBody(1, shape, -1, [0.5 * place, 0, 0.1]) for place in range(10)]
    crowds.settle(20)
    return boxes


def change_constraint(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]

    def tie_and_untie() -> None:
        tie = p.createConstraint(box, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [1.5, 0, 0.1])
        p.stepSimulation()
        p.removeConstraint(tie)

    return tie_and_untie


def detect_collisions(original_data: str) -> Prepared:
    _boxes_on_a_floor()
    return p.performCollisionDetection


def contact_points(original_data: str) -> Prepared:
    box = _boxes_on_a_floor()[3]
    return lambda: p.getContactPoints(box)


def closest_points(original_data: str) -> Prepared:
    boxes = _boxes_on_a_floor()
    return lambda: p.getClosestPoints(boxes[3], boxes[4], 1.0)


def closest_points_moved(original_data: str) -> Prepared:
    boxes = _boxes_on_a_floor()
    heights = itertools.cycle((0.1, 0.2))

    def move_and_ask() -> None:
        p.resetBasePositionAndOrientation(boxes[3], [1.5, 0.0, next(heights)], NO_TURN)
        p.getClosestPoints(boxes[3], boxes[4], 1.0)

    return move_and_ask


def overlapping(original_data: str) -> Prepared:
    _boxes_on_a_floor()
    return lambda: p.getOverlappingObjects([0.0, -0.1, 0.0], [0.6, 0.1, 0.3])


def _inverse_dynamics(body: int, positions: list[float], dofs: int) -> Timed:
    velocities, accelerations = [0.1] * dofs, [0.5] * dofs
    return lambda: p.calculateInverseDynamics(body, positions, velocities, accelerations)


def inverse_dynamics(original_data: str) -> Prepared:
    return _inverse_dynamics(_panda(), HOME, 9)


def inverse_dynamics_kuka(original_data: str) -> Prepared:
    return _inverse_dynamics(_kuka(), [0.1] * 7, 7)


def inverse_dynamics_tree(original_data: str) -> Prepared:
    tree, single, spherical = _tree()
    dofs = len(single) + 3 * len(spherical)
    base = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    return _inverse_dynamics(tree, base + [0.1] * dofs, 6 + dofs)


def jacobian(original_data: str) -> Prepared:
    panda = _panda()
    zeros = [0.0] * 9
    return lambda: p.calculateJacobian(panda, 11, [0.0, 0.0, 0.0], HOME, zeros, zeros)


def mass_matrix(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.calculateMassMatrix(panda, HOME)


def inverse_kinematics(original_data: str) -> Prepared:
    kuka = _kuka()
    return lambda: p.calculateInverseKinematics(kuka, 6, [0.3, 0.2, 0.7])


def inverse_kinematics_oriented(original_data: str) -> Prepared:
    panda = _panda()
    return lambda: p.calculateInverseKinematics(panda, 11, [0.45, 0.1, 0.4], [1.0, 0.0, 0.0, 0.0])


def _image(width: int, height: int, shadow: int = 0) -> Timed:
    _panda()
    p.loadURDF(PLANE)
    view = p.computeViewMatrix([1.2, -0.8, 1.0], [0.2, 0.0, 0.4], [0.0, 0.0, 1.0])
    projection = p.computeProjectionMatrixFOV(50, width / height, 0.01, 20)
    return lambda: p.getCameraImage(
        width, height, view, projection, shadow=shadow, renderer=p.ER_TINY_RENDERER
    )


def image_84(original_data: str) -> Prepared:
    return _image(84, 84)


def image_320(original_data: str) -> Prepared:
    return _image(320, 240)


def image_640(original_data: str) -> Prepared:
    return _image(640, 480)


def image_shadow(original_data: str) -> Prepared:
    return _image(320, 240, shadow=1)


def load_panda(original_data: str) -> Prepared:
    _world()
    return lambda: p.loadURDF(PANDA, useFixedBase=True), p.removeBody


def load_original_panda(original_data: str) -> Prepared:
    _world()
    file = str(Path(original_data) / "franka_panda" / "panda.urdf")
    return lambda: p.loadURDF(file, useFixedBase=True), p.removeBody
