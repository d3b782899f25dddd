"""The example that teleoperates the Panda, by the mouse and by a gamepad in the page."""

import sys
import threading
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser, wait_for
from tests.viewer.hands.test_gamepads import PLUG

from carom.viewer import Viewer

pytestmark = needs_browser
EXAMPLES = Path(__file__).parents[3] / "examples"
# Ends the example should a test leave it running [s of simulated time].
LONGEST = 120


@pytest.fixture
def teleoperated(monkeypatch: pytest.MonkeyPatch, browser: Any) -> Iterator[tuple[Page, Any, Viewer]]:
    """The page, the arm and the viewer, with the example running beside."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    monkeypatch.delitem(sys.modules, "teleoperate_panda", raising=False)
    example = import_module("teleoperate_panda")
    world, arm = example.load()
    viewer = Viewer(world, port=0)
    viewer.set_speed(1.0)
    thread = threading.Thread(target=example.teleoperate, args=(world, arm, viewer, LONGEST))
    thread.start()
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.scene.bodies.size === 1 && app.handles.items.size === 1")
    page.until("!app.viewpoint.undecided || app.camera.distance < 5")
    yield page, arm, viewer
    viewer.is_open = False
    thread.join()
    viewer.close()
    page.page.close()
    assert page.complaints == []


def knob(page: Page, kind: str, axis: int | None) -> list[float]:
    found = "([kind, axis]) => app.handles.knobs(app.handles.items.get(0)).find("
    return page.page.evaluate(found + "(k) => k.kind === kind && k.axis === axis).point", [kind, axis])


def pose_of(page: Page) -> tuple[list[float], list[float]]:
    item = page.page.evaluate("app.handles.items.get(0)")
    return item["position"], item["orientation"]


def drag(page: Page, start: list[float], end: list[float]) -> None:
    start, end = (page.page.evaluate("point => app.camera.pixel(point)", point)[:2] for point in (start, end))
    page.page.mouse.move(*start)
    page.page.mouse.down()
    page.page.mouse.move(*end, steps=5)
    page.page.mouse.up()


def test_the_hand_arrives_where_the_mouse_has_moved_and_turned_the_handle(teleoperated):
    page, arm, _ = teleoperated
    hand = arm.links["panda_grasptarget"]
    before = np.array(hand.pose.position)
    tip = knob(page, "shift", 2)
    first = pose_of(page)[0]
    outwards = (np.array(tip) - first) / np.linalg.norm(np.array(tip) - first)
    drag(page, tip, (np.array(tip) - 0.12 * outwards).tolist())
    # The page is told again where its handle is, which may be on the way still.
    wait_for(lambda: np.linalg.norm(np.array(pose_of(page)[0]) - first) > 0.11, page)
    goal = np.array(pose_of(page)[0])
    wait_for(lambda: np.linalg.norm(hand.pose.position - goal) < 0.01, page)
    assert np.linalg.norm(hand.pose.position - before) > 0.08
    turned = np.array(hand.pose.orientation)
    spoke = np.array(knob(page, "turn", 2))
    arm_of_spoke = spoke - goal
    quarter = np.cross(outwards, arm_of_spoke)
    drag(page, spoke.tolist(), (goal + 0.8 * arm_of_spoke + 0.6 * quarter).tolist())
    wait_for(lambda: abs(np.dot(pose_of(page)[1], turned)) < 0.955, page)
    wanted = np.array(pose_of(page)[1])

    def arrived() -> bool:
        pose = hand.pose
        near = np.linalg.norm(pose.position - goal) < 0.01
        return bool(near and abs(np.dot(pose.orientation, wanted)) > 0.9999)

    wait_for(arrived, page)


def test_a_gamepad_moves_the_handle_and_closes_the_fingers(teleoperated):
    page, arm, _ = teleoperated
    hand, finger = arm.links["panda_grasptarget"], arm.joints["panda_finger_joint1"]
    before = np.array(hand.pose.position)
    page.page.evaluate(PLUG)
    page.page.evaluate("() => { pad.axes[0] = 1; }")
    wait_for(lambda: pose_of(page)[0][1] < before[1] - 0.1, page)
    page.page.evaluate("() => { pad.axes[0] = 0; pad.buttons[0].value = 1; }")
    wait_for(lambda: finger.position < 0.002, page)
    wait_for(lambda: np.linalg.norm(hand.pose.position - pose_of(page)[0]) < 0.01, page)
    assert hand.pose.position[1] < before[1] - 0.08
    page.page.evaluate("() => { pad.buttons[0].value = 0; }")
    wait_for(lambda: finger.position > 0.038, page)


def test_a_script_moves_its_handle_on_all_pages(teleoperated):
    page, _, viewer = teleoperated
    handle = viewer.handle("second", (0, 0, 1))
    page.until("app.handles.items.size === 2")
    handle.move_to((0.3, 0.2, 0.7), (0, 0, 2, 0))
    page.until("app.handles.items.get(1).position[0] === 0.3")
    assert page.page.evaluate("app.handles.items.get(1).orientation") == [0, 0, 1, 0]
    handle.move_to((0.1, 0.2, 0.7))
    assert handle.pose == ((0.1, 0.2, 0.7), (0, 0, 1, 0))
    with pytest.raises(ValueError, match="second"):
        handle.move_to((0, 0, float("nan")))
    assert handle.position == (0.1, 0.2, 0.7)
