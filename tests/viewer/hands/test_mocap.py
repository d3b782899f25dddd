"""Mocap bodies of MJCF files follow the mouse as it is: no force moves them, nor do they need a step."""

import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.patience import until
from tests.viewer.browser import Page, needs_browser, wait_for
from tests.viewer.watcher import Watcher

from carom import World
from carom.scene.body import Body
from carom.viewer.viewer import Viewer

SCENE = """<mujoco>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body name="target" mocap="true" pos="0.5 0 0.5">
      <geom type="box" size="0.05 0.05 0.05"/>
      <body name="flag" pos="0 0 0.2"><geom type="sphere" size="0.02"/></body>
    </body>
    <body name="post" pos="-1 0 0.5"><geom type="box" size="0.05 0.05 0.5"/></body>
  </worldbody>
</mujoco>"""


@pytest.fixture
def world(tmp_path: Path) -> World:
    file = tmp_path / "scene.xml"
    file.write_text(SCENE)
    world = World()
    world.load(file)
    return world


@pytest.fixture
def page(world: World) -> Iterator[Watcher]:
    viewer = Viewer(world, port=0)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("layout", None) in page.shown)
        yield page
    viewer.close()


def named(world: World, name: str) -> Body:
    return next(body for body in world.bodies.values() if body.name == name)


def is_at(body: Body, *place: float) -> bool:
    return math.dist(body.links[-1].pose.position, place) < 1e-6


def test_a_mocap_body_follows_the_mouse_without_a_step(world: World, page: Watcher):
    target = named(world, "target")
    page.tell("grasp", body=target.id, link=-1, point=[0.0, 0.05, 0.0], target=[0.5, 0.05, 0.5])
    page.tell("pull", target=[0.7, 0.25, 0.9])
    assert until(lambda: is_at(target, 0.7, 0.2, 0.9))
    assert not world.user_constraints.all
    world.step(10)
    assert is_at(target, 0.7, 0.2, 0.9)
    # By a part of it, which is fixed to it.
    page.tell("let go")
    page.tell("grasp", body=target.id, link=0, point=[0, 0, 0], target=[0.0, 0.0, 0.2])
    assert until(lambda: is_at(target, 0.0, 0.0, 0.0))


def test_a_mocap_body_is_turned_at_once(world: World, page: Watcher):
    target = named(world, "target")
    half = math.sqrt(0.5)
    page.tell("turn", body=target.id, link=-1, orientation=[0, 0, half, half])
    assert until(lambda: target.links[-1].pose.orientation == pytest.approx((0, 0, half, half)))
    assert is_at(target, 0.5, 0, 0.5)
    page.tell("let go")


def test_pages_let_the_mouse_grasp_what_follows_it(world: World, page: Watcher):
    bodies = {body.name: body for body in world.bodies.values()}
    moves = {name: page.shown["body", body.id]["links"][0]["moves"] for name, body in bodies.items()}
    assert moves == {"world": False, "target": True, "post": False}
    page.tell("grasp", body=bodies["post"].id, link=-1, point=[0, 0, 0], target=[0, 0, 2])
    page.tell("pull", target=[0, 0, 3])
    page.tell("grasp", body=bodies["target"].id, link=-1, point=[0, 0, 0], target=[0, 1, 0.5])
    assert until(lambda: is_at(bodies["target"], 0, 1, 0.5))
    assert is_at(bodies["post"], -1, 0, 0.5)


@pytest.mark.long
@needs_browser
@pytest.mark.parametrize("paused", [False, True])
def test_the_mouse_moves_a_mocap_body_in_the_page(world: World, browser, paused: bool):
    viewer, target = Viewer(world, port=0), named(world, "target")
    viewer.pause(paused)
    page = Page(browser, viewer.address, 800, 480)
    page.until("window.app?.scene.groups.length > 0")
    # From the front: x points to the right.
    page.page.evaluate("Object.assign(app.camera, { distance: 3, yaw: 0, pitch: 0, target: [1.2, 0, 0.5] })")
    page.page.evaluate("app.camera.update()")
    x, y, _ = page.page.evaluate("app.camera.pixel([0.5, 0, 0.5])")
    right, top, _ = page.page.evaluate("app.camera.pixel([0.8, 0, 0.7])")
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    page.page.mouse.move(right, top, steps=4)
    wait_for(lambda: math.dist(target.links[-1].pose.position, (0.8, 0, 0.7)) < 0.02, page)
    page.page.mouse.up()
    place = target.links[-1].pose.position
    page.page.mouse.move(x, y)
    page.page.wait_for_timeout(200)
    assert is_at(target, *place)
    assert page.complaints == []
    viewer.close()


def test_copies_and_files_know_mocap_bodies(world: World, tmp_path: Path):
    world.save(tmp_path / "saved.carom")
    loaded = World()
    loaded.load_saved(tmp_path / "saved.carom")
    for each in (world.copy(), loaded):
        assert {body.name: body.spec.is_mocap for body in each.bodies.values()}["target"]
