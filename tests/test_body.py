"""Bodies: coordinates, inertia and the freedom of their bases."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.energy import momentum
from tests.physics.robots import (
    coordinates,
    free_body,
    joint_coordinates,
    let_go,
    pendulum,
    put_in_motion,
    random_rotation,
    random_tree,
)

from carom import Body, World
from carom.description import Box, Collision, JointType, Pose
from carom.model.body_spec import BASE, BodySpec, LinkSpec
from carom.model.link_dynamics import LinkDynamics


def boxes(*, fixed_base: bool = False) -> BodySpec:
    """A base and a link, both of 2 kg with collision shapes, on a joint about x."""
    shape = (Collision(Box((0.1, 0.2, 0.3))),)
    inertia = (2.0 * 0.52 / 12, 2.0 * 0.4 / 12, 2.0 * 0.2 / 12)
    base = LinkSpec("base", mass=2.0, inertia=inertia, collisions=shape)
    link = LinkSpec(
        "link",
        mass=2.0,
        inertia=inertia,
        collisions=shape,
        joint_type=JointType.REVOLUTE,
        joint_frame=Pose((0.0, 0.0, 0.6)),
    )
    return BodySpec("boxes", base, [link], fixed_base=fixed_base)


def test_coordinates_are_counted_joint_by_joint():
    types = [
        JointType.FIXED,
        JointType.SPHERICAL,
        JointType.PRISMATIC,
        JointType.PLANAR,
        JointType.CONTINUOUS,
    ]
    links = [LinkSpec(f"l{j}", parent=j - 1, mass=1.0, joint_type=kind) for j, kind in enumerate(types)]
    world = World()
    world.load(pendulum())
    body = world.load(BodySpec("all", LinkSpec("base"), links, fixed_base=True))
    assert body.joint_types == (4, 2, 1, 3, 0)
    assert body.position_count == (0, 4, 1, 3, 1)
    assert body.velocity_count == (0, 3, 1, 3, 1)
    q, v = body.first_position + 7, body.first_velocity + 6
    assert body.position_index == (-1, q, q + 4, q + 5, q + 8)
    assert body.velocity_index == (-1, v, v + 3, v + 4, v + 7)
    assert (body.first_link, body.first_position, body.first_velocity) == (2, 8, 7)


def test_joint_state_is_set_in_part_or_whole():
    body = World().load(random_tree(1, 6, fixed_base=True))
    for joint, count in enumerate(body.position_count):
        body.set_joint_state(joint, [0.5] * count, None)
        body.set_joint_state(joint, None, [0.25] * body.velocity_count[joint])
    position, velocity = joint_coordinates(body)
    # Quaternions come out normalised, which (0.5, 0.5, 0.5, 0.5) is.
    np.testing.assert_array_equal(position, 0.5)
    np.testing.assert_array_equal(velocity, 0.25)


def test_quaternions_are_normalised():
    body = World().load(random_tree(2, 1, fixed_base=False, joint_types=[JointType.SPHERICAL]))
    body.set_joint_state(0, [0.0, 3.0, 0.0, 4.0], None)
    body.set_inertial_pose((0.0, 0.0, 0.0), (2.0, 0.0, 0.0, 0.0))
    assert_allclose(coordinates(body)[0][3:], [1.0, 0.0, 0.0, 0.0, 0.0, 0.6, 0.0, 0.8], rtol=1e-15)


def test_setting_coordinates_moves_links_at_once():
    body = World().load(pendulum(2))
    body.set_joint_state(0, [math.pi / 2], [0.0])
    assert_allclose(body.world.link_pose[2, :3], [-1.5, 0.0, 0.0], atol=1e-15)
    body.set_inertial_pose((0.0, 0.0, 2.0), (0.0, 0.0, 1.0, 0.0))
    assert_allclose(body.world.link_pose[2, :3], [1.5, 0.0, 2.0], atol=1e-15)


def test_velocities_of_links_follow_from_those_of_base_and_joints():
    body = World().load(boxes())
    body.set_base_velocity((1.0, 0.0, 0.0), (0.0, 2.0, 0.0))
    body.set_joint_state(0, [0.3], [0.5])
    body.update_link_velocities()
    assert_allclose(body.world.link_velocity[0], [1.0, 0.0, 0.0, 0.0, 2.0, 0.0], atol=1e-15)
    assert_allclose(body.world.link_velocity[1], [1.0 + 2.0 * 0.6, 0.0, 0.0, 0.5, 2.0, 0.0], atol=1e-15)


@pytest.mark.parametrize("seed", range(3))
def test_link_velocities_are_derivatives_of_link_poses(seed):
    step = 1e-6
    world = World(step)
    body = world.load(random_tree(seed, 10, fixed_base=False))
    let_go(body)
    put_in_motion(body, np.random.default_rng(seed))
    before = world.link_pose[:11].copy()
    world.step()
    body.update_link_poses()
    body.update_link_velocities()
    moved = (world.link_pose[:11, :3] - before[:, :3]) / step
    assert_allclose(world.link_velocity[:11, :3], moved, rtol=0, atol=2e-4)
    for pose, old, twist in zip(world.link_pose[:11], before, world.link_velocity[:11], strict=True):
        spin = (rotation(pose[3:]) - rotation(old[3:])) / step @ rotation(pose[3:]).T
        assert_allclose([spin[2, 1], spin[0, 2], spin[1, 0]], twist[3:], rtol=0, atol=2e-4)


def test_a_fixed_base_stays_where_it_is():
    body = World().load(pendulum())
    body.world.gravity = (0.0, 0.0, -9.81)
    body.set_inertial_pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    body.world.link_force[0] = [100.0, 0.0, 0.0, 0.0, 0.0, 10.0]
    body.world.step(10)
    assert coordinates(body)[0][:7].tolist() == [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]


def twin_of(body: Body, spec: BodySpec) -> Body:
    """A body loaded from `spec` into a world of its own, in the state of another."""
    world = World()
    world.gravity = tuple(body.world.gravity)
    twin = world.load(spec)
    for values, wanted in zip(coordinates(twin), coordinates(body), strict=True):
        values[:] = wanted
    return twin


@pytest.mark.parametrize("frees", [True, False], ids=["freed", "held"])
def test_the_mass_of_the_base_frees_and_holds_it(frees):
    """A base that gets a mass moves as one loaded free, one that loses it as one loaded fixed."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(boxes(fixed_base=frees))
    world.load(pendulum())
    body.set_joint_state(0, [0.4], [1.0])
    world.step(3)
    body.change_dynamics(BASE, mass=2.0 if frees else 0.0)
    assert body.fixed_base is not frees
    if not frees:
        coordinates(body)[1][:6] = 0.0
    twin = twin_of(body, boxes(fixed_base=not frees))
    height = coordinates(body)[0][2]
    world.step(20)
    twin.world.step(20)
    for values, wanted in zip(coordinates(body), coordinates(twin), strict=True):
        assert_allclose(values, wanted, rtol=0, atol=1e-12)
    assert (coordinates(body)[0][2] < height) == frees


