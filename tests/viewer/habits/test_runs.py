"""What is left of a run that has ended, and how the next one takes its place."""

from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from tests.viewer.browser import Page, needs_browser

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
SHOWN = "[...document.querySelectorAll('#sliders .slider')].map(each => each.textContent.replace('↺', ''))"


@pytest.fixture
def run(page: Page) -> Page:
    """A page that has seen a ball fall for a quarter of a second."""
    p.setGravity(0, 0, -9.8)
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 2])
    page.until("app.scene.bodies.size === 1")
    for _ in range(60):
        p.stepSimulation()
        page.page.wait_for_timeout(1)
    page.until("app.history.frames.at(-1)?.header.time > 0.24 && app.saving.player !== null")
    page.expect_the_end()
    return page


@pytest.fixture
def again(viewer: Viewer) -> Callable[[], None]:
    """Starts the next run, at the same address."""
    port = urlsplit(viewer.address).port

    def start() -> None:
        p.connect(p.GUI, options=f"--port={port}")
        p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3))
        p.createMultiBody(
            1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3), basePosition=[1, 0, 0]
        )

    return start


def test_sliders_keep_their_order_on_a_page_that_comes_late(page: Page):
    numbers = [p.addUserDebugParameter(name, 0, 1, 0) for name in "ABC"]
    p.addUserDebugParameter("D", 1, 0, 0)
    page.page.get_by_label("A", exact=True).fill("0.5")
    page.until("app.panel.controls.size === 4")
    p.stepSimulation()
    while p.readUserDebugParameter(numbers[0]) != 0.5:
        page.page.wait_for_timeout(10)
    page.page.reload()
    page.until("window.app?.panel.controls.size === 4")
    assert page.page.evaluate(SHOWN) == ["A", "B", "C", "D"]


def test_a_run_that_has_ended_is_saved_and_scrubbed(run: Page, browser, tmp_path: Path):
    p.disconnect()
    run.page.get_by_text("has ended").wait_for()
    run.page.get_by_title("More controls").click()
    with run.page.expect_download() as download:
        run.page.get_by_role("button", name="Save", exact=True).click()
    download.value.save_as(tmp_path / "run.html")
    replay = Page(browser, (tmp_path / "run.html").as_uri())
    replay.until("window.app?.history.end > 0.2")
    run.page.locator("#scrub").fill("0.1")
    run.until("!app.player.live")
    assert replay.complaints == []


def test_what_cannot_be_saved_is_said_beside_the_end_of_the_run(run: Page):
    run.page.evaluate("app.saving.player = null")
    p.disconnect()
    run.page.get_by_text("has ended").wait_for()
    run.page.get_by_title("More controls").click()
    run.page.get_by_role("button", name="Save", exact=True).click()
    run.page.get_by_text("could not be saved").wait_for()
    # The page goes on looking for the next run, which it says again and again.
    run.page.wait_for_timeout(1500)
    assert run.page.get_by_text("could not be saved").is_visible()
    assert run.page.get_by_text("has ended").is_visible()


def test_a_run_stays_until_the_user_lets_the_next_one_in(run: Page, again: Callable[[], None]):
    p.disconnect()
    run.page.get_by_text("has ended").wait_for()
    count = run.page.evaluate("app.history.count")
    again()
    run.page.get_by_text("The next run is there").wait_for()
    run.page.wait_for_timeout(300)
    assert run.page.evaluate("[app.history.count, app.scene.bodies.size]") == [count, 1]
    run.page.get_by_role("button", name="Show it").click()
    run.until("app.scene.bodies.size === 2")
    assert not run.page.get_by_text("The next run is there").is_visible()


def test_the_next_run_is_shown_at_once_to_who_wants_that(run: Page, again: Callable[[], None]):
    run.page.evaluate("localStorage.setItem('carom.nextRunAtOnce', 'yes')")
    p.disconnect()
    run.page.get_by_text("has ended").wait_for()
    again()
    run.until("app.scene.bodies.size === 2")
