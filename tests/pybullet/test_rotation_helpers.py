"""The math helpers against figures of real PyBullet, and against their own laws."""

import json
from math import cos, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.each import each

import pybullet as p
from pybullet._maths.rotations import turned

CALLS = json.loads((Path(__file__).parent / "maths.json").read_text())
# PyBullet computes these in double precision, the others in single precision.
EXACT = {"getQuaternionFromEuler", "getEulerFromQuaternion", "getMatrixFromQuaternion"}

Quaternion = tuple[float, float, float, float]
numbers = st.floats(-10.0, 10.0)
vectors = st.tuples(numbers, numbers, numbers)


@st.composite
def quaternions(draw: st.DrawFn) -> Quaternion:
    part = st.floats(-1.0, 1.0)
    raw = draw(st.tuples(part, part, part, part).filter(lambda q: sum(x * x for x in q) > 0.01))
    length = sqrt(sum(x * x for x in raw))
    x, y, z, w = (component / length for component in raw)
    return x, y, z, w


@each("call", CALLS, ids=lambda call: call["function"])
def test_results_are_those_of_pybullet(call: dict[str, Any]) -> None:
    result = getattr(p, call["function"])(*call["arguments"])
    expected = _flat(call["result"])
    tolerance = 1e-12 if call["function"] in EXACT else 1e-6 * max(1.0, *map(abs, expected))
    assert _flat(result) == pytest.approx(expected, abs=tolerance)
    assert _shape(result) == _shape(call["result"])


@given(st.tuples(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0)))
def test_euler_angles_come_back(angles: tuple[float, float, float]) -> None:
    turn = p.getQuaternionFromEuler(angles)
    if abs(2.0 * (turn[3] * turn[1] - turn[0] * turn[2])) < 0.9999:
        assert p.getEulerFromQuaternion(turn) == pytest.approx(angles, abs=1e-6)


@pytest.mark.parametrize("pitch", [-0.5 * pi, 0.5 * pi])
@pytest.mark.parametrize("yaw", [-2.0, 0.5, 1.2])
def test_a_turn_straight_up_or_down_has_a_yaw_only(pitch: float, yaw: float) -> None:
    turn = p.getQuaternionFromEuler((0.4, pitch, yaw))
    angles = p.getEulerFromQuaternion(turn)
    assert angles[:2] == (0.0, pitch)
    assert _same_rotation(p.getQuaternionFromEuler(angles), turn)


@given(quaternions(), vectors)
def test_matrix_and_quaternion_turn_vectors_alike(
    turn: Quaternion, vector: tuple[float, float, float]
) -> None:
    matrix = np.reshape(p.getMatrixFromQuaternion(turn), (3, 3))
    assert p.rotateVector(turn, vector) == pytest.approx(tuple(matrix @ vector), abs=1e-9)


@given(vectors, quaternions())
def test_a_transform_times_its_inverse_is_none(
    position: tuple[float, float, float], turn: Quaternion
) -> None:
    there, back = (position, turn), p.invertTransform(position, turn)
    origin, rotation = p.multiplyTransforms(*there, *back)
    assert origin == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert rotation == pytest.approx((0.0, 0.0, 0.0, 1.0), abs=1e-9)


@given(quaternions(), quaternions())
def test_differences_lead_from_one_to_the_other(start: Quaternion, end: Quaternion) -> None:
    difference = p.getDifferenceQuaternion(start, end)
    _, reached = p.multiplyTransforms((0, 0, 0), difference, (0, 0, 0), start)
    assert _same_rotation(reached, end)
    assert difference[3] >= -1e-12


@given(quaternions(), quaternions(), st.floats(0.01, 2.0))
def test_velocity_leads_there_in_time(start: Quaternion, end: Quaternion, time: float) -> None:
    rate = p.calculateVelocityQuaternion(start, end, time)
    angle = float(np.linalg.norm(rate)) * time
    assert angle <= pi + 1e-9
    turn = p.getQuaternionFromAxisAngle(rate, angle)
    _, reached = p.multiplyTransforms((0, 0, 0), turn, (0, 0, 0), start)
    assert _same_rotation(reached, end)


