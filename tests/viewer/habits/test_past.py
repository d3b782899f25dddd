"""The past of a run is that of the process that simulates: pages that come later see it, too."""

import time
from collections.abc import Iterator

import pytest
from tests.patience import until
from tests.viewer.browser import Page, needs_browser, wait_for
from tests.viewer.watcher import Watcher

import pybullet as p
import pybullet_data
from carom.viewer.history.history import History
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow

DATA = pybullet_data.getDataPath()
# Heights of the first body in all frames, by time.
HEIGHTS = """Object.fromEntries(app.history.frames.filter(({ header }) => header.poses > 0)
    .map(({ header, payload }) => [header.time.toFixed(4), new Float32Array(payload, 8, 1)[0]]))"""
LABELS = "#labels span:not(.hover):not(.reading)"


def fall(steps: int) -> None:
    for _ in range(steps):
        p.stepSimulation()
        time.sleep(1 / 240)


def fall_before_a_page_is_there(steps: int, viewer: Viewer) -> None:
    """With a frame after every fifth step, however busy the machine is."""
    for step in range(steps):
        p.stepSimulation()
        if step % 5 == 4:
            number = viewer._past.next_number
            assert until(lambda number=number: viewer._past.next_number > number)


@pytest.fixture
def ball(viewer: Viewer) -> int:
    """A ball that has fallen for a second, before any page is open; a text was there in the first half."""
    p.setGravity(0, 0, -10)
    number = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 8])
    p.changeDynamics(number, -1, linearDamping=0)
    text = p.addUserDebugText("first half", [0, 0, 1])
    until(lambda: viewer._past.next_number > 0)
    fall_before_a_page_is_there(120, viewer)
    p.removeUserDebugItem(text)
    fall_before_a_page_is_there(120, viewer)
    return number


@pytest.fixture
def late(viewer: Viewer, ball: int, browser) -> Iterator[Page]:
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.history.start < -0.9")
    yield page
    page.page.close()
    assert page.complaints == []


@pytest.mark.long
@needs_browser
def test_a_page_that_comes_late_sees_what_was_before_it(late: Page):
    heights = late.page.evaluate(HEIGHTS)
    assert len(heights) > 20
    for at, height in heights.items():
        # A frame may have the poses of the next step.
        assert height == pytest.approx(8 - 5 * float(at) * (float(at) + 1 / 240), abs=0.06)
    start = late.page.evaluate("app.history.start")
    late.page.locator("#scrub").fill(str(start + 0.25))
    assert late.page.locator(LABELS).all_text_contents() == ["first half"]
    assert late.page.evaluate("app.scene.bodies.size") == 1
    late.page.locator("#scrub").fill(str(start + 0.8))
    assert late.page.locator(LABELS).all_text_contents() == []
    # What is still there has been since then, and not once more.
    assert late.page.evaluate("app.history.messages.versions.get('body 0').length") == 1
    late.page.locator("#live").click()
    fall(10)
    late.until("app.history.frames.at(-1).header.time > 1.02")


@pytest.mark.long
@needs_browser
def test_tabs_and_reloads_see_the_same_past(late: Page, viewer: Viewer, browser):
    late.page.reload()
    late.until("window.app?.history.start < -0.9")
    other = Page(browser, viewer.address, 600, 400)
    other.until("window.app?.history.start < -0.9")
    # The past comes in parts.
    wait_for(lambda: other.page.evaluate(HEIGHTS) == late.page.evaluate(HEIGHTS), late)
    assert other.complaints == []


@pytest.mark.long
def test_the_memory_of_the_process_is_bounded(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("CI", "true")
    window = clients[p.connect(p.GUI, options="--port=0 --history=1")].window
    assert isinstance(window, PageWindow)
    viewer = window.viewer
    try:
        shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
        for n in range(300):
            p.createMultiBody(1, shape, basePosition=[n, 0, 5])
        past = viewer._past._history

        def drops() -> bool:
            p.stepSimulation()
            return past.first > 64

        assert until(drops)
        assert past.size < 2**20 + 64 * 15000
        with Watcher(viewer.address) as page:
            page.wait_for(lambda: page.frame.get("number"))
            assert page.shown["title", None]["history"] == 2**20
    finally:
        p.disconnect()


def test_without_memory_nothing_is_kept(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("CI", "true")
    window = clients[p.connect(p.GUI, options="--port=0 --history=0")].window
    assert isinstance(window, PageWindow)
    try:
        p.loadURDF(f"{DATA}/cube_small.urdf")
        fall(60)
        with Watcher(window.viewer.address) as page:
            page.wait_for(lambda: page.frame.get("poses") == 1)
            assert "number" not in page.frame
            page.tell("past", before=100, known=False)
            fall(60)
            page.wait_for(lambda: page.frame["time"] > 0.4)
    finally:
        p.disconnect()


def test_a_history_gives_each_frame_and_what_was_shown_with_it():
    history = History(10_000_000)
    history.take([(("body", 1), b"ball"), ("title", b"not kept")])
    for number in range(10):
        if number == 5:
            history.take([(("body", 1), b"box"), (("mesh", 3), b"mesh")])
        if number == 8:
            history.take([(("body", 1), None)])
        history.add(b"frame %d" % number)
    newest = history.before(10, 16, known=False)
    assert (newest.first, newest.frames) == (8, [b"frame 8", b"frame 9"])
    assert [each.message for each in newest.versions] == [b"mesh"]
    earlier = history.before(8, 16, known=True)
    assert (earlier.first, earlier.frames) == (6, [b"frame 6", b"frame 7"])
    assert [(each.name, each.begin, each.end) for each in earlier.versions] == [("body 1", 5, 8)]
    rest = history.before(6, 1000, known=True)
    assert (rest.first, rest.oldest, len(rest.frames)) == (0, 0, 6)
    assert [(each.name, each.begin, each.end) for each in rest.versions] == [("body 1", 0, 5)]


def test_a_history_drops_the_oldest_frames():
    history = History(64 * 200)
    history.take([(("item", 1), b"before")])
    for _ in range(10):
        history.add(bytes(100))
    history.take([(("item", 1), b"after")])
    for _ in range(500):
        history.add(bytes(100))
    assert history.size <= 64 * 200 + 64 * 200
    assert history.end == 510
    excerpt = history.before(510, 10**9, known=False)
    assert excerpt.first == excerpt.oldest == 510 - len(excerpt.frames) > 300
    assert [each.message for each in excerpt.versions] == [b"after"]
