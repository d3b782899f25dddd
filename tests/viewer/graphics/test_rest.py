"""A page at which nothing changes takes little processor time, and is there at once when something does."""

import time

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
# Counts pictures of the screen that the page asks for, and those that it draws, from now on.
COUNT = """() => {
  const { requestAnimationFrame: ask } = window, draw = app.drawScene;
  window.work = [0, 0];
  window.requestAnimationFrame = (call) => (window.work[0]++, ask.call(window, call));
  app.drawScene = () => (window.work[1]++, draw.call(app));
}"""


@pytest.fixture
def resting(page: Page, viewer: Viewer) -> Page:
    """A page that shows a ball at rest."""
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.2), basePosition=[0, 0, 1])
    p.setGravity(0, 0, -10)
    page.until("app.scene.groups.length > 0 && app.beat.resting")
    return page


def test_a_page_at_rest_asks_for_no_pictures(resting: Page):
    told = resting.page.locator("#fps").text_content()
    resting.page.evaluate(COUNT)
    resting.page.wait_for_timeout(700)
    assert resting.page.evaluate("window.work") == [0, 0]
    # The user is told of pictures that are drawn, not of looks at a page that rests.
    assert resting.page.locator("#fps").text_content() == told


def test_a_step_wakes_it(resting: Page):
    resting.page.evaluate(COUNT)
    p.stepSimulation()
    resting.until("app.history.frames.at(-1).header.time > 0 && window.work[0] > 2 && window.work[1] > 0")
    resting.until("app.beat.resting")


def test_playing_the_past_wakes_it(resting: Page):
    for _ in range(24):
        p.stepSimulation()
        time.sleep(0.02)
    resting.until("app.history.count > 3")
    resting.until("app.beat.resting")
    resting.page.evaluate("app.player.looping = true, app.player.play()")
    assert not resting.page.evaluate("app.beat.resting")
    resting.page.wait_for_timeout(2500)
    assert not resting.page.evaluate("app.beat.resting")
    resting.page.evaluate("app.player.goLive()")
    resting.until("app.beat.resting")


def test_a_window_of_another_size_is_noticed(resting: Page):
    resting.page.set_viewport_size({"width": 600, "height": 300})
    resting.until("app.camera.width === 600 && app.camera.height === 300")
    wait_for(lambda: resting.page.evaluate("app.canvas.width / app.canvas.clientWidth") >= 1, resting)