@given(quaternions(), quaternions())
def test_slerp_starts_and_ends_where_it_should(start: Quaternion, end: Quaternion) -> None:
    assert _same_rotation(p.getQuaternionSlerp(start, end, 0.0), start)
    assert _same_rotation(p.getQuaternionSlerp(start, end, 1.0), end)


@given(quaternions().filter(lambda q: abs(q[3]) < 0.9999))
def test_axis_and_angle_come_back(turn: Quaternion) -> None:
    axis, angle = p.getAxisAngleFromQuaternion(turn)
    assert _same_rotation(p.getQuaternionFromAxisAngle(axis, angle), turn, 1e-5)


@given(quaternions(), quaternions())
def test_reported_quaternions_have_the_sign_of_a_matrix(a: Quaternion, b: Quaternion) -> None:
    _, (x, y, z, w) = p.multiplyTransforms((0, 0, 0), a, (0, 0, 0), b)
    assert w > 0.0 if w * w > 0.2500001 else max(x, y, z, key=abs) > 0.0 or abs(w * w - 0.25) < 1e-6


def test_lengths_of_quaternions_do_not_matter_where_a_matrix_is_made() -> None:
    assert p.getMatrixFromQuaternion([0, 0, 3, 4]) == pytest.approx(
        p.getMatrixFromQuaternion([0, 0, 0.6, 0.8])
    )


def test_projection_of_a_field_of_view() -> None:
    matrix = p.computeProjectionMatrixFOV(90, 2.0, 1.0, 3.0)
    assert matrix[0] == pytest.approx(0.5)
    assert matrix[5] == pytest.approx(1.0)
    assert np.allclose(matrix, p.computeProjectionMatrix(-2, 2, -1, 1, 1, 3))


def test_view_matrix_brings_the_target_in_front() -> None:
    view = np.reshape(p.computeViewMatrix([1, 2, 3], [4, 6, 3], [0, 0, 1]), (4, 4)).T
    assert view @ [4, 6, 3, 1] == pytest.approx([0, 0, -5, 1])


def test_yaw_pitch_and_roll_circle_the_target() -> None:
    view = np.reshape(p.computeViewMatrixFromYawPitchRoll([1, 1, 1], 2.0, 30, -40, 0, 2), (4, 4)).T
    assert view @ [1, 1, 1, 1] == pytest.approx([0, 0, -2, 1])
    eye = np.linalg.inv(view)[:3, 3]
    assert eye[2] == pytest.approx(1.0 + 2.0 * cos(pi / 180 * 50))


def _same_rotation(a: Any, b: Any, tolerance: float = 1e-7) -> bool:
    return 1.0 - abs(float(np.dot(a, b))) < tolerance


def _flat(value: Any) -> list[float]:
    return (
        [value] if isinstance(value, (int, float)) else [number for item in value for number in _flat(item)]
    )


def _shape(value: Any) -> Any:
    return None if isinstance(value, (int, float)) else [_shape(item) for item in value]


@pytest.mark.parametrize(
    ("start", "end", "angles"),
    [
        ([0.707, 0, 0, 0.707], [0, 0, 0.707, 0.707], [-0.0, -1.5703080892562866, -0.0]),
        ([sqrt(0.5), 0, 0, sqrt(0.5)], [0, 0, sqrt(0.5), sqrt(0.5)], [-0.0, -1.570451021194458, -0.0]),
        ([0.71, 0, 0, 0.71], [0, 0, 0.71, 0.71], [1.5707963705062866, -1.5707963705062866, 0.0]),
    ],
)
def test_angles_near_a_pitch_of_90_degrees_are_those_of_single_precision(
    start: list[float], end: list[float], angles: list[float]
) -> None:
    assert p.getAxisDifferenceQuaternion(start, end) == pytest.approx(angles, abs=2e-7)


@given(quaternions(), vectors)
def test_vectors_are_turned_as_by_the_matrix(
    quaternion: Quaternion, vector: tuple[float, float, float]
) -> None:
    matrix = np.reshape(p.getMatrixFromQuaternion(quaternion), (3, 3))
    assert turned(quaternion, vector) == pytest.approx(matrix @ vector, abs=1e-12)
