"""A phone and a SpaceMouse, told to scripts as gamepads; in a browser, with stand-ins for the devices."""

from __future__ import annotations

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

from carom.viewer.viewer import Viewer

pytestmark = [needs_browser, pytest.mark.long]

# A SpaceMouse as WebHID has it; `report(id, bytes)` is what the device sends.
MOUSE = """() => {
  const device = new EventTarget();
  const open = async () => { device.opened = true; };
  Object.assign(device, { productName: "SpaceMouse Compact", opened: false, open });
  window.report = (reportId, bytes) => device.dispatchEvent(
    Object.assign(new Event("inputreport"), { reportId, data: new DataView(new Uint8Array(bytes).buffer) }));
  const hid = new EventTarget();
  hid.getDevices = async () => [];
  hid.requestDevice = async ({ filters }) => { window.asked = filters; return [device]; };
  window.unplug = () => hid.dispatchEvent(Object.assign(new Event("disconnect"), { device }));
  Object.defineProperty(navigator, "hid", { value: hid, configurable: true });
}"""


def test_the_page_of_a_phone_is_a_gamepad_with_two_sticks(viewer: Viewer, browser):
    page = Page(browser, f"{viewer.address}#controller", 740, 360)
    wait_for(viewer.gamepads, page)
    (pad,) = viewer.gamepads()
    assert (pad.name, pad.axes, pad.buttons, pad.standard) == ("Thumbs", (0,) * 6, (0, 0), True)
    stick = page.page.locator("#thumb-right").bounding_box()
    x, y = stick["x"] + stick["width"] / 2, stick["y"] + stick["height"] / 2
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    page.page.mouse.move(x + 30, y - 15, steps=3)
    wait_for(lambda: viewer.gamepads()[0].axes[2:4] == pytest.approx((0.5, -0.25)), page)
    # Beyond its end a stick stays in its direction.
    page.page.mouse.move(x + 600, y, steps=3)
    wait_for(lambda: viewer.gamepads()[0].axes[2:4] == pytest.approx((1.0, 0.0)), page)
    page.page.mouse.up()
    wait_for(lambda: viewer.gamepads()[0].axes == (0,) * 6, page)
    a = page.page.locator("#thumb-a").bounding_box()
    page.page.mouse.move(a["x"] + 10, a["y"] + 10)
    page.page.mouse.down()
    wait_for(lambda: viewer.gamepads()[0].pressed(0), page)
    page.page.mouse.up()
    wait_for(lambda: not viewer.gamepads()[0].pressed(0), page)
    page.page.locator("#thumbs-close").click()
    wait_for(lambda: viewer.gamepads() == [], page)
    page.page.close()
    assert page.complaints == []


def test_a_phone_that_is_tilted_tells_how_far_from_where_it_was(page: Page, viewer: Viewer):
    page.page.evaluate("document.getElementById('controllers').open = true")
    page.page.locator("#thumbs-open").click()
    page.page.evaluate("app.controllers.thumbs.askForTilt()")
    tilt = """([beta, gamma]) => window.dispatchEvent(
      new DeviceOrientationEvent("deviceorientation", { alpha: 0, beta, gamma }))"""
    page.page.evaluate(tilt, [40, 5])
    page.page.evaluate(tilt, [62.5, -4])
    wait_for(lambda: viewer.gamepads()[0].axes[4:] == pytest.approx((-0.2, 0.5), abs=1e-3), page)
    page.page.evaluate(tilt, [-80, 5])
    wait_for(lambda: viewer.gamepads()[0].axes[4:] == pytest.approx((0.0, -1.0), abs=1e-3), page)


def test_a_space_mouse_is_a_gamepad_with_six_axes(viewer: Viewer, browser):
    page = Page(browser, viewer.address)
    page.page.add_init_script(f"({MOUSE})()")
    page.page.reload()
    page.until("window.app?.scene.layout.layout > 0")
    page.page.evaluate("document.getElementById('controllers').open = true")
    page.page.locator("#space-mouse").click()
    wait_for(viewer.gamepads, page)
    (pad,) = viewer.gamepads()
    assert (pad.name, pad.axes, pad.buttons, pad.standard) == ("SpaceMouse Compact", (0,) * 6, (0, 0), False)
    assert {it["vendorId"] for it in page.page.evaluate("asked")} == {0x256F, 0x046D}
    # 175, -350, 700; then turns of 35, 0, -35 and the second button.
    page.page.evaluate("report(1, [175, 0, 0xa2, 0xfe, 0xbc, 0x02])")
    page.page.evaluate("report(2, [35, 0, 0, 0, 0xdd, 0xff])")
    page.page.evaluate("report(3, [2, 0])")
    wait_for(lambda: viewer.gamepads()[0].pressed(1), page)
    (pad,) = viewer.gamepads()
    assert pad.axes == pytest.approx((0.5, -1, 1, 0.1, 0, -0.1))
    assert not pad.pressed(0)
    # Newer devices tell all six in one report.
    page.page.evaluate("report(1, [0, 0, 0, 0, 0, 0, 175, 0, 0, 0, 0, 0])")
    wait_for(lambda: viewer.gamepads()[0].axes == pytest.approx((0, 0, 0, 0.5, 0, 0)), page)
    page.page.evaluate("unplug()")
    wait_for(lambda: viewer.gamepads() == [], page)
    page.page.close()
    assert page.complaints == []


def test_spectators_have_no_controllers(viewer: Viewer, browser):
    page = Page(browser, f"{viewer.spectator_address}#controller")
    page.until("window.app?.controllers")
    assert page.page.locator("#controllers").is_hidden()
    assert page.page.locator("#thumbs").is_hidden()
    page.page.close()
