"""Bodies that are turned, and pulled while the simulation is paused, with the mouse in the page."""

import math
import threading
from typing import Any

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.description.transform import multiplied
from carom.viewer.input.turning import turn_between
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()
# By a hundred pixels to the right and 0.01 rad for each.
ANGLE = 1.0


@pytest.fixture
def brick(page: Page) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2, 0.1, 0.15])
    brick = p.createMultiBody(2, shape, basePosition=[0, 0, 0.5])
    p.resetDebugVisualizerCamera(2, 0, 0, [0.3, 0, 0.5])
    page.until("app.camera.distance === 2 && app.scene.groups.length > 0")
    return brick


def drag(page: Page, point: list[float], way: tuple[float, float], *keys: str, hold: bool = False) -> None:
    x, y, _ = page.page.evaluate(f"app.camera.pixel({point})")
    for key in keys:
        page.page.keyboard.down(key)
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    page.page.mouse.move(x + way[0], y + way[1], steps=4)
    if not hold:
        page.page.mouse.up()
    for key in keys:
        page.page.keyboard.up(key)


def yaw(body: int) -> float:
    return p.getEulerFromQuaternion(p.getBasePositionAndOrientation(body)[1])[2]


def observers() -> int:
    return len(clients[0].world.observers)


@pytest.mark.long
@pytest.mark.parametrize("keys", [("Control", "Shift"), ("Alt", "Shift")])
def test_a_body_is_turned_by_a_torque_and_comes_to_rest(page: Page, brick: int, keys: tuple[str, ...]):
    before = page.page.evaluate("app.camera.yaw")
    drag(page, [0, 0, 0.5], (100, 0), *keys, hold=True)
    wait_for(observers, page)
    p.stepSimulation()
    assert 0 < p.getBaseVelocity(brick)[1][2] < 2

    def there() -> bool:
        for _ in range(8):
            p.stepSimulation()
        return yaw(brick) == pytest.approx(ANGLE, abs=0.01) and abs(p.getBaseVelocity(brick)[1][2]) < 0.01

    wait_for(there, page)
    # A torque alone: it stays where it is, and the camera as well.
    assert p.getBasePositionAndOrientation(brick)[0] == pytest.approx((0, 0, 0.5), abs=1e-6)
    assert page.page.evaluate("app.camera.yaw") == before
    page.page.mouse.up()
    wait_for(lambda: not observers(), page)


def test_a_body_is_turned_at_once_while_paused(page: Page, viewer: Viewer, brick: int):
    viewer.pause(True)
    drag(page, [0, 0, 0.5], (100, 0), "Control", "Shift")
    wait_for(lambda: yaw(brick) == pytest.approx(ANGLE, abs=1e-6), page)
    assert p.getBasePositionAndOrientation(brick)[0] == pytest.approx((0, 0, 0.5), abs=1e-9)


@pytest.mark.long
def test_a_link_is_turned_about_the_axis_of_its_joint(page: Page):
    door = p.createMultiBody(
        baseMass=0,
        linkMasses=[1.5],
        linkCollisionShapeIndices=[p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.4, 0.03, 0.4])],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0, 0, 0.5]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0.4, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_REVOLUTE],
        linkJointAxis=[[0, 0, 1]],
    )
    p.setJointMotorControl2(door, 0, p.VELOCITY_CONTROL, force=0)
    p.resetDebugVisualizerCamera(2, 0, 0, [0.3, 0, 0.5])
    page.until("app.camera.distance === 2 && app.scene.groups.length > 0")
    drag(page, [0.1, 0, 0.5], (80, 0), "Control", "Shift", hold=True)

    def open_so_far() -> bool:
        for _ in range(8):
            p.stepSimulation()
        return p.getJointState(door, 0)[0] == pytest.approx(0.8, abs=0.02)

    wait_for(open_so_far, page)
    page.page.mouse.up()


@pytest.mark.long
def test_a_robot_that_is_pulled_while_paused_moves_once_the_simulation_goes_on(page: Page, viewer: Viewer):
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    hand = np.array(p.getLinkState(arm, 8)[0])
    p.resetDebugVisualizerCamera(1.5, 0, 0, [0.3, 0, 0.6])
    page.until("app.camera.distance === 1.5 && app.scene.groups.length > 0")
    viewer.pause(True)
    drag(page, hand.tolist(), (-60, 0), hold=True)
    wait_for(lambda: clients[0].world.user_constraints.rows, page)
    page.page.wait_for_timeout(200)
    positions = [p.getJointState(arm, joint)[0] for joint in range(7)]
    assert positions == [0.0] * 7

    def script() -> None:
        for _ in range(240):
            p.stepSimulation()

    thread = threading.Thread(target=script)
    thread.start()
    page.page.keyboard.press("i")
    wait_for(lambda: not thread.is_alive(), page)
    thread.join()
    way = np.array(p.getLinkState(arm, 8)[0]) - hand
    assert way[0] < -0.05
    assert math.isclose(p.getJointState(arm, 0)[1], 0, abs_tol=5)
    page.page.mouse.up()


def test_what_cannot_be_turned_is_not(viewer: Viewer):
    wall = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 1]))
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    hands: Any = viewer._hands
    turning = hands._turning
    quarter = [0, 0, math.sqrt(0.5), math.sqrt(0.5)]
    for body, link in ((wall, -1), (99, -1), (ball, 7), (ball, -2)):
        turning.turn(1, {"body": body, "link": link, "orientation": quarter})
        turning.apply(1.0)
        assert not observers()
    turning.turn(1, {"body": ball, "link": -1, "orientation": [0, 0, 0, 0]})
    turning.turn(1, {"body": ball, "link": -1, "orientation": [0, 0, math.nan, 1]})
    turning.apply(1.0)
    assert not observers()
    turning.turn(1, {"body": ball, "link": -1, "orientation": quarter})
    turning.apply(1.0)
    assert observers() == 1
    p.removeBody(ball)
    p.stepSimulation()
    turning.release(1)
    turning.apply(1.0)
    assert not observers()


@pytest.mark.parametrize("angle", [-3.0, -1.0, 0.5, 3.0])
def test_the_rotation_vector_between_orientations_is_the_shorter_way_round(angle: float) -> None:
    start = (0.5, 0.5, 0.5, 0.5)
    turn = (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))
    end = multiplied(turn, start)
    for sign in (1.0, -1.0):
        x, y, z, w = (sign * it for it in end)
        np.testing.assert_allclose(turn_between(start, (x, y, z, w)), (0.0, 0.0, angle), atol=1e-12)
