"""What must hold of contact whoever computes it: how deep things sink, and what a collision keeps."""

import random
from collections.abc import Callable
from itertools import combinations_with_replacement

import numpy as np
import pytest
from tests.pybullet.drops.test_drops import GROUNDS, turned

import pybullet as p

DEEPEST = 2e-4
"""Penetration at rest that nobody sees [m]."""

# A shape of a size [m], how high its centre stands above the floor in sizes, and how it lies.
LYING = [2**-0.5, 0.0, 0.0, 2**-0.5]
UPRIGHT = [0.0, 0.0, 0.0, 1.0]
HOUSEHOLD: dict[str, tuple[Callable[[float], int], float, list[float]]] = {
    "ball": (lambda size: p.createCollisionShape(p.GEOM_SPHERE, radius=size), 1.0, UPRIGHT),
    "box": (
        lambda size: p.createCollisionShape(p.GEOM_BOX, halfExtents=[size, 0.5 * size, 0.7 * size]),
        0.7,
        UPRIGHT,
    ),
    "standing cylinder": (
        lambda size: p.createCollisionShape(p.GEOM_CYLINDER, radius=size, height=size),
        0.5,
        UPRIGHT,
    ),
    "lying cylinder": (
        lambda size: p.createCollisionShape(p.GEOM_CYLINDER, radius=size, height=size),
        1.0,
        LYING,
    ),
    "lying capsule": (
        lambda size: p.createCollisionShape(p.GEOM_CAPSULE, radius=size, height=size),
        1.0,
        LYING,
    ),
    "hull": (
        lambda size: p.createCollisionShape(
            p.GEOM_MESH,
            vertices=[
                [size * x, size * y, size * z] for x in (-1, 1) for y in (-0.6, 0.6) for z in (-0.8, 0.8)
            ],
        ),
        0.8,
        UPRIGHT,
    ),
}


@pytest.mark.parametrize("ground", GROUNDS)
def test_household_things_hardly_sink_in(client: int, ground: str) -> None:
    p.setGravity(0, 0, -9.81)
    make, height = GROUNDS[ground]
    floor = p.createMultiBody(0, make(), basePosition=[0, 0, height])
    bodies: dict[str, int] = {}
    for i, (name, (shape, stands, turn)) in enumerate(HOUSEHOLD.items()):
        for j, size in enumerate((0.02, 0.05, 0.15, 0.4)):
            bodies[f"{name} of {size} m"] = p.createMultiBody(
                1000.0 * size**3 + 0.05,
                shape(size),
                basePosition=[2.0 * i - 5, 2.0 * j - 3, stands * size + 0.002],
                baseOrientation=turn,
            )
    for _ in range(480):
        p.stepSimulation()
    for name, body in bodies.items():
        contacts = p.getContactPoints(body, floor)
        assert contacts, name
        assert min(contact[8] for contact in contacts) > -DEEPEST, name


SHAPES: dict[str, Callable[[], int]] = {
    "ball": lambda: p.createCollisionShape(p.GEOM_SPHERE, radius=0.1),
    "box": lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.07, 0.12]),
    "capsule": lambda: p.createCollisionShape(p.GEOM_CAPSULE, radius=0.06, height=0.15),
    "cylinder": lambda: p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.12),
    "hull": lambda: p.createCollisionShape(
        p.GEOM_MESH, vertices=[[x, y, z] for x in (-0.1, 0.1) for y in (-0.08, 0.1) for z in (-0.09, 0.1)]
    ),
}


def momentum(masses: dict[int, float]) -> np.ndarray:
    """The sum over free bodies [kg m/s]."""
    return np.sum([mass * np.array(p.getBaseVelocity(body)[0]) for body, mass in masses.items()], axis=0)


@pytest.mark.parametrize(("first", "second"), list(combinations_with_replacement(SHAPES, 2)))
def test_collisions_keep_momentum_to_rounding(client: int, first: str, second: str) -> None:
    """Of bodies of unequal mass that spin, slip and bounce, twenty times from random sides."""
    chance = random.Random(first + second)
    shapes = SHAPES[first](), SHAPES[second]()
    hits = 0
    for _ in range(20):
        masses = {
            p.createMultiBody(
                mass, shape, basePosition=[x, chance.uniform(-0.05, 0.05), 0], baseOrientation=turned(chance)
            ): mass
            for shape, x, mass in zip(shapes, (-0.3, 0.3), (1.0, 7.0), strict=True)
        }
        for body, speed in zip(masses, (3.0, -1.0), strict=True):
            p.changeDynamics(body, -1, linearDamping=0, angularDamping=0)
            p.changeDynamics(body, -1, restitution=0.8, lateralFriction=1, rollingFriction=0.01)
            spin = [chance.uniform(-5, 5) for _ in range(3)]
            p.resetBaseVelocity(body, [speed, chance.uniform(-0.2, 0.2), 0], spin)
        before = momentum(masses)
        touched = False
        for _ in range(60):
            p.stepSimulation()
            touched |= bool(p.getContactPoints())
            np.testing.assert_allclose(momentum(masses), before, atol=1e-11)
        hits += touched
        for body in masses:
            p.removeBody(body)
    assert hits > 10


