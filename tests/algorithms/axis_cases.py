"""Arms whose joint axes are longer or shorter than 1, and what algorithms say about them.

For real PyBullet and Carom alike, so this needs nothing but the module that is asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

HINGE, SLIDER = 0, 1
_POSITIONS, _RATES, _ACCELERATIONS = [0.3, -0.2], [0.7, 0.6], [0.5, 0.4]
_GRAVITY = (1.0, 2.0, -9.8)
_BASE, _NO_TURN = [0.0] * 6, [0.0, 0.0, 0.0, 1.0]


@dataclass(frozen=True)
class Arm:
    """Two joints, one after the other: their types and axes; and the mass of the base [kg], 0 if fixed."""

    types: tuple[int, int]
    axes: tuple[list[float], list[float]]
    mass: float


_PAIRS = {
    "hinges": ((HINGE, HINGE), ([0.0, 0.0, 2.0], [0.0, 1.0, 0.0])),
    "hinge and short slider": ((HINGE, SLIDER), ([0.0, 0.0, 1.0], [0.0, 0.5, 0.0])),
    "short slider and long hinge": ((SLIDER, HINGE), ([0.0, 0.3, 0.4], [0.6, 0.0, 1.8])),
}
ARMS = {
    f"{name}, {base} base": Arm(types, axes, mass)
    for name, (types, axes) in _PAIRS.items()
    for base, mass in (("fixed", 0.0), ("free", 1.0))
}


def ask(pybullet: Any, arm: Arm) -> dict[str, Any]:
    """Answers about an arm, by the names of the questions."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        return _answers(pybullet, arm)
    finally:
        pybullet.disconnect(client)


def _answers(pybullet: Any, arm: Arm) -> dict[str, Any]:
    pybullet.setGravity(*_GRAVITY)
    box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    body = pybullet.createMultiBody(
        arm.mass,
        box,
        basePosition=[0.3, 0.1, 0.4],
        linkMasses=[1.0, 0.5],
        linkCollisionShapeIndices=[box, box],
        linkVisualShapeIndices=[-1, -1],
        linkPositions=[[1.0, 0.0, 0.0], [0.0, 0.3, 0.2]],
        linkOrientations=[_NO_TURN] * 2,
        linkInertialFramePositions=[[0.1, 0.0, 0.2], [0.0, 0.1, 0.0]],
        linkInertialFrameOrientations=[_NO_TURN] * 2,
        linkParentIndices=[0, 1],
        linkJointTypes=list(arm.types),
        linkJointAxis=list(arm.axes),
    )
    # With a floating base PyBullet reads the base's numbers after those of the joints of the full lists.
    still = _BASE if arm.mass else []
    place = [0.0, 0.0, 0.0, *_NO_TURN] if arm.mass else []
    # `flags=1` counts the base of a fixed body in its answer, not in its arguments.
    rates = [*[0.0] * len(place), *_RATES]
    accelerations = [*[0.0] * len(place), *_ACCELERATIONS]
    motion = [*place, *_POSITIONS], [*still, *_RATES], [*still, *_ACCELERATIONS]
    return {
        "mass matrix": pybullet.calculateMassMatrix(body, _POSITIONS),
        "mass matrix of the full model": pybullet.calculateMassMatrix(body, [*place, *_POSITIONS], flags=1),
        "Jacobian": pybullet.calculateJacobian(body, 1, [0.1, 0.2, 0.3], _POSITIONS, [0.0] * 2, [0.0] * 2),
        "inverse dynamics": pybullet.calculateInverseDynamics(body, *motion),
        "inverse dynamics of the full model": pybullet.calculateInverseDynamics(
            body, [*place, *_POSITIONS], rates, accelerations, flags=1
        ),
    }
