"""Pulling bodies with the mouse."""

import math
import time

import numpy as np
import pytest
from tests.patience import PATIENCE
from tests.viewer.watcher import Watcher

import pybullet as p
from carom import World
from carom.viewer.input.picking import Picking
from carom.viewer.input.turning import Turning
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients


@pytest.fixture
def ball() -> int:
    return p.createMultiBody(2, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 1])


def pull(page: Watcher, body: int, target: list[float], link: int = -1) -> None:
    page.tell("grasp", body=body, link=link, point=[0, 0, 0], target=target)


def ties(viewer: Viewer) -> int:
    return len(clients[0].world.user_constraints.rows)


def step_until(page: Watcher, condition) -> None:
    """Steps for as long as a busy machine's server needs to hear the page: steps are too fast to count."""
    give_up = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < give_up, "it does not come to that"
        p.stepSimulation()
        page.take_what_came()
        # So that the server, which has to hear it, is not held up by steps.
        time.sleep(0.0005)


def hangs_at(body: int, place: list[float]) -> bool:
    """Whether it is there, and does not only swing through."""
    position, _ = p.getBasePositionAndOrientation(body)
    return math.dist(position, place) < 0.01 and math.hypot(*p.getBaseVelocity(body)[0]) < 0.1


def test_a_body_follows_the_hand_and_falls_when_let_go(viewer: Viewer, ball: int):
    target = [0.3, 0.2, 1.5]
    with Watcher(viewer.address) as page:
        pull(page, ball, [0, 0, 1])
        step_until(page, lambda: ties(viewer))
        # Not before: nobody knows how many steps the hand takes to come.
        p.setGravity(0, 0, -10)
        assert p.getNumConstraints() == 0
        page.tell("pull", target=target)
        step_until(page, lambda: hangs_at(ball, target))
        for _ in range(240):
            p.stepSimulation()
        np.testing.assert_allclose(p.getBasePositionAndOrientation(ball)[0], target, atol=0.02)
        page.tell("let go")
        step_until(page, lambda: not ties(viewer))
        for _ in range(60):
            p.stepSimulation()
    assert p.getBasePositionAndOrientation(ball)[0][2] < 1.4


def test_numbers_of_the_scripts_constraints_are_not_taken(viewer: Viewer, ball: int):
    arguments = (ball, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [0, 0, 1])
    first = p.createConstraint(*arguments)
    with Watcher(viewer.address) as page:
        pull(page, ball, [0, 0, 1])
        step_until(page, lambda: ties(viewer) == 2)
        assert p.getNumConstraints() == 1
        assert p.createConstraint(*arguments) == first + 1
        assert [p.getConstraintUniqueId(i) for i in range(p.getNumConstraints())] == [first, first + 1]


def test_a_page_that_goes_lets_go(viewer: Viewer, ball: int):
    with Watcher(viewer.address) as page:
        pull(page, ball, [0, 0, 1])
        step_until(page, lambda: ties(viewer))
    with Watcher(viewer.address) as page:
        step_until(page, lambda: not ties(viewer))


def test_a_body_may_go_while_it_is_held(viewer: Viewer, ball: int):
    with Watcher(viewer.address) as page:
        pull(page, ball, [0, 0, 1])
        step_until(page, lambda: ties(viewer))
        p.removeBody(ball)
        page.tell("pull", target=[1, 1, 1])
        page.tell("let go")
        other = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
        pull(page, other, [0, 0, 0.5])
        step_until(page, lambda: ties(viewer))


def test_what_is_fixed_or_not_there_cannot_be_held(viewer: Viewer, ball: int):
    wall = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 1]))
    with Watcher(viewer.address) as page:
        for body, link in ((wall, -1), (99, -1), (ball, 7), (ball, -2)):
            pull(page, body, [0, 0, 1], link)
            page.tell("pull", target=[1, 1, 1])
        page.tell("grasp", body=ball, link=-1, point=[0, 0, math.nan], target=[0, 0, 0])
        for _ in range(50):
            p.stepSimulation()
        slider = p.addUserDebugParameter("news")
        page.tell("slider", slider=slider, value=1)
        page.wait_for(lambda: page.shown.get(("slider", slider), {}).get("value") == 1)
        p.stepSimulation()
        page.wait_for(lambda: page.frame.get("time") == pytest.approx(51 / 240))
    assert ties(viewer) == 0


def test_the_last_turn_and_move_count_where_the_hand_lets_go_at_once() -> None:
    """A page sends the last motion and the release of the button within one frame."""
    world = World()
    ball = world.add_sphere(0.1, position=(0.0, 0.0, 1.0))
    turning = Turning(world, world.lock, lambda: True)
    half = math.sqrt(0.5)
    for quarter in ([0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]):
        turning.turn(1, {"body": ball.id, "link": -1, "orientation": quarter})
    turning.release(1)
    turning.apply()
    np.testing.assert_allclose(ball.links[-1].pose.orientation, [0.0, 0.0, half, half], atol=1e-15)
    assert not world.observers

    picking = Picking(world, world.lock, lambda: True)
    for has_hold in (True, False):
        picking.take(1, ball.id, -1, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        if has_hold:
            picking.apply()
        target = (0.5, 0.25, 1.0) if has_hold else (-0.5, 0.0, 2.0)
        picking.move(1, target)
        picking.release(1)
        picking.apply()
        np.testing.assert_allclose(ball.links[-1].pose.position, target, atol=1e-15)
        assert not world.user_constraints.rows
