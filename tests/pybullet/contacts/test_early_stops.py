"""First contacts of two bodies where Bullet's GJK stops before it is done; numbers from PyBullet 3.2.7.

It stops at a tetrahedron whose volume is less than 1.7e-9 m³. Where shapes are small, or one is round, its
answer is off by then: the normal by up to 6e-2, the point by up to 0.2 mm. None of these answers changes by
more than 1e-9 if a body starts 1e-12 m elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin

import pytest

import pybullet as p

Numbers = list[float]
SHARD = [[0.02, 0, 0], [0, 0.015, 0], [0, 0, 0.02], [-0.01, -0.02, 0], [-0.01, 0.01, -0.02]]
# Shape and orientation of the first; shape, position and orientation of the second; point, normal, distance.
CASES: list[tuple[str, Numbers, str, Numbers, Numbers, Numbers, Numbers, float]] = [
    (
        "drum",
        [-0.241, 0.559, -0.607, 0.512],
        "box",
        [0.12118, -0.03233, -0.27222],
        [0.317, 0.696, -0.495, 0.413],
        [-0.015320793, -0.049974467, -0.090179692],
        [0.02006589, 0.544973377, 0.838213206],
        0.0031355951,
    ),
    (
        "drum",
        [0.052, 0.759, -0.482, 0.435],
        "drum",
        [0.0705, -0.19291, 0.17468],
        [0.151, 0.735, 0.425, 0.505],
        [0.104374897, -0.125759541, 0.075654796],
        [-0.30267135, 0.315499388, -0.89936099],
        0.0005567058,
    ),
    (
        "ball",
        [0.585, 0.388, -0.138, -0.699],
        "drum",
        [0.21913, 0.15033, -0.08502],
        [0.73, -0.376, -0.218, 0.528],
        [0.080278292, 0.043659971, -0.0439104],
        [-0.724387355, -0.520221856, 0.452362885],
        0.0006965288,
    ),
    (
        "pin",
        [0.257, -0.813, -0.094, -0.514],
        "drum",
        [-0.10159, 0.01038, 0.07572],
        [0.93, 0.318, -0.166, -0.077],
        [-0.021710906, 0.010396723, 0.004789182],
        [0.933257738, -0.018240422, -0.358744032],
        4.91288e-05,
    ),
    (
        "shard",
        [-0.027, -0.485, 0.417, -0.768],
        "drum",
        [-0.15251, 0.12842, 0.00298],
        [0.027, 0.485, -0.417, 0.768],
        [-0.011725861, 0.016825495, -0.001141197],
        [0.573244404, -0.561815848, -0.59645101],
        0.0007546292,
    ),
    (
        "drum",
        [-0.079, 0.798, 0.54, -0.255],
        "ball",
        [0.24058, -0.01578, 0.0648],
        [-0.079, 0.798, 0.54, -0.255],
        [0.156166497, -0.069509705, 0.052119836],
        [-0.892223808, -0.426464089, -0.148543116],
        -0.0012754549,
    ),
    (
        "pin",
        [0.717, -0.132, 0.675, 0.113],
        "ball",
        [-0.06667, -0.02878, 0.1018],
        [-0.426, -0.584, 0.689, 0.05],
        [-0.014747327, -0.00176808, 0.019587618],
        [0.499042387, 0.138071198, -0.855507476],
        -9.198e-06,
    ),
    (
        "drum",
        [-0.052, -0.419, 0.172, -0.89],
        "pin",
        [-0.05063, -0.0863, -0.11781],
        [-0.58, -0.499, -0.58, 0.279],
        [-0.055027039, -0.065715549, -0.105085466],
        [-0.118281824, 0.881077917, 0.457942261],
        -0.0004809423,
    ),
    (
        "ball",
        [0.201, 0.399, 0.861, 0.244],
        "pin",
        [-0.01064, -0.07131, -0.09683],
        [0.201, 0.399, 0.861, 0.244],
        [-0.018342223, -0.058922708, -0.077203847],
        [0.193211385, 0.596906186, 0.778699149],
        -0.0012930168,
    ),
    (
        "drum",
        [0.991, -0.068, -0.116, -0.02],
        "shard",
        [0.01807, -0.11607, 0.01648],
        [-0.883, -0.235, 0.371, -0.164],
        [0.001231984, -0.101293478, 0.021547262],
        [0.042401765, 0.997998023, 0.046925857],
        3.37972e-05,
    ),
    (
        "ball",
        [-0.682, 0.311, 0.342, -0.567],
        "shard",
        [0.01157, 0.03338, -0.1054],
        [-0.366, -0.63, -0.685, 0.032],
        [0.019036619, 0.030007938, -0.091868061],
        [-0.098590178, -0.297421272, 0.949642335],
        -0.001789115,
    ),
    (
        "pin",
        [0.098, -0.814, 0.057, 0.57],
        "shard",
        [-0.0253, -0.03161, -0.00125],
        [0.49, -0.351, -0.708, -0.367],
        [-0.012864528, -0.020352642, 0.004762701],
        [0.300637914, 0.862800735, -0.406437864],
        2.388e-06,
    ),
    (
        "box",
        [-0.634, 0.388, -0.609, -0.277],
        "drum",
        [-0.08976, 0.15416, 0.1938],
        [-0.519, 0.032, 0.414, 0.747],
        [0.05430595, 0.080845681, 0.115065348],
        [0.53235011, -0.705082383, -0.468467921],
        -0.0016436368,
    ),
    (
        "shard",
        [0.58, 0.277, 0.145, 0.752],
        "ball",
        [-0.09317, -0.06282, -0.03196],
        [0.58, 0.277, 0.145, 0.752],
        [-0.00941859, -0.0106891, -0.016448119],
        [0.852310477, 0.499244122, 0.155955624],
        -0.0018109336,
    ),
    (
        "pin",
        [0.362, 0.002, 0.067, 0.93],
        "pin",
        [-0.00016, 0.04293, 0.0078],
        [-0.125, 0.851, -0.398, -0.318],
        [0.007719305, 0.022756745, 0.001133692],
        [-0.438345594, -0.76038914, -0.479230106],
        -0.0004806524,
    ),
    (
        "shard",
        [0.775, 0.316, 0.166, -0.521],
        "pin",
        [-0.01499, 0.02669, 0.01319],
        [0.648, -0.353, 0.347, -0.579],
        [-0.018486253, 0.003524584, 0.006273025],
        [0.338351903, -0.834122171, -0.435612436],
        -0.0012926301,
    ),
    (
        "ball",
        [0.117, -0.151, -0.13, -0.973],
        "ball",
        [-0.00624, -0.09739, 0.1748],
        [-0.459, 0.503, -0.552, -0.481],
        [-0.000762871, -0.044938136, 0.089770174],
        [0.017886313, 0.549365122, -0.835390952],
        -0.0004873446,
    ),
]


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def shape(name: str) -> int:
    if name == "box":
        return p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.05])
    if name == "drum":
        return p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.3)
    if name == "pin":
        return p.createCollisionShape(p.GEOM_CYLINDER, radius=0.02, height=0.03)
    return p.createCollisionShape(p.GEOM_MESH, vertices=ball() if name == "ball" else SHARD)


def ball() -> list[Numbers]:
    """Points on a sphere: eleven rings of forty."""
    points = []
    for meridian in range(40):
        longitude = 2 * pi * meridian / 40
        for ring in range(-5, 6):
            latitude = pi * ring / 12
            x, y = cos(longitude) * cos(latitude), sin(longitude) * cos(latitude)
            points.append([0.1 * x, 0.1 * y, 0.1 * sin(latitude)])
    return points


@pytest.mark.parametrize(
    ("first", "turn", "second", "place", "other_turn", "point", "normal", "distance"), CASES
)
def test_gjk_stops_where_bullets_does(
    first: str,
    turn: Numbers,
    second: str,
    place: Numbers,
    other_turn: Numbers,
    point: Numbers,
    normal: Numbers,
    distance: float,
):
    a = p.createMultiBody(1, shape(first), -1, [0, 0, 0], turn)
    b = p.createMultiBody(1, shape(second), -1, place, other_turn)
    p.performCollisionDetection()
    (contact,) = p.getContactPoints(a, b)
    assert contact[6] == pytest.approx(point, abs=2e-9)
    assert contact[7] == pytest.approx(normal, abs=2e-9)
    assert contact[8] == pytest.approx(distance, abs=1e-9)
