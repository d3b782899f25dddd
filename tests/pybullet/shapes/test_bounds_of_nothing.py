"""The margin of a base without shapes is all of its bounds, as in PyBullet 3.2.7."""

from __future__ import annotations

import pytest

import pybullet as p


@pytest.mark.parametrize("mass", [0, 1])
def test_a_margin_widens_the_bounds_of_a_base_without_shapes(mass: int) -> None:
    client = p.connect(p.DIRECT)
    body = p.createMultiBody(mass, -1, -1, [1, 2, 3])
    assert p.getAABB(body) == ((1, 2, 3), (1, 2, 3))
    for margin in (0.05, 0.2, 0.0, 0.1):
        p.changeDynamics(body, -1, collisionMargin=margin)
        lower, upper = p.getAABB(body)
        assert lower == pytest.approx((1 - margin, 2 - margin, 3 - margin), abs=1e-12)
        assert upper == pytest.approx((1 + margin, 2 + margin, 3 + margin), abs=1e-12)
    p.disconnect(client)
