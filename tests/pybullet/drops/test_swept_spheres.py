"""Capsules of MJCF files given by their ends, beside what PyBullet 3.2.7 answered."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p

CAPSULE = '<geom type="capsule" size=".05" fromto="{}"/>'
BALL = '<geom type="sphere" size=".03" pos=".1 0 0"/>'
UPRIGHT, LYING, ASKEW = "0 0 -.2 0 0 .2", "0 -.2 0 0 .2 0", "-.1 -.2 -.1 .1 .2 .1"
# Geoms; bounds; margin; step of the first contact with a plane, and its gap [mm].
CASES = [
    (CAPSULE.format(UPRIGHT), [[-0.09, -0.09, 0.31], [0.09, 0.09, 0.89]], 0.04, 63, 2.761),
    (CAPSULE.format(LYING), [[-0.09, -0.29, 0.51], [0.09, 0.29, 0.69]], 0.04, 80, -6.013),
    (CAPSULE.format(ASKEW), [[-0.19, -0.29, 0.41], [0.19, 0.29, 0.79]], 0.04, 72, -1.806),
    (CAPSULE.format("0 -.1 0 .1 .3 .1"), [[-0.14, -0.29, 0.46], [0.14, 0.29, 0.74]], 0.0, 76, -2.592),
    (CAPSULE.format("0 0 0 0 0 .2"), [[-0.09, -0.09, 0.41], [0.09, 0.09, 0.79]], 0.0, 72, -1.806),
    (CAPSULE.format(UPRIGHT) + BALL, [[-0.09, -0.09, 0.31], [0.13, 0.09, 0.89]], 0.0, 63, 2.761),
    ('<geom type="capsule" size=".05 .2"/>', [[-0.05, -0.05, 0.35], [0.05, 0.05, 0.85]], 0.05, 63, 2.761),
]


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    yield
    p.disconnect()


def load(folder: Path, geoms: str, flags: int = -1) -> int:
    file = folder / "body.xml"
    file.write_text(f'<mujoco><worldbody><body pos="0 0 0.6">{geoms}</body></worldbody></mujoco>')
    return p.loadMJCF(str(file), flags)[0]


def first_contact() -> tuple[int, float]:
    """Step and gap [mm]."""
    for step in range(120):
        p.stepSimulation()
        points = p.getContactPoints()
        if points:
            return step, 1e3 * points[0][8]
    raise AssertionError("there was none")


@pytest.mark.parametrize(("geoms", "bounds", "margin", "step", "gap"), CASES)
def test_bounds_margin_and_first_contact_with_a_plane(
    tmp_path: Path, geoms: str, bounds: list[list[float]], margin: float, step: int, gap: float
) -> None:
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    body = load(tmp_path, geoms)
    lower, upper = p.getAABB(body)
    assert [*lower, *upper] == pytest.approx([*bounds[0], *bounds[1]], abs=1e-6)
    assert p.getDynamicsInfo(body, -1)[11] == pytest.approx(margin)
    assert first_contact() == (step, pytest.approx(gap, abs=1e-3))


@pytest.mark.parametrize(("geoms", "step", "gap"), [(case[0], case[3], case[4]) for case in CASES])
def test_first_contact_with_a_box(tmp_path: Path, geoms: str, step: int, gap: float) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 0.1])
    p.createMultiBody(0, box, basePosition=[0, 0, -0.1])
    load(tmp_path, geoms)
    assert first_contact() == (step, pytest.approx(gap, abs=1e-3))


def test_with_implicit_cylinders_they_are_capsules(tmp_path: Path) -> None:
    body = load(tmp_path, CAPSULE.format(LYING), p.URDF_USE_IMPLICIT_CYLINDER)
    assert p.getAABB(body)[1] == pytest.approx([0.05, 0.25, 0.65])