TIME_STEP = 1e-3
"""So short that the explicit gyroscopic torque, which adds energy in free flight, hardly does [s]."""


def energy(body: int, gravity: float) -> float:
    """What semi-implicit steps keep of the energy of a body in free fall [J]."""
    mass, _, inertia, *_ = p.getDynamicsInfo(body, -1)
    (_, _, height), turn = p.getBasePositionAndOrientation(body)
    linear, angular = p.getBaseVelocity(body)
    spin = np.reshape(p.getMatrixFromQuaternion(turn), (3, 3)).T @ angular
    kinetic = 0.5 * mass * np.dot(linear, linear) + 0.5 * np.dot(inertia, spin * spin)
    return float(kinetic + mass * gravity * (height - 0.5 * TIME_STEP * linear[2]))


def throw(shape: int, position: list[float], velocity: list[float], chance: random.Random) -> int:
    """A body that loses nothing, turned and spinning at random."""
    body = p.createMultiBody(1, shape, basePosition=position, baseOrientation=turned(chance))
    p.changeDynamics(body, -1, restitution=1, lateralFriction=0, linearDamping=0, angularDamping=0)
    p.resetBaseVelocity(body, velocity, [chance.uniform(-3, 3) for _ in range(3)])
    return body


def most_gained(bodies: list[int], gravity: float, seconds: float) -> float:
    """Share by which the energy of bodies is at most above that of the start."""
    before = most = sum(energy(body, gravity) for body in bodies)
    for step in range(round(seconds / TIME_STEP)):
        p.stepSimulation()
        if step % 5 == 0:
            most = max(most, sum(energy(body, gravity) for body in bodies))
    return most / before - 1.0


@pytest.mark.parametrize("name", SHAPES)
def test_what_bounces_at_restitution_one_gains_no_energy(client: int, name: str) -> None:
    p.setTimeStep(TIME_STEP)
    p.setGravity(0, 0, -9.81)
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(floor, -1, restitution=1, lateralFriction=0)
    chance, shape = random.Random(name), SHAPES[name]()
    for _ in range(8):
        body = throw(shape, [0, 0, chance.uniform(0.3, 0.6)], [0.5, -0.3, chance.uniform(-2, 0)], chance)
        assert most_gained([body], 9.81, 1.5) < 5e-3
        p.removeBody(body)


@pytest.mark.parametrize(("first", "second"), list(combinations_with_replacement(SHAPES, 2)))
def test_collisions_at_restitution_one_gain_no_energy(client: int, first: str, second: str) -> None:
    p.setTimeStep(TIME_STEP)
    chance, shapes = random.Random(first + second), (SHAPES[first](), SHAPES[second]())
    for _ in range(8):
        bodies = [
            throw(shape, [x, chance.uniform(-0.05, 0.05), 0], [-4.0 * x, 0, 0], chance)
            for shape, x in zip(shapes, (-0.4, 0.4), strict=True)
        ]
        assert most_gained(bodies, 0.0, 0.4) < 5e-3
        assert p.getBaseVelocity(bodies[0])[0][0] < 1.0, "they met"
        for body in bodies:
            p.removeBody(body)


@pytest.mark.parametrize("speed", [0.5, 2.0, 5.0])
def test_a_ball_at_restitution_one_bounces_no_higher_at_usual_steps(client: int, speed: float) -> None:
    """At 240 Hz penetration is deep, and what takes it back would add a tenth to the energy."""
    p.setGravity(0, 0, -9.81)
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(floor, -1, restitution=1)
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 1.0])
    p.changeDynamics(ball, -1, restitution=1, linearDamping=0, angularDamping=0)
    p.resetBaseVelocity(ball, [0, 0, -speed])
    top = 1.0 + speed**2 / (2 * 9.81) + 0.5 * speed / 240
    highest = 0.0
    for _ in range(2400):
        p.stepSimulation()
        highest = max(highest, p.getBasePositionAndOrientation(ball)[0][2])
    assert highest < top + 1e-4


@pytest.mark.parametrize("name", SHAPES)
def test_friction_stays_in_its_cone(client: int, name: str) -> None:
    """At every contact of things that slide, roll and tumble over a floor."""
    p.setGravity(0, 0, -9.81)
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(floor, -1, lateralFriction=1)
    chance, shape, friction = random.Random(name), SHAPES[name](), 0.4
    for i in range(12):
        body = p.createMultiBody(1, shape, basePosition=[i, 0, 0.2], baseOrientation=turned(chance))
        p.changeDynamics(body, -1, lateralFriction=friction)
        p.resetBaseVelocity(
            body,
            [chance.uniform(-2, 2), chance.uniform(-2, 2), 0],
            [chance.uniform(-5, 5) for _ in range(3)],
        )
    sliding = 0
    for _ in range(120):
        p.stepSimulation()
        for contact in p.getContactPoints():
            normal, tangential = contact[9], np.hypot(contact[10], contact[12])
            assert normal >= 0
            assert tangential <= friction * normal * (1 + 1e-9) + 1e-12
            sliding += bool(tangential > 0.99 * friction * normal > 0)
    assert sliding > 20
