"""Other ways of looking at a scene, in a real browser: names, colours by link, depth, cameras, trails."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.previews import pyramid
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()


@pytest.fixture
def arm(page: Page) -> int:
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    page.until("app.scene.bodies.size === 1 && app.scene.groups.length > 5")
    return arm


def until_lines(page: Page, count: int) -> None:
    """Waits until as many lines are drawn."""
    page.until(f"app.overlays.lines.count === {count}")


@pytest.mark.long
def test_a_body_is_hidden_and_shown(page: Page, arm: int):
    p.loadURDF(f"{DATA}/cube_small.urdf", [1, 0, 0.5])
    page.page.locator("#bodies summary").click()
    page.until("app.scene.groups.reduce((sum, group) => sum + group.instances, 0) > 11")
    eye = page.page.get_by_title(f"Show panda (body {arm})")
    eye.uncheck()
    page.until("app.scene.groups.reduce((sum, group) => sum + group.instances, 0) === 1")
    # What is hidden is not in the way of the mouse, and not what one wants to fit into the view.
    x, y, _ = page.page.evaluate("app.camera.pixel([0, 0, 0.1])")
    page.page.mouse.click(x, y)
    assert page.page.evaluate("app.bodies.selected") is None
    page.page.locator("#camera summary").click()
    page.page.get_by_role("button", name="Fit").click()
    page.until("app.camera.target[0] > 0.9")
    eye.check()
    page.until("app.scene.groups.reduce((sum, group) => sum + group.instances, 0) > 11")


@pytest.mark.long
def test_links_are_named(page: Page, arm: int):
    page.page.locator("input[name=linkNames]").check()
    for name in ("panda_link0", "panda_link4", "panda_hand"):
        page.page.locator("#labels").get_by_text(name, exact=True).wait_for()
    page.page.locator("input[name=linkNames]").uncheck()
    page.page.locator("#labels").get_by_text("panda_hand", exact=True).wait_for(state="hidden")


@pytest.mark.long
def test_links_have_colours_of_their_own(page: Page, arm: int):
    before = page.picture()
    page.page.locator("input[name=linkColours]").check()

    def of_few_strong_colours(picture: np.ndarray) -> bool:
        flat, counts = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
        strong = (np.ptp(flat, axis=1) > 100) & (counts > 30)
        return 5 <= strong.sum() <= 40 and (picture[5, 5] == 255).all()

    page.wait_for_picture(of_few_strong_colours)
    page.page.locator("input[name=linkColours]").uncheck()
    page.wait_for_picture(lambda picture: np.abs(picture - before).mean() < 5)


@pytest.mark.long
def test_depth_is_seen(page: Page, arm: int):
    p.loadURDF(f"{DATA}/plane.urdf")
    p.resetDebugVisualizerCamera(2, 0, -20, [0, 0, 0])
    page.until("app.scene.bodies.size === 2")
    page.page.locator("input[name=depth]").check()

    def grey_and_darker_near_by(picture: np.ndarray) -> bool:
        column = picture[320:, 30, 0]
        return bool(
            np.ptp(picture, axis=2).max() <= 2 and (np.diff(column) <= 1).all() and np.ptp(column) > 40
        )

    page.wait_for_picture(grey_and_darker_near_by)


@pytest.mark.long
def test_the_camera_of_a_script_is_drawn(page: Page, arm: int):
    page.page.locator("input[name=cameras]").check()
    until_lines(page, 0)
    view = p.computeViewMatrix([1, 0, 0.5], [0, 0, 0.5], [0, 0, 1])
    p.getCameraImage(64, 48, view, p.computeProjectionMatrixFOV(60, 4 / 3, 0.1, 10))
    page.until("app.overlays.pyramid.length === 8")
    # Four edges, two rectangles, and the mark above the image.
    until_lines(page, 4 + 8 + 2)
    middle = page.page.evaluate("app.overlays.pyramid")
    assert np.mean(middle[:4], axis=0) == pytest.approx([0.9, 0, 0.5], abs=1e-4)
    assert np.mean(middle[4:], axis=0) == pytest.approx([0.65, 0, 0.5], abs=1e-4)
    half = 0.35 * math.tan(math.radians(30))
    assert np.max(middle[4:], axis=0)[2] == pytest.approx(0.5 + half, abs=1e-4)


@pytest.mark.long
def test_a_camera_that_sees_nothing_is_not_drawn():
    assert pyramid(np.zeros((4, 4))) is None


@pytest.mark.long
def test_the_skeleton_joins_links(page: Page, arm: int):
    page.page.locator("input[name=skeleton]").check()
    until_lines(page, 3 * (1 + p.getNumJoints(arm)) + p.getNumJoints(arm))


@pytest.mark.long
def test_the_selected_link_leaves_a_trail(page: Page):
    ball = p.loadURDF(f"{DATA}/sphere_small.urdf", [0, 0, 1])
    page.until("app.scene.bodies.size === 1")
    page.page.locator("input[name=trail]").check()
    page.page.locator("#bodies summary").click()
    page.page.locator(f"#bodies-list button[data-body='{ball}']").click()
    p.resetBaseVelocity(ball, [1, 0, 0])
    for part in range(12):
        for _ in range(10):
            p.stepSimulation()
        page.until(f"app.overlays.trail().length > {part}")
    places = page.page.evaluate("app.overlays.trail()")
    assert all(before[0] <= after[0] for before, after in pairwise(places))
    assert places[-1][0] > places[0][0]
    # In the past the trail ends where the ball was.
    page.page.evaluate("app.player.seek((app.history.start + app.history.end) / 2)")
    earlier = page.page.evaluate("app.overlays.trail()")
    assert places[0][0] < earlier[-1][0] < places[-1][0]


@pytest.mark.long
def test_the_state_of_a_body_is_copied_as_code(page: Page, arm: int):
    page.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    p.resetJointState(arm, 3, -1.25)
    page.page.locator("#bodies summary").click()
    page.page.locator(f"#bodies-list button[data-body='{arm}']").click()
    page.until("Math.abs(app.readings.joints.get('0,3')?.position + 1.25) < 1e-6")
    page.page.get_by_role("button", name="Copy as Python").click()
    wait_for(lambda: "resetJointState" in page.page.evaluate("navigator.clipboard.readText()"), page)
    code = page.page.evaluate("navigator.clipboard.readText()")
    p.resetJointState(arm, 3, 0)
    p.resetBasePositionAndOrientation(arm, [1, 2, 3], [0, 0, 0, 1])
    exec(code, {"p": p})
    assert p.getJointState(arm, 3)[0] == -1.25
    assert p.getBasePositionAndOrientation(arm)[0] == pytest.approx((-0.041, 0, 0.05), abs=0.1)


@pytest.mark.long
def test_what_was_set_by_hand_is_copied_as_code(page: Page, arm: int, viewer: Viewer):
    page.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.page.locator("#bodies summary").click()
    page.page.locator(f"#bodies-list button[data-body='{arm}']").click()
    world = clients[0].world
    by_hand = (
        (1, "position", -0.5),
        (3, "velocity", 0.25),
        (5, "torque", -7.0),
        (6, "torque", 3.0),
    )
    for joint, mode, value in by_hand:
        name = f"panda_joint{joint + 1}"
        page.page.get_by_label(f"What the slider of {name} sets").select_option(mode)
        before = world.motor.copy()
        page.page.get_by_label(name, exact=True).fill(str(value))
        page.page.get_by_label(name, exact=True).press("Enter")
        wait_for(lambda before=before: (world.motor != before).any(), page)
    p.resetDebugVisualizerCamera(2.5, 30, -20, [0.1, 0.2, 0.3])
    page.until("app.camera.distance === 2.5")
    motors, drives = world.motor.copy(), world.pd.copy()
    page.page.get_by_role("button", name="Copy as Python").click()
    wait_for(lambda: "2.50, 30.0" in page.page.evaluate("navigator.clipboard.readText()"), page)
    code = page.page.evaluate("navigator.clipboard.readText()")
    assert code.count("setJointMotorControl2") == 4
    for joint, _, _ in by_hand:
        p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
    p.resetDebugVisualizerCamera(1, 0, 0, [0, 0, 0])
    exec(code, {"p": p})
    assert world.motor == pytest.approx(motors)
    assert world.pd == pytest.approx(drives)
    assert p.getDebugVisualizerCamera()[10] == 2.5


@pytest.mark.long
def test_keys_are_listed_over_the_view(page: Page):
    page.page.focus("#view")
    page.page.keyboard.press("?")
    page.page.get_by_text("contact points").wait_for()
    # Esc closes the list, and not the simulation.
    page.page.keyboard.press("Escape")
    page.page.locator("#help").wait_for(state="hidden")
    assert p.isConnected()
    assert 27 not in p.getKeyboardEvents()
    page.page.get_by_title("Keys and mouse").click()
    page.page.get_by_text("record a video").wait_for()
    page.page.locator("#help").click()
    page.page.locator("#help").wait_for(state="hidden")


@pytest.mark.long
def test_the_background_is_that_of_the_script(page: Page):
    p.configureDebugVisualizer(rgbBackground=[1, 0, 0])
    page.wait_for_picture(lambda picture: (picture[5, 5] == (255, 0, 0)).all())


@pytest.mark.long
def test_a_profile_is_recorded_while_its_key_is_held(
    page: Page, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    monkeypatch.setattr("pybullet._window.page_window.gettempdir", lambda: str(tmp_path))
    page.page.focus("#view")
    page.page.keyboard.down("p")
    wait_for(lambda: list(tmp_path.iterdir()), page)
    p.stepSimulation()
    page.page.keyboard.up("p")
    (file,) = tmp_path.iterdir()
    wait_for(lambda: "stepSimulation" in file.read_text(), page)


def drag(page: Page, start: list[float], end: list[float]) -> None:
    """Drags the mouse from one pixel to another."""
    page.page.mouse.move(*start[:2])
    page.page.mouse.down()
    for share in (0.3, 0.6, 1.0):
        page.page.mouse.move(*(a + share * (b - a) for a, b in zip(start[:2], end[:2], strict=True)))
    page.page.mouse.up()


@pytest.mark.long
def test_a_handle_is_shifted_carried_and_turned(page: Page, viewer: Viewer):
    handle = viewer.handle("goal", (0.2, 0.1, 0.3))
    page.page.locator("#labels").get_by_text("goal").wait_for()
    p.resetDebugVisualizerCamera(2, 30, -30, [0.2, 0.1, 0.3])
    page.until("app.camera.distance === 2 && app.viewpoint.undecided === false")
    yaw = page.page.evaluate("app.camera.yaw")
    pixel = "point => app.camera.pixel(point)"

    def knob(kind: str, axis: int | None) -> list[float]:
        found = "([kind, axis]) => app.handles.knobs(app.handles.items.get(0)).find("
        return page.page.evaluate(found + "(k) => k.kind === kind && k.axis === axis).point", [kind, axis])

    tip = knob("shift", 0)
    aim = [tip[0] + 0.25, tip[1], tip[2]]
    drag(page, page.page.evaluate(pixel, tip), page.page.evaluate(pixel, aim))
    wait_for(lambda: handle.position == pytest.approx((0.45, 0.1, 0.3), abs=0.01), page)
    assert handle.position[1:] == pytest.approx((0.1, 0.3), abs=1e-9)
    middle = page.page.evaluate(pixel, knob("carry", None))
    drag(page, middle, [middle[0], middle[1] - 60])
    wait_for(lambda: handle.position[2] > 0.35 and handle.position == tuple(knob("carry", None)), page)
    # A quarter of a turn about the upward axis.
    spoke = knob("turn", 2)
    arm = [spoke[0] - handle.position[0], spoke[1] - handle.position[1]]
    aim = [handle.position[0] - arm[1], handle.position[1] + arm[0], spoke[2]]
    drag(page, page.page.evaluate(pixel, spoke), page.page.evaluate(pixel, aim))
    half = math.sqrt(0.5)
    wait_for(lambda: handle.orientation == pytest.approx((0, 0, half, half), abs=0.03), page)
    assert page.page.evaluate("app.camera.yaw") == yaw


@pytest.mark.long
def test_handles_take_poses_only(viewer: Viewer):
    for position, orientation in (((0, 0, math.nan), (0, 0, 0, 1)), ((0, 0, 0), (0, 0, 0, 0))):
        with pytest.raises(ValueError, match="goal"):
            viewer.handle("goal", position, orientation)
    handle = viewer.handle("goal", (1, 2, 3), (0, 0, 0, 2))
    assert handle.orientation == (0, 0, 0, 1)
    viewer._hands.handles.move(0, (0, 0, math.inf), (0, 0, 0, 1))
    viewer._hands.handles.move(0, (0, 0, 0), (0, 0, 0, 0))
    viewer._hands.handles.move(7, (0, 0, 0), (0, 0, 0, 1))
    assert handle.position == (1, 2, 3)


@pytest.mark.long
def test_a_button_of_the_modern_api_counts(page: Page, viewer: Viewer):
    button = viewer.button("again")
    page.page.get_by_role("button", name="again").click()
    wait_for(lambda: button.value == 1, page)


@pytest.mark.long
def test_a_script_has_lists_and_boxes(page: Page, viewer: Viewer):
    gait, slow = viewer.choice("gait", ["walk", "trot", "pace"], 1), viewer.checkbox("slow")
    assert (gait.chosen, slow.checked) == ("trot", False)
    select = page.page.get_by_label("gait")
    page.until("document.querySelector('#sliders select')?.value === '1'")
    select.select_option("pace")
    wait_for(lambda: gait.chosen == "pace", page)
    page.page.get_by_label("slow").check()
    wait_for(lambda: slow.checked, page)
    for value in (0.4, 99, math.nan):
        viewer.controls.move(0, value)
    assert gait.chosen == "pace"
    page.until("document.querySelector('#sliders select')?.value === '2'")
    with pytest.raises(ValueError, match="gait"):
        viewer.choice("gait", [])
