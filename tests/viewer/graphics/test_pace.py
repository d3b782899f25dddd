"""Pictures that take too long get coarser while something moves, and many equal shapes cost few calls."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser

import pybullet_data
from carom import World

pytestmark = needs_browser

SIDE = 10
WIDTH, HEIGHT = 900, 640
# Draws the present moment once, and counts the calls that draw something.
CALLS = """() => {
  const { gl } = app.renderer;
  const names = ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"];
  let [calls, instances] = [0, 0];
  for (const name of names) {
    gl[name] = (...told) => {
      calls += 1;
      if (name.endsWith("Instanced")) instances += told.at(-1);
      Object.getPrototypeOf(gl)[name].apply(gl, told);
    };
  }
  app.drawScene();
  for (const name of names) delete gl[name];
  return [calls, instances];
}"""


@pytest.fixture(scope="module")
def hundred(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A replay of a hundred boxes that fall on a plane."""
    data = Path(pybullet_data.getDataPath())
    world = World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf(data / "plane.urdf")
    for n in range(SIDE**2):
        world.load_urdf(data / "cube_small.urdf", (0.1 * (n % SIDE), 0.1 * (n // SIDE), 0.3))
    file = tmp_path_factory.mktemp("pace") / "hundred.html"
    with world.record(file):
        world.step(240)
    return file


@pytest.fixture
def replay(hundred: Path, browser) -> Iterator[Page]:
    page = Page(browser, hundred.as_uri(), WIDTH, HEIGHT)
    page.until("window.app?.history.count > 0 && app.scene.groups.length > 0")
    page.page.evaluate("app.player.pause(); app.player.seek(app.history.start)")
    yield page
    page.page.close()
    assert page.complaints == []


def test_a_hundred_equal_boxes_are_drawn_with_few_calls(replay: Page):
    # Boxes and the plane for the eye and for the light, the sky, the grid.
    replay.until("app.renderer.pace.still")
    calls, instances = replay.page.evaluate(CALLS)
    assert calls <= 6
    # The browser draws by the processor, where each instance would cost as much as a call.
    assert replay.page.evaluate("app.renderer.byProcessor")
    assert instances <= 2
    replay.page.evaluate("app.options.wireframe = true")
    assert replay.page.evaluate(CALLS)[0] <= 4


def test_lines_are_drawn_with_one_call_and_arrows_with_another(replay: Page):
    replay.until("app.renderer.pace.still")
    alone, _ = replay.page.evaluate(CALLS)
    # At once: the next picture of a moment that is new would be one of something that moves.
    change = "app.player.seek(1), Object.assign(app.options, { frames: true, forces: true })"
    calls, instances = replay.page.evaluate(f"({change}, ({CALLS})())")
    assert replay.page.evaluate("app.overlays.lines.count") > 3 * SIDE**2
    assert calls == alone + 2
    assert instances <= replay.page.evaluate("app.overlays.solids.count") + 2


def test_slow_pictures_get_coarser_while_something_moves_and_sharp_when_nothing_does(replay: Page):
    width = replay.page.evaluate(
        """async () => {
          const { pace } = app.renderer;
          const note = pace.note.bind(pace);
          pace.note = () => {};
          // On a busy machine it may count as still between two pictures, and be sharp for one.
          let coarsest = app.canvas.width;
          for (let picture = 0; picture < 60; picture++) {
            app.player.seek(picture / 60);
            await new Promise(requestAnimationFrame);
            note(100);
            coarsest = Math.min(coarsest, app.canvas.width);
          }
          return coarsest;
        }"""
    )
    assert width == 0.25 * WIDTH
    replay.until(f"app.canvas.width === {2 * WIDTH}")
    assert replay.page.evaluate("app.canvas.clientWidth") == WIDTH


def test_fast_pictures_get_finer_again(replay: Page):
    steps = replay.page.evaluate(
        """async () => {
          const pace = new app.renderer.pace.constructor(true);
          const told = (duration, pictures) => {
            for (let picture = 0; picture < pictures; picture++) pace.note(duration);
            return pace.sharpness;
          };
          const first = pace.sharpness;
          const single = (told(15, 2), told(900, 1), told(30, 5));
          const some = (told(30, 5), told(48, 3)), slow = told(60, 8);
          // Coarser than half, pictures need not be fast to go back to half; from there on they do.
          const slowest = told(500, 50), stays = told(40, 50), enough = told(30, 50), fast = told(10, 50);
          pace.wait(600);
          const still = (told(500, 50), pace.sharpness);
          pace.wait(0);
          const moving = pace.sharpness;
          pace.hold(true);
          pace.wait(9999);
          const filmed = (told(500, 50), pace.sharpness);
          return [first, single, some, slow, slowest, stays, enough, fast, still, moving, filmed];
        }"""
    )
    assert steps == [0.5, 0.5, 0.5, 0.4, 0.25, 0.25, 0.5, 1, 1, 1, 1]


# Draws moments of the recording as while something moves: with what does not move kept, and without.
LAYERS = """async ([first, last]) => {
  const { renderer } = app, { gl, pace } = renderer, layer = renderer.layers[0];
  app.draw = () => {};
  pace.wait(0);
  renderer.resize();
  app.fitCanvas();
  const shown = () => {
    app.drawScene();
    const bytes = new Uint8Array(4 * app.canvas.width * app.canvas.height);
    gl.readPixels(0, 0, app.canvas.width, app.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  };
  const seek = (moment) => app.player.seek(app.history.start + moment);
  const windows = [], window = layer.window.bind(layer);
  layer.window = (...told) => (windows.push(window(...told)), windows.at(-1));
  for (const moment of [first, first, 0.5 * (first + last), last]) seek(moment), shown();
  const [,, width, height] = layer.spoilt;
  // A new line, below the floor, which hides it.
  app.grasp.line = () => [[-0.6, -0.6, -0.05], [0.6, -0.6, -0.05]];
  const quick = shown();
  layer.window = () => null;
  const whole = shown();
  seek(first);
  const before = shown();
  delete layer.window;
  delete app.grasp.line;
  const differ = (a, b) => a.reduce((sum, value, i) => sum + (Math.abs(value - b[i]) > 3), 0);
  const area = app.canvas.width * app.canvas.height;
  const [differing, moved] = [differ(quick, whole), differ(before, whole)];
  return { windows, differing, moved, area, solids: app.overlays.solids.count, copied: width * height };
}"""


def test_only_what_moves_is_drawn_anew(tmp_path: Path, browser):
    data = Path(pybullet_data.getDataPath())
    world = World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf(data / "plane.urdf")
    world.load_urdf(data / "table/table.urdf", (0.6, 0, 0), fixed_base=True)
    ball = world.load_urdf(data / "sphere_small.urdf", (0, 0.3, 1.1))
    ball.set_base_velocity((0.8, 0, 0), (0, 0, 0))
    # It rests, under the ball, so that there is a force at every moment.
    world.load_urdf(data / "cube_small.urdf", (0.2, 0.3, 0.651))
    with world.record(tmp_path / "ball.html"):
        world.step(240)
    page = Page(browser, (tmp_path / "ball.html").as_uri(), WIDTH, HEIGHT)
    page.until("window.app?.history.count > 0 && app.scene.groups.length > 0")
    page.page.evaluate("app.player.pause(); app.player.seek(app.history.start)")
    for frames, forces in ((False, False), (True, False), (False, True), (True, True)):
        page.page.evaluate(f"Object.assign(app.options, {json.dumps({'frames': frames, 'forces': forces})})")
        result = page.page.evaluate(LAYERS, [0.1, 0.6])
        # The first picture of a camera is drawn as a whole, the next ones where the ball and its shadow are.
        assert all(width * height < 0.5 * result["area"] for *_, width, height in result["windows"][1:])
        assert result["moved"] > 100
        assert result["differing"] <= 4
        assert bool(result["solids"]) == forces
        # What was drawn over the picture is restored where it was, not everywhere.
        assert result["copied"] < 0.5 * result["area"]
    assert page.complaints == []


def test_the_user_chooses_sharp_or_fluent(replay: Page):
    replay.page.evaluate("app.renderer.pace.note = () => {}, app.renderer.pace.step = 0")
    move = "app.player.seek(app.history.start + Math.random())"
    replay.page.evaluate(f"window.moving = setInterval(() => {move}, 10)")
    replay.page.get_by_text("25 % of the pixels").wait_for()
    replay.page.locator("#sharpness").select_option("sharp")
    replay.until(f"app.canvas.width === {WIDTH}")
    replay.page.get_by_text("of the pixels").wait_for(state="detached")
    replay.page.locator("#sharpness").select_option("fluent")
    replay.until(f"app.canvas.width === {WIDTH // 4}")
    replay.page.evaluate("clearInterval(window.moving)")
