"""The page in a real browser: what it shows, and what users do with it."""

import re
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from tests.patience import PATIENCE
from tests.rings import few
from tests.viewer.browser import HEIGHT, WIDTH, Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

pytestmark = needs_browser


@pytest.fixture
def page(viewer: Viewer, browser) -> Iterator[Page]:
    page = Page(browser, viewer.address)
    page.page.wait_for_selector("#panel")
    # Until the page has told its size, the camera is that of a larger one.
    wait_for(lambda: p.getDebugVisualizerCamera()[:2] == (WIDTH, HEIGHT), page)
    yield page
    page.page.close()
    assert page.complaints == []


def pixel_of(point: tuple[float, float, float]) -> tuple[int, int]:
    """Column and row of a point, by what `getDebugVisualizerCamera` says of the camera."""
    info = p.getDebugVisualizerCamera()
    view, projection = (np.array(matrix).reshape(4, 4).T for matrix in info[2:4])
    x, y, _, w = projection @ view @ (*point, 1)
    return int((x / w + 1) / 2 * info[0]), int((1 - y / w) / 2 * info[1])


def is_red(colour: np.ndarray) -> bool:
    return bool(colour[0] > 90 and colour[0] > 2 * max(colour[1], colour[2]))


def red_ball(position: tuple[float, float, float], radius: float = 0.1) -> int:
    shape = p.createVisualShape(p.GEOM_SPHERE, radius=radius, rgbaColor=[1, 0, 0, 1], specularColor=[0, 0, 0])
    return p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=radius), shape, position)


def red_at(point: tuple[float, float, float]) -> Callable[[np.ndarray], bool]:
    column, row = pixel_of(point)
    return lambda picture: is_red(picture[row, column])


def test_things_are_seen_where_the_simulation_has_them(page: Page):
    p.resetDebugVisualizerCamera(2, 40, -30, [0, 0, 0.3])
    places = [(0.4, 0.3, 0.2), (-0.5, 0.2, 0.9), (0.1, -0.6, 0.5)]
    balls = [red_ball(place) for place in places]
    picture = page.wait_for_picture(lambda picture: all(red_at(place)(picture) for place in places))
    assert not is_red(picture[5, 5])
    for place in places:
        column, row = pixel_of(place)
        # The middle of what is red near by is the middle of the ball.
        near = picture[row - 18 : row + 18, column - 18 : column + 18]
        rows, columns = np.nonzero((near[..., 0] > 90) & (near[..., 0] > 2 * near[..., 1]))
        assert rows.mean() == pytest.approx(18, abs=3)
        assert columns.mean() == pytest.approx(18, abs=3)
    p.resetBasePositionAndOrientation(balls[0], [0.8, 0.6, 0.2], [0, 0, 0, 1])
    page.wait_for_picture(red_at((0.8, 0.6, 0.2)))
    p.removeBody(balls[0])
    page.wait_for_picture(lambda picture: not red_at((0.8, 0.6, 0.2))(picture))


def test_a_robot_on_a_floor_shows_and_the_camera_of_the_user_counts(page: Page):
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    p.resetDebugVisualizerCamera(1.5, 30, -20, [0, 0, 0.5])
    page.wait_for_picture(lambda picture: len(np.unique(picture.reshape(-1, 3), axis=0)) > 500)
    page.page.mouse.move(60, 300)
    page.page.mouse.wheel(0, 400)
    wait_for(lambda: p.getDebugVisualizerCamera()[10] > 1.6, page)
    page.page.keyboard.down("Control")
    page.page.mouse.down()
    page.page.mouse.move(90, 300)
    page.page.mouse.up()
    page.page.keyboard.up("Control")
    wait_for(lambda: p.getDebugVisualizerCamera()[8] == pytest.approx(21), page)
    assert p.getDebugVisualizerCamera()[9] == pytest.approx(-20)


def test_a_slider_moves_what_the_script_reads(page: Page):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    slider = page.page.get_by_label(re.compile("^gain"))
    slider.wait_for()
    assert float(slider.input_value()) == 2
    slider.fill("7.5")
    wait_for(lambda: p.readUserDebugParameter(gain) == 7.5, page)
    again = p.addUserDebugParameter("again", 1, 0, 3)
    page.page.get_by_role("button", name="again").click(click_count=2)
    wait_for(lambda: p.readUserDebugParameter(again) == 5, page)
    p.removeAllUserParameters()
    slider.wait_for(state="detached")


