"""Two fingers on a touch screen."""

from collections.abc import Iterator

import pytest
from tests.viewer.browser import Page as ViewerPage
from tests.viewer.browser import needs_browser, wait_for

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser


@pytest.fixture
def fingers(page: ViewerPage) -> Iterator:
    """Sends touches: a kind of event, and the pixels of the fingers that are down from then on."""
    session = page.page.context.new_cdp_session(page.page)

    def touch(kind: str, *pixels: tuple[float, float]) -> None:
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(pixels)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    yield touch
    session.detach()


def camera(page: ViewerPage) -> dict:
    return page.page.evaluate("app.camera.state()")


def test_two_fingers_zoom_and_what_is_between_them_stays_there(page: ViewerPage, fingers):
    p.resetDebugVisualizerCamera(2, 30, -30, [0, 0, 0.3])
    page.until("app.camera.distance === 2")
    # A point at the target's depth, not in the middle of the view.
    point = page.page.evaluate(
        "app.camera.target.map((x, i) => x - 0.4 * app.camera.right[i] + 0.2 * app.camera.up[i])"
    )
    x, y, _ = page.page.evaluate("point => app.camera.pixel(point)", point)
    fingers("touchStart", (x - 40, y))
    fingers("touchStart", (x - 40, y), (x + 40, y))
    for reach in (50, 60, 70, 80):
        fingers("touchMove", (x - reach, y), (x + reach, y))
    wait_for(lambda: camera(page)["distance"] == pytest.approx(1, rel=1e-6), page)
    assert page.page.evaluate("point => app.camera.pixel(point)", point)[:2] == pytest.approx([x, y], abs=0.5)
    now = camera(page)
    assert (now["yaw"], now["pitch"]) == (30, -30)
    fingers("touchEnd")


def test_two_fingers_move_the_view_and_one_that_stays_does_nothing(page: ViewerPage, fingers):
    p.resetDebugVisualizerCamera(2, 0, 0, [0, 0, 0.3])
    page.until("app.camera.distance === 2")
    height = page.page.evaluate("app.camera.height")
    fingers("touchStart", (200, 300))
    fingers("touchStart", (200, 300), (280, 300))
    for step in (10, 20, 30, 40):
        fingers("touchMove", (200 + step, 300), (280 + step, 300))
    # Four metres are as high as the view, whose field of view is 90 degrees.
    wait_for(lambda: camera(page)["target"][0] == pytest.approx(-40 * 4 / height, abs=1e-6), page)
    assert camera(page)["distance"] == pytest.approx(2)
    # The driver cannot lift one finger of two.
    page.page.evaluate(
        "() => { const pointerId = [...app.pointer.pinch.fingers.keys()][1];"
        " app.canvas.dispatchEvent(new PointerEvent('pointerup', { pointerId, pointerType: 'touch' })); }"
    )
    before = camera(page)
    for step in (10, 20, 30):
        fingers("touchMove", (240 + step, 300), (320, 300))
    page.page.wait_for_timeout(100)
    assert camera(page) == before
    fingers("touchEnd")


def test_a_second_finger_lets_go_of_what_the_first_one_pulls(page: ViewerPage, viewer: Viewer, fingers):
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.2)
    p.createMultiBody(1, shape, basePosition=[0, 0, 0.3])
    p.resetDebugVisualizerCamera(2, 0, 0, [0.3, 0, 0.3])
    page.until("app.camera.distance === 2 && app.scene.groups.length > 0")
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0.3])")
    fingers("touchStart", (x, y))
    for step in (5, 10, 15):
        fingers("touchMove", (x + step, y))
    page.until("app.grasp.busy")
    fingers("touchStart", (x + 15, y), (x + 15, y + 80))
    page.until("!app.grasp.busy")
    fingers("touchEnd")
