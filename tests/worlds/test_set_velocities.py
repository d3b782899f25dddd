"""Fixed bases with set velocities, in many worlds."""

from __future__ import annotations

from tests.physics.contact_scenes import add_ball, add_floor, earth
from tests.worlds.same_bits import assert_same_bits, stirred, stirred_worlds


def test_a_floor_that_turns_and_moves_does_so_in_each_world() -> None:
    scene = earth()
    floor = add_floor(scene)
    add_ball(scene, (0.3, 0.0, 1.0))
    floor.set_base_velocity([0.3, 0.0, 0.0], [0.0, 0.0, 1.0])
    worlds = stirred_worlds(scene, 3, threads=2)
    lone = stirred(scene, 2)
    worlds.step(60)
    lone.step(60)
    assert_same_bits(worlds, 2, lone)
    assert lone.velocity[floor.first_velocity + 4] > 0.05
