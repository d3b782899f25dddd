"""Gamepads of the browser, read by a script."""

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

from carom.viewer.input.gamepads import Gamepad, Gamepads
from carom.viewer.viewer import Viewer

PLUG = """() => {
  window.pad = {
    id: "Test pad", index: 0, connected: true, mapping: "standard",
    axes: [0, 0, 0, 0], buttons: [...Array(17)].map(() => ({ pressed: false, touched: false, value: 0 })),
  };
  navigator.getGamepads = () => [null, window.pad];
}"""


@needs_browser
def test_a_script_reads_sticks_and_buttons_of_a_gamepad(page: Page, viewer: Viewer):
    assert viewer.gamepads() == []
    page.page.evaluate(PLUG)
    wait_for(viewer.gamepads, page)
    (pad,) = viewer.gamepads()
    assert (pad.name, pad.standard, pad.axes, len(pad.buttons)) == ("Test pad", True, (0, 0, 0, 0), 17)
    page.page.evaluate("() => { pad.axes[1] = -0.5; pad.buttons[0].value = 1; pad.buttons[7].value = 0.25; }")
    wait_for(lambda: viewer.gamepads()[0].axes[1] == pytest.approx(-0.5), page)
    (pad,) = viewer.gamepads()
    assert pad.pressed(0)
    assert not pad.pressed(7)
    assert pad.buttons[7] == pytest.approx(0.25)
    page.page.evaluate("() => { navigator.getGamepads = () => [null]; }")
    wait_for(lambda: viewer.gamepads() == [], page)


@pytest.mark.long
@needs_browser
def test_a_gamepad_that_rests_sends_nothing(page: Page, viewer: Viewer):
    page.page.evaluate(
        "() => { window.told = []; const send = app.gamepads.send;"
        " app.gamepads.send = (message) => { told.push(message); send(message); }; }"
    )
    page.page.evaluate(PLUG)
    page.until("told.length === 1")
    page.page.evaluate("() => { pad.axes[0] = 0.0002; }")
    page.page.wait_for_timeout(300)
    assert page.page.evaluate("told.length") == 1


@pytest.mark.long
@needs_browser
def test_gamepads_are_known_after_a_reload_and_gone_with_their_page(viewer: Viewer, browser):
    page = Page(browser, viewer.address)
    page.page.add_init_script(f"({PLUG})()")
    page.page.reload()
    wait_for(viewer.gamepads, page)
    page.page.close()
    other = Page(browser, viewer.address)
    wait_for(lambda: viewer.gamepads() == [], other)


@pytest.mark.long
@needs_browser
def test_a_page_that_may_not_ask_has_no_gamepads(page: Page, viewer: Viewer):
    page.page.evaluate(PLUG)
    wait_for(viewer.gamepads, page)
    page.page.evaluate(
        "() => { navigator.getGamepads = () => { throw new DOMException('no', 'SecurityError'); }; }"
    )
    wait_for(lambda: viewer.gamepads() == [], page)


def test_numbers_are_kept_in_their_ranges():
    gamepads = Gamepads()
    told = {"name": "x", "axes": [2, float("nan"), -3], "buttons": [-1, 0.5], "standard": False}
    gamepads.take(3, {"gamepads": [told]})
    assert gamepads.all() == [Gamepad("x", (1, 0, -1), (0, 0.5))]
    assert [gamepads.all()[0].pressed(button) for button in (-1, 0, 1, 2)] == [False, False, True, False]
    gamepads.forget(3)
    assert gamepads.all() == []
