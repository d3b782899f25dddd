"""Bodies asleep: what is kept of them, and that they cost what they should. Their motion is compared in
`tests/conformance/scenarios/sleeping.py`."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import clients

RADIUS = 0.1


@pytest.fixture(autouse=True)
def _connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def floor() -> int:
    p.setGravity(0, 0, -10)
    return p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))


def ball(x: float = 0.0, *, may_sleep: bool = True) -> int:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS)
    body = p.createMultiBody(1, shape, basePosition=[x, 0, RADIUS])
    if may_sleep:
        p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
    return body


def steps(count: int) -> None:
    for _ in range(count):
        p.stepSimulation()


def is_asleep(body: int) -> bool:
    return clients[0].world.bodies[body].asleep


def height(body: int) -> float:
    return p.getBasePositionAndOrientation(body)[0][2]


def test_the_same_bits_whether_others_sleep_or_not() -> None:
    places = []
    for sleeper in (False, True):
        p.resetSimulation()
        floor()
        other, thrown = ball(x=5.0, may_sleep=sleeper), ball(may_sleep=False)
        p.resetBaseVelocity(thrown, [0.5, 0.1, 3], [1, 2, 3])
        steps(700)
        assert is_asleep(other) == sleeper
        places.append(p.getBasePositionAndOrientation(thrown) + p.getBaseVelocity(thrown))
    assert places[0] == places[1]


def test_bodies_fall_asleep_when_they_have_been_slow_for_two_seconds() -> None:
    p.setGravity(0, 0, 0)
    body = ball()
    p.resetBaseVelocity(body, [0.1, 0, 0])
    # 480 steps are two seconds; it has to be longer than that, and the next step acts upon it.
    steps(481)
    assert not is_asleep(body)
    steps(1)
    assert is_asleep(body)


@pytest.mark.parametrize(("gap", "asleep"), [(0.03, False), (0.05, True)])
def test_bodies_near_one_that_is_active_stay_awake(gap: float, asleep: bool) -> None:
    p.setGravity(0, 0, 0)
    body = ball()
    ball(x=2 * RADIUS + gap, may_sleep=False)
    steps(500)
    assert is_asleep(body) == asleep


def test_contacts_of_sleepers_stay_with_their_forces() -> None:
    ground, body = floor(), ball()
    steps(470)
    before = p.getContactPoints(body, ground)
    steps(30)
    assert is_asleep(body)
    after = p.getContactPoints(body, ground)
    assert len(before) == len(after) == 1
    assert after[0][9] == pytest.approx(10.0)
    np.testing.assert_allclose(np.hstack(before[0][5:8]), np.hstack(after[0][5:8]), atol=1e-12)


def test_contacts_of_a_sleeper_that_is_moved_are_found_anew() -> None:
    ground, body = floor(), ball()
    steps(500)
    p.resetBasePositionAndOrientation(body, [1, 0, 3], [0, 0, 0, 1])
    steps(1)
    assert is_asleep(body) and not p.getContactPoints(body)
    p.resetBasePositionAndOrientation(body, [2, 0, RADIUS], [0, 0, 0, 1])
    steps(1)
    assert [contact[5][0] for contact in p.getContactPoints(body, ground)] == [2.0]
    assert height(body) == RADIUS


def test_contacts_that_stay_do_not_hinder_those_that_come_and_go() -> None:
    """Sleepers before and after a bouncing ball in the order of contacts."""
    ground = floor()
    first, bouncing, last = ball(x=0.0), ball(x=2.0, may_sleep=False), ball(x=4.0)
    p.changeDynamics(bouncing, -1, restitution=1.0, linearDamping=0)
    p.changeDynamics(ground, -1, restitution=1.0)
    steps(500)
    assert is_asleep(first) and is_asleep(last)
    p.resetBaseVelocity(bouncing, [0, 0, 2])
    counts = set()
    for _ in range(400):
        p.stepSimulation()
        counts.add(len(p.getContactPoints(bouncing)))
        for body in (first, last):
            (contact,) = p.getContactPoints(body)
            assert contact[9] == pytest.approx(10.0)
            assert contact[5][0] == p.getBasePositionAndOrientation(body)[0][0]
    assert counts == {0, 1}


def test_solver_statistics_leave_sleepers_out() -> None:
    p.setPhysicsEngineParameter(reportSolverAnalytics=1)
    floor()
    ball()
    assert [island["numBodies"] for island in p.stepSimulation()] == [1]
    steps(500)
    assert not p.stepSimulation()


def test_a_state_tells_who_is_asleep() -> None:
    floor()
    body = ball()
    awake = p.saveState()
    steps(500)
    asleep = p.saveState()
    p.setGravity(0, 0, 10)
    p.restoreState(awake)
    assert not is_asleep(body)
    steps(5)
    assert height(body) > RADIUS
    p.restoreState(asleep)
    assert is_asleep(body)
    steps(5)
    assert height(body) == pytest.approx(RADIUS, abs=1e-4)


def test_a_file_tells_who_is_asleep_and_who_may(tmp_path: Path) -> None:
    floor()
    body, other = ball(), ball(x=1.0, may_sleep=False)
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_DISABLE_WAKEUP, sleepThreshold=0.07)
    steps(500)
    path = str(tmp_path / "world.bullet")
    p.saveBullet(path)
    p.resetSimulation()
    p.loadBullet(path)
    assert is_asleep(body) and not is_asleep(other)
    p.setGravity(0, 0, 10)
    steps(5)
    assert height(body) < RADIUS < height(other)
    p.saveBullet(path)
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_WAKE_UP)
    steps(5)
    assert not is_asleep(body)


def test_removing_a_body_leaves_the_others_asleep() -> None:
    floor()
    first, second = ball(), ball(x=2.0)
    steps(500)
    p.removeBody(first)
    assert is_asleep(second)
    third = ball(x=4.0, may_sleep=False)
    assert not is_asleep(third)
    p.setGravity(0, 0, 10)
    steps(5)
    assert height(second) < RADIUS < height(third)


def test_fixed_bases_and_bodies_without_shapes_never_sleep() -> None:
    ghost = p.createMultiBody(1)
    p.changeDynamics(ghost, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING | p.ACTIVATION_STATE_SLEEP)
    steps(3)
    assert not is_asleep(ghost)
    p.setGravity(0, 0, -10)
    steps(3)
    assert height(ghost) < 0


def test_sleep_that_is_not_enabled_is_over_after_a_step() -> None:
    body = p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[RADIUS] * 3))
    p.setGravity(0, 0, -10)
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_SLEEP)
    steps(1)
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
    steps(2)
    # In PyBullet, too, it has fallen for all three steps: by 1 + 2 + 3 times g dt², but for damping.
    assert height(body) == pytest.approx(-6 * 10 / 240**2, rel=1e-3)
