"""The window drives actuators of MJCF files, plots their sensors and draws their tendons."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.patience import until
from tests.viewer.browser import Page, wait_for
from tests.viewer.watcher import Watcher

from carom import World
from carom.viewer import readings
from carom.viewer.viewer import Viewer
from carom.world.scene import Scene

ARM = """<mujoco>
  <worldbody>
    <site name="post" pos="-.4 0 1.05"/>
    <body name="arm" pos="0 0 1">
      <joint name="shoulder" axis="0 1 0" range="-60 60"/>
      <geom name="ball" size=".1"/>
      <geom size=".05" pos=".3 0 0"/>
      <site name="tip" pos=".3 0 0"/>
      <body name="hand" pos=".3 0 0">
        <joint name="wrist" axis="0 1 0"/>
        <geom size=".03" pos=".1 0 0"/>
        <site name="end" pos=".1 0 -.2"/>
      </body>
    </body>
  </worldbody>
  <tendon>
    <spatial name="cord" range="0 .3"><site site="post"/><geom geom="ball"/><site site="end"/></spatial>
    <fixed name="sum"><joint joint="shoulder" coef="1"/></fixed>
  </tendon>
  <actuator>
    <motor name="torque" joint="shoulder" ctrlrange="-2 3"/>
    <position name="servo" joint="shoulder" kp="5" gear="2"/>
    <intvelocity name="integrated" joint="wrist" actrange="-1 1"/>
  </actuator>
  <sensor>
    <framepos name="place" objtype="site" objname="tip"/>
    <jointpos name="angle" joint="wrist"/>
  </sensor>
</mujoco>"""


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    (tmp_path / "arm.xml").write_text(ARM)
    return World().load(tmp_path / "arm.xml")


@pytest.fixture
def page(scene: Scene) -> Iterator[Watcher]:
    viewer = Viewer(scene.world, port=0)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("body", scene["arm"].id) in page.shown)
        yield page
    viewer.close()


def test_a_page_is_told_of_actuators_and_sensors(scene: Scene, page: Watcher):
    told = page.shown["body", scene["arm"].id]
    assert [it["name"] for it in told["actuators"]] == ["torque", "servo", "integrated"]
    third = np.pi / 3.0
    assert_allclose([it["range"] for it in told["actuators"]], [[-2, 3], [-2 * third, 2 * third], [-1, 1]])
    assert told["sensors"] == [
        {"name": "place", "kind": scene.sensors["place"].spec.kind.value, "size": 3},
        {"name": "angle", "kind": scene.sensors["angle"].spec.kind.value, "size": 1},
    ]


def test_a_slider_sets_the_control_of_an_actuator(scene: Scene, page: Watcher):
    body = scene["arm"]
    page.tell("control", body=body.id, actuator=0, control=1.5)
    page.tell("control", body=body.id, actuator=7, control=1.0)
    page.tell("control", body=99, actuator=0, control=1.0)
    assert until(lambda: scene.actuators["torque"].control == 1.5)
    scene.world.step()
    page.tell("want", joints=[body.id])
    page.wait_for(lambda: page.frame.get("time", 0.0) > 0.0 and "actuators" in page.blocks)
    rows = page.blocks["actuators"]
    assert rows[:, :2].tolist() == [[body.id, 0], [body.id, 1], [body.id, 2]]
    assert rows[0, 2:4].tolist() == [1.5, 1.5]
    assert np.isnan(rows[:, 4]).tolist() == [True, True, False]


def test_sensors_are_read_while_a_page_plots_them(scene: Scene, page: Watcher):
    body = scene["arm"]
    page.wait_for(lambda: page.frame)
    assert "sensors" not in page.blocks
    scene.world.step(50)
    page.tell("want", sensors=[body.id, 99])
    page.wait_for(lambda: len(page.blocks.get("sensors", ())))
    rows = page.blocks["sensors"]
    assert rows[:, :3].tolist() == [[body.id, 0, 0], [body.id, 0, 1], [body.id, 0, 2], [body.id, 1, 0]]
    values = [*scene.sensors["place"].read(), *scene.sensors["angle"].read()]
    assert_allclose(rows[:, 3], values, rtol=1e-6, atol=1e-7)
    page.tell("want", sensors=[])
    page.wait_for(lambda: "sensors" not in page.blocks)


def test_tendons_are_drawn_along_their_paths(scene: Scene, page: Watcher):
    scene.world.step()
    page.tell("want", tendons=True)
    page.wait_for(lambda: page.frame.get("time", 0.0) > 0.0 and "tendons" in page.blocks)
    rows = page.blocks["tendons"]
    start, end = rows[:, 1:4], rows[:, 4:7]
    assert len(rows) > 2
    assert_allclose(start[0], (-0.4, 0, 1.05), rtol=1e-6)
    assert_allclose(end[-1], scene["arm"].sites["end"].pose.position, atol=1e-6)
    assert_allclose(start[1:], end[:-1], atol=1e-6)
    # Pieces of the arc are on the ball, and hardly shorter than it.
    assert_allclose(np.linalg.norm(start[1:] - (0, 0, 1), axis=1), 0.1, atol=1e-6)
    length = np.linalg.norm(end - start, axis=1).sum()
    assert_allclose(length, scene.tendons["cord"].length, rtol=2e-3)
    assert (rows[:, 8] == 1.0).all()
    assert_allclose(rows[:, 7], scene.tendons["cord"].force, rtol=1e-5)


def set_value(page: Page, selector: str, value: str) -> None:
    """Change an element of a folded part of the panel."""
    page.page.evaluate(
        "([selector, value]) => { const element = document.querySelector(selector); element.value = value;"
        " element.dispatchEvent(new Event('change')); }",
        [selector, value],
    )


@pytest.mark.long
def test_a_page_has_sliders_plots_and_lines(scene: Scene, browser):
    viewer, body = Viewer(scene.world, port=0), scene["arm"]
    page = Page(browser, viewer.address)
    page.until("window.app?.scene.layout.layout > 0")
    page.page.evaluate(f"app.bodies.select({body.id})")
    set_value(page, "[title='Value of torque']", "2.5")
    wait_for(lambda: scene.actuators["torque"].control == 2.5, page)
    scene.world.step()
    page.until(f"app.readings.actuators.get('{body.id},0')?.force > 2")
    slider = page.page.locator(".slider", has=page.page.locator(f"#actuator-{body.id}-0"))
    page.page.evaluate("app.bodies.show()")
    assert slider.locator(".now").text_content() == "force 2.50"
    set_value(page, "#joint", f"reading {body.id},0")
    set_value(page, "#joint", f"actuator {body.id},0")
    scene.world.step(20)
    # The cord is pulled hard, so it is at times round the ball and at times not.
    pieces = readings.tendons(scene.world)[0]

    def drawn() -> bool:
        """Whether the page draws the present ones, and no longer those of a frame before."""
        ends = page.page.evaluate("app.readings.tendons.map(({ start, end }) => [...start, ...end])")
        return len(ends) == len(pieces) and np.allclose(ends, pieces[:, 1:7], rtol=1e-6, atol=1e-6)

    wait_for(drawn, page)
    page.until(f"app.readings.sensors.get('{body.id},0')?.length === 3")
    page.until(f"app.plots.plotted.get('reading {body.id},0').samples.at(-1)?.values[0].length === 3")
    page.until(f"app.plots.plotted.get('actuator {body.id},0').samples.at(-1)?.values[0][0] === 2.5")
    assert page.complaints == []
    viewer.close()