def key_events(page: Page) -> dict[int, int]:
    """The next events there are."""
    events: dict[int, int] = {}
    wait_for(lambda: events or events.update(p.getKeyboardEvents()), page)
    return events


@pytest.mark.parametrize(
    ("key", "code"),
    few([("Tab", 9), ("q", ord("q")), ("ArrowUp", p.B3G_UP_ARROW), ("Shift", p.B3G_SHIFT)], 2),
)
def test_keys_are_down_triggered_and_released(page: Page, key: str, code: int):
    page.page.focus("#view")
    page.page.keyboard.down(key)
    assert key_events(page) == {code: p.KEY_IS_DOWN | p.KEY_WAS_TRIGGERED}
    page.page.keyboard.down(key)
    page.page.wait_for_timeout(50)
    assert p.getKeyboardEvents() == {code: p.KEY_IS_DOWN}
    page.page.keyboard.up(key)
    wait_for(lambda: p.getKeyboardEvents() == {code: p.KEY_WAS_RELEASED}, page)
    assert p.getKeyboardEvents() == {}


@pytest.mark.long
def test_a_clicked_slider_does_not_keep_the_keyboard(page: Page):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    button = p.addUserDebugParameter("press", 1, 0, 0)
    slider = page.page.get_by_label("gain", exact=True)
    slider.click()
    wait_for(lambda: p.readUserDebugParameter(gain) == pytest.approx(5, abs=0.5), page)
    value = p.readUserDebugParameter(gain)
    page.page.keyboard.press("ArrowRight")
    assert p.B3G_RIGHT_ARROW in key_events(page)
    page.page.get_by_role("button", name="press").click()
    wait_for(lambda: p.readUserDebugParameter(button) == 1, page)
    p.getKeyboardEvents()
    page.page.keyboard.press(" ")
    assert ord(" ") in key_events(page)
    page.page.wait_for_timeout(100)
    assert (p.readUserDebugParameter(gain), p.readUserDebugParameter(button)) == (value, 1)


def test_the_mouse_is_told_to_the_script(page: Page):
    seen: list[tuple] = []
    page.page.mouse.move(100, 150)
    page.page.mouse.down()
    page.page.mouse.up()
    wait_for(lambda: seen.extend(p.getMouseEvents()) or sum(event[0] == 2 for event in seen) == 2, page)
    pressed, released = (event for event in seen if event[0] == 2)
    assert pressed == (2, 100, 150, 0, p.KEY_IS_DOWN | p.KEY_WAS_TRIGGERED)
    assert released == (2, 100, 150, 0, p.KEY_WAS_RELEASED)
    assert any(event[:3] == (1, 100, 150) for event in seen)


@pytest.mark.long
def test_shortcuts_change_the_view_unless_switched_off(page: Page):
    page.page.focus("#view")
    box = page.page.locator("input[name=wireframe]")
    page.page.keyboard.press("w")
    assert box.is_checked()
    page.page.keyboard.press("g")
    assert not page.page.locator("#panel").is_visible()
    page.page.keyboard.press("g")
    p.configureDebugVisualizer(p.COV_ENABLE_KEYBOARD_SHORTCUTS, 0)
    p.configureDebugVisualizer(p.COV_ENABLE_WIREFRAME, 0)
    wait_for(lambda: not box.is_checked(), page)
    page.page.keyboard.press("w")
    assert not box.is_checked()


def test_lines_points_and_texts_come_and_go(page: Page):
    p.resetDebugVisualizerCamera(2, 0, -20, [0, 0, 0])
    column, row = pixel_of((0.5, 0, 0.5))
    line = p.addUserDebugLine([-1, 0, 0.5], [1, 0, 0.5], [1, 0, 0], 6)
    page.wait_for_picture(lambda picture: is_red(picture[row, column]))
    p.removeUserDebugItem(line)
    page.wait_for_picture(lambda picture: not is_red(picture[row, column]))
    p.addUserDebugPoints([[0.5, 0, 0.5]], [[1, 0, 0]], 12)
    page.wait_for_picture(lambda picture: is_red(picture[row, column]))
    ball = red_ball((-0.5, 0, 0.3))
    text = p.addUserDebugText("the ball", [0, 0, 0.2], [0, 0, 1], 1.5, parentObjectUniqueId=ball)
    # Texts keep clear of the panel, which covers half of so small a page.
    page.page.get_by_title("Collapse the panel").click()
    label = page.page.get_by_text("the ball")
    label.wait_for()
    box = label.bounding_box()
    column, row = pixel_of((-0.5, 0, 0.5))
    wait_for(lambda: abs(label.bounding_box()["x"] - column) < 3, page)
    box = label.bounding_box()
    assert box["y"] + box["height"] == pytest.approx(row, abs=3)
    p.addUserDebugText("gone soon", [0, 0, 0], lifeTime=0.1, replaceItemUniqueId=text)
    label.wait_for(state="detached")
    page.page.get_by_text("gone soon").wait_for(state="detached")


