"""The page of a spectator: it shows everything, says that it only watches, and has no controls."""

from collections.abc import Iterator

import pytest
from tests.viewer.browser import Page, needs_browser

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
HIDDEN = ("#share", "#close", "#running", "#mark", "#body-card .hand")


NOTE_WHAT_IS_SENT = """() => {
  window.sent = [];
  const { prototype } = WebSocket;
  const { send } = prototype;
  prototype.send = function (text) {
    window.sent.push(JSON.parse(text).type);
    send.call(this, text);
  };
}"""
# Wide enough for all of the time bar.
WIDTH, HEIGHT = 1300, 700


def opened(browser, address: str) -> Iterator[Page]:
    page = Page(browser, address, WIDTH, HEIGHT)
    page.until("window.app?.scene.bodies.size === 1 && app.scene.groups.length > 0")
    yield page
    page.page.close()
    assert page.complaints == []


@pytest.fixture
def cart(viewer: Viewer) -> int:
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.addUserDebugParameter("gain", 0, 2, 0.5)
    return p.loadURDF("cartpole.urdf", [0, 0, 0.5])


@pytest.fixture
def spectator(cart: int, viewer: Viewer, browser) -> Iterator[Page]:
    yield from opened(browser, viewer.spectator_address)


@pytest.fixture
def own(cart: int, viewer: Viewer, browser) -> Iterator[Page]:
    yield from opened(browser, viewer.address)


def test_it_says_so_and_has_no_controls(spectator: Page, own: Page):
    spectator.page.evaluate("app.bodies.select(0)")
    own.page.evaluate("app.bodies.select(0)")
    for each, watches in ((spectator.page, True), (own.page, False)):
        each.evaluate("document.getElementById('bodies').open = true")
        assert each.locator("#watching").is_visible() is watches
        for place in HIDDEN:
            assert each.locator(place).first.is_visible() is not watches, place
        sliders = each.locator(".slider input[type=range]")
        assert sliders.count() == 3
        for number in range(3):
            assert sliders.nth(number).is_visible()
            assert (sliders.nth(number).locator("xpath=ancestor::*[@inert]").count() > 0) is watches
    assert spectator.page.locator("#save").is_visible()
    assert spectator.page.locator("#scrub").is_enabled()


def test_nothing_that_is_done_there_reaches_the_simulation(
    spectator: Page, viewer: Viewer, monkeypatch: pytest.MonkeyPatch
):
    told: list[dict[str, object]] = []
    receive = viewer._server._receive

    def tell(page: int, message: dict[str, object]) -> object:
        told.append(message)
        return receive(page, message)

    monkeypatch.setattr(viewer._server, "_receive", tell)
    spectator.page.evaluate(NOTE_WHAT_IS_SENT)
    p.resetDebugVisualizerCamera(2, 0, -20, [0, 0, 0.5])
    spectator.until("app.camera.distance === 2")
    before = p.getDebugVisualizerCamera()
    # A body is dragged, which turns the view here; keys that pause, step and end.
    x, y = spectator.page.evaluate("app.camera.pixel([0, 0, 0.5])")[:2]
    yaw = spectator.page.evaluate("app.camera.yaw")
    spectator.page.mouse.move(x, y)
    spectator.page.mouse.down()
    spectator.page.mouse.move(x + 60, y, steps=4)
    spectator.page.mouse.up()
    assert spectator.page.evaluate("app.camera.yaw") != yaw
    for key in "iodp":
        spectator.page.keyboard.press(key)
    spectator.page.keyboard.press("Escape")
    # What a visitor could call in its console is not listened to either.
    spectator.page.evaluate("app.toggles.options.collisions = true; app.tellWants()")
    spectator.until("[...app.scene.bodies.values()].some(({ shapes }) => shapes.some((it) => it.collision))")
    assert {message["type"] for message in told} == {"want"}
    assert set(spectator.page.evaluate("window.sent")) == {"want"}
    assert p.getDebugVisualizerCamera() == before
    assert viewer.is_open
    assert not viewer.pause_control.closed


def test_the_page_has_the_link_for_spectators(own: Page, viewer: Viewer):
    own.page.evaluate("void (navigator.clipboard.writeText = async () => { throw new Error('not here'); })")
    own.page.locator("#share").click()
    notice = own.page.locator("#notice")
    own.until("!document.getElementById('notice').hidden")
    assert viewer.spectator_address in (notice.text_content() or "")
    own.page.locator("#notice button").click()
    own.until("document.getElementById('notice').hidden")
    # Where the browser lets pages copy, it is copied.
    own.page.evaluate("void (navigator.clipboard.writeText = async (text) => { window.copied = text; })")
    own.page.locator("#share").click()
    own.until("document.getElementById('notice').textContent.startsWith('Copied')")
    assert own.page.evaluate("window.copied") == viewer.spectator_address


def test_marks_are_seen_and_not_gone_back_to(spectator: Page, own: Page):
    for _ in range(20):
        p.stepSimulation()
    own.page.locator("#mark").click()
    for each, words in ((spectator, False), (own, True)):
        each.until("document.querySelector('.tick') !== null")
        title = each.page.locator(".tick").get_attribute("title") or ""
        assert "click to view this state" in title
        assert ("double-click" in title) is words
