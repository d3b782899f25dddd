"""Parameters that differ from world to world: each world is the one that has them alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.physics.contact_scenes import add_box, add_floor, earth
from tests.worlds.same_bits import assert_same_bits

import pybullet_data
from carom import Body, World, Worlds
from carom.layouts.codes import UserConstraintKind
from carom.layouts.contacts import SORTED

COUNT, STEPS = 4, 60
# What has an effect only where the other body has it as well.
_OF_PAIRS = ("restitution", "spinning_friction", "contact_damping")
VALUES = np.array([0.2, 0.5, 1.0, 1.7])


def panda_world() -> tuple[World, Body]:
    world = earth()
    panda = world.load_urdf(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True)
    panda.joints.set_velocity_targets(0.3, max_forces=20.0)
    return world, panda


def box_world() -> tuple[World, Body]:
    world = earth()
    add_floor(world)
    box = add_box(world, (0.0, 0.0, 0.12))
    box.set_base_velocity((1.0, 0.3, -0.5), (0.2, 0.1, 3.0))
    return world, box


def assert_each_is_alone(scene: World, worlds: Worlds, change: Callable[[World, float], None]) -> list[World]:
    worlds.step(STEPS)
    alone = []
    for number, value in enumerate(VALUES.tolist()):
        lone = scene.copy()
        change(lone, value)
        lone.step(STEPS)
        assert_same_bits(worlds, number, lone)
        alone.append(lone)
    return alone


@pytest.mark.parametrize(
    "name",
    [
        "mass",
        "lateral_friction",
        "restitution",
        "rolling_friction",
        "spinning_friction",
        "linear_damping",
        "angular_damping",
        "contact_stiffness",
        "contact_damping",
    ],
)
def test_a_sliding_box(name: str) -> None:
    scene, box = box_world()
    worlds = Worlds(scene, COUNT, threads=2)
    scale = 1e4 if name == "contact_stiffness" else 1.0
    worlds[box].change_dynamics(-1, **{name: scale * VALUES})

    def change(world: World, value: float) -> None:
        world.bodies[box.id].change_dynamics(-1, **{name: scale * value})

    alone = assert_each_is_alone(scene, worlds, change)
    rows = slice(box.first_position, box.first_position + 7)
    ends = {tuple(world.position[rows]) for world in alone}
    # Something else than the box itself has to have them, too.
    assert name in _OF_PAIRS or len(ends) > 1


@pytest.mark.parametrize("link", [2, "panda_link3", "panda_hand"])
@pytest.mark.parametrize("name", ["mass", "joint_damping", "max_joint_velocity"])
def test_an_arm(name: str, link: int | str) -> None:
    scene, panda = panda_world()
    worlds = Worlds(scene, COUNT, threads=2)
    worlds[panda].change_dynamics(link, **{name: VALUES})
    index = panda.links[link].index

    def change(world: World, value: float) -> None:
        world.bodies[panda.id].change_dynamics(index, **{name: value})

    assert_each_is_alone(scene, worlds, change)


def test_limits_of_a_joint() -> None:
    scene, panda = panda_world()
    worlds = Worlds(scene, COUNT, threads=2)
    upper = 0.02 * VALUES
    worlds[panda].change_dynamics(0, joint_lower_limit=-0.1, joint_upper_limit=upper)

    def change(world: World, value: float) -> None:
        body = world.bodies[panda.id]
        body.change_dynamics(0, joint_lower_limit=-0.1, joint_upper_limit=0.02 * value)

    assert_each_is_alone(scene, worlds, change)
    assert (worlds[panda].joints.positions[:, 0] < upper + 1e-3).all()


@pytest.mark.parametrize(
    "name", ["joint_armature", "joint_stiffness", "joint_damping", "joint_friction", "joint_spring_reference"]
)
def test_terms_of_joints_of_a_body_as_written(name: str) -> None:
    scene = earth()
    panda = scene.load(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True).bodies[0]
    panda.joints[1].stiffness = 2.0
    panda.joints[1].friction_loss = 0.1
    worlds = Worlds(scene, COUNT, threads=2)
    worlds[panda].change_dynamics(1, **{name: VALUES})
    np.testing.assert_array_equal(worlds[panda].dynamics(1)[name], VALUES)

    def change(world: World, value: float) -> None:
        joint = world.bodies[panda.id].joints[1]
        if name == "joint_friction":
            joint.friction_loss = value
        else:
            world.bodies[panda.id].change_dynamics(1, **{name: value})

    alone = assert_each_is_alone(scene, worlds, change)
    assert len({tuple(world.position) for world in alone}) == COUNT
    for number, world in enumerate(alone):
        taken = worlds.extract(number)
        world.step()
        taken.step()
        np.testing.assert_array_equal(taken.position, world.position)


def test_a_joint_without_friction_has_none_in_any_world() -> None:
    scene, panda = panda_world()
    with pytest.raises(ValueError, match="set friction_loss in the original world"):
        Worlds(scene, COUNT)[panda].change_dynamics(1, joint_friction=VALUES)


def test_gravity() -> None:
    scene, _ = box_world()
    worlds = Worlds(scene, COUNT)
    directions = np.stack([VALUES, 0 * VALUES, -9.81 * VALUES], axis=1)
    worlds.gravity = directions
    np.testing.assert_array_equal(worlds.gravity, directions)

    def change(world: World, value: float) -> None:
        world.gravity = (value, 0.0, -9.81 * value)

    assert_each_is_alone(scene, worlds, change)


def tied_world() -> tuple[World, int]:
    scene, box = box_world()
    other = add_box(scene, (0.5, 0.0, 0.12))
    tie = scene.constrain_links(UserConstraintKind.POINT_TO_POINT, box, -1, other, -1)
    tie.parent_frame = type(tie.parent_frame)((0.25, 0.0, 0.0))
    tie.child_frame = type(tie.child_frame)((-0.25, 0.0, 0.0))
    scene.scene_changed()
    return scene, tie.id


def test_constraints_that_hold_in_some_worlds() -> None:
    scene, tie = tied_world()
    worlds = Worlds(scene, COUNT, threads=2)
    holds = np.array([True, False, True, False])
    worlds.constraints[0].enable(holds)

    def change(world: World, value: float) -> None:
        constraint = world.user_constraints.get(tie)
        assert constraint is not None
        constraint.enabled = bool(holds[VALUES.tolist().index(value)])
        world.scene_changed()

    alone = assert_each_is_alone(scene, worlds, change)
    assert (alone[0].position != alone[1].position).any()
    np.testing.assert_array_equal(alone[0].position, alone[2].position)


def test_one_of_them_goes_on_alone_with_its_own_parameters() -> None:
    scene, _ = tied_world()
    worlds = Worlds(scene, COUNT, threads=2)
    box = next(iter(scene.bodies.values()))
    batch = worlds[list(scene.bodies)[1]]
    worlds.gravity = np.stack([VALUES, 0 * VALUES, -9.81 * VALUES], axis=1)
    batch.change_dynamics(-1, mass=VALUES, lateral_friction=VALUES, linear_damping=0.1 * VALUES)
    worlds.constraints[0].enable(VALUES > 0.6)
    worlds.step(20)
    lone = [worlds.extract(number) for number in range(COUNT)]
    worlds.step(40)
    for number, world in enumerate(lone):
        world.step(40)
        assert_same_bits(worlds, number, world)
        body = world.bodies[batch.id]
        assert body.dynamics(-1).mass == VALUES[number]
        assert body.dynamics(-1).lateral_friction == VALUES[number]
        assert world.gravity[0] == VALUES[number]
    assert box.dynamics(-1).mass == 0.0


def test_an_arm_with_limits_goes_on_alone() -> None:
    scene, panda = panda_world()
    worlds = Worlds(scene, COUNT)
    worlds[panda].change_dynamics(0, joint_upper_limit=0.02 * VALUES, joint_damping=VALUES)
    worlds.step(20)
    lone = [worlds.extract(number) for number in range(COUNT)]
    worlds.step(40)
    for number, world in enumerate(lone):
        world.step(40)
        assert_same_bits(worlds, number, world)
        assert world.bodies[panda.id].joints[0].limits[1] == 0.02 * VALUES[number]


@pytest.mark.parametrize(
    ("link", "changes", "error", "words"),
    [
        (-1, {"mass": -1.0}, ValueError, "mass must not be negative"),
        (-1, {"mass": [1.0, 0.0, 1.0, 1.0]}, ValueError, "greater than 0"),
        (-1, {"mass": [1.0, 2.0]}, ValueError, r"mass has shape \(2,\); it must have shape \(4,\)"),
        (-1, {"lateral_friction": np.nan}, ValueError, "lateral_friction must be finite"),
        (-1, {"colour": 1.0}, TypeError, "no parameter 'colour' can differ"),
        (-1, {"joint_damping": 1.0}, ValueError, "the base has no joint"),
        ("wheel", {"mass": 1.0}, KeyError, "no link is called 'wheel'"),
        (3, {"mass": 1.0}, IndexError, "link 3 is out of range"),
    ],
)
def test_what_makes_no_sense_is_refused(
    link: int | str, changes: dict[str, Any], error: type[Exception], words: str
) -> None:
    scene, box = box_world()
    worlds = Worlds(scene, COUNT)
    with pytest.raises(error, match=words):
        worlds[box].change_dynamics(link, **changes)
    assert_each_is_alone(scene, worlds, lambda world, value: None)


def test_a_joint_without_limits_gets_none_world_by_world() -> None:
    world = earth()
    robot = world.load_urdf(f"{pybullet_data.getDataPath()}/r2d2.urdf")
    wheel = next(joint.index for joint in robot.joints if joint.name == "right_front_wheel_joint")
    with pytest.raises(
        ValueError, match="'right_front_wheel_joint' has no limits: set them in the original world"
    ):
        Worlds(world, 2)[robot].change_dynamics(wheel, joint_upper_limit=1.0)


def test_fixed_bases_have_no_mass() -> None:
    scene, panda = panda_world()
    with pytest.raises(ValueError, match="the base is fixed"):
        Worlds(scene, 2)[panda].change_dynamics(-1, mass=1.0)


def test_inertias_are_scaled_with_the_mass_whatever_was_set_before() -> None:
    scene, panda = panda_world()
    panda.change_dynamics(2, inertia=(0.1, 0.2, 0.4))
    mass = panda.dynamics(2).mass
    batch = Worlds(scene, COUNT)[panda]
    batch.change_dynamics(2, mass=7.0, inertia=1.0)
    batch.change_dynamics(2, mass=VALUES * mass)
    expected = VALUES[:, None] * np.array([0.1, 0.2, 0.4])
    np.testing.assert_allclose(batch.dynamics(2)["inertia"], expected, rtol=1e-14)
    panda.change_dynamics(2, mass=2.0 * mass)
    np.testing.assert_allclose(panda.dynamics(2).inertia, [0.2, 0.4, 0.8], rtol=1e-14)


def test_masses_of_many_worlds_are_set_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, box = box_world()
    calls: list[float] = []
    monkeypatch.setattr("carom.worlds.dynamics.shape_inertia", lambda *given: calls.append(given[2]))
    batch = Worlds(scene, 4096)[box]
    batch.change_dynamics(-1, mass=np.linspace(0.5, 2.0, 4096))
    assert not calls
    assert len(np.unique(batch.dynamics(-1)["inertia"][:, 0])) > 4000


def test_a_link_without_mass_gets_the_inertia_of_its_shapes() -> None:
    scene, panda = panda_world()
    tip = panda.links["panda_grasptarget"].index
    assert panda.dynamics(tip).mass == 0.0
    batch = Worlds(scene, COUNT)[panda]
    batch.change_dynamics(tip, mass=VALUES)
    panda.change_dynamics(tip, mass=float(VALUES[1]))
    np.testing.assert_array_equal(batch.dynamics(tip)["inertia"][1], panda.dynamics(tip).inertia)


def test_targets_are_clipped_to_the_limits_of_their_world() -> None:
    scene, panda = panda_world()
    worlds = Worlds(scene, COUNT, threads=2)
    arms = worlds[panda]
    upper = 0.3 * VALUES
    arms.change_dynamics("panda_link1", joint_upper_limit=upper)
    np.testing.assert_array_equal(arms.joints.limits[1][:, 0], upper)
    np.testing.assert_array_equal(arms.joints.limits[0], np.tile(panda.joints.limits[0], (COUNT, 1)))
    arms.joints.set_position_targets(2.0, max_forces=87.0, where=[0, 1])
    arms.joints[[0, 2]].set_position_targets(2.0, max_forces=87.0, where=[3, 2])

    def change(world: World, value: float) -> None:
        body = world.bodies[panda.id]
        body.change_dynamics(0, joint_upper_limit=0.3 * value)
        joints = body.joints.movable if value < 0.6 else [body.joints[0], body.joints[2]]
        for joint in joints:
            joint.set_position_target(2.0, max_force=87.0)

    assert_each_is_alone(scene, worlds, change)


def test_limits_that_cross_are_none() -> None:
    scene, panda = panda_world()
    worlds = Worlds(scene, COUNT)
    worlds[panda].change_dynamics(0, joint_lower_limit=1.0 - VALUES, joint_upper_limit=0.3)
    assert worlds[panda].joints.limits[0][:, 0].tolist() == [-np.inf, -np.inf, 0.0, 1.0 - VALUES[3]]

    def change(world: World, value: float) -> None:
        limits = (1.0 - value, 0.3) if value > 0.7 else (-np.inf, np.inf)
        world.bodies[panda.id].change_dynamics(0, joint_lower_limit=limits[0], joint_upper_limit=limits[1])

    assert_each_is_alone(scene, worlds, change)


def test_the_time_step_is_that_of_the_steps() -> None:
    scene, _ = box_world()
    worlds = Worlds(scene, COUNT)
    worlds.time_step = 0.01
    assert worlds.time_step == 0.01

    def change(world: World, value: float) -> None:
        world.parameters.time_step = 0.01
        world.apply_parameters()

    lone, *_ = assert_each_is_alone(scene, worlds, change)
    assert worlds.time[0] == lone.time
    for wrong in (0.0, -0.01, np.nan, "soon"):
        with pytest.raises(ValueError, match="time_step must be"):
            worlds.time_step = wrong  # type: ignore[assignment]
    assert worlds.extract(0).parameters.time_step == 0.01


def test_bounds_of_actuators_may_be_infinite_but_gains_are_numbers() -> None:
    scene = World()
    scene.load("""<mujoco><worldbody><body name="arm"><joint name="j"/><geom size=".1"/></body></worldbody>
        <actuator><motor name="m" joint="j" ctrlrange="-1 1" forcerange="-2 2"/></actuator></mujoco>""")
    motor = Worlds(scene, 2)["arm"].actuators["m"]
    motor.change(force_upper=[np.inf, 3.0], control_lower=-np.inf)
    assert motor.force_range[1].tolist() == [np.inf, 3.0]
    assert motor.control_range[0].tolist() == [-np.inf, -np.inf]
    for wrong in ({"gear": np.inf}, {"gain": (np.inf, 0.0, 0.0)}, {"force_upper": np.nan}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            motor.change(**wrong)
    assert motor.force_range[1].tolist() == [np.inf, 3.0]


def test_restored_worlds_sort_their_constraints_anew() -> None:
    """Parameters are not restored: a constraint that was switched off since then stays so."""
    scene, _ = tied_world()
    worlds, others = Worlds(scene, 2), Worlds(scene, 2)
    worlds.step(20)
    saved = worlds.snapshot()
    counts = worlds._engine.contact_arrays.contacts.numpy["count_contacts"]
    assert (counts[:, SORTED] != 0).all()
    worlds.constraints[0].enable(False)
    worlds.restore(saved)
    assert (counts[:, SORTED] == 0).all()
    worlds.step(20)
    others.step(20)
    others.constraints[0].enable(False)
    others.step(20)
    for number in range(2):
        assert_same_bits(worlds, number, others.extract(number))


def test_rests_of_springs_of_spherical_joints_become_unit_quaternions() -> None:
    scene = earth()
    body = scene.load("""<mujoco><worldbody><body name="b"><joint name="j" type="ball" stiffness="1"/>
        <geom size=".1" pos="1 0 0"/></body></worldbody></mujoco>""").bodies[0]
    batch = Worlds(scene, 2)[body]
    batch.change_dynamics("b", joint_spring_reference=[[0.0, 0.0, 0.0, 2.0], [0.0, 3.0, 0.0, 4.0]])
    rests = batch.dynamics("b")["joint_spring_reference"]
    np.testing.assert_allclose(rests, [[0.0, 0.0, 0.0, 1.0], [0.0, 0.6, 0.0, 0.8]], atol=1e-15)
