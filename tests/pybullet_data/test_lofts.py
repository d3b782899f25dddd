"""Lofts: closed skins that pass through their sections, and the housings of arms that are made of them."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from tests.each import each
from tools.assets.housings.kuka_links import LOFTS as KUKA
from tools.assets.housings.lofts import OTHERS, PAINT, SIDES, Loft, band, housing, loft_mesh
from tools.assets.housings.panda_links import LOFTS as PANDA
from tools.assets.obj_mesh import ObjMesh, triangles

ARMS = {
    f"{arm}-{name}": lofts
    for arm, links in (("panda", PANDA), ("kuka", KUKA))
    for name, lofts in links.items()
}
CONE = ((0.0, 0.1, -0.2, 0.3, 0.4), (0.5, 0.1, -0.2, 0.15, 0.2))


def volume(mesh: ObjMesh) -> float:
    """Of a closed mesh; positive if its faces are seen from outside [m³]."""
    a, b, c = np.moveaxis(mesh.vertices[triangles(mesh)], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def edges(mesh: ObjMesh) -> list[tuple[int, int]]:
    """Edges of all faces, as they are walked, between distinct places."""
    _, number = np.unique(np.round(mesh.vertices, 9), axis=0, return_inverse=True)
    places = number.ravel()[triangles(mesh)].tolist()
    return [(face[i], face[(i + 1) % 3]) for face in places for i in range(3)]


@each("axis", "xyz")
def test_a_loft_spans_its_sections(axis: Literal["x", "y", "z"]) -> None:
    mesh = loft_mesh(Loft(axis, 2.0, CONE))
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    along, across = "xyz".index(axis), list(OTHERS[axis])
    assert (low[along], high[along]) == (0.0, 0.5)
    assert low[across] == pytest.approx((-0.2, -0.6)) and high[across] == pytest.approx((0.4, 0.2))


@each("axis", "xyz")
def test_a_loft_is_closed_and_seen_from_outside(axis: Literal["x", "y", "z"]) -> None:
    mesh = loft_mesh(Loft(axis, 2.0, CONE))
    walked = edges(mesh)
    assert {(b, a) for a, b in walked} == set(walked) and len(set(walked)) == len(walked)
    exact = np.pi * 0.3 * 0.4 * 0.5 * 7.0 / 12.0
    assert volume(mesh) == pytest.approx(exact * np.sinc(2.0 / SIDES), rel=1e-9)
    assert mesh.normals is not None
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
    middle = np.full(3, 0.25)
    middle[list(OTHERS[axis])] = 0.1, -0.2
    assert np.einsum("ij,ij->i", mesh.vertices - middle, mesh.normals).min() > 0.0


def test_a_higher_power_fills_the_corners() -> None:
    round_one, square_one = (
        volume(loft_mesh(Loft("z", power, ((0, 0, 0, 1, 1), (1, 0, 0, 1, 1))))) for power in (2.0, 8.0)
    )
    assert 1.15 * round_one < square_one < 4.0


@each("sections", [CONE[:1], (CONE[1], CONE[0]), (CONE[0], CONE[0])], ids=["one", "backwards", "twice"])
def test_sections_have_to_go_along(sections: tuple[tuple[float, float, float, float, float], ...]) -> None:
    with pytest.raises(ValueError, match="further along y"):
        loft_mesh(Loft("y", 2.0, sections))


def test_a_band_lies_on_its_loft() -> None:
    sections = ((0.0, 0.0, 0.0, 0.1, 0.1), (0.1, 0.0, 0.02, 0.2, 0.1), (0.2, 0.0, 0.02, 0.2, 0.1))
    painted = band(Loft("z", 3.0, sections), 0.05, 0.15)
    assert (painted.axis, painted.power) == ("z", 3.0)
    assert np.array(painted.sections) == pytest.approx(
        np.array(
            (
                (0.05, 0.0, 0.01, 0.15 + PAINT, 0.1 + PAINT),
                (0.1, 0.0, 0.02, 0.2 + PAINT, 0.1 + PAINT),
                (0.15, 0.0, 0.02, 0.2 + PAINT, 0.1 + PAINT),
            )
        )
    )


@each("name", sorted(ARMS))
def test_housings_of_arms_are_bodies(name: str) -> None:
    mesh = housing(ARMS[name])
    assert volume(mesh) == pytest.approx(sum(volume(loft_mesh(loft)) for loft in ARMS[name]))
    assert all(volume(loft_mesh(loft)) > 0.0 for loft in ARMS[name])
