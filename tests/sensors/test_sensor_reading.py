"""Sensors that a kernel reads show what NumPy finds for each of them, in one world and in many."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tests.algorithms.moving_robots import load
from tests.linearization.scenes import ASSETS, excite
from tests.linearization.test_sensors import add, add_all

from carom import Body, PositionActuator, World, Worlds
from carom.description import Pose
from carom.description.sensor import DISTANCE_KINDS, OF_STEPS, SensorKind
from carom.description.site import SiteShape
from carom.layouts import queries as layout
from carom.layouts.codes import JointCode
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.reading import reading
from carom.scene.sensors.table import is_in_table

ROBOTS = ("laikago", "panda", "humanoid")
SIZES = {
    SiteShape.SPHERE: (0.3,),
    SiteShape.CAPSULE: (0.2, 0.3),
    SiteShape.ELLIPSOID: (0.3, 0.2, 0.4),
    SiteShape.CYLINDER: (0.3, 0.2),
    SiteShape.BOX: (0.2, 0.3, 0.2),
}
TURN = (0.5, -0.5, 0.5, 0.5)


def add_others(body: Body) -> None:
    """Add those kinds of sensors that `add_all` leaves out, and some of limited quality."""
    last = len(body.spec.links) - 1
    for link in range(last + 1):
        body.add_site(f"at {link}", link, Pose((0.1, 0.02, -0.05), TURN))
        for kind in ("Force", "Torque"):
            add(body, kind, f"{kind} {link}", site=f"at {link}")
    for shape, size in SIZES.items():
        for link in (-1, last // 2, last):
            name = f"{shape.value} {link}"
            body.add_site(name, link, Pose((0.0, 0.01, 0.02), TURN), shape=shape, size=size)
            add(body, "Touch", f"touch {name}", site=name)
    add(body, "RangeFinder", site="at 0")
    joints = zip(body.joint_types, body.joints, strict=True)
    single = [it.name for code, it in joints if code in (JointCode.REVOLUTE, JointCode.PRISMATIC)]
    for number, joint in enumerate(single):
        add(body, "JointLimitForce", f"limit force of {joint}", joint=joint)
        if number < 2:
            body.add_actuator(f"servo {number}", PositionActuator(joint, kp=5.0))
            body.actuators[f"servo {number}"].control = 0.2
            for kind in ("ActuatorPosition", "ActuatorVelocity", "ActuatorForce"):
                add(body, kind, f"{kind} {number}", actuator=f"servo {number}")
            add(body, "JointActuatorForce", f"drive {number}", joint=joint)
    add(body, "Force", "short force", site="at 0", bias=0.3, cutoff=0.5)
    add(body, "Gyro", "noisy gyro", site="at 0", noise=0.2, seed=4, cutoff=0.4)
    add(body, "Accelerometer", "noisy imu", site="at 0", noise=0.2, seed=5, bias=(1.0, 2.0, 3.0))
    add(body, "Gyro", "late gyro", site="at 0", delay=0.01)
    add(body, "FrameQuaternion", "uncut", site="at 0", cutoff=0.1)


def equipped(name: str, floor: bool = False) -> tuple[World, Body]:
    world = World(contact="bullet")
    world.gravity = (0.3, -0.2, -9.81)
    if floor:
        world.load_urdf(f"{ASSETS}/plane.urdf")
    body = load(world, name)
    excite(body)
    add_all(body)
    add_others(body)
    return world, body


def assert_shown(world: World, body: Body) -> None:
    """Compare what a kernel reads with what NumPy finds."""
    source, shown = LoneSource(world), body.sensors.read()
    for sensor in body.sensors:
        wanted = reading(source, body, sensor.index)[0]
        scale = max(1.0, float(np.abs(wanted).max()))
        if sensor.spec.kind in OF_STEPS:
            # They are differences of velocities, divided by the step.
            scale = max(scale, float(np.abs(world.velocity).max()) / world.parameters.time_step)
        assert_allclose(shown[sensor.name], wanted, rtol=0.0, atol=1e-12 * scale, err_msg=sensor.name)
        assert_array_equal(sensor.read(), shown[sensor.name], err_msg=sensor.name)


def test_kinds_and_shapes_have_the_numbers_that_kernels_know() -> None:
    # No kernel reads sensors of contacts and distances.
    unknown = (SensorKind.CONTACT, *DISTANCE_KINDS)
    known = [*SensorKind][: -len(unknown)]
    assert [getattr(layout, kind.name) for kind in known] == list(range(len(known)))
    assert (*known, *unknown) == (*SensorKind,)
    assert [getattr(layout, f"{shape.name}_VOLUME") for shape in SiteShape] == list(range(len(SiteShape)))


def test_the_scenes_have_all_kinds() -> None:
    found = {spec.kind for name in ROBOTS for spec in equipped(name)[1].spec.sensors}
    tendons = {SensorKind.TENDON_POSITION, SensorKind.TENDON_VELOCITY, SensorKind.TENDON_ACTUATOR_FORCE}
    assert set(SensorKind) - found == {*tendons, SensorKind.CONTACT, *DISTANCE_KINDS}
    body = equipped("panda")[1]
    alone = [it.kind for it in body.spec.sensors if not it.is_clocked and not is_in_table(body, it)]
    assert alone == [SensorKind.RANGE_FINDER]


@pytest.mark.parametrize("floor", [False, True])
@pytest.mark.parametrize("name", ROBOTS)
def test_a_kernel_reads_what_numpy_finds(name: str, floor: bool, tmp_path: Path) -> None:
    world, body = equipped(name, floor)
    worlds = Worlds(world, 5, threads=1)
    assert_shown(world, body)
    for steps in (1, 2, 30):
        world.step(steps)
        worlds.step(steps)
        assert_shown(world, body)
        many = worlds.bodies[body.id].sensors.read()
        for sensor_name, shown in body.sensors.read().items():
            if body.sensors[sensor_name].noise == 0.0:
                assert_array_equal(many[sensor_name], np.tile(shown, (5, 1)), err_msg=sensor_name)
            assert_array_equal(many[sensor_name], worlds.bodies[body.id].sensors[sensor_name].read())
            assert_array_equal(many[sensor_name][0], shown, err_msg=sensor_name)
    now, state = body.sensors.read(), world.snapshot()
    world.save(tmp_path / "world.carom")
    copied, loaded = world.copy(), World()
    loaded.load(tmp_path / "world.carom")
    world.step(3)
    world.restore(state)
    for other in (world, copied, loaded):
        for sensor_name, shown in other.bodies[body.id].sensors.read().items():
            assert_array_equal(shown, now[sensor_name], err_msg=sensor_name)


def test_sensors_are_read_again_after_each_change() -> None:
    world, body = equipped("panda")
    world.step(2)
    name = body.joints.movable[0].name
    for position in (0.1, 0.2):
        body.joints.movable[0].reset(position, 2.0 * position)
        assert body.sensors[f"JointPosition of {name}"].read() == position
        assert_shown(world, body)
    # Numbers that are written past the handles, and rows that move.
    world.position[body.position_index[body.joints.movable[0].index]] = -0.4
    assert body.sensors.read()[f"JointPosition of {name}"] == -0.4
    world.load_urdf(f"{ASSETS}/plane.urdf")
    add(body, "Gyro", "later", site="at 1")
    assert_shown(world, body)


def loads_of(body: Body) -> np.ndarray:
    """What force and torque sensors show."""
    shown = body.sensors.read()
    names = [it.name for it in body.sensors if it.spec.kind in (SensorKind.FORCE, SensorKind.TORQUE)]
    return np.concatenate([shown[name] for name in names])


def is_left(world: World, body: Body) -> bool:
    """Whether the last step has left its loads to be found when they are read."""
    return bool(world.arrays.state.numpy["tree_load_step"][0, body.rows.tree, 3] > 0.0)


def push_free(world: World, body: Body) -> None:
    """Let nothing act on the body."""


def push_fluid(world: World, body: Body) -> None:
    """Let a fluid act on the body."""
    world.change_parameters(fluid_density=1.0)


def push_user(world: World, body: Body) -> None:
    """Apply a force and a torque that last for one step."""
    body.links[-1].apply_force((10.0, 20.0, -30.0))
    body.links[1].apply_torque((1.0, 2.0, -3.0))


@pytest.mark.parametrize("floor", [False, True])
@pytest.mark.parametrize("push", [push_free, push_fluid, push_user])
@pytest.mark.parametrize("name", ROBOTS)
def test_forces_found_when_read_are_those_measured_in_the_step(
    name: str, push: Callable[[World, Body], None], floor: bool
) -> None:
    world, body = equipped(name, floor)
    eager, same = equipped(name, floor)
    # Without the motion of a tree its loads are measured in the step.
    eager.arrays.model.numpy["tree_is_followed"][same.rows.tree] = 0
    for _ in range(15):
        for scene, pushed in ((world, body), (eager, same)):
            scene.step()
            push(scene, pushed)
            scene.step()
        assert is_left(world, body) and not is_left(eager, same)
        wanted = loads_of(same)
        scale = max(1.0, float(np.abs(wanted).max()))
        assert_allclose(loads_of(body), wanted, rtol=0.0, atol=1e-12 * scale)
        assert not is_left(world, body)


SPRINGY = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="trunk" pos="0 0 0.4">
      <freejoint/>
      <geom type="box" size="0.2 0.1 0.1"/>
      <body name="thigh" pos="0.2 0 0">
        <joint name="hip" axis="0 1 0" armature="0.1" damping="0.5" stiffness="3" springref="20"/>
        <geom type="capsule" size="0.05" fromto="0 0 0 0.1 0 -0.2"/>
        <body name="shank" pos="0.1 0 -0.2">
          <joint name="knee" axis="0 1 0" armature="0.02" damping="0.2"/>
          <geom type="capsule" size="0.05" fromto="0 0 0 -0.1 0 -0.2"/>
        </body>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="knee" joint2="hip" polycoef="0 0.5 0 0 0"/></equality>
</mujoco>
"""


