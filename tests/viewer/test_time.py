"""Time travel on a live page: looking back, going on, marks, reset, speed, and saving."""

import json
import re
import struct
import threading
import time
from base64 import b64decode
from pathlib import Path
from zlib import decompress

import pytest
from tests.patience import PATIENCE, until
from tests.viewer.browser import Page, needs_browser, wait_for
from tests.viewer.watcher import Watcher

import carom.replay
import pybullet as p
import pybullet_data
from carom import World
from carom.viewer import Viewer as ModernViewer
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()


def fall(steps: int = 240) -> None:
    for _ in range(steps):
        p.stepSimulation()
        time.sleep(1 / 240)


@pytest.fixture
def page(page: Page) -> Page:
    """Wide enough for all controls of the time bar side by side."""
    page.page.set_viewport_size({"width": 1100, "height": 640})
    return page


@pytest.fixture
def ball(viewer: Viewer) -> int:
    p.setGravity(0, 0, -10)
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    return p.createMultiBody(1, shape, basePosition=[0, 0, 5])


def height(page: Page) -> float:
    return page.page.evaluate("app.scene.poses[2]")


def seen(page: Page, steps: int) -> None:
    """Waits until the page shows the world after so many steps."""
    page.until(f"Math.abs(app.history.frames.at(-1)?.header.time - {steps / 240}) < 1e-6")


def test_the_past_is_seen_while_the_simulation_goes_on(page: Page, ball: int):
    fall(120)
    seen(page, 120)
    page.page.locator("#scrub").fill("0.1")
    past = height(page)
    assert 4.9 < past <= 5
    fall(60)
    seen(page, 180)
    assert height(page) == past
    assert page.page.locator("#timeline").get_attribute("class") == "past"
    page.page.locator("#live").click()
    poses = clients[0].world.link_pose
    assert height(page) == pytest.approx(poses[0, 2], abs=1e-6)
    fall(1)
    seen(page, 181)
    assert height(page) == pytest.approx(poses[0, 2], abs=1e-6)


@pytest.mark.long
def test_the_memory_of_the_past_is_bounded(page: Page, ball: int):
    page.until("app.history.messages.bytes > 0")
    page.page.evaluate("app.history.budget = app.history.messages.bytes + 20000")

    def drops() -> bool:
        fall(30)
        return page.page.evaluate("app.history.first > 0")

    wait_for(drops, page)
    page.until("app.history.bytes < 40000")
    page.page.evaluate("app.player.seek(0)")
    assert page.page.evaluate("app.history.start") > 0
    assert page.page.evaluate("app.scene.bodies.size") == 1


@pytest.mark.long
def test_drawings_and_bodies_of_the_past_are_seen_again(page: Page, ball: int):
    clocks = []
    text = -1
    for word in ("", "before", "after"):
        if word:
            text = p.addUserDebugText(word, [0, 0, 1], replaceItemUniqueId=text)
        fall(12)
        seen(page, 24 * len(clocks) + 12)
        clocks.append(page.page.evaluate("app.history.end"))
        fall(12)
    p.removeBody(ball)
    p.createMultiBody(1, -1, p.createVisualShape(p.GEOM_BOX, halfExtents=[1, 1, 1]))
    fall(24)
    seen(page, 96)
    labels = page.page.locator("#labels span:not(.hover):not(.reading)")
    for clock, words, bodies in zip(clocks, ([], ["before"], ["after"]), (1, 1, 1), strict=True):
        page.page.locator("#scrub").fill(str(clock))
        assert labels.all_text_contents() == words
        assert page.page.evaluate("app.scene.bodies.size") == bodies
        assert page.page.evaluate("app.scene.bodies.values().next().value.shapes.length") == 1
    page.page.locator("#live").click()
    assert labels.all_text_contents() == ["after"]


@pytest.mark.long
def test_reset_goes_back_to_the_state_before_the_first_step(page: Page, ball: int):
    start = p.getBasePositionAndOrientation(ball)
    fall(60)
    page.page.get_by_role("button", name="Reset", exact=True).click()
    wait_for(lambda: p.getBasePositionAndOrientation(ball) == start, page)
    fall(60)
    assert p.getBasePositionAndOrientation(ball)[0][2] < 4.8


def test_a_mark_can_be_gone_back_to(page: Page, ball: int):
    fall(30)
    there = p.getBasePositionAndOrientation(ball)
    page.page.locator("#mark").click()
    page.page.locator(".tick").wait_for()
    fall(60)
    seen(page, 90)
    page.page.locator(".tick").dblclick()
    wait_for(lambda: p.getBasePositionAndOrientation(ball) == there, page)
    # What was marked cannot come back without its bodies.
    p.removeBody(ball)

    def mark_is_gone() -> bool:
        p.stepSimulation()
        return page.page.locator(".tick").count() == 0

    wait_for(mark_is_gone, page)


