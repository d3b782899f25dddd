"""Long runs, and digests of their results, which are the same on every machine.

Nothing in them comes from a random generator or from Python's own sines: scripts that use those differ from
one machine to the next by themselves.
"""

from __future__ import annotations

import hashlib
import json
import struct
import sys
from itertools import pairwise

import pybullet as p
import pybullet_data
from carom import Camera, World
from carom.description import Box, Cylinder, Sphere, Visual
from carom.model.body_spec import BodySpec, LinkSpec

IDENTITY = (0.0, 0.0, 0.0, 1.0)


def _begin() -> None:
    p.resetSimulation()
    p.setGravity(0, 0, -9.8125)


def _chain(links: int, height: float) -> int:
    """An arm of boxes, whose hinges turn about y and x in turn."""
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.0625, 0.0625, 0.125])
    axes = [[0, 1, 0] if number % 2 == 0 else [1, 0, 0] for number in range(links)]
    return p.createMultiBody(
        0,
        box,
        -1,
        [0, 0, height],
        linkMasses=[0.5] * links,
        linkCollisionShapeIndices=[box] * links,
        linkVisualShapeIndices=[-1] * links,
        linkPositions=[[0.03125, 0, 0.3125]] * links,
        linkOrientations=[IDENTITY] * links,
        linkInertialFramePositions=[[0, 0, 0]] * links,
        linkInertialFrameOrientations=[IDENTITY] * links,
        linkParentIndices=list(range(links)),
        linkJointTypes=[p.JOINT_REVOLUTE] * links,
        linkJointAxis=axes,
    )


def _joints(body: int) -> list[float]:
    states = [p.getJointState(body, joint) for joint in range(p.getNumJoints(body))]
    return [number for state in states for number in (state[0], state[1], *state[2], state[3])]


def _poses() -> list[float]:
    bodies = [p.getBodyUniqueId(index) for index in range(p.getNumBodies())]
    return [number for body in bodies for part in p.getBasePositionAndOrientation(body) for number in part]


def arm() -> list[float]:
    """An arm that swings, then is held by its motors; a sensor in it."""
    _begin()
    body = _chain(6, 1.0)
    p.enableJointForceTorqueSensor(body, 2)
    for joint in range(6):
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
    numbers = []
    for step in range(960):
        if step == 480:
            targets = [0.5, -0.25, 0.75, 0.125, -0.5, 0.25]
            p.setJointMotorControlArray(
                body, range(6), p.POSITION_CONTROL, targetPositions=targets, forces=[40.0] * 6
            )
        p.stepSimulation()
        if step % 60 == 0:
            numbers += _joints(body)
    return numbers


def stack() -> list[float]:
    """Boxes, balls, capsules and cylinders that fall onto each other."""
    _begin()
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shapes = [
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.25, 0.25, 0.125]),
        p.createCollisionShape(p.GEOM_SPHERE, radius=0.1875),
        p.createCollisionShape(p.GEOM_CAPSULE, radius=0.125, height=0.25),
        p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1875, height=0.25),
    ]
    for number in range(24):
        place = [0.0625 * (number % 3), 0.03125 * (number % 5), 0.25 + 0.375 * number]
        body = p.createMultiBody(1.0 + 0.25 * (number % 4), shapes[number % 4], -1, place)
        p.changeDynamics(body, -1, rollingFriction=0.0009765625, restitution=0.25 * (number % 2))
    numbers = []
    for step in range(960):
        p.stepSimulation()
        if step % 60 == 0:
            numbers += _poses()
    for contact in p.getContactPoints():
        numbers += [*contact[5], *contact[6], *contact[7], contact[8], contact[9]]
    return numbers


def tied() -> list[float]:
    """Bodies tied together by user constraints, and an arm that pushes them."""
    _begin()
    body = _chain(4, 0.5)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.125, 0.125, 0.125])
    boxes = [p.createMultiBody(0.75, box, -1, [0.5, 0.25 * number, 1.0]) for number in range(4)]
    for first, second in pairwise(boxes):
        p.createConstraint(
            first, -1, second, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0.125, 0], [0, -0.125, 0]
        )
    p.createConstraint(boxes[0], -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 1.0])
    numbers = []
    for step in range(480):
        p.setJointMotorControl2(body, 0, p.TORQUE_CONTROL, force=2.0 if step % 120 < 60 else -2.0)
        p.stepSimulation()
        if step % 40 == 0:
            numbers += _poses() + _joints(body)
    return numbers


