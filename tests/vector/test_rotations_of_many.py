"""Rotations of many worlds in arrays are those that the drop-in computes one by one."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet as p
from carom.vector.rotations import euler_from_quaternions, turned


def orientations(kind: str) -> np.ndarray:
    random = np.random.default_rng(3)
    if kind == "any":
        found = random.normal(size=(200, 4))
        return found / np.linalg.norm(found, axis=1, keepdims=True)
    pitch = 0.5 * np.pi if kind == "up" else -0.5 * np.pi
    angles = [(roll, pitch, yaw) for roll, yaw in random.uniform(-3.0, 3.0, (50, 2))]
    return np.array([p.getQuaternionFromEuler(each) for each in angles])


@pytest.mark.parametrize("kind", ["any", "up", "down"])
def test_angles_are_those_of_the_drop_in(kind: str) -> None:
    asked = orientations(kind)
    expected = [p.getEulerFromQuaternion(each) for each in asked]
    np.testing.assert_allclose(euler_from_quaternions(asked), expected, atol=1e-7)


def test_vectors_turn_as_by_matrices() -> None:
    asked = orientations("any")
    vectors = np.random.default_rng(4).normal(size=(len(asked), 3))
    matrices = np.array([p.getMatrixFromQuaternion(each) for each in asked]).reshape(-1, 3, 3)
    np.testing.assert_allclose(turned(asked, vectors), (matrices @ vectors[:, :, None])[:, :, 0], atol=1e-12)
