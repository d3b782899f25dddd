"""Pictures and videos of the recording, at a size that does not depend on how fast the machine draws."""

from base64 import b64encode
from collections.abc import Iterator
from pathlib import Path

import pytest
from PIL import Image
from tests.viewer.browser import Page, needs_browser

import pybullet_data
from carom import World

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()
FILM = """async (text) => {
  const bytes = Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  const video = document.createElement("video");
  video.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
  await new Promise((done) => (video.onloadeddata = done));
  const shown = async (time) => {
    video.currentTime = time;
    await new Promise((done) => (video.onseeked = done));
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
    const context = canvas.getContext("2d");
    context.drawImage(video, 0, 0);
    return [...context.getImageData(0, 0, canvas.width, canvas.height).data];
  };
  const [start, end] = [await shown(0.05), await shown(0.4)];
  const changed = start.filter((value, i) => Math.abs(value - end[i]) > 40).length;
  return { width: video.videoWidth, height: video.videoHeight, duration: video.duration, changed };
}"""


@pytest.fixture
def replay(browser, tmp_path: Path) -> Iterator[Page]:
    world = World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf(f"{DATA}/plane.urdf")
    world.load_urdf(f"{DATA}/cube_small.urdf", (0, 0, 1.5))
    with world.record(tmp_path / "fall.html"):
        world.step(120)
    page = Page(browser, (tmp_path / "fall.html").as_uri(), 1100, 640)
    page.until("window.app?.history.count > 0 && app.scene.groups.length > 0")
    page.page.evaluate("app.player.pause(); app.player.seek(app.history.start)")
    yield page
    page.page.close()
    assert page.complaints == []


def saved(page: Page, button: str, file: Path) -> Path:
    with page.page.expect_download() as download:
        page.page.locator(button).click()
    download.value.save_as(file)
    return file


def test_a_picture_is_as_large_as_the_view_or_as_chosen(replay: Page, tmp_path: Path):
    # As while something moves on a slow machine.
    replay.page.evaluate("Object.assign(app.renderer.pace, { step: 0, unchanged: 0 })")
    with Image.open(saved(replay, "#picture", tmp_path / "shown.png")) as picture:
        assert picture.size == (1100, 640)
    before = replay.page.evaluate("[app.camera.width, app.camera.height]")
    replay.page.locator("#size").select_option("3840x2160")
    with Image.open(saved(replay, "#picture", tmp_path / "large.png")) as picture:
        assert picture.size == (3840, 2160)
    assert replay.page.evaluate("[app.camera.width, app.camera.height]") == before


def test_the_recording_is_filmed_frame_by_frame(replay: Page, tmp_path: Path):
    replay.page.locator("#size").select_option("1280x720")
    replay.page.locator("#live").evaluate("() => app.player.seek(0.1)")
    film = saved(replay, "#render", tmp_path / "film.webm").read_bytes()
    seen = replay.page.evaluate(FILM, b64encode(film).decode())
    assert (seen["width"], seen["height"]) == (1280, 720)
    assert seen["duration"] == pytest.approx(0.4, abs=0.05)
    assert seen["changed"] > 1000
    assert replay.page.evaluate("app.player.clock") == pytest.approx(0.1)
    replay.until("document.querySelector('#render').textContent === 'Render'")


def test_filming_ends_at_a_second_click(replay: Page):
    replay.page.locator("#playback").select_option("0.1")
    replay.page.locator("#render").click()
    replay.until("/%/.test(document.querySelector('#render').textContent)")
    replay.page.locator("#render").click()
    replay.until("document.querySelector('#render').textContent === 'Render'")
