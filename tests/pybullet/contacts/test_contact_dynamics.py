"""What changeDynamics says about contacts; the figures expected are what PyBullet 3.2.7 answers."""

from pathlib import Path
from typing import Any

import pytest

import pybullet as p


def box_on_floor(sideways: float, **dynamics: Any) -> int:
    """A box of 1 kg that gravity also pulls along x, and its number."""
    p.setGravity(sideways, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1]), basePosition=[0, 0, -1])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    box = p.createMultiBody(1, shape, basePosition=[0, 0, 0.1])
    p.changeDynamics(box, -1, **dynamics)
    return box


def step(count: int) -> None:
    for _ in range(count):
        p.stepSimulation()


@pytest.mark.parametrize(
    ("factors", "distance", "speed"),
    [([0.5, 1, 1], 0.082746, 0.39174), ([0, 1, 1], 0.191347, 0.90465)],
)
def test_friction_is_less_along_an_axis_with_a_small_factor(
    client: int, factors: list[float], distance: float, speed: float
) -> None:
    box = box_on_floor(2.2, anisotropicFriction=factors)
    step(100)
    assert p.getBasePositionAndOrientation(box)[0][0] == pytest.approx(distance, abs=2e-6)
    assert p.getBaseVelocity(box)[0][0] == pytest.approx(speed, abs=2e-5)
    assert p.getContactPoints(box)[0][13] == pytest.approx((factors[0], 0, 0), abs=5e-3)


@pytest.mark.parametrize("factors", [[1, 1, 1], [1, 0.2, 1], [2, 1, 1]])
def test_factors_along_other_axes_do_not_matter(client: int, factors: list[float]) -> None:
    box = box_on_floor(2.2, anisotropicFriction=factors)
    step(100)
    assert abs(p.getBasePositionAndOrientation(box)[0][0]) < 5e-4


def test_the_axes_are_those_of_the_link(client: int) -> None:
    box = box_on_floor(2.2, anisotropicFriction=[0.5, 1, 1])
    p.resetBasePositionAndOrientation(box, [0, 0, 0.1], p.getQuaternionFromEuler([0, 0, 1.5707963267948966]))
    step(100)
    assert abs(p.getBasePositionAndOrientation(box)[0][0]) < 5e-4


def creep(**dynamics: Any) -> float:
    """Speed at which a box that friction holds creeps down its slope, nearly slipping."""
    # With rolling friction the solver does not start from what held the box before.
    box = box_on_floor(2.4, rollingFriction=1e-9, **dynamics)
    step(1200)
    before = p.getBasePositionAndOrientation(box)[0][0]
    step(1200)
    after = p.getBasePositionAndOrientation(box)[0][0]
    p.resetSimulation()
    return abs(after - before) / 5.0


def test_a_friction_anchor_holds_what_creeps(client: int) -> None:
    p.setPhysicsEngineParameter(numSolverIterations=5)
    free = creep()
    p.setPhysicsEngineParameter(numSolverIterations=5)
    assert creep(frictionAnchor=1) < 0.8 * free


def test_a_friction_anchor_lets_go_when_friction_is_overcome(client: int) -> None:
    box = box_on_floor(5.0, frictionAnchor=1)
    step(120)
    assert p.getBaseVelocity(box)[0][0] == pytest.approx(0.5 * 2.5, rel=0.02)
    p.setGravity(0, 0, -10)
    step(120)
    rest = p.getBasePositionAndOrientation(box)[0][0]
    step(120)
    assert p.getBasePositionAndOrientation(box)[0][0] == pytest.approx(rest, abs=1e-4)


def test_contacts_beyond_the_processing_threshold_do_not_push(client: int) -> None:
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    ball = p.createMultiBody(1, shape, basePosition=[0, 0, 0.105])
    p.changeDynamics(ball, -1, contactProcessingThreshold=0)
    heights = []
    for _ in range(5):
        heights.append(p.getBasePositionAndOrientation(ball)[0][2])
        step(6 if len(heights) == 1 else 5)
    expected = [0.105, 0.101355, 0.099027, 0.099355, 0.099572]
    assert heights == pytest.approx(expected, abs=1e-6), "it sinks in before it is pushed"


