"""Beams, pendulums and blocks of soft bodies against the theory of elasticity and mechanics."""

from __future__ import annotations

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, rigid, world
from tests.soft.test_physics import settled

from carom.description import Plane


def tip_of_cantilever(cells: int, thickness: int) -> float:
    """How far the end of a beam hangs down that is held at the other end [m]."""
    where = world()
    beam = where.load_soft_solid(
        (0.8, 0.1, 0.1), (cells, thickness, thickness), youngs_modulus=4e5, poissons_ratio=0.0, mass=0.8,
        damping=0.02,
    )  # fmt: skip
    for node in np.flatnonzero(beam.nodes[:, 0] < -0.399):
        beam.anchor(int(node))
    end = beam.nodes[:, 0] > 0.399
    settled(beam, 2.0)
    return float(-beam.nodes[end, 2].mean())


@pytest.mark.long
def test_a_cantilever_bends_as_a_beam_the_finer_the_better() -> None:
    """Timoshenko's beam; linear tetrahedra are too stiff, and less so when finer."""
    length, side, modulus = 0.8, 0.1, 4e5
    load = 0.8 * GRAVITY / length
    bending = load * length**4 / (8.0 * modulus * side**4 / 12.0)
    shear = load * length**2 / (2.0 * 5.0 / 6.0 * modulus / 2.0 * side**2)
    wanted = bending + shear
    coarse, fine = tip_of_cantilever(16, 2), tip_of_cantilever(24, 3)
    # What solving the equations of linear elasticity for these meshes gives, but for the large displacement.
    assert (coarse, fine) == pytest.approx((0.0874, 0.1149), rel=0.03)
    # The error goes with the square of the size of cells.
    assert (9.0 * fine - 4.0 * coarse) / 5.0 == pytest.approx(wanted, rel=0.15)


def test_a_pendulum_of_cloth_swings_as_a_stiff_sheet_would() -> None:
    """A physical pendulum: of a sheet that hangs from its edge and is swung by a small angle."""
    where = world()
    length, angle = 0.4, 0.1
    cloth = where.load_cloth((0.2, length), (4, 8), stiffness=5e3, bending=5e3, damping=0.0, mass=0.2)
    down = cloth.nodes[:, 1] + length / 2
    places = np.stack([cloth.nodes[:, 0], down * np.sin(angle), -down * np.cos(angle)], axis=1)
    cloth.set_nodes(places)
    for node in np.flatnonzero(down < 1e-9):
        cloth.anchor(int(node))
    crossings, last = [], 1.0
    for step in range(720):
        where.step()
        y = float(cloth.nodes[:, 1].mean())
        if y < 0.0 <= last:
            crossings.append((step + y / (last - y)) / 240.0)
        last = y
    # Nodes of equal mass, those of the edge at rest.
    moment, first = float((down**2).sum()), float(down.sum())
    period = 2.0 * np.pi * np.sqrt(moment / (GRAVITY * first)) * (1 + angle**2 / 16)
    assert np.diff(crossings) == pytest.approx(period, rel=0.03)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.45])
def test_a_pressed_block_loses_the_volume_that_poissons_ratio_says(ratio: float) -> None:
    """On a plane without friction: the volume of its middle changes by (1 - 2 nu) times the strain."""
    where = world(0.0)
    rigid(where, Plane(), friction=0.0)
    block = where.load_soft_solid(
        (0.3, 0.3, 0.3), (6, 6, 6), (0, 0, 0.155), youngs_modulus=1e4, poissons_ratio=ratio, damping=0.05
    )
    rest = block.nodes.copy()
    top = rest[:, 2] > 0.304
    # As much on each node as there is surface around it.
    sides = (np.abs(rest[:, :2]) > 0.149).sum(axis=1)
    share = np.where(top, 0.5**sides, 0.0)
    share *= 45.0 / share.sum()
    for _ in range(720):
        block.node_forces[:, 2] = -share
        where.step()
    corners = block.soft_spec.tetras
    corners = corners[(np.abs(rest[corners][:, :, 2] - 0.155) < 0.101).all(axis=1)]

    def volume(nodes: np.ndarray) -> float:
        edges = nodes[corners][:, 1:] - nodes[corners][:, :1]
        return float(np.linalg.det(edges).sum() / 6.0)

    upper, lower = np.abs(rest[:, 2] - 0.255) < 1e-9, np.abs(rest[:, 2] - 0.055) < 1e-9
    strain = 1.0 - float(block.nodes[upper, 2].mean() - block.nodes[lower, 2].mean()) / 0.2
    assert strain == pytest.approx(45.0 / 0.09 / 1e4, rel=0.1)
    change = 1.0 - volume(block.nodes) / volume(rest)
    assert change == pytest.approx((1.0 - 2.0 * ratio) * strain, abs=0.1 * strain)


def test_sag_of_a_cube_converges_with_resolution() -> None:
    """A cube on the floor under its own weight: ever finer meshes agree ever better."""
    heights = []
    for cells in (2, 4, 8):
        where = world()
        rigid(where, Plane(), friction=0.0)
        cube = where.load_soft_solid(
            (0.2, 0.2, 0.2), (cells, cells, cells), (0, 0, 0.105), youngs_modulus=1e4, damping=0.05, mass=2.0
        )
        settled(cube, 2.0)
        heights.append(float(cube.nodes[:, 2].max()))
    assert abs(heights[2] - heights[1]) < abs(heights[1] - heights[0])
    # Stress m g (1 - z / h) / A, of which the mean is half of that at the floor.
    assert 0.205 - heights[2] == pytest.approx(0.2 * 2.0 * GRAVITY / 2 / 0.04 / 1e4, rel=0.15)
