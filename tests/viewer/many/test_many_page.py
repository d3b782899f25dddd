"""The page of many worlds in a real browser."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet_data
from carom import World, Worlds
from carom.viewer import Viewer

pytestmark = [needs_browser, pytest.mark.long]
DATA = pybullet_data.getDataPath()
CUBE = 1


@pytest.fixture
def worlds() -> Worlds:
    world = World()
    world.parameters.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{DATA}/plane.urdf", fixed_base=True)
    world.load_urdf(f"{DATA}/cube_small.urdf", position=(0.0, 0.0, 0.5))
    return Worlds(world, 12)


@pytest.fixture
def many(worlds: Worlds, browser, monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(worlds, port=0, shown=9, spacing=1.0)
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.worlds?.facts && app.scene.poses.length > 0 && !app.stale")
    yield page
    page.page.close()
    viewer.close()
    assert page.complaints == []


def test_the_panel_tells_and_chooses_the_worlds(many: Page):
    panel = many.page.locator("#worlds")
    assert panel.is_visible()
    assert many.page.locator("#worlds-count").text_content() == "9 of 12"
    assert many.page.locator("#world").input_value() == "0"
    assert many.page.locator("#worlds-shown").input_value() == "9"
    many.page.locator("#world-after").click()
    many.until("app.worlds.facts.chosen === 1")
    assert many.page.locator("#world").input_value() == "1"
    many.page.locator("#world").fill("11")
    many.page.locator("#world").press("Enter")
    many.until("app.worlds.facts.chosen === 11")
    many.page.locator("#worlds-shown").select_option("4")
    many.until("app.worlds.facts.shown.join() === '8,9,10,11'")
    # After the last one comes the first one.
    many.page.locator("#world-after").click()
    many.until("app.worlds.facts.chosen === 0")
    many.page.locator("#worlds-arrangement").select_option("overlay")
    many.until("app.worlds.facts.arrangement === 'overlay' && app.worlds.facts.size === 0")


def test_a_click_on_a_body_chooses_its_world_and_the_body_there(many: Page):
    many.page.evaluate("app.viewpoint.change(() => app.viewpoint.fit())")
    many.until_drawn()
    x, y = many.page.evaluate(
        "app.camera.pixel(app.scene.inertialPose("
        "[...app.scene.bodies.values()].find(({world}) => world === 8).body, 0).position)"
    )[:2]
    many.page.mouse.click(x, y)
    many.until("app.worlds.facts.chosen === 8")
    assert many.page.evaluate("app.bodies.selected") == CUBE
    many.page.wait_for_selector("#body-card:not([hidden])")
    # Only the bodies of the chosen world are listed.
    assert many.page.locator("#bodies-count").text_content() == "2"


def test_a_body_that_is_dragged_is_pulled_in_its_world(many: Page, worlds: Worlds):
    many.page.evaluate("app.viewpoint.change(() => app.viewpoint.fit())")
    many.until_drawn()
    x, y = many.page.evaluate(
        "app.camera.pixel(app.scene.inertialPose("
        "[...app.scene.bodies.values()].find(({world}) => world === 4).body, 0).position)"
    )[:2]
    many.page.locator("#pause").click()
    many.until("app.panel.paused")
    many.page.mouse.move(x, y)
    many.page.mouse.down()
    many.page.mouse.move(x, y - 60, steps=5)
    many.until(
        "app.scene.inertialPose([...app.scene.bodies.values()]"
        ".find(({world}) => world === 4).body, 0).position[2] > 0.55"
    )
    many.page.mouse.up()
    heights = worlds["cube.urdf"].base_inertial_poses[:, 2]
    assert heights[4] > 0.55
    assert (heights[[0, 1, 2, 3, 5]] == 0.5).all()


def test_each_world_in_the_grid_has_its_number(many: Page):
    labels = many.page.locator("#labels span")
    many.until("document.querySelectorAll('#labels span').length >= 9")
    texts = set(labels.all_text_contents())
    assert {f"world {number}" for number in range(9)} & texts
    assert many.page.evaluate("app.worlds.facts.cells.length") == 9


def test_sliders_drive_the_joints_of_the_world_that_is_looked_at(browser, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("CI", "true")
    world = World()
    cart = world.load_urdf(f"{DATA}/cartpole.urdf", fixed_base=True)
    cart.joints.free()
    worlds = Worlds(world, 6)
    viewer = Viewer(worlds, port=0, shown=4)
    page = Page(browser, viewer.address, 900, 640)
    page.until("window.app?.worlds?.facts && app.scene.poses.length > 0 && !app.stale")
    page.page.evaluate("app.bodies.select(0), document.getElementById('bodies').open = true")
    page.page.locator("#pause").click()
    page.until("app.panel.paused")

    def slide(value: str) -> None:
        page.page.locator("#body-card .slider input[type=range]").first.evaluate(
            "(it, value) => { it.value = value; it.dispatchEvent(new Event('input')); }", value
        )

    def carts() -> list[float]:
        return worlds["physics"].joints.positions[:, 0].tolist()

    slide("0.5")
    wait_for(lambda: carts() == [0.5, 0, 0, 0, 0, 0], page)
    page.page.locator("#world-after").click()
    page.until("app.worlds.facts.chosen === 1")
    # The sliders are now those of that world, which nobody has moved.
    page.until("document.querySelector('#body-card .slider input[type=range]').value === '0'")
    slide("0.25")
    wait_for(lambda: carts() == [0.5, 0.25, 0, 0, 0, 0], page)
    # What there is not says so.
    page.page.locator("#view").press("d")
    page.page.get_by_text("Key d has no effect here").wait_for()
    page.page.close()
    viewer.close()
    assert page.complaints == []
