"""Two or four views of the scene on one page, each with a camera of its own, in a real browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.viewer.browser import Page, needs_browser

from carom import World
from carom.viewer import Viewer

pytestmark = needs_browser
SCENE = """
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 0.1" rgba="0.6 0.7 0.6 1"/>
    <camera name="above" pos="0 0 2" fovy="40"/>
    <body name="arm" pos="0 0 0.5">
      <joint name="swing" type="hinge" axis="0 0 1"/>
      <geom type="box" size="0.3 0.1 0.1" pos="0.2 0 0" rgba="0.9 0.1 0.1 1"/>
      <camera name="riding" pos="0.2 0 0.6" fovy="70"/>
    </body>
  </worldbody>
</mujoco>
"""
ARM = 1


@pytest.fixture
def world(tmp_path: Path) -> World:
    (tmp_path / "arm.xml").write_text(SCENE)
    world = World()
    world.load_mjcf(tmp_path / "arm.xml")
    return world


@pytest.fixture
def opened(world: World, browser, monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(world, port=0)
    page = Page(browser, viewer.address, 1100, 700)
    page.until("window.app?.scene.poses.length > 0 && app.scene.groups.length > 0")
    yield page
    page.page.close()
    viewer.close()
    assert page.complaints == []


def split(page: Page, count: int) -> None:
    page.page.locator("#camera").evaluate("(section) => { section.open = true; }")
    page.page.locator("#views").get_by_text(str(count), exact=True).click()
    page.until(f"app.views.count === {count} && !app.views.newcomers.length && !app.stale")


def boxes(page: Page) -> list[list[float]]:
    return page.page.evaluate("app.views.cameras.map((it) => [it.left, it.top, it.width, it.height])")


def middle(page: Page, view: int) -> list[float]:
    """Where the middle of the arm is in a view [pixels of the window]."""
    place = "app.scene.inertialPose(app.scene.own.find(({name}) => name === 'arm').body, 1).position"
    return page.page.evaluate(f"app.views.cameras[{view}].pixel({place})")[:2]


def test_views_share_what_the_panel_and_the_time_bar_leave_free(opened: Page):
    assert boxes(opened) == [[0, 0, 1100, 700]]
    right = opened.page.evaluate("document.getElementById('panel').getBoundingClientRect().left")
    bottom = opened.page.evaluate("document.getElementById('timeline').getBoundingClientRect().top")
    split(opened, 4)
    found = np.array(boxes(opened))
    assert len({(width, height) for _, _, width, height in found.tolist()}) == 1
    assert (found[:, :2] + found[:, 2:] <= (right, bottom)).all()
    assert 2 * found[0, 2] > 0.98 * right
    assert 2 * found[0, 3] > 0.98 * bottom
    split(opened, 2)
    assert np.array(boxes(opened))[:, 3] == pytest.approx(found[0, 3] * 2 + 2)
    split(opened, 1)
    assert boxes(opened) == [[0, 0, 1100, 700]]


def test_each_view_shows_the_arm_where_its_camera_sees_it(opened: Page):
    split(opened, 4)
    places = [middle(opened, view) for view in range(4)]

    def is_red(picture) -> bool:
        found = [picture[round(y), round(x)] for x, y in places]
        return all(colour[0] > 1.5 * colour[1] and colour[0] > 1.5 * colour[2] for colour in found)

    opened.wait_for_picture(is_red)
    # From the side, from the front and from above: the views are not the same.
    corners = opened.page.evaluate(
        "app.views.cameras.map((it) => { const a = it.pixel([0, 0, 0.5]), b = it.pixel([0.4, 0, 0.5]);"
        " return [b[0] - a[0], b[1] - a[1]]; })"
    )
    assert abs(corners[1][0]) < 1
    assert corners[2][0] > 10
    assert abs(corners[2][1]) < 1


def test_dragging_turns_the_camera_of_the_view_under_the_pointer(opened: Page):
    split(opened, 2)
    before = opened.page.evaluate("app.views.cameras.map((it) => it.state())")
    left, top, width, _ = boxes(opened)[1]
    opened.page.mouse.move(left + 0.5 * width, top + 30)
    opened.page.mouse.down()
    opened.page.mouse.move(left + 0.5 * width + 50, top + 40, steps=3)
    opened.page.mouse.up()
    opened.until(f"app.views.cameras[1].yaw !== {before[1]['yaw']}")
    assert opened.page.evaluate("app.views.chosen.number") == 1
    assert opened.page.evaluate("app.camera.state()") == before[0]
    # What the panel does is for that view, too.
    opened.page.locator("#presets").get_by_text("left", exact=True).click()
    assert opened.page.evaluate("app.views.cameras[1].yaw") == 180
    assert opened.page.evaluate("app.camera.state()") == before[0]
    assert opened.page.locator(".pane select").nth(1).input_value() == "left"


@pytest.mark.parametrize("view", [0, 3])
def test_a_body_is_chosen_and_pulled_in_the_view_under_the_pointer(opened: Page, world: World, view: int):
    split(opened, 4)
    x, y = middle(opened, view)
    opened.page.mouse.click(x, y)
    opened.until("app.bodies.selected !== null")
    assert opened.page.evaluate("app.scene.bodies.get(app.bodies.selected).name") == "arm"
    opened.until_drawn()
    opened.page.mouse.move(x, y)
    opened.page.mouse.down()
    opened.page.mouse.move(x + 20, y + 5, steps=4)
    opened.until("app.grasp.held !== null")
    held = opened.page.evaluate("app.grasp.held.target")
    assert opened.page.evaluate("(at) => app.grasp.camera.pixel(at)", held)[:2] == pytest.approx(
        [x + 20, y + 5], abs=0.5
    )
    assert opened.page.evaluate("app.grasp.camera === app.views.cameras[app.views.chosen.number]")
    assert opened.page.evaluate("app.views.chosen.number") == view
    opened.page.mouse.up()


def test_a_view_through_a_camera_of_the_file_rides_along(opened: Page, world: World):
    split(opened, 2)
    opened.page.locator(".pane select").nth(1).select_option(label="riding")
    opened.until("app.views.cameras[1].lens !== null && !app.stale")
    assert opened.page.evaluate("app.camera.lens") is None
    eye = [round(x, 3) for x in opened.page.evaluate("app.views.cameras[1].eye")]
    assert eye == [0.2, 0, 1.1]
    world.bodies[ARM].joints["swing"].position = np.pi / 2
    world.step()
    opened.until("app.views.cameras[1].eye[1] > 0.19")
    # What its image does not contain is covered, in its view alone.
    assert opened.page.locator(".letterbox").nth(1).is_visible()
    assert not opened.page.locator(".letterbox").nth(0).is_visible()


def test_views_are_there_again_when_the_page_is_loaded_again(opened: Page):
    split(opened, 4)
    opened.page.locator(".pane select").nth(1).select_option("back")
    opened.page.locator(".pane select").nth(3).select_option(label="above")
    opened.until("app.views.cameras[3].lens !== null")
    kept = opened.page.evaluate("app.views.cameras[1].state()")
    opened.until_kept()
    opened.page.reload()
    opened.until("window.app?.views.count === 4 && app.views.cameras[3].lens !== null && !app.stale")
    assert opened.page.evaluate("app.views.cameras[1].state()") == kept
    assert opened.page.locator(".pane select").nth(1).input_value() == "back"
    split(opened, 1)
    opened.until_kept()
    opened.page.reload()
    opened.until("window.app?.scene.poses.length > 0 && !app.stale")
    assert opened.page.evaluate("app.views.count") == 1


def test_a_picture_has_all_views_and_nothing_of_the_panel(opened: Page):
    split(opened, 2)
    size = opened.page.evaluate(
        "(() => { const it = app.saving.shots.draw(); return [it.width, it.height]; })()"
    )
    assert size == [1100, 700]
    # Afterwards all is where it was.
    opened.until_drawn()
    assert boxes(opened)[1][0] + boxes(opened)[1][2] < 900


def test_the_whole_screen_comes_back_with_the_first_click(opened: Page):
    opened.page.locator("#full").click()
    opened.until("document.fullscreenElement !== null && app.memory.get('fullScreen') === true")
    opened.until_kept()
    opened.page.reload()
    opened.until("!!window.app?.fullScreen.waiting")
    # No page may do so by itself.
    assert opened.page.evaluate("document.fullscreenElement") is None
    assert "next click" in opened.page.locator("#full").get_attribute("title")
    opened.page.mouse.click(300, 30)
    opened.until("document.fullscreenElement !== null")
    opened.page.locator("#full").click()
    opened.until("document.fullscreenElement === null && app.memory.get('fullScreen') === false")
