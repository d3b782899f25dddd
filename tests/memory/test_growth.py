"""Memory stays the same, however long a world runs and however many bodies come and go."""

import gc
import sys
from collections.abc import Callable

import numpy as np
import pytest
from tests.physics.robots import pendulum, random_tree

from carom import World, Worlds
from carom.algorithms import inverse_dynamics, jacobian, mass_matrix

resource = pytest.importorskip("resource", reason="peak memory is not known on this system")

# Peak memory is counted in pages and taken in chunks. A leak of 10 kB per round would show.
SOME_CHUNKS = 2**20


def peak_memory() -> int:
    """The most memory this process has held so far, in bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def collect() -> None:
    """Free what nobody can reach; some of it is only found once the rest has gone."""
    for _ in range(3):
        gc.collect()


def assert_leaves_nothing_behind(work: Callable[[], object], rounds: int) -> None:
    """Neither objects nor memory stay when `work` is done many times."""
    # Classes get their methods compiled once they have many objects.
    for _ in range(250):
        work()
    collect()
    # In this order: the list of all objects takes memory itself.
    objects, memory = len(gc.get_objects()), peak_memory()
    for _ in range(rounds):
        work()
    collect()
    assert len(gc.get_objects()) - objects < rounds / 10
    assert peak_memory() - memory < SOME_CHUNKS


def test_steps_leave_nothing_behind():
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load(pendulum(3))
    assert_leaves_nothing_behind(lambda: world.step(200), rounds=100)


def test_loading_and_removing_leaves_nothing_behind():
    world = World()
    world.load(pendulum(2))
    arm, tree = pendulum(4), random_tree(1, 6, fixed_base=False)

    def cycle() -> None:
        bodies = [world.load(arm), world.load(tree)]
        world.step()
        bodies[1].set_joint_state(0, [0.1] * bodies[1].position_count[0], None)
        inverse_dynamics(bodies[0], [0.0] * 4, [0.0] * 4, [0.0] * 4)
        mass_matrix(bodies[0], [0.0] * 4)
        jacobian(bodies[0], 3, (0.0, 0.0, 0.0), [0.0] * 4)
        for body in bodies:
            world.remove(body.id)

    assert_leaves_nothing_behind(cycle, rounds=300)
    capacity = [dict(table.capacity) for table in world.arrays.tables]
    cycle()
    assert [dict(table.capacity) for table in world.arrays.tables] == capacity


def test_resets_and_new_worlds_leave_nothing_behind():
    world = World()

    def cycle() -> None:
        world.clear()
        world.load(pendulum(2))
        world.step()
        with World() as other:
            other.load(pendulum(2))
            other.step()

    assert_leaves_nothing_behind(cycle, rounds=100)


def test_resets_of_many_worlds_leave_nothing_behind():
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    arm = world.load(pendulum(3))
    ball = world.add_sphere(0.1, (1.0, 0.0, 0.3), mass=1.0)
    world.add_plane()
    worlds = Worlds(world, 16)
    start = worlds.snapshot()
    random = np.random.default_rng(0)

    def cycle() -> None:
        over = np.flatnonzero(random.random(16) < 0.5)
        worlds.restore(start, where=over)
        worlds[ball].set_present(random.random(len(over)) < 0.8, where=over)
        worlds[arm].change_dynamics(0, mass=random.uniform(0.5, 2.0, len(over)), where=over)
        worlds[ball].set_base_inertial_poses((1.0, 0.0, random.random()), where=over)
        worlds.step(3)
        worlds.snapshot(where=over)
        worlds.contacts(ball)

    assert_leaves_nothing_behind(cycle, rounds=1000)