@pytest.mark.long
def test_the_ground_mirrors_what_is_above_it(page: Page):
    p.resetDebugVisualizerCamera(2, 0, -20, [0.3, 0, 0])
    floor = p.createVisualShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5], rgbaColor=[0.6, 0.6, 0.6, 0.5])
    p.createMultiBody(0, -1, floor, [0, 0, -0.5])
    red_ball((0, 0, 0.4))
    column, row = pixel_of((0, 0, -0.4))

    def mirrored(picture: np.ndarray) -> bool:
        red, green, blue = picture[row, column]
        return red > 1.3 * max(green, blue)

    page.wait_for_picture(red_at((0, 0, 0.4)))
    page.wait_for_picture(lambda picture: not mirrored(picture))
    p.configureDebugVisualizer(p.COV_ENABLE_PLANAR_REFLECTION, 1)
    page.wait_for_picture(mirrored)
    p.configureDebugVisualizer(p.COV_ENABLE_PLANAR_REFLECTION, 0)
    page.wait_for_picture(lambda picture: not mirrored(picture))


@pytest.mark.long
def test_each_step_can_be_seen(page: Page, viewer: Viewer):
    page.page.wait_for_timeout(200)
    numbers = []
    for _ in range(3):
        p.stepSimulation()
        p.configureDebugVisualizer(p.COV_ENABLE_SINGLE_STEP_RENDERING, 1)
        numbers.append(viewer._pictures.asked)
    assert numbers == [1, 2, 3]
    wait_for(lambda: 3 in viewer._pictures._drawn.values(), page)


@pytest.mark.long
def test_texts_with_an_orientation_stand_in_the_world(page: Page):
    # The panel covers the right half of so small a page.
    p.resetDebugVisualizerCamera(2, 0, 0, [0.6, 0, 0])
    upright = p.getQuaternionFromEuler([np.pi / 2, 0, 0])
    text = p.addUserDebugText("████", [-0.8, 0, 0], [1, 0, 0], 4, textOrientation=upright)
    page.wait_for_picture(red_at((-0.7, 0, 0.15)))
    ball = red_ball((0, 0, 0))
    p.addUserDebugText("████", [0, 0, 0.2], [1, 0, 0], 4, 0, upright, ball, -1, text)
    picture = page.wait_for_picture(red_at((0.1, 0, 0.35)))
    assert not red_at((-0.7, 0, 0.15))(picture)
    assert not red_at((0.1, 0, 0.9))(picture)


@pytest.mark.long
def test_a_page_loaded_again_shows_it_all_again(page: Page):
    p.resetDebugVisualizerCamera(2, 0, -20, [0, 0, 0])
    red_ball((0.3, 0, 0.4))
    p.addUserDebugParameter("gain")
    page.wait_for_picture(red_at((0.3, 0, 0.4)))
    page.page.reload()
    page.wait_for_picture(red_at((0.3, 0, 0.4)))
    page.page.get_by_label("gain", exact=True).wait_for()


@pytest.mark.long
def test_a_page_whose_graphics_were_taken_away_shows_it_all_again(page: Page):
    red_ball((0, 0, 0.5))
    p.resetDebugVisualizerCamera(2, 40, -30, [0, 0, 0.5])
    page.wait_for_picture(red_at((0, 0, 0.5)))
    page.page.evaluate("window.graphics = app.renderer.gl.getExtension('WEBGL_lose_context')")
    page.page.evaluate("graphics.loseContext()")
    page.page.wait_for_selector("#notice:not([hidden])")
    assert "graphics" in page.page.inner_text("#notice")
    page.page.evaluate("window.before = app.history.frames[0]")
    page.page.evaluate("void setTimeout(() => graphics.restoreContext(), 100)")
    page.page.wait_for_selector("#notice", state="hidden")
    page.wait_for_picture(red_at((0, 0, 0.5)))
    # The page has not been loaded again: a run that has ended could not be.
    assert page.page.evaluate("app.history.frames[0] === window.before")
    # The browser may say that it has done so.
    page.expect("CONTEXT_LOST_WEBGL")


