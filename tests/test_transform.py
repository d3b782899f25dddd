"""Rotations as plain tuples: the two ways to the quaternion of roll, pitch and yaw agree, sign included."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom.description import transform
from carom.description.transform import quaternion_from_matrix, quaternion_from_rpy, rotation_matrix


def test_the_sign_of_a_quaternion_is_that_of_its_matrix() -> None:
    for angles in np.random.default_rng(0).uniform(-np.pi, np.pi, (500, 3)):
        quaternion = quaternion_from_rpy(*angles)
        assert_allclose(quaternion_from_matrix(rotation_matrix(quaternion)), quaternion, rtol=0, atol=1e-7)


def test_roll_pitch_and_yaw_of_a_quaternion_are_those_it_was_made_of():
    for angles in ((0.3, -0.7, 1.1), (-2.0, 1.2, 3.0), (0.0, 0.0, 0.0), (1.0, -1.5, -2.5)):
        assert transform.rpy_from_quaternion(transform.quaternion_from_rpy(*angles)) == pytest.approx(
            angles, abs=1e-9
        )