def questions() -> list[float]:
    """Inverse kinematics and dynamics, Jacobians, rays and nearest points."""
    _begin()
    body = _chain(6, 1.0)
    sphere = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.25), -1, [0.75, 0.25, 1.5])
    numbers: list[float] = []
    for number in range(8):
        target = [0.25 + 0.0625 * number, 0.125 * number - 0.5, 1.75]
        numbers += p.calculateInverseKinematics(body, 5, target, maxNumIterations=50)
        pose = [0.125 * number, -0.25, 0.0625 * number, 0.5, -0.125, 0.25]
        numbers += p.calculateInverseDynamics(body, pose, [0.5] * 6, [0.25] * 6)
        for rows in p.calculateJacobian(body, 5, [0, 0, 0.125], pose, [0.0] * 6, [0.0] * 6):
            numbers += [entry for row in rows for entry in row]
        for row in p.calculateMassMatrix(body, pose):
            numbers += row
        hit = p.rayTest([2, 0.0625 * number, 1.5], [-2, 0.0625 * number, 1.4375])[0]
        numbers += [hit[0], hit[2], *hit[3], *hit[4]]
    for near in p.getClosestPoints(body, sphere, 5.0):
        numbers += [*near[5], *near[6], *near[7], near[8]]
    return numbers


def images() -> list[float]:
    """What cameras see of shapes of all kinds: colours, depths and labels, with and without shadows."""
    _begin()
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    box = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.25, 0.125, 0.25], rgbaColor=[0.75, 0.25, 0.125, 1])
    capsule = p.createVisualShape(p.GEOM_CAPSULE, radius=0.125, length=0.5, rgbaColor=[0.25, 0.5, 1, 1])
    shapes = {
        box: p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.25, 0.125, 0.25]),
        capsule: p.createCollisionShape(p.GEOM_CAPSULE, radius=0.125, height=0.5),
        -1: p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1875, height=0.25),
    }
    for number in range(9):
        look = list(shapes)[number % 3]
        place = [0.375 * (number % 3), 0.25 * (number % 4), 0.5 + 0.25 * number]
        p.createMultiBody(1.0, shapes[look], look, place)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.25)
    p.createMultiBody(1.0, ball, -1, [-0.5, 0.25, 0.5])
    _chain(4, 1.5)
    numbers: list[float] = []
    for turn in range(8):
        for _ in range(30):
            p.stepSimulation()
        view = p.computeViewMatrixFromYawPitchRoll([0, 0, 0.5], 3.0 + 0.25 * turn, 47.0 * turn, -35.0, 3.0, 2)
        if turn % 3 == 2:
            view = p.computeViewMatrix([2.0, 0.25 * turn, 1.5], [0, 0, 0.5], [0, 0, 1])
        lens = p.computeProjectionMatrixFOV(40.0 + 5.0 * turn, 1.25, 0.125, 16.0)
        *_, colour, depth, label = p.getCameraImage(
            160, 128, view, lens, lightDirection=[1, 0.5 * turn - 2, 3], shadow=turn % 2
        )
        for picture in (colour, depth, label):
            numbers += picture.ravel().tolist()
    return [*numbers, *_mounted_camera()]


def _mounted_camera() -> list[float]:
    """What a camera with parallel light sees."""
    world = World()
    looks = Visual(Box((0.25, 0.125, 0.0625))), Visual(Sphere(0.125)), Visual(Cylinder(0.125, 0.25))
    for number in range(6):
        base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(looks[number % 3],))
        world.load(BodySpec("thing", base), (0.25 * number, 0.5, 0.25 * number))
    camera = Camera.with_field_of_view(128, 96, 55.0).look_at([2.0, 1.0, 1.5], [0.5, 0.25, 0.25])
    image = camera.capture(world)
    points = image.point_cloud().points
    return [*image.colour.ravel().tolist(), *image.depth.ravel().tolist(), *points.ravel().tolist()]