@pytest.mark.parametrize("kept", ["state", "file"])
def test_states_keep_the_threshold_of_pairs_that_have_met(client: int, kept: str, tmp_path: Path) -> None:
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    ball = p.createMultiBody(1, shape, basePosition=[0, 0, 0.105])
    step(2)
    p.changeDynamics(ball, -1, contactProcessingThreshold=0)
    file = str(tmp_path / "state.bullet")
    p.saveBullet(file)
    state = p.saveState()
    step(10)
    height = p.getBasePositionAndOrientation(ball)[0][2]
    assert height > 0.0999, "it is braked before it touches"
    # Pairs that meet again have the new threshold.
    p.resetBasePositionAndOrientation(ball, [0, 0, 1], [0, 0, 0, 1])
    step(1)
    if kept == "state":
        p.restoreState(state)
    else:
        p.restoreState(fileName=file)
    step(10)
    assert p.getBasePositionAndOrientation(ball)[0][2] == height


HEIGHTS = {
    "ball": [0.108958, 0.106355, 0.102192, 0.097445, 0.098272, 0.100233, 0.10066, 0.099525],
    "box": [0.108958, 0.106355, 0.102192, 0.09689, 0.099331, 0.101822, 0.102749, 0.102265],
    "jointed balls": [0.108958, 0.106355, 0.102192, 0.097472, 0.098272, 0.100154, 0.100521, 0.099539],
}


@pytest.mark.parametrize("kind", HEIGHTS)
def test_soft_contacts_beyond_the_processing_threshold_do_not_push(client: int, kind: str) -> None:
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    if kind == "box":
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2, 0.2, 0.1])
    link: dict[str, Any] = {}
    if kind == "jointed balls":
        link = {
            "linkMasses": [0.5],
            "linkCollisionShapeIndices": [shape],
            "linkVisualShapeIndices": [-1],
            "linkPositions": [[0.5, 0, 0]],
            "linkOrientations": [[0, 0, 0, 1]],
            "linkInertialFramePositions": [[0, 0, 0]],
            "linkInertialFrameOrientations": [[0, 0, 0, 1]],
            "linkParentIndices": [0],
            "linkJointTypes": [p.JOINT_REVOLUTE],
            "linkJointAxis": [[0, 1, 0]],
        }
    body = p.createMultiBody(1, shape, basePosition=[0, 0, 0.11], **link)
    for index in range(-1, p.getNumJoints(body)):
        p.changeDynamics(body, index, contactStiffness=2e4, contactDamping=20, contactProcessingThreshold=0)
    heights = []
    for _ in range(8):
        step(3)
        heights.append(p.getBasePositionAndOrientation(body)[0][2])
    assert heights == pytest.approx(HEIGHTS[kind], abs=1e-6)


@pytest.mark.parametrize("shape", [p.GEOM_SPHERE, p.GEOM_BOX, p.GEOM_CAPSULE, p.GEOM_CYLINDER])
@pytest.mark.parametrize("speed", [30.0, 90.0, 400.0])
def test_what_has_a_swept_sphere_does_not_pass_through_thin_walls(
    client: int, shape: int, speed: float
) -> None:
    wall = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.005, 1, 1])
    p.createMultiBody(0, wall, basePosition=[1, 0, 0])
    size = {"radius": 0.02, "halfExtents": [0.02] * 3, "height": 0.04}
    bullet = p.createMultiBody(0.1, p.createCollisionShape(shape, **size))
    p.changeDynamics(bullet, -1, ccdSweptSphereRadius=0.02, maxJointVelocity=1000)
    p.resetBaseVelocity(bullet, [speed, 0.5, 0])
    step(60)
    assert p.getBasePositionAndOrientation(bullet)[0][0] < 1.0


@pytest.mark.parametrize(("share", "looks_ahead"), [(0.48, False), (0.52, True)])
def test_who_moves_by_more_than_half_its_swept_radius_looks_ahead(
    client: int, share: float, looks_ahead: bool
) -> None:
    radius, gap = 0.05, 0.02
    wall = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 1, 1])
    p.createMultiBody(0, wall, basePosition=[0.5 + radius + gap, 0, 0])
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=radius))
    p.changeDynamics(ball, -1, ccdSweptSphereRadius=radius, linearDamping=0)
    p.resetBaseVelocity(ball, [share * radius * 240, 0, 0])
    p.stepSimulation()
    # Other contacts are made only when the surfaces are nearer.
    assert [point[8] for point in p.getContactPoints()] == pytest.approx([gap] * looks_ahead)


