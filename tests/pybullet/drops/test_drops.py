"""Many bodies of every shape dropped onto each other, and stacks that are hard to hold."""

import math
import random
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest

import pybullet as p

G = 9.81
SITE = 1.5
SIDE = 16
CUBE = [[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)]
TETRAHEDRON = [[0.12, 0.12, 0.12], [0.12, -0.12, -0.12], [-0.12, 0.12, -0.12], [-0.12, -0.12, 0.12]]

BODIES: dict[str, Callable[[], int]] = {
    "ball": lambda: p.createCollisionShape(p.GEOM_SPHERE, radius=0.1),
    "box": lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.07, 0.12]),
    "capsule": lambda: p.createCollisionShape(p.GEOM_CAPSULE, radius=0.06, height=0.15),
    "cylinder": lambda: p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.12),
    "hull": lambda: p.createCollisionShape(p.GEOM_MESH, vertices=TETRAHEDRON),
    "compound": lambda: p.createCollisionShapeArray(
        shapeTypes=[p.GEOM_SPHERE, p.GEOM_BOX],
        radii=[0.08, 0.0],
        halfExtents=[[0.0] * 3, [0.06] * 3],
        collisionFramePositions=[[-0.08, 0, 0], [0.08, 0, 0]],
    ),
}


def mesh() -> int:
    corners = [[x, y, 0.0] for x in (-20, 20) for y in (-20, 20)]
    return p.createCollisionShape(
        p.GEOM_MESH, vertices=corners, indices=[0, 2, 1, 1, 2, 3], flags=p.GEOM_FORCE_CONCAVE_TRIMESH
    )


def heightfield() -> int:
    return p.createCollisionShape(
        p.GEOM_HEIGHTFIELD, heightfieldData=[0.0] * 900, numHeightfieldRows=30, numHeightfieldColumns=30
    )


GROUNDS: dict[str, tuple[Callable[[], int], float]] = {
    "plane": (lambda: p.createCollisionShape(p.GEOM_PLANE), 0.0),
    "box": (lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 1]), -1.0),
    "mesh": (mesh, 0.0),
    "heightfield": (heightfield, 0.0),
}


def turned(chance: random.Random) -> list[float]:
    """A random orientation."""
    q = [chance.gauss(0, 1) for _ in range(4)]
    size = math.sqrt(sum(x * x for x in q))
    return [x / size for x in q]


@pytest.mark.parametrize("ground", GROUNDS)
def test_drops_of_every_pair_of_shapes_stay_in_this_world(client: int, ground: str) -> None:
    chance = random.Random(ground)
    p.setGravity(0, 0, -G)
    make, height = GROUNDS[ground]
    p.createMultiBody(0, make(), basePosition=[0, 0, height])
    shapes = {name: make() for name, make in BODIES.items()}
    pairs = list(product(shapes, repeat=2))
    bodies = []
    for site in range(252):
        x, y = SITE * (site % SIDE - SIDE / 2 + 0.5), SITE * (site // SIDE - SIDE / 2 + 0.5)
        for level, name in enumerate(pairs[site % len(pairs)]):
            place = [x + chance.uniform(-0.05, 0.05), y + chance.uniform(-0.05, 0.05), 0.3 + 0.5 * level]
            body = p.createMultiBody(1, shapes[name], basePosition=place, baseOrientation=turned(chance))
            spin = [chance.uniform(-5, 5) for _ in range(3)]
            p.resetBaseVelocity(body, [chance.uniform(-0.5, 0.5), chance.uniform(-0.5, 0.5), 0], spin)
            bodies.append(body)
    fastest = math.sqrt(2 * G * 1.0) + 2.0
    for _ in range(240):
        p.stepSimulation()
        for body in bodies[chance.randrange(8) :: 8]:
            linear, _ = p.getBaseVelocity(body)
            assert math.hypot(*linear) < fastest
    for body in bodies:
        position, _ = p.getBasePositionAndOrientation(body)
        assert 0.02 < position[2] < 0.5
        assert max(abs(position[0]), abs(position[1])) < SITE * SIDE


def test_a_heavy_box_stands_on_a_light_one(client: int) -> None:
    p.setGravity(0, 0, -G)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    light = p.createMultiBody(1, shape, basePosition=[0, 0, 0.1])
    heavy = p.createMultiBody(100, shape, basePosition=[0, 0, 0.3])
    for _ in range(960):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(light)[0] == pytest.approx((0, 0, 0.1), abs=5e-3)
    assert p.getBasePositionAndOrientation(heavy)[0] == pytest.approx((0, 0, 0.3), abs=1e-2)


def tower() -> list[int]:
    """125 boxes and a heavy ball that flies at them."""
    p.resetSimulation()
    p.setGravity(0, 0, -G)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    boxes = [
        p.createMultiBody(1, shape, basePosition=[0.201 * x, 0.201 * y, 0.1 + 0.2 * z])
        for x, y, z in product(range(5), repeat=3)
    ]
    ball = p.createMultiBody(
        20, p.createCollisionShape(p.GEOM_SPHERE, radius=0.2), basePosition=[-1, 0.4, 0.5]
    )
    p.resetBaseVelocity(ball, [8, 0, 0])
    return boxes


def run(boxes: list[int], steps: int) -> list[tuple[float, ...]]:
    """Poses of boxes some steps later."""
    for _ in range(steps):
        p.stepSimulation()
    return [sum(p.getBasePositionAndOrientation(box), ()) for box in boxes]


def test_the_collapse_of_125_boxes_is_the_same_to_the_last_bit(client: int) -> None:
    first = run(tower(), 150)
    assert max(abs(pose[2] - 0.2 * (n % 5) - 0.1) for n, pose in enumerate(first)) > 0.15, "nothing fell"
    assert run(tower(), 150) == first


@pytest.mark.parametrize("by_file", [False, True])
def test_a_collapse_goes_on_from_a_saved_state_to_the_last_bit(
    client: int, tmp_path: Path, by_file: bool
) -> None:
    boxes, name = tower(), str(tmp_path / "collapse.bullet")
    run(boxes, 70)
    state = p.saveState()
    p.saveBullet(name)
    expected = run(boxes, 80)
    for _ in range(2):
        if by_file:
            p.restoreState(fileName=name)
        else:
            p.restoreState(state)
        assert run(boxes, 80) == expected