def robots() -> list[float]:
    """Robots from files, which give rotations as angles: an arm is driven, others fall onto the floor."""
    _begin()
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf", [0, 0, 0], p.getQuaternionFromEuler([0.03125, -0.0625, 0]))
    arm = p.loadURDF("franka_panda/panda.urdf", [0, 0, 0.5], useFixedBase=True)
    p.loadURDF("r2d2.urdf", [1, 0, 1], p.getQuaternionFromEuler([0.4, 0.3, -1.1]))
    p.loadMJCF("mjcf/ant.xml")
    numbers = []
    for step in range(360):
        joints = [0, 1, 2, 3, 4, 5, 6]
        p.setJointMotorControlArray(arm, joints, p.VELOCITY_CONTROL, targetVelocities=[0.3] * 7)
        p.stepSimulation()
        if step % 30 == 0:
            numbers += _poses() + _joints(arm)
            numbers += [
                angle
                for pose in map(p.getBasePositionAndOrientation, (0, 2, 3))
                for angle in p.getEulerFromQuaternion(pose[1])
            ]
    return numbers


def meshes() -> list[float]:
    """Hulls of meshes, and of points in a plane and on a line, that fall onto a triangle mesh."""
    _begin()
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    floor = [[x, y, 0.03125 * ((5 * x + 3 * y) % 4)] for x in range(-3, 4) for y in range(-3, 4)]
    corners = [7 * x + y for x in range(6) for y in range(6)]
    triangles = [corner + step for corner in corners for step in (0, 7, 1, 1, 7, 8)]
    ground = p.createCollisionShape(p.GEOM_MESH, vertices=floor, indices=triangles)
    p.createMultiBody(0, ground)
    flat = [[0.3 * x, 0.2 * y, 0.1 * x + 0.05 * y] for x in (-1, 0, 1) for y in (-1, 0, 1)]
    line = [[0.1 * x, 0.2 * x, -0.05 * x] for x in range(-2, 3)]
    shapes = [
        p.createCollisionShape(p.GEOM_MESH, fileName="duck.obj", meshScale=[0.1, 0.1, 0.1]),
        p.createCollisionShape(p.GEOM_MESH, fileName="soccerball.obj", meshScale=[0.2, 0.2, 0.2]),
        p.createCollisionShape(p.GEOM_MESH, vertices=flat),
        p.createCollisionShape(p.GEOM_MESH, vertices=line),
    ]
    for number in range(12):
        place = [0.3 * (number % 3) - 0.3, 0.2 * (number % 5) - 0.4, 0.5 + 0.4 * number]
        turn = p.getQuaternionFromAxisAngle([0.2, 0.5, 1.0], 0.7 * number)
        p.createMultiBody(1.0, shapes[number % 4], -1, place, turn)
    numbers = []
    for step in range(480):
        p.stepSimulation()
        if step % 40 == 0:
            numbers += _poses()
    return numbers


def soft() -> list[float]:
    """A cloth that falls onto a ball, and a soft solid that falls beside it."""
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -9.8125)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.25), -1, [0, 0, 0.25])
    cloth = p.loadSoftBody(
        "cloth_z_up.obj",
        basePosition=[0, 0, 0.75],
        baseOrientation=p.getQuaternionFromEuler([0.1, 0.2, 0.3]),
        scale=0.5,
        mass=0.5,
        useMassSpring=1,
        useBendingSprings=1,
        springElasticStiffness=40,
        springDampingStiffness=0.1,
        frictionCoeff=0.5,
        useFaceContact=1,
    )
    solid = p.loadSoftBody(
        "ball.vtk",
        basePosition=[2, 0, 1],
        scale=0.5,
        mass=1,
        useNeoHookean=1,
        NeoHookeanMu=180,
        NeoHookeanLambda=600,
        NeoHookeanDamping=0.01,
        frictionCoeff=0.5,
        useFaceContact=1,
    )
    numbers: list[float] = []
    for step in range(240):
        p.stepSimulation()
        if step % 60 == 59:
            for body in (cloth, solid):
                _, nodes = p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)
                numbers += [number for node in nodes for number in node]
    return numbers


RUNS = (arm, stack, tied, questions, images, robots, meshes, soft)


def digests(*names: str) -> dict[str, str]:
    """A digest of the bits of all numbers of each run, or of those that are named."""
    p.connect(p.DIRECT)
    results = {}
    for run in (run for run in RUNS if not names or run.__name__ in names):
        numbers = run()
        results[run.__name__] = hashlib.blake2b(
            struct.pack(f"<{len(numbers)}d", *numbers), digest_size=8
        ).hexdigest()
    p.disconnect()
    return results


if __name__ == "__main__":
    json.dump(digests(*sys.argv[1:]), sys.stdout)
