"""The page by the keyboard alone, and as a screen reader has it."""

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
FOCUSED = "document.activeElement.id"


def test_tab_leads_to_the_panel_and_escape_back_without_ending_the_script(page: Page, viewer: Viewer):
    slider = p.addUserDebugParameter("speed", 0, 1, 0.5)
    page.until("app.panel.controls.size === 1")
    page.page.focus("#view")
    p.getKeyboardEvents()
    for _ in range(20):
        page.page.keyboard.press("Tab")
        if page.page.evaluate(FOCUSED) == f"slider-{slider}":
            break
    else:
        raise AssertionError("Tab does not lead to the slider")
    page.page.keyboard.press("ArrowRight")
    wait_for(lambda: p.readUserDebugParameter(slider) != 0.5, page)
    page.page.keyboard.press("Escape")
    assert page.page.evaluate(FOCUSED) == "view"
    page.page.wait_for_timeout(1200)
    assert viewer.is_open
    p.getKeyboardEvents()
    page.page.keyboard.press("Tab")
    page.page.keyboard.press("Shift+Tab")
    assert page.page.evaluate(FOCUSED) == "view"
    page.page.keyboard.press("Escape")
    wait_for(lambda: p.getKeyboardEvents().get(27) is not None, page)


@pytest.mark.parametrize(
    ("button", "state"),
    [
        ("fold", "aria-expanded"),
        ("keys", "aria-expanded"),
        ("loop", "aria-pressed"),
        ("live", "aria-pressed"),
    ],
)
def test_states_are_told(page: Page, button: str, state: str):
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    for _ in range(3):
        p.stepSimulation()
        page.page.wait_for_timeout(30)
    page.until("app.history.count > 1")
    element = page.page.locator(f"#{button}")
    before = element.get_attribute(state)
    if button == "live":
        page.page.locator("#back").click()
    else:
        if button == "loop":
            page.page.get_by_title("More controls").click()
        element.click()
    assert (before, element.get_attribute(state)) in [("true", "false"), ("false", "true")]


def test_the_view_has_a_role(page: Page):
    assert page.page.get_by_role("application").get_attribute("id") == "view"
