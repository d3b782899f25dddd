"""The page in a browser without WebGL: everything but the picture."""

import re
from typing import Any

from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = needs_browser

NO_WEBGL = """
const real = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind.startsWith("webgl") ? null : real.call(this, kind, ...more);
};
"""


class WithoutGraphics:
    """A browser whose pages have no WebGL."""

    def __init__(self, browser: Any) -> None:
        self._browser = browser

    def new_page(self, **options: Any) -> Any:
        page = self._browser.new_page(**options)
        page.add_init_script(NO_WEBGL)
        return page


def test_panel_sliders_and_plots_work_without_webgl(viewer: Viewer, browser):
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    p.setGravity(0, 0, -9.81)
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    p.addUserDebugText("here", [0, 0, 1], textOrientation=[0, 0, 0, 1])
    p.addUserDebugPoints([[0, 0, 1]], [[1, 0, 0]], 3)
    page = Page(WithoutGraphics(browser), viewer.address, 900, 640)
    page.page.get_by_text("This browser has no WebGL 2").wait_for()
    page.page.get_by_label(re.compile("^gain")).fill("7.5")
    wait_for(lambda: p.readUserDebugParameter(gain) == 7.5, page)
    page.until("app.scene.bodies.size === 2")
    page.page.locator("#joint").select_option(index=1)
    for _ in range(50):
        p.stepSimulation()
        page.page.wait_for_timeout(5)
    page.until("document.querySelectorAll('#charts canvas, #charts svg').length > 0")
    page.page.locator("#bodies summary").click()
    page.page.locator(f"#bodies-list button[data-body='{arm}']").click()
    page.page.get_by_text("kg").first.wait_for()
    assert page.page.locator("#clock").inner_text() != "0.000"
    page.page.locator("#view").click(position={"x": 100, "y": 500})
    page.page.get_by_role("button", name="Pause").click()
    wait_for(lambda: viewer.pause_control.closed, page)
    page.page.get_by_role("button", name="Continue").click()
    assert page.page.locator("#picture").is_disabled()
    assert page.complaints == []


def test_the_word_is_not_there_with_webgl(viewer: Viewer, browser):
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.scene.layout.layout >= 0")
    assert not page.page.locator("#no-picture").is_visible()
    assert page.complaints == []