def test_slow_motion(page: Page, viewer: Viewer, ball: int):
    page.page.locator("#speed").select_option("0.1")
    wait_for(lambda: viewer.pause_control.speed == 0.1, page)
    began = time.monotonic()
    for _ in range(24):
        p.stepSimulation()
    assert time.monotonic() - began > 0.8
    page.page.locator("#speed").select_option("")
    wait_for(lambda: viewer.pause_control.speed is None, page)
    # At that speed they would take a hundred seconds.
    began = time.monotonic()
    for _ in range(2400):
        p.stepSimulation()
    assert time.monotonic() - began < PATIENCE


@pytest.mark.long
def test_slow_motion_of_real_time_simulation(viewer: Viewer):
    p.setRealTimeSimulation(1)
    viewer.set_speed(0.1)
    time.sleep(0.3)
    # A busy machine may be slower; what it makes up for is at most a tenth of a second.
    began, start = time.monotonic(), viewer.time
    assert until(lambda: viewer.time - start > 0.1)
    assert time.monotonic() - began > 0.8
    p.setRealTimeSimulation(0)


@pytest.mark.long
def test_a_replay_is_saved_from_the_page(page: Page, ball: int, browser, tmp_path: Path):
    fall(60)
    seen(page, 60)
    with page.page.expect_download() as download:
        page.page.get_by_role("button", name="Save").click()
    file = tmp_path / "replay.html"
    download.value.save_as(file)
    replay = Page(browser, file.as_uri(), 900, 600)
    replay.until("window.app?.history.count > 0")
    times = "app.history.frames.map(({header}) => header.time)"
    assert replay.page.evaluate(times) == page.page.evaluate(times)
    last = "[...new Float32Array(app.history.frames.at(-1).payload)]"
    assert replay.page.evaluate(last) == page.page.evaluate(last)
    assert replay.complaints == []
    found = carom.replay.read(file)
    assert found.times.tolist() == page.page.evaluate(times)
    (body,) = found.bodies.values()
    poses = page.page.evaluate(
        "app.history.frames.map(({payload}) => [...new Float32Array(payload).slice(0, 7)])"
    )
    there = body.present.nonzero()[0]
    (base,) = body.links.values()
    assert base.inertial_pose[there].tolist() == [poses[frame] for frame in there]
    assert body.looks[-1].shapes
    replay.page.close()
    # Frames are packed by the run, of which there is one for each set of bodies.
    assert len(lengths_of_runs(file)) < 5 < sum(lengths_of_runs(file))


def lengths_of_runs(replay: Path) -> list[int]:
    """The number of frames in each run of a replay."""
    (text,) = re.findall(r'id="recording">([^<]*)<', replay.read_text(encoding="utf-8"))
    plain = decompress(b64decode(text))
    (length,) = struct.unpack_from("<I", plain)
    return [record["frames"] for record in json.loads(plain[4 : 4 + length])["records"] if "frames" in record]


@pytest.mark.long
def test_a_picture_and_a_film_are_saved_from_the_page(page: Page, ball: int, tmp_path: Path):
    from PIL import Image

    p.addUserDebugText("title", [0, 0, 5], [1, 0, 0])
    with page.page.expect_download() as download:
        page.page.get_by_role("button", name="Picture").click()
    download.value.save_as(tmp_path / "picture.png")
    with Image.open(tmp_path / "picture.png") as picture:
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 50
    page.page.locator("#film").click()
    fall(120)
    # The key F1 does the same as the button.
    page.page.focus("#view")
    with page.page.expect_download() as download:
        page.page.keyboard.press("F1")
    assert re.search(r"\.(mp4|webm)$", download.value.suggested_filename)
    download.value.save_as(tmp_path / "film")
    assert (tmp_path / "film").stat().st_size > 2000


def test_the_modern_viewer_pauses_and_pulls_without_a_lock_of_its_own():
    world = World()
    world.load_urdf(f"{DATA}/cube_small.urdf")
    viewer = ModernViewer(world, port=0)
    try:
        with Watcher(viewer.address) as page:
            page.tell("pause", paused=True)
            until(lambda: viewer.pause_control.closed)
            thread = threading.Thread(target=lambda: world.step(3))
            thread.start()
            time.sleep(0.3)
            assert world.time == 0.0
            page.tell("step")
            assert until(lambda: world.time == pytest.approx(1 / 240))
            page.tell("pause", paused=False)
            thread.join(PATIENCE)
            assert world.time == pytest.approx(3 / 240)
            page.tell("reset")
            assert until(lambda: world.time == 0.0)
            viewer.plot("error", 0.25)
            page.wait_for(lambda: page.frame.get("values") == {"error": 0.25})
            with pytest.raises(ValueError, match="finite"):
                viewer.plot("error", float("nan"))
    finally:
        viewer.close()
    world.step()
    assert world.observers == []
