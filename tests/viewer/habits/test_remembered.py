"""What a page shows at first, and what it remembers of the user when a script is run again."""

from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()
STATE = "app.camera.state()"


@pytest.fixture
def wide(viewer: Viewer, browser) -> Iterator[Page]:
    page = Page(browser, viewer.address, 1280, 800)
    page.until("window.app?.scene.layout.layout > 0")
    yield page
    page.page.close()
    assert page.complaints == []


def run_again(viewer: Viewer, page: Page) -> None:
    """Ends the run, and starts the next one at the same address."""
    port = urlsplit(viewer.address).port
    page.expect_the_end()
    p.disconnect()
    page.page.get_by_text("has ended").wait_for()
    p.connect(p.GUI, options=f"--port={port}")


def test_the_first_view_shows_where_a_body_in_the_air_will_land(wide: Page):
    p.loadURDF(f"{DATA}/plane.urdf")
    robot = p.loadURDF(f"{DATA}/r2d2.urdf", [0, 0, 2])
    wide.until("app.viewpoint.fitted === '[0,1]'")
    wait_for(lambda: p.getDebugVisualizerCamera()[10] < 6, wide)
    lower, upper = p.getAABB(robot)
    top = wide.page.evaluate("document.getElementById('timeline').getBoundingClientRect().top")
    left = wide.page.evaluate("document.getElementById('panel').getBoundingClientRect().left")
    for x in (lower[0], upper[0]):
        for y in (lower[1], upper[1]):
            for z in (0, upper[2]):
                at = wide.page.evaluate("point => app.camera.pixel(point)", [x, y, z])
                assert 0 < at[0] < left
                assert 0 < at[1] < top


def test_a_camera_that_the_user_has_moved_stays_when_the_script_is_run_again(viewer: Viewer, wide: Page):
    def script() -> None:
        p.resetDebugVisualizerCamera(3, 20, -30, [0, 0, 0.5])
        p.loadURDF(f"{DATA}/r2d2.urdf")

    script()
    wide.until("app.camera.distance === 3 && app.scene.bodies.size === 1")
    wide.page.locator("#view").hover(position={"x": 300, "y": 300})
    wide.page.mouse.wheel(0, 400)
    wide.until("app.camera.distance > 4")
    moved = wide.page.evaluate(STATE)
    wide.until_kept()
    run_again(viewer, wide)
    script()
    wide.page.reload()
    wide.until("window.app?.scene.bodies.size === 1")
    wide.page.wait_for_timeout(300)
    assert wide.page.evaluate(STATE) == moved
    wait_for(lambda: p.getDebugVisualizerCamera()[10] == pytest.approx(moved["distance"]), wide)
    # Another camera of the script is a new one.
    p.resetDebugVisualizerCamera(7, 20, -30, [0, 0, 0.5])
    wide.until("app.camera.distance === 7")


def test_switches_sections_and_plots_are_remembered(viewer: Viewer, wide: Page):
    def script() -> None:
        p.configureDebugVisualizer(p.COV_ENABLE_SHADOWS, 0)
        p.loadURDF(f"{DATA}/r2d2.urdf")

    script()
    wide.until("app.scene.bodies.size === 1 && !app.options.shadows")
    wide.page.locator("input[name=contacts]").check()
    wide.page.locator("input[name=shadows]").check()
    wide.page.locator("#camera summary").click()
    wide.page.locator("#joint").select_option(label="physics (body 0)")
    wide.until_kept()
    run_again(viewer, wide)
    script()
    wide.page.reload()
    wide.until("window.app?.scene.bodies.size === 1 && app.scriptOptions")
    wide.until("app.options.contacts && app.options.shadows && app.plots.plotted.size === 1")
    assert wide.page.locator("#camera").get_attribute("open") is not None
    assert wide.page.locator("input[name=contacts]").is_checked()
