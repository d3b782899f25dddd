"""Panels in a real browser: taken out, moved, put back and remembered; and the whole screen."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from tests.patience import until
from tests.viewer.browser import Page, needs_browser

from carom import World
from carom.viewer import Viewer

pytestmark = [needs_browser, pytest.mark.long]
MINE = "details[id='own-My gains']"


@pytest.fixture
def own(monkeypatch: pytest.MonkeyPatch) -> Iterator[Viewer]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(World(), port=0, title="floating")
    panel = viewer.add_panel("My gains")
    panel.add_slider("kp", 0, 10, 5)
    panel.add_text("goal", "home")
    panel.add_text("state", "idle", editable=False)
    panel.add_image("eye", [[0.0, 1.0], [1.0, 0.0]])
    yield viewer
    viewer.close()


@pytest.fixture
def page(own: Viewer, browser) -> Iterator[Page]:
    page = Page(browser, own.address, 1000, 700)
    page.until("window.app?.own?.parts.size === 3 && app.panel.controls.size === 1")
    yield page
    page.page.close()
    assert page.complaints == []


def box(page: Page, place: str) -> dict[str, float]:
    return page.page.locator(place).bounding_box()


def test_parts_of_a_panel_are_in_their_order_and_work(page: Page, own: Viewer):
    panel = page.page.locator(MINE)
    texts = panel.locator("> div > .slider").all_inner_texts()
    assert [text.split()[0] for text in texts] == ["kp", "goal", "state", "eye"]
    page.until(f'document.querySelector("{MINE} img").naturalWidth === 2')
    panel.locator("input[type=text]").fill("away")
    page.page.keyboard.press("Enter")
    goal = next(iter(own._parts._texts.values()))
    assert until(lambda: (page.page.wait_for_timeout(1), goal.value)[1] == "away")


def test_a_section_is_taken_out_moved_put_back_and_remembered(page: Page):
    for place in (MINE, "#camera"):
        page.page.locator(f"{place} .undock").click()
        assert page.page.locator(f"body > {place}").count() == 1
    before = box(page, MINE)
    title = box(page, f"{MINE} > summary")
    page.page.mouse.move(title["x"] + 60, title["y"] + 5)
    page.page.mouse.down()
    page.page.mouse.move(title["x"] + 160, title["y"] + 105, steps=4)
    page.page.mouse.up()
    after = box(page, MINE)
    assert (after["x"] - before["x"], after["y"] - before["y"]) == (100, 100)
    assert page.page.locator(MINE).get_attribute("open") is not None
    page.until_kept()
    page.page.reload()
    page.until("window.app?.own?.parts.size === 3 && app.panel.controls.size === 1")
    page.until(f'document.querySelector("body > {MINE}") !== null')
    again = box(page, MINE)
    assert (again["x"], again["y"]) == (after["x"], after["y"])
    assert page.page.locator("body > #camera").count() == 1
    page.page.locator("#camera .undock").click()
    assert page.page.locator("#rooms > #camera").count() == 1
    page.page.locator(f"{MINE} .undock").click()
    assert page.page.locator(f"#rooms > {MINE}").count() == 1


def test_the_page_fills_the_screen_and_leaves_it(page: Page):
    button = page.page.locator("#full")
    button.click()
    page.until("document.fullscreenElement !== null")
    page.until("document.getElementById('full').getAttribute('aria-pressed') === 'true'")
    button.click()
    page.until("document.fullscreenElement === null")
