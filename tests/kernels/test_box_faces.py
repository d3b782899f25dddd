"""Which face of a box meets that of another, by itself."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportGeneralTypeIssues=false, reportInvalidTypeForm=false

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.shapes.box_faces import incident_axis
from carom.kernels.types import Int32, Vector3, kernel


@kernel
def incident_axis_kernel(direction: Vector3, answer: wp.array(dtype=Int32)):
    """The axis of the incident face."""
    answer[0] = incident_axis(direction)


def in_bullet(x: float, y: float, z: float) -> int:
    """The axis as `dBoxBox2` decides on it."""
    if y > x:
        return 1 if y > z else 2
    return 0 if x > z else 2


@pytest.mark.parametrize("sizes", list(product((0.25, 0.5, 0.75), repeat=3)))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_incident_face_is_bullets_also_where_components_are_equal(
    sizes: tuple[float, float, float], sign: float
) -> None:
    answer = np.full(1, -1, dtype=np.int32)
    direction = Vector3(*(sign * size for size in sizes))
    inputs = [direction, wp.array(answer, device="cpu", copy=False)]
    wp.launch(incident_axis_kernel, dim=1, inputs=inputs, device="cpu")
    assert answer[0] == in_bullet(*sizes)