def test_a_base_freed_in_flight_keeps_its_momentum():
    body = World().load(boxes(fixed_base=True))
    body.change_dynamics(BASE, mass=2.0, linear_damping=0.0, angular_damping=0.0)
    body.set_base_velocity((0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
    start = momentum(body)
    body.world.step(100)
    assert_allclose(momentum(body)[:3], start[:3], rtol=0, atol=1e-12)


def test_a_new_mass_scales_the_inertia():
    body = World().load(boxes())
    body.change_dynamics(0, mass=6.0)
    dynamics = body.dynamics(0)
    assert dynamics.mass == 6.0
    assert_allclose(dynamics.inertia, [6.0 * 0.52 / 12, 6.0 * 0.4 / 12, 6.0 * 0.2 / 12])
    body.change_dynamics(0, mass=6.0, inertia=(1.0, 2.0, 3.0))
    assert body.dynamics(0).inertia == (1.0, 2.0, 3.0)
    body.change_dynamics(0, mass=3.0)
    assert_allclose(body.dynamics(0).inertia, (0.5, 1.0, 1.5))
    assert body.spec.links[0].mass == 2.0


def test_a_freed_base_has_the_inertia_of_its_file():
    body = World().load(boxes(fixed_base=True))
    spec = body.spec.base
    assert body.dynamics(BASE).mass == 0.0
    body.change_dynamics(BASE, mass=2.0 * spec.mass)
    assert_allclose(body.dynamics(BASE).inertia, 2.0 * np.array(spec.inertia))


def test_changes_of_mass_are_felt_by_the_next_step():
    body = World().load(free_body(mass=2.0))
    let_go(body)
    for mass in (2.0, 5.0):
        body.change_dynamics(BASE, mass=mass, inertia=(0.1, 0.1, 0.1))
        before = coordinates(body)[1][3]
        body.world.link_force[0, 0] = 240.0
        body.world.step()
        assert coordinates(body)[1][3] - before == pytest.approx(1.0 / mass)


def test_surface_settings_are_kept():
    body = World().load(boxes())
    body.change_dynamics(0, lateral_friction=0.8, restitution=0.3)
    assert (body.dynamics(0).lateral_friction, body.dynamics(0).restitution) == (0.8, 0.3)
    assert body.dynamics(BASE) == LinkDynamics.of(body.spec.base)


def test_the_weight_of_a_fixed_base_is_reported_as_none():
    assert World().load(boxes(fixed_base=True)).dynamics(BASE).mass == 0.0
    assert World().load(boxes()).dynamics(BASE).mass == 2.0


def test_rotating_everything_rotates_the_motion():
    """Physics has no preferred direction: base, gravity and motion turn together."""
    spec = random_tree(17, 7, fixed_base=False)
    turn = np.array(random_rotation(np.random.default_rng(5)))
    axes = rotation(turn)
    ends = []
    for turned in (False, True):
        world = World()
        gravity = np.array([1.0, 2.0, -9.0])
        body = world.load(spec)
        put_in_motion(body, np.random.default_rng(17))
        position, velocity = coordinates(body)
        if turned:
            gravity = axes @ gravity
            position[:3] = axes @ position[:3]
            x, y, z, w = turn
            left = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
            position[3:7] = left @ position[3:7]
            velocity[:3], velocity[3:6] = axes @ velocity[:3], axes @ velocity[3:6]
        world.gravity = gravity.tolist()
        world.step(30)
        ends.append((position.copy(), velocity.copy()))
    (position, velocity), (turned_position, turned_velocity) = ends
    assert_allclose(turned_position[:3], axes @ position[:3], rtol=0, atol=1e-9)
    assert_allclose(rotation(turned_position[3:7]), axes @ rotation(position[3:7]), rtol=0, atol=1e-9)
    assert_allclose(turned_position[7:], position[7:], rtol=0, atol=1e-9)
    assert_allclose(turned_velocity[6:], velocity[6:], rtol=0, atol=1e-9)
