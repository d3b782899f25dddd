"""Moments, bounds and margins of shapes that MJCF files give by their ends; numbers from PyBullet 3.2.7."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p

IMPLICIT = p.URDF_USE_IMPLICIT_CYLINDER
CENTRED, UPRIGHT = 'fromto="0 0 -.3 0 0 .3"', 'fromto="0 0 0 0 0 .6"'
ASKEW = 'fromto=".1 .2 .3 -.2 .3 .5" pos=".1 0 .1" quat=".8 0 .6 0"'
Vector = tuple[float, float, float]


def upright(radius: float, half_height: float) -> list[Vector]:
    """Bounds of a shape that stands upright around the origin."""
    return [(-radius, -radius, -half_height), (radius, radius, half_height)]


OF_CAPSULE: tuple[Vector, Vector, list[Vector]] = (
    (0.1694191354, 0.1694191354, 0.005668298211),
    (0.1210500096, 0.1210500096, 0.004050000322),
    upright(0.04500000179, 0.3450000137),
)
OF_CYLINDER: tuple[Vector, Vector, list[Vector]] = (
    (0.1170875742, 0.1170875742, 0.005152998374),
    (0.09202500731, 0.09202500731, 0.004050000322),
    upright(0.04500000179, 0.3000000119),
)
SWEPT = upright(0.08500000179, 0.3850000137)
# Kind; flags; ends; margin; moments as loaded, and of 3 kg; bounds.
CASES: list[tuple[str, int, str, float, Vector, Vector, list[Vector]]] = [
    ("capsule", 0, CENTRED, 0.04, *OF_CAPSULE[:2], SWEPT),
    (
        *("capsule", 0, UPRIGHT, 0.0),
        (0.2175646786, 0.2175646786, 0.02022392743),
        (0.1554500109, 0.1554500109, 0.01445000061),
        SWEPT,
    ),
    (
        *("capsule", 0, ASKEW, 0.0),
        (0.0876265256, 0.1253915341, 0.07132383795),
        (0.09517576171, 0.1361943166, 0.07746855827),
        [(0.2766000186, -0.1350000063, -0.4174000109), (0.7634000045, 0.1350000063, 0.1373999891)],
    ),
    ("capsule", IMPLICIT, CENTRED, 0.0, *OF_CAPSULE),
    ("capsule", IMPLICIT, UPRIGHT, 0.0, *OF_CAPSULE),
    (
        *("capsule", IMPLICIT, ASKEW, 0.0),
        (0.07266112701, 0.1084885303, 0.05860323535),
        (0.078921058, 0.1178350783, 0.06365204513),
        [(0.2935424378, -0.1112160619, -0.3979768424), (0.7464575853, 0.1112160619, 0.1179768206)],
    ),
    ("cylinder", 0, CENTRED, 0.0, *OF_CYLINDER),
    ("cylinder", 0, UPRIGHT, 0.0, *OF_CYLINDER),
    (
        *("cylinder", 0, ASKEW, 0.0),
        (0.04503297604, 0.06686255666, 0.0374422579),
        (0.05675615305, 0.08426850351, 0.04718938669),
        [(0.3267362835, -0.09918930445, -0.3566048006), (0.7132637396, 0.09918930445, 0.07660477883)],
    ),
]


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize(("kind", "flags", "ends", "margin", "moments", "of_three", "bounds"), CASES)
def test_a_shape_given_by_its_ends_counts_as_its_box(
    tmp_path: Path,
    kind: str,
    flags: int,
    ends: str,
    margin: float,
    moments: Vector,
    of_three: Vector,
    bounds: list[Vector],
):
    file = tmp_path / "body.xml"
    geom = f'<geom type="{kind}" size=".045" {ends}/>'
    file.write_text(f'<mujoco><worldbody><body><joint type="free"/>{geom}</body></worldbody></mujoco>')
    (body,) = p.loadMJCF(str(file), flags=flags)
    info = p.getDynamicsInfo(body, -1)
    assert info[2] == pytest.approx(moments, rel=1e-9)
    assert info[11] == pytest.approx(margin, abs=1e-12)
    assert p.getAABB(body, -1) == tuple(pytest.approx(corner, abs=1e-9) for corner in bounds)
    p.changeDynamics(body, -1, mass=3.0)
    assert p.getDynamicsInfo(body, -1)[2] == pytest.approx(of_three, rel=1e-9)