def test_forces_found_when_read_count_springs_armature_and_couplings(tmp_path: Path) -> None:
    (tmp_path / "springy.xml").write_text(SPRINGY)
    scenes = []
    for followed in (True, False):
        world = World(contact="bullet")
        body = next(it for it in world.load_mjcf(tmp_path / "springy.xml") if it.joint_count)
        world.gravity = (0.0, 0.0, -9.81)
        for link in range(body.joint_count):
            body.add_site(f"at {link}", link, Pose((0.1, 0.02, -0.05), TURN))
            for kind in ("Force", "Torque"):
                add(body, kind, f"{kind} {link}", site=f"at {link}")
        if not followed:
            world.arrays.model.numpy["tree_is_followed"][body.rows.tree] = 0
        scenes.append((world, body))
    coupled = pushed = False
    for _ in range(100):
        for world, _body in scenes:
            world.step(2)
        state, tree = scenes[0][0].arrays.state.numpy, scenes[0][1].rows.tree
        coupled = coupled or bool(state["dof_coupling"].any())
        pushed = pushed or bool(state["tree_is_pushed"][0, tree])
        assert is_left(*scenes[0]) and not is_left(*scenes[1])
        wanted = loads_of(scenes[1][1])
        scale = max(1.0, float(np.abs(wanted).max()))
        assert_allclose(loads_of(scenes[0][1]), wanted, rtol=0.0, atol=1e-12 * scale)
    assert coupled and pushed