def test_fast_bodies_with_swept_spheres_meet(client: int) -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.02)
    left, right = (p.createMultiBody(1, ball, basePosition=[x, 0, 0]) for x in (-1, 1))
    for body, speed in ((left, 70), (right, -70)):
        p.changeDynamics(body, -1, ccdSweptSphereRadius=0.02, linearDamping=0)
        p.resetBaseVelocity(body, [speed, 0, 0])
    step(20)
    positions = [p.getBasePositionAndOrientation(body)[0][0] for body in (left, right)]
    assert positions[0] < positions[1]
    momentum = sum(p.getBaseVelocity(body)[0][0] for body in (left, right))
    assert momentum == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("masses", [(1.0,), (0.0, 2.0)])
def test_a_base_that_may_move_again_collides_with_fixed_ones(client: int, masses: tuple[float, ...]) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.5])
    p.createMultiBody(0, box)
    upper = p.createMultiBody(0 if len(masses) == 1 else 1, box, basePosition=[0, 0, 1.2])
    p.setCollisionFilterGroupMask(upper, -1, 0, 0)
    for mass in masses:
        p.changeDynamics(upper, -1, mass=mass)
    p.setGravity(0, 0, -10)
    for _ in range(120):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(upper)[0][2] == pytest.approx(1.0, abs=1e-3)


def test_whole_numbers_come_back_as_floats(client: int) -> None:
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=1))
    p.changeDynamics(ball, -1, mass=2, restitution=1, contactStiffness=1000, contactDamping=10)
    info = p.getDynamicsInfo(ball, -1)
    assert [type(info[field]) for field in (0, 5, 8, 9)] == [float] * 4


def moving_floor(linear: list[float], angular: list[float]) -> tuple[int, int]:
    """A body without mass that moves, and a box on it; gravity is 10."""
    p.setGravity(0, 0, -10)
    bodies = [
        p.createMultiBody(mass, p.createCollisionShape(p.GEOM_BOX, halfExtents=half), basePosition=[0, 0, z])
        for mass, half, z in ((0, [3, 3, 0.05], 0.05), (1, [0.1, 0.1, 0.1], 0.2))
    ]
    p.resetBaseVelocity(bodies[0], linear, angular)
    return bodies[0], bodies[1]


def test_a_belt_takes_things_along_as_in_pybullet(client: int) -> None:
    belt, box = moving_floor([0.5, 0, 0], [0, 0, 0])
    for _ in range(240):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(belt)[0] == pytest.approx((0.5, 0, 0.05), abs=1e-9)
    assert p.getBasePositionAndOrientation(box)[0][0] == pytest.approx(0.45087, abs=1e-4)
    assert p.getBaseVelocity(box)[0] == pytest.approx((0.5, 0, 0), abs=1e-4)


def test_a_turntable_turns_things_and_a_lift_lifts_them(client: int) -> None:
    _, box = moving_floor([0, 0, 0.3], [0, 0, 1])
    for _ in range(100):
        p.stepSimulation()
    velocity, spin = p.getBaseVelocity(box)
    assert velocity == pytest.approx((0, 0, 0.3), abs=1e-2)
    assert spin == pytest.approx((0, 0, 1), abs=1e-3)


def test_soft_contacts_that_are_not_solved_do_not_push(client: int) -> None:
    """A gap beyond `contactProcessingThreshold` has no row; softness does not make one of it."""
    p.setGravity(0, 0, -10)
    p.setPhysicsEngineParameter(fixedTimeStep=0.01, numSolverIterations=1, globalCFM=1e-6)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    ball = p.createMultiBody(2.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.2), -1, [0, 0, 0.201])
    p.changeDynamics(ball, -1, contactProcessingThreshold=0)
    p.resetBaseVelocity(ball, [0, 0, -0.6])
    heights = []
    for _ in range(3):
        p.stepSimulation()
        heights.append(p.getBasePositionAndOrientation(ball)[0][2])
    expected = (0.1940038399999142, 0.19448103907936798, 0.19492156324800303)
    assert heights == pytest.approx(expected, abs=1e-12)
