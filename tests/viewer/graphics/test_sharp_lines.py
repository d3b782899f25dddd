"""Frames, inertia boxes and contacts stay legible where the processor draws pictures with few pixels."""

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from tests.viewer.browser import Page, needs_browser

from carom import World

pytestmark = needs_browser

WIDTH, HEIGHT = 600, 450
# A quarter of the pixels along an edge, as on a slow machine while something moves; or as at rest.
COARSE = """() => {
  const { pace } = app.renderer;
  Object.assign(pace, { step: 0, note: () => {}, wait: () => (pace.unchanged = 0) });
  pace.wait();
  app.renderer.resize();
  app.drawScene();
}"""
SHARP = """() => {
  const { pace } = app.renderer;
  Object.assign(pace, { wait: () => (pace.unchanged = 9999) });
  pace.wait();
  app.renderer.resize();
  app.drawScene();
}"""
# Colours of the middles of the three axes of the base of body 1.
ALONG_AXES = """() => {
  const middles = [[0.05, 0, 0], [0, 0.05, 0], [0, 0, 0.05]];
  const { position } = app.scene.linkPose(1, 0);
  return middles.map((middle) => app.camera.pixel(middle.map((x, i) => position[i] + x)).slice(0, 2));
}"""
HIDDEN = "document.getElementById('sharp-lines').hidden"


@pytest.fixture(scope="module")
def box(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A replay of a box on the floor, larger than its frame."""
    world = World()
    world.gravity = (0, 0, -9.81)
    world.add_plane()
    world.add_box([0.15, 0.15, 0.15], mass=1.0, position=[0, 0, 0.15])
    file = tmp_path_factory.mktemp("lines") / "box.html"
    with world.record(file):
        world.step(24)
    return file


@pytest.fixture
def replay(box: Path, browser) -> Iterator[Page]:
    page = Page(browser, box.as_uri(), WIDTH, HEIGHT)
    page.until("window.app?.history.count > 0 && app.scene.groups.length > 0")
    page.page.evaluate("app.player.pause(); app.player.seek(app.history.start + 0.05)")
    yield page
    page.page.close()
    assert page.complaints == []


def strongest(picture: NDArray[np.int16], page: Page) -> list[int]:
    """Which of red, green and blue is the strongest in the middle of each axis of the frame."""
    return [int(picture[round(y), round(x)].argmax()) for x, y in page.page.evaluate(ALONG_AXES)]


def test_frames_are_drawn_with_all_pixels_over_coarse_pictures(replay: Page):
    replay.page.evaluate("app.options.frames = true")
    replay.page.evaluate(COARSE)
    assert replay.page.evaluate("app.canvas.width") == WIDTH / 4
    assert not replay.page.evaluate(HIDDEN)
    # The origin of the frame is inside the box, which it is seen through.
    assert strongest(replay.picture(), replay) == [0, 1, 2]
    replay.page.evaluate(SHARP)
    assert replay.page.evaluate(HIDDEN)
    assert strongest(replay.picture(), replay) == [0, 1, 2]


def test_lines_over_a_coarse_picture_are_as_thin_as_on_a_sharp_one(replay: Page):
    plain, lined = [], []
    for aspect in COARSE, SHARP:
        for options, pictures in ("false", plain), ("true", lined):
            replay.page.evaluate(
                f"Object.assign(app.options, {{ inertias: {options}, contacts: {options} }})"
            )
            replay.page.evaluate(aspect)
            pictures.append(replay.picture())
    coarse, sharp = (int((abs(a - b).sum(2) > 90).sum()) for a, b in zip(plain, lined, strict=True))
    assert 0.7 * sharp < coarse < 1.3 * sharp


def test_pictures_that_are_saved_have_the_lines_as_well(replay: Page):
    replay.page.evaluate("app.options.frames = true")
    replay.page.evaluate(COARSE)
    saved = replay.page.evaluate("app.saving.shots.draw().toDataURL('image/png').split(',')[1]")
    from base64 import b64decode

    picture = np.array(Image.open(io.BytesIO(b64decode(saved))).convert("RGB")).astype(np.int16)
    assert picture.shape == (HEIGHT, WIDTH, 3)
    assert strongest(picture, replay) == [0, 1, 2]


def test_lines_behind_the_eye_are_left_out_and_others_cut_off(replay: Page):
    replay.page.evaluate("app.options.frames = true")
    # In the middle of the frame, one axis of which points backwards.
    replay.page.evaluate(
        "app.camera.set({ distance: 0.02, yaw: 0, pitch: 0, target: app.scene.linkPose(1, 0).position })"
    )
    replay.page.evaluate(COARSE)
    seen = replay.page.evaluate(
        """() => {
          const { context, canvas } = app.renderer.sharpLines;
          const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
          return data.some((part, at) => at % 4 === 3 && part > 0);
        }"""
    )
    assert seen
    replay.page.evaluate("app.camera.set({ distance: 1, yaw: 0, pitch: 0, target: [0, 3, 0] })")
    replay.page.evaluate(COARSE)
    assert replay.page.evaluate("app.overlays.lines.count") > 0
    assert not replay.page.evaluate(
        """() => {
          const { context, canvas } = app.renderer.sharpLines;
          return context.getImageData(0, 0, canvas.width, canvas.height).data.some((part) => part > 0);
        }"""
    )


def test_lines_that_bodies_hide_are_not_thinner_than_a_drawn_pixel(replay: Page):
    """A line of a script beside the box, which is drawn with depth, has no gaps."""
    replay.page.evaluate("app.camera.set({ distance: 1.5, yaw: 20, pitch: -30, target: [0.2, 0, 0.2] })")
    replay.page.evaluate(
        """app.drawings.items.set(7, {
          type: "line", body: -1, link: 0, start: [0.4, -0.6, 0.3], end: [0.4, 0.6, 0.3],
          colour: [1, 0, 0], width: 1,
        })"""
    )
    replay.page.evaluate(COARSE)
    picture = replay.picture()
    ends = replay.page.evaluate("[[0.4, -0.3, 0.3], [0.4, 0.3, 0.3]].map((point) => app.camera.pixel(point))")
    (x, y, _), (to_x, to_y, _) = ends
    around = range(-4, 5)
    for part in np.linspace(0, 1, 40):
        column, row = round(x + part * (to_x - x)), round(y + part * (to_y - y))
        reds = [picture[row + k, column, 0] - picture[row + k, column, 2] for k in around]
        assert max(reds) > 100
