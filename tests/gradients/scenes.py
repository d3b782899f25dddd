"""Worlds for the tests of steps that PyTorch and JAX differentiate, away from switches."""

from __future__ import annotations

from tests.linearization.scenes import ASSETS, excite, motors_off, new_world, set_velocity

from carom import World, Worlds


def cartpole() -> World:
    world = new_world()
    robot = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    excite(robot)
    motors_off(robot)
    return world


def panda() -> World:
    """A Panda whose arm has motors with targets near its pose."""
    world = new_world()
    robot = world.load_urdf(f"{ASSETS}/franka_panda/panda.urdf", fixed_base=True, as_pybullet=False)
    excite(robot, share=0.1)
    for number, joint in enumerate(robot.joints.movable[:7]):
        joint.set_position_target(joint.position + 0.02 * (-1) ** number, gain=0.05, max_force=1e5)
    return world


def ball_on_plane() -> World:
    """A ball that slides on a plane, a little inside it."""
    world = new_world(plane=True)
    ball = world.load_urdf(f"{ASSETS}/sphere2.urdf", (0.0, 0.0, 0.498))
    set_velocity(ball, 0.3, 0.1, 0.2, 1.0, 0.4, 0.0)
    return world


def differing(world: World, count: int) -> Worlds:
    """Worlds whose velocities differ."""
    worlds = Worlds(world, count, threads=1)
    state = worlds._engine.arrays.state.numpy
    for number in range(count):
        state["dof_velocity"][number] *= 1.0 + 0.1 * number
    return worlds
