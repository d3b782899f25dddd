"""Linearised steps with limits of a spherical joint, beside central differences."""

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, statuses, tighten
from tests.physics.test_spherical_joint import limited_ball


@pytest.mark.parametrize("seed", range(6))
def test_limits_of_a_spherical_joint(seed):
    body = limited_ball()
    world = body.world
    world.gravity = (0.3, -0.5, -9.81)
    tighten(world)
    rng = np.random.default_rng(seed)
    turn = np.append(rng.uniform(-0.6, 0.6, 3), 1.0)
    q, dof = body.position_index[0], body.velocity_index[0]
    world.position[q : q + 4] = turn / np.linalg.norm(turn)
    world.velocity[dof : dof + 3] = 6.0 * turn[:3] + rng.uniform(-0.5, 0.5, 3)
    step = assert_exact(world, parameters=["masses", "inertias"])
    limits = [status for name, status in statuses(step).items() if name.startswith("limit")]
    assert limits and set(limits[0]) == {"holds"}
