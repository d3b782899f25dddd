"""Driving joints and turning bodies of some of many worlds, as in a single one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.patience import until
from tests.viewer.watcher import Watcher

from carom import World, Worlds
from carom.viewer import Viewer

COUNT = 8
CHOSEN = 3
SCENE = """
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body name="arm" pos="0 0 1">
      <joint name="swing" axis="0 1 0" damping="0.5"/>
      <geom type="box" size="0.3 0.05 0.05" pos="0.3 0 0" density="1000"/>
    </body>
    <body name="stick" pos="0 1 1"><freejoint/><geom type="box" size="0.3 0.05 0.05" density="1000"/></body>
    <body name="reel" pos="0 -1 1">
      <joint name="roll" axis="1 0 0" damping="0.5"/>
      <geom type="sphere" size="0.1"/>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="roll" ctrlrange="-5 5"/></actuator>
</mujoco>
"""


@pytest.fixture
def worlds(tmp_path: Path) -> Worlds:
    (tmp_path / "scene.xml").write_text(SCENE)
    world = World()
    world.load_mjcf(tmp_path / "scene.xml")
    return Worlds(world, COUNT)


@pytest.fixture
def page(worlds: Worlds, monkeypatch: pytest.MonkeyPatch) -> Iterator[Watcher]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(worlds, port=0, shown=4, chosen=CHOSEN)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: page.frame and page.frame["layout"] == page.shown["layout", None]["layout"])
        yield page
    viewer.close()


def number_of(page: Watcher, name: str) -> int:
    """The body of the chosen world with a name."""
    return next(
        number
        for (kind, number), facts in page.shown.items()
        if kind == "body" and facts["name"] == name and "world" not in facts
    )


def others() -> list[int]:
    return [world for world in range(COUNT) if world != CHOSEN]


def step_until(worlds: Worlds, done: Any) -> None:
    def stepped() -> bool:
        worlds.step(10)
        return bool(done())

    assert until(stepped)


def test_a_slider_drives_the_joint_of_the_chosen_world_alone(worlds: Worlds, page: Watcher):
    arm = number_of(page, "arm")
    joint = worlds["arm"].joints["swing"]
    page.tell("drive", body=arm, joint=0, mode="position", target=0.7)
    step_until(worlds, lambda: abs(joint.position[CHOSEN] - 0.7) < 0.02)
    assert (joint.position[others()] == 0.0).all()
    # Given back, its motor is as before: nothing holds it.
    page.tell("give back", body=arm, joint=0)
    joint.reset(0.7, where=[CHOSEN])
    step_until(worlds, lambda: joint.motor_torque[CHOSEN] == 0.0)
    worlds.step(200)
    assert joint.position[CHOSEN] == pytest.approx(0.7, abs=1e-3)


def test_while_paused_a_slider_puts_the_joint_there(worlds: Worlds, page: Watcher):
    page.tell("pause", paused=True)
    page.wait_for(lambda: page.shown["pause", None]["paused"])
    page.tell("want", joints="all")
    page.tell("drive", body=number_of(page, "arm"), joint=0, mode="position", target=-0.4)
    assert until(lambda: worlds["arm"].joints["swing"].position[CHOSEN] == -0.4)
    assert (worlds["arm"].joints["swing"].position[others()] == 0.0).all()
    assert (worlds.time == 0.0).all()
    # Pages see it at once.
    page.wait_for(
        lambda: "joints" in page.blocks and np.isclose(page.blocks["joints"][:, 2], -0.4, atol=1e-6).any()
    )


@pytest.mark.parametrize("mode", ["velocity", "torque"])
def test_sliders_set_velocities_and_torques_too(worlds: Worlds, page: Watcher, mode: str):
    page.tell("drive", body=number_of(page, "arm"), joint=0, mode=mode, target=0.5)
    joint = worlds["arm"].joints["swing"]
    step_until(worlds, lambda: joint.position[CHOSEN] > 0.2)
    assert (joint.position[others()] == 0.0).all()


def test_the_control_of_an_actuator_is_that_of_the_chosen_world(worlds: Worlds, page: Watcher):
    page.tell("control", body=number_of(page, "reel"), actuator=0, control=2.0)
    motor = worlds["reel"].actuators["motor"]
    assert until(lambda: motor.control[CHOSEN] == 2.0)
    assert (motor.control[others()] == 0.0).all()
    page.tell("control", body=number_of(page, "reel"), actuator=7, control=2.0)
    page.tell("drive", body=number_of(page, "reel"), joint=5, mode="position", target=1.0)
    page.tell("drive", body=99, joint=0, mode="position", target=1.0)
    page.tell("control", body=number_of(page, "reel"), actuator=0, control=3.0)
    assert until(lambda: motor.control[CHOSEN] == 3.0)


@pytest.mark.parametrize(("name", "axis"), [("stick", 2), ("arm", 1)])
def test_a_body_is_turned_in_its_world(worlds: Worlds, page: Watcher, name: str, axis: int):
    half = 0.3
    target = [0.0, 0.0, 0.0, float(np.cos(half))]
    target[axis] = float(np.sin(half))
    link = -1 if name == "stick" else 0
    page.tell("turn", body=number_of(page, name), link=link, orientation=target)
    batch = worlds[name]

    def is_there() -> bool:
        turned = batch.pose.orientation if name == "stick" else None
        angle = batch.joints["swing"].position if turned is None else 2.0 * np.arcsin(turned[:, axis])
        return bool(
            abs(angle[CHOSEN] - 2.0 * half) < 0.02 and (np.abs(np.delete(angle, CHOSEN)) < 1e-9).all()
        )

    step_until(worlds, is_there)
    assert not worlds.halted.any()
    page.tell("let go")


def test_while_paused_a_free_body_is_turned_at_once(worlds: Worlds, page: Watcher):
    page.tell("pause", paused=True)
    page.wait_for(lambda: page.shown["pause", None]["paused"])
    page.tell("turn", body=number_of(page, "stick"), link=-1, orientation=[0, 0, 1, 1])
    half = np.sqrt(0.5)
    assert until(lambda: np.allclose(worlds["stick"].pose.orientation[CHOSEN], [0, 0, half, half]))
    assert np.allclose(worlds["stick"].pose.orientation[others()], [0, 0, 0, 1])
    assert np.allclose(worlds["stick"].pose.position[CHOSEN], [0, 1, 1])