def test_the_floor_acts_on_bodies_and_forces_from_outside_last_one_step() -> None:
    pushed = []
    for name in ROBOTS:
        world, body = equipped(name, floor=True)
        world.step(60)
        pushed.append(bool(world.arrays.state.numpy["tree_is_pushed"][0, body.rows.tree]))
        push_user(world, body)
        world.step()
        assert world.arrays.state.numpy["link_applied"][0].any()
        world.step()
        assert not world.arrays.state.numpy["link_applied"][0].any()
    assert any(pushed)


def test_forces_of_several_substeps_are_measured_in_the_step() -> None:
    world, body = equipped("panda")
    world.change_parameters(substeps=2)
    world.step()
    assert not is_left(world, body)
    world.change_parameters(substeps=1)
    world.step()
    assert is_left(world, body)


def test_with_sensors_of_bullet_forces_are_measured_in_the_step() -> None:
    world, body = equipped("panda")
    body.set_sensor(2, True)
    world.step()
    assert not is_left(world, body)
    body.set_sensor(2, False)
    world.step()
    assert is_left(world, body)


def test_forces_stay_those_of_the_last_step_of_a_body_that_is_absent() -> None:
    world, body = equipped("panda")
    world.step(3)
    other = world.copy()
    wanted = loads_of(other.bodies[body.id])
    body.present = False
    world.step(2)
    assert_array_equal(loads_of(body), wanted)
