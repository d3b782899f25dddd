"""Rotations and poses, as plain tuples and as arrays, beside SciPy's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from carom import Pose
from carom.description import transform
from carom.description.pose import Pose as FramePose
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


def rotations() -> list[Rotation]:
    """At random, and those at which formulas change: none, half turns, quarter turns, nearly none."""
    turns = [axis * angle for axis in np.eye(3) for angle in (0.0, 1e-9, np.pi / 2, -np.pi / 2, np.pi)]
    turns += [np.pi * np.array((a, b, 0.0)) / np.hypot(a, b) for a, b in ((1, 1), (-1, 1), (1, -2))]
    return [*(Rotation.from_rotvec(turn) for turn in turns), *Rotation.random(30, np.random.default_rng(0))]


def same_turn(found: object, expected: Rotation) -> None:
    assert (Rotation.from_quat(found) * expected.inv()).magnitude() < 1e-7
    assert np.linalg.norm(np.asarray(found)) == pytest.approx(1.0, abs=1e-12)


def test_rotations_of_tuples_are_those_of_scipy() -> None:
    vector = (0.3, -1.2, 2.5)
    for turn in rotations():
        x, y, z, w = turn.as_quat().tolist()
        matrix = turn.as_matrix()
        for scale in (1.0, -2.0):
            quaternion = (scale * x, scale * y, scale * z, scale * w)
            assert_allclose(rotation_matrix(quaternion), matrix, atol=1e-15)
            assert_allclose(transform.rotate(quaternion, vector), turn.apply(vector), atol=1e-14)
        same_turn(quaternion_from_matrix(rotation_matrix((x, y, z, w))), turn)
        same_turn(transform.conjugate((x, y, z, w)), turn.inv())
        shortest = Rotation.from_quat(transform.turn_of_z(tuple(matrix[:, 2].tolist())))
        assert_allclose(shortest.apply((0.0, 0.0, 1.0)), matrix[:, 2], atol=1e-7)
        assert shortest.magnitude() == pytest.approx(np.arccos(np.clip(matrix[2, 2], -1.0, 1.0)), abs=1e-7)
        roll, pitch, yaw = transform.rpy_from_quaternion((x, y, z, w))
        assert Rotation.from_euler("xyz", (roll, pitch, yaw)).approx_equal(turn, 1e-7)
        same_turn(quaternion_from_rpy(roll, pitch, yaw), turn)
        same_turn(transform.turns_about_axes(roll, pitch, yaw), turn)
        assert_allclose(transform.transposed(rotation_matrix((x, y, z, w))), matrix.T, atol=1e-15)


def test_products_of_tuples_and_of_arrays_are_those_of_scipy() -> None:
    random = np.random.default_rng(1)
    for first, second in zip(rotations(), reversed(rotations()), strict=True):
        a, b = tuple(first.as_quat().tolist()), tuple(second.as_quat().tolist())
        same_turn(transform.multiplied(a, b), first * second)
        assert_allclose(
            transform.matrix_product(rotation_matrix(a), rotation_matrix(b)),
            (first * second).as_matrix(),
            atol=1e-14,
        )
        p, q, point = random.normal(size=(3, 3))
        one, other = FramePose(tuple(p.tolist()), a), FramePose(tuple(q.tolist()), b)
        both = transform.compose(one, other)
        assert_allclose(both.position, p + first.apply(q), atol=1e-14)
        same_turn(both.orientation, first * second)
        back = transform.inverse(one)
        assert_allclose(back.position, -first.inv().apply(p), atol=1e-14)
        same_turn(back.orientation, first.inv())
        in_arrays = Pose(p, a) * Pose(q, b)
        assert_allclose(in_arrays.position, both.position, atol=1e-14)
        same_turn(in_arrays.orientation, first * second)
        assert_allclose(Pose(p, a).inverse().array[:3], back.position, atol=1e-14)
        assert_allclose(in_arrays.apply(point), first.apply(second.apply(point) + q) + p, atol=1e-13)
        assert_allclose(Pose(p, a).matrix @ (*point, 1.0), (*(first.apply(point) + p), 1.0), atol=1e-14)


def test_poses_of_many_frames_are_those_of_each() -> None:
    turns = rotations()
    places = np.random.default_rng(2).normal(size=(len(turns), 3))
    many = Pose(places, np.array([turn.as_quat() for turn in turns]))
    products, matrices, points = many * many, many.matrix, many.apply((1.0, 2.0, 3.0))
    for row in range(len(turns)):
        one = Pose(many.position[row], many.orientation[row])
        assert_allclose(products.array[row], (one * one).array, atol=1e-15)
        assert_allclose(matrices[row], one.matrix, atol=1e-15)
        assert_allclose(points[row], one.apply((1.0, 2.0, 3.0)), atol=1e-15)
