"""Rows whose impulse is the only one possible are left out of sweeps, without an effect on anything else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.worlds.test_legged_lanes import on_a_floor

from carom import Body, Motor, World
from carom.layouts.codes import UserConstraintKind

_SLIDER = """
<mujoco>
  <worldbody>
    <body><joint name="x" type="slide" axis="1 0 0"/><geom type="sphere" size="0.1"/></body>
  </worldbody>
</mujoco>
"""


def give(world: World, controls: np.ndarray | list[float]) -> None:
    world.arrays.state.numpy["actuator_control"][0, : len(controls)] = controls


def sweeps_of(world: World, body: Body) -> int:
    return int(world.arrays.state.numpy["tree_iterations"][0, body.rows.tree])


def test_given_torques_are_left_out_of_all_but_the_first_sweeps() -> None:
    world, robot = on_a_floor("ant")
    give(world, [0.1] * 8)
    world.step(60)
    rows = world.engine.workspace.pair_rows.numpy
    assert sweeps_of(world, robot) > 2
    assert world.contact_arrays.contact_count > 0
    assert rows["visit_row"][0, :8].tolist() != list(range(8))


def test_a_given_torque_counts_after_rows_along_which_nothing_can_move(tmp_path: Path) -> None:
    # As in Bullet the change of such rows is 0/0; only that of the motor after them ends the sweeps.
    path = tmp_path / "slider.xml"
    path.write_text(_SLIDER)
    world = World(contact="bullet")
    body = next(body for body in world.load(path).bodies if body.joint_count)
    body.add_actuator("x", Motor("x", gear=5.0))
    world.constrain_links(UserConstraintKind.PRISMATIC, body, 0, None, -1, axis=(1.0, 0.0, 0.0))
    for control in np.linspace(-1.0, 1.0, 20):
        give(world, [control])
        world.step()
        assert sweeps_of(world, body) == 2
