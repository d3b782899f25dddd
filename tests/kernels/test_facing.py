"""Which touches of a node face each other, by themselves."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

import math

import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.soft.contact import facing
from carom.kernels.structs import SoftWork
from carom.kernels.types import Int32, Ints, Vector3, kernel


@kernel
def facing_kernel(work: SoftWork, first: Int32, count: Int32, answer: Ints):
    """The touch besides the two that face each other."""
    answer[0] = facing(work, 0, first, count)


def third(*degrees: float) -> int:
    """The answer for touches whose normals have these angles."""
    work = SoftWork()
    normals = [(0.0, 0.0, 1.0), *((math.cos(it), math.sin(it), 0.0) for it in map(math.radians, degrees))]
    work.touch_normal = wp.array([normals], dtype=Vector3, device="cpu")
    answer = wp.full(1, -9, dtype=Int32, device="cpu")
    wp.launch(facing_kernel, dim=1, inputs=[work, 1, len(degrees), answer], device="cpu")
    return int(answer.numpy()[0])


@pytest.mark.parametrize("angle", [121, 150, 180, 239])
def test_two_touches_face_each_other_beyond_120_degrees(angle: float) -> None:
    assert third(0, angle) == third(angle, 0) == 2


@pytest.mark.parametrize("angle", [0, 60, 90, 119, 241])
def test_two_touches_that_stand_askew_do_not(angle: float) -> None:
    assert third(0, angle) == -1


@pytest.mark.parametrize(
    ("degrees", "other"),
    [((0, 180, 90), 2), ((0, 90, 180), 1), ((90, 0, 180), 0), ((0, 130, 171), 1), ((0, 40, 80), -1)],
)
def test_of_three_touches_those_that_face_each_other_most_are_taken(
    degrees: tuple[float, ...], other: int
) -> None:
    assert third(*degrees) == other


@pytest.mark.parametrize("count", [0, 1])
def test_one_touch_faces_none(count: int) -> None:
    assert third(*[0.0] * count) == -1
