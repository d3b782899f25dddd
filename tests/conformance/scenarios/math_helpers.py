"""Quaternions, Euler angles and transforms."""

from __future__ import annotations

import itertools
import math
import random
from typing import Any

from ..scenario import Kind, scenario

SINGLE_PRECISION = (
    "products",
    "inverses",
    "rotated",
    "from_axis_angle",
    "axis_angle",
    "slerp",
    "difference",
    "axis_difference",
    "velocity",
)


@scenario(Kind.INFO, SINGLE_PRECISION)
def math_helpers(p: Any) -> dict[str, Any]:
    """Every helper on random arguments, quaternions not normalised among them."""
    generator = random.Random(90)

    def numbers(count: int, size: float) -> list[float]:
        return [generator.uniform(-size, size) for _ in range(count)]

    eulers = [numbers(3, 3.1) for _ in range(12)]
    # Gimbal lock and no rotation, but no half turn from one to the next: that has two axes.
    eulers += [[0.3, -math.pi / 2, -0.4], [1.0, math.pi / 2, 0.2]]
    eulers += [[0.0, 0.0, 0.0], [2.5, 0.0, 0.0], [0.4, 0.2, -math.pi]]
    unit = [list(p.getQuaternionFromEuler(euler)) for euler in eulers]
    loose = [[1.5 * part for part in quaternion] for quaternion in unit[:6]]
    pairs = list(itertools.pairwise(unit))
    points = [numbers(3, 2.0) for _ in unit]
    products = [
        p.multiplyTransforms(here, turn, there, other)
        for here, there, (turn, other) in zip(points[:-1], points[1:], pairs, strict=True)
    ]
    inverses = [p.invertTransform(point, turn) for point, turn in zip(points, unit, strict=True)]
    axis_angles = [p.getAxisAngleFromQuaternion(turn) for turn in unit]
    return {
        "from_euler": unit,
        "to_euler": [p.getEulerFromQuaternion(turn) for turn in unit[:12]],
        "to_euler_at_gimbal_lock": [p.getEulerFromQuaternion(turn) for turn in unit[12:14]],
        "matrices": [p.getMatrixFromQuaternion(turn) for turn in unit + loose],
        "products": [[*position, *orientation] for position, orientation in products],
        "inverses": [[*position, *orientation] for position, orientation in inverses],
        "rotated": [p.rotateVector(turn, point) for turn, point in zip(unit, points, strict=True)],
        "from_axis_angle": [p.getQuaternionFromAxisAngle(point, 0.3 * i) for i, point in enumerate(points)],
        "axis_angle": [[*axis, angle] for axis, angle in axis_angles],
        "slerp": [p.getQuaternionSlerp(a, b, 0.1 * i) for i, (a, b) in enumerate(pairs)],
        "difference": [p.getDifferenceQuaternion(a, b) for a, b in pairs],
        "axis_difference": [p.getAxisDifferenceQuaternion(a, b) for a, b in pairs],
        "velocity": [p.calculateVelocityQuaternion(a, b, 0.02) for a, b in pairs],
    }