@pytest.mark.long
def test_the_loop_of_a_script_ends_by_the_close_button(page: Page):
    ended = threading.Event()

    def script() -> None:
        while p.isConnected():
            try:
                p.stepSimulation()
            except p.error:
                break
            time.sleep(0.001)
        ended.set()

    thread = threading.Thread(target=script)
    thread.start()
    page.page.get_by_title("End the simulation").click()
    page.page.get_by_role("button", name="End it").click()
    assert ended.wait(PATIENCE)
    thread.join()
    page.page.get_by_text("has ended").wait_for()
    page.expect_the_end()


def test_a_body_is_dragged_with_the_mouse(page: Page):
    # The panel covers the right half of so small a page.
    p.resetDebugVisualizerCamera(2, 0, -20, [0.6, 0, 0.5])
    ball = red_ball((-0.4, 0, 0.5), radius=0.15)
    page.wait_for_picture(red_at((-0.4, 0, 0.5)))
    yaw = p.getDebugVisualizerCamera()[8]
    page.page.mouse.move(*pixel_of((-0.4, 0, 0.5)))
    page.page.mouse.down()
    page.page.mouse.move(*pixel_of((0.4, 0, 0.5)), steps=4)

    def position() -> tuple[float, float, float]:
        return p.getBasePositionAndOrientation(ball)[0]

    def pulled() -> bool:
        for _ in range(4):
            p.stepSimulation()
        return position()[0] > 0.2

    wait_for(pulled, page)
    assert position()[2] == pytest.approx(0.5, abs=0.2)
    page.page.mouse.up()
    assert p.getDebugVisualizerCamera()[8] == yaw
    # Where there is nothing to hold, the same turns the camera.
    page.page.mouse.move(20, 20)
    page.page.mouse.down()
    page.page.mouse.move(60, 20)
    page.page.mouse.up()
    wait_for(lambda: p.getDebugVisualizerCamera()[8] != yaw, page)


def test_plots_names_and_previews(page: Page):
    arm = p.loadURDF(pybullet_data.getDataPath() + "/franka_panda/panda.urdf", useFixedBase=True)
    p.resetDebugVisualizerCamera(1, 90, 0, [0, 0.6, 0.15])
    plots = page.page.locator("#joint")
    wait_for(lambda: plots.locator("option").count() > 7, page)
    plots.select_option(label="panda · panda_joint2")
    assert page.page.locator(".chart canvas").count() == 3
    page.page.get_by_title("Remove").click()
    assert page.page.locator(".chart").count() == 0
    page.page.locator("input[name=names]").check()
    page.page.mouse.move(*pixel_of((0, 0, 0.1)))
    page.page.get_by_text(re.compile("panda · panda_link0")).wait_for()
    assert not page.page.locator("#previews").is_visible()
    p.getCameraImage(64, 48, *p.getDebugVisualizerCamera()[2:4])
    page.page.get_by_text("segmentation").wait_for()
    p.configureDebugVisualizer(p.COV_ENABLE_SEGMENTATION_MARK_PREVIEW, 0)
    page.page.get_by_text("segmentation").wait_for(state="hidden")
    assert p.getNumJoints(arm) > 0


def test_a_paused_simulation_goes_step_by_step(page: Page):
    page.page.get_by_role("button", name="Pause").click()
    page.page.get_by_role("button", name="Continue").wait_for()
    # The page shows at once what it has asked for.
    window = clients[0].window
    assert isinstance(window, PageWindow)
    wait_for(lambda: window.viewer.pause_control.closed, page)
    steps = []

    def script() -> None:
        for _ in range(3):
            p.stepSimulation()
            steps.append(1)

    thread = threading.Thread(target=script)
    thread.start()
    page.page.get_by_role("button", name="Step").click()
    wait_for(lambda: len(steps) == 1, page)
    page.page.wait_for_timeout(50)
    assert len(steps) == 1
    page.page.get_by_role("button", name="Continue").click()
    thread.join(PATIENCE)
    assert len(steps) == 3
