"""Worlds: bodies that come and go, parameters, time."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.robots import (
    coordinates,
    free_body,
    joint_coordinates,
    let_go,
    pendulum,
    put_in_motion,
    random_tree,
)

from carom import Body, World
from carom.description import JointType
from carom.layouts.codes import MOTOR_KP, MOTOR_MAX_IMPULSE, MOTOR_POSITION
from carom.model.body_spec import BodySpec
from carom.model.solver_order import quicksort_order

SPECS = [
    random_tree(0, 5, fixed_base=True),
    random_tree(1, 6, fixed_base=False),
    pendulum(3, limited=True, lower=-0.1, upper=0.2),
    free_body(),
]


def add(world: World, spec: BodySpec, seed: int) -> Body:
    """A body at work: moving, with position targets."""
    body = world.load(spec, position=(float(seed), 0.0, 1.0))
    put_in_motion(body, np.random.default_rng(seed), speed=0.5)
    rows = slice(body.first_velocity + 6, body.first_velocity + 6 + sum(body.velocity_count))
    world.motor[rows, MOTOR_POSITION] = 0.1
    world.motor[rows, MOTOR_KP] = 0.05
    return body


def heavy_world() -> World:
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    return world


def exact_world() -> World:
    """A world whose solver ends at the solution, whatever the order of its rows."""
    world = heavy_world()
    world.parameters.solver_residual_threshold = 0.0
    world.parameters.solver_iterations = 4000
    world.apply_parameters()
    return world


def assert_same_motion(found: Body, expected: Body, tolerance: float = 0.0) -> None:
    for values, wanted in zip(coordinates(found), coordinates(expected), strict=True):
        assert_allclose(values, wanted, rtol=0, atol=tolerance)


def test_a_body_moves_as_if_it_were_alone():
    together = exact_world()
    bodies = [add(together, spec, seed) for seed, spec in enumerate(SPECS)]
    together.step(10)
    for seed, spec in enumerate(SPECS):
        alone = exact_world()
        body = add(alone, spec, seed)
        alone.step(10)
        # Only the order of rows can differ; a body without joints has none.
        assert_same_motion(bodies[seed], body, tolerance=1e-9 if spec.links else 0.0)


def test_bodies_added_one_by_one_while_the_world_runs():
    """Growing in use is the same as having had the room from the start."""
    grown, roomy = heavy_world(), heavy_world()
    roomy.arrays.reserve(**dict.fromkeys(roomy.arrays.used, 5000))
    roomy.scene_changed()
    for n in range(12):
        for world in (grown, roomy):
            add(world, SPECS[n % 4], n)
            world.step(3)
    for n in range(12):
        assert_same_motion(grown.bodies[n], roomy.bodies[n])


def test_a_fresh_world_with_the_same_state_goes_on_the_same_way():
    first = heavy_world()
    for seed, spec in enumerate(SPECS):
        add(first, spec, seed)
        first.step(5)
    second = heavy_world()
    for seed, spec in enumerate(SPECS):
        body = add(second, spec, seed)
        for values, wanted in zip(coordinates(body), coordinates(first.bodies[seed]), strict=True):
            values[:] = wanted
    first.step(20)
    second.step(20)
    for body in first.bodies:
        assert_same_motion(second.bodies[body.id], body)


@pytest.mark.parametrize("removed", range(4))
def test_removing_one_leaves_the_motion_of_others(removed):
    """With one motor each there is no order of rows that a removal could change."""
    specs = [pendulum(), random_tree(5, 3, fixed_base=False, joint_types=[JointType.FIXED]), free_body()]
    specs.append(pendulum(1, joint_axis=(1.0, 0.0, 0.0)))
    world, expected = heavy_world(), heavy_world()
    bodies = [add(world, spec, seed) for seed, spec in enumerate(specs)]
    twins = [add(expected, spec, seed) for seed, spec in enumerate(specs) if seed != removed]
    world.remove(bodies.pop(removed).id)
    world.step(50)
    expected.step(50)
    for body, twin in zip(bodies, twins, strict=True):
        assert_same_motion(body, twin)


@pytest.mark.parametrize("removed", range(4))
def test_removing_one_changes_at_most_the_order_of_rows(removed):
    specs = [pendulum(2), random_tree(1, 4, fixed_base=False), pendulum(2), free_body()]
    world, expected = exact_world(), exact_world()
    bodies = [add(world, spec, seed) for seed, spec in enumerate(specs)]
    twins = [add(expected, spec, seed) for seed, spec in enumerate(specs) if seed != removed]
    world.step(5)
    expected.step(5)
    world.remove(bodies.pop(removed).id)
    world.step(20)
    expected.step(20)
    for body, twin in zip(bodies, twins, strict=True):
        assert_same_motion(body, twin, tolerance=1e-9)


def test_handles_stay_valid_when_others_are_removed():
    world = heavy_world()
    bodies = [add(world, SPECS[n % 4], n) for n in range(8)]
    kept = [(body, *(values.copy() for values in coordinates(body))) for body in bodies[1::2]]
    for body in bodies[::2]:
        world.remove(body.id)
    for body, position, velocity in kept:
        assert world.bodies[body.id] is body
        np.testing.assert_array_equal(coordinates(body)[0], position)
        np.testing.assert_array_equal(coordinates(body)[1], velocity)
        for joint, row in enumerate(body.position_index):
            if row >= 0:
                assert body.first_position + 7 <= row < body.first_position + 7 + sum(body.position_count)
                assert body.velocity_count[joint] > 0
        body.set_inertial_pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 2.0))
        assert world.link_pose[body.first_link].tolist() == [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]


def test_numbers_of_removed_bodies_are_given_again_the_last_first():
    world = World()
    for _ in range(4):
        world.load(free_body())
    world.remove(1)
    world.remove(3)
    assert [world.load(free_body()).id for _ in range(3)] == [3, 1, 4]
    assert sorted(world.bodies.keys()) == [0, 1, 2, 3, 4]


def constraint_links(world: World) -> list[int]:
    """Link rows of the constraints in the order of the solver."""
    world.step()
    return world.arrays.model.numpy["constraint_link"][: world.arrays.used["constraint"]].tolist()


def test_removed_constraints_are_replaced_by_the_last_ones():
    """All motors are solved together here, so that their order is that of the list, sorted by body."""
    world = World()
    world.parameters.minimum_island_size = 100
    world.apply_parameters()
    bodies = [world.load(pendulum(count)) for count in (1, 2, 3)]
    world.remove(bodies[0].id)
    # The list was 0a | 1a 1b | 2a 2b 2c; 2c took the place of 0a. The collision objects of body 2 took the
    # places of those of body 0 too, so that its island comes first.
    remaining = {"2c": 6, "1a": 1, "1b": 2, "2a": 4, "2b": 5}
    order = quicksort_order([0 if name[0] == "2" else 3 for name in remaining])
    assert constraint_links(world) == [list(remaining.values())[i] for i in order]


def test_removing_a_body_that_is_not_there_is_an_error():
    world = World()
    world.load(free_body())
    with pytest.raises(KeyError):
        world.remove(7)
    assert list(world.bodies.keys()) == [0]


def test_a_body_of_300_links():
    world = heavy_world()
    spec = random_tree(300, 300, fixed_base=False)
    body = world.load(spec)
    put_in_motion(body, np.random.default_rng(300), speed=0.1)
    world.step(2)
    assert np.isfinite(world.position).all()
    assert body.joint_count == 300
    assert sum(body.velocity_count) > 128


def test_a_hundred_bodies():
    world = heavy_world()
    bodies = [add(world, SPECS[n % 4], n % 4) for n in range(100)]
    world.step(3)
    for n in range(4, 100):
        if n % 4 == 3:
            assert_same_motion(bodies[n], bodies[3])
    assert len(world.analytics()) == 75
    for body in bodies:
        world.remove(body.id)
    world.step()
    assert not world.bodies
    assert not any(world.arrays.used.values())


def test_the_base_is_placed_by_its_link_frame():
    spec = random_tree(9, 2, fixed_base=True)
    half = 0.5**0.5
    body = World().load(spec, position=(1.0, 2.0, 3.0), orientation=(0.0, 0.0, half, half))
    x, y, z = spec.base.inertial_frame.position
    assert_allclose(coordinates(body)[0][:3], [1.0 - y, 2.0 + x, 3.0 + z], atol=1e-15)


def test_a_new_body_has_its_link_poses_at_once():
    world = World()
    body = world.load(pendulum(2), position=(0.0, 0.0, 5.0))
    assert_allclose(world.link_pose[body.first_link : body.first_link + 3, 2], [5.0, 4.5, 3.5])


def test_link_poses_after_a_step_are_those_it_started_from():
    """As in Bullet, until they are asked for anew."""
    world = heavy_world()
    body = world.load(pendulum())
    let_go(body)
    body.set_joint_state(0, [1.0], [2.0])
    before = world.link_pose[:2].copy()
    world.step()
    np.testing.assert_array_equal(world.link_pose[:2], before)
    body.update_link_poses()
    assert world.link_pose[1, 0] < before[1, 0]


def test_reset_empties_the_world_but_keeps_time_step_and_substeps():
    world = World(time_step=0.01)
    world.parameters.substeps = 3
    world.parameters.solver_iterations = 7
    world.gravity = (0.0, 0.0, -1.0)
    for _ in range(3):
        world.load(pendulum())
    world.remove(1)
    world.step(2)
    world.clear()
    assert not world.bodies
    assert world.gravity.tolist() == [0.0, 0.0, 0.0]
    assert (world.parameters.time_step, world.parameters.substeps) == (0.01, 3)
    assert world.parameters.solver_iterations == 50
    body = world.load(pendulum())
    assert body.id == 0
    body.set_joint_state(0, [1.0], [0.0])
    world.step(5)
    assert joint_coordinates(body)[0].tolist() == [1.0]


def test_a_world_in_a_with_statement_is_empty_after_it():
    with World() as world:
        world.load(pendulum())
        world.step()
        assert len(world.bodies) == 1
    assert not world.bodies


def test_an_empty_world_can_be_stepped():
    world = World(time_step=0.5)
    world.step(4)
    assert world.time == 2.0
    assert world.analytics() == []


def test_parameters_take_effect_when_applied():
    world = World()
    body = world.load(free_body())
    let_go(body)
    world.gravity = (0.0, 0.0, -10.0)
    world.step()
    world.parameters.time_step = 0.5
    world.apply_parameters()
    world.step()
    assert coordinates(body)[1][5] == pytest.approx(-10.0 * (1.0 / 240 + 0.5))
    assert world.gravity.tolist() == [0.0, 0.0, -10.0]


def test_memory_views_show_the_arrays():
    world = World()
    for n in range(5):
        body = world.load(SPECS[n % 4])
        for name in ("position", "velocity", "motor", "pd", "joint_torque", "link_pose", "link_force"):
            array, memory = getattr(world, name), getattr(world, f"{name}_memory")
            assert memory.format == "d"
            assert len(memory) == array.size
            memory[array.size - 1] = 4.5
            assert array.reshape(-1)[-1] == 4.5
            array.reshape(-1)[-1] = 0.0
        world.motor_memory[8 * body.first_velocity + MOTOR_MAX_IMPULSE] = 2.0
        assert world.motor[body.first_velocity, MOTOR_MAX_IMPULSE] == 2.0


def test_a_copy_goes_on_as_the_original_does_and_is_a_world_of_its_own():
    world = heavy_world()
    for seed, spec in enumerate(SPECS):
        add(world, spec, seed)
    world.step(5)
    other = world.copy()
    world.step(10)
    other.step(10)
    for number, body in world.bodies.items():
        assert_same_motion(body, other.bodies[number])
    before = world.position.copy()
    other.remove(0)
    other.gravity = (0.0, 0.0, 3.0)
    other.step(5)
    np.testing.assert_array_equal(world.position, before)
    assert 0 in world.bodies
    assert world.gravity[2] != 3.0
