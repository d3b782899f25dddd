"""Functions that ask kernels in one native call."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World
from carom.algorithms.mechanism import mechanism_of
from carom.native.host import host


@pytest.mark.skipif(host is None, reason="there are no builtins")
def test_a_kernel_answers_and_where_there_is_nothing_to_answer_none_is_asked() -> None:
    world = World()
    world.load("""<mujoco><worldbody><body name="arm"><joint name="j"/><geom size=".1" mass="2" pos="1 0 0"/>
        </body><body name="held"><geom size=".1"/></body></worldbody></mujoco>""")
    arm = mechanism_of(world["arm"])
    found = arm.mass_matrix_asker(world.call_lock)([0.0])
    assert found is not None
    np.testing.assert_array_equal(found, arm.mass_matrix([0.0]))
    assert mechanism_of(world["held"]).mass_matrix_asker(world.call_lock)([]) is None
