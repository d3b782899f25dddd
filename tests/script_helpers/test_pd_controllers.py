"""Angular velocities that the stable PD controllers follow, by closed forms."""

from __future__ import annotations

from math import cos, pi, sin

import pytest

import pybullet as p
from pybullet_utils.pd_controller_stable import PDControllerStableMultiDof

START = (sin(pi / 4), 0.0, 0.0, cos(pi / 4))
TURN = (0.0, 0.0, sin(0.15), cos(0.15))


def test_a_turn_in_the_axes_of_the_first_orientation_and_in_those_of_the_world() -> None:
    controller, end = PDControllerStableMultiDof(p), p.multiplyTransforms([0] * 3, START, [0] * 3, TURN)[1]
    assert controller.quatMul(START, TURN) == pytest.approx(end)
    # 0.3 rad in 0.1 s about the own z axis, which a quarter turn about x has made the world's -y.
    assert controller.computeAngVelRel(START, end, 0.1, p) == pytest.approx([0.0, 0.0, 3.0])
    assert controller.computeAngVel(START, end, 0.1, p) == pytest.approx([0.0, -3.0, 0.0])
