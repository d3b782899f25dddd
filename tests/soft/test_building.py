"""Soft bodies from meshes: what follows from cells, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.soft.scenes import write_cube, write_grid

from carom import World
from carom.errors import DescriptionError
from carom.scene.soft_body import SoftBody
from carom.soft.build import soft_body
from carom.soft.files import soft_body_from_file
from carom.soft.materials import NeoHookean, Springs
from carom.soft.shapes import ball, box, grid, oriented
from carom.soft.skin import bind
from carom.soft.topology import bending_pairs, edges_of, surface_of

TETRA = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
ONE = np.array([[0, 1, 2, 3]], dtype=np.int32)


def volumes(nodes: np.ndarray, tetras: np.ndarray) -> np.ndarray:
    corners = nodes[tetras]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6


def test_edges_are_found_once() -> None:
    _, triangles = grid((1.0, 1.0), (1, 1))
    assert edges_of(triangles).tolist() == [[0, 1], [0, 2], [0, 3], [1, 3], [2, 3]]


def test_bending_pairs_have_a_neighbour_in_common() -> None:
    edges = np.array([[0, 1], [1, 2], [2, 3]], dtype=np.int32)
    assert bending_pairs(edges, 4).tolist() == [[0, 2], [1, 3]]
    _, triangles = grid((1.0, 1.0), (1, 1))
    assert bending_pairs(edges_of(triangles), 4).tolist() == [[1, 2]]


def test_a_grid_has_its_cells_along_each_side() -> None:
    nodes, triangles = grid((2.0, 3.0), (2, 5))
    assert len(nodes) == 3 * 6 and len(triangles) == 2 * 2 * 5
    corners = nodes[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # All look up, and are as large as half a cell.
    assert across == pytest.approx(np.tile([0.0, 0.0, 2.0 * 3.0 / 10], (20, 1)))


def test_points_of_a_skin_follow_the_cell_that_they_are_in() -> None:
    nodes, tetras = box((1.0, 1.0, 1.0), (4, 4, 4))
    points = np.random.default_rng(5).uniform(-0.5, 0.5, (200, 3))
    followed, weights = bind(points, nodes, tetras)
    assert weights.min() > -1e-9
    assert weights.sum(axis=1) == pytest.approx(np.ones(200))
    assert (weights[..., None] * nodes[followed]).sum(axis=1) == pytest.approx(points)


def test_the_surface_is_closed_and_looks_outward() -> None:
    nodes, tetras = box((1.0, 2.0, 3.0), (2, 3, 4))
    faces = surface_of(tetras)
    corners = nodes[faces]
    # Gauss: the surface has the volume of what is inside.
    assert np.linalg.det(corners).sum() / 6 == pytest.approx(6.0)
    assert len(faces) == 2 * 2 * (2 * 3 + 3 * 4 + 2 * 4)


def test_shapes_fill_their_volume() -> None:
    assert volumes(*box((1.0, 2.0, 3.0), (2, 3, 4))).sum() == pytest.approx(6.0)
    nodes, tetras = ball(0.5, 8)
    assert (volumes(nodes, tetras) > 0.0).all()
    assert volumes(nodes, tetras).sum() == pytest.approx(4 / 3 * np.pi * 0.5**3, rel=0.05)
    assert np.linalg.norm(nodes, axis=1).max() == pytest.approx(0.5)


def test_inverted_tetrahedra_are_turned_round() -> None:
    turned = oriented(TETRA, ONE[:, [1, 0, 2, 3]])
    assert volumes(TETRA, turned)[0] == pytest.approx(1 / 6)


def test_small_strains_are_those_of_a_linear_solid() -> None:
    solid = NeoHookean.of(1e4, 0.3)
    nodes, tetras = box((1.0, 1.0, 1.0), (1, 1, 1))
    shear, first = 0.75 * solid.mu, solid.lam - 0.625 * solid.mu
    assert shear == pytest.approx(1e4 / 2.6)
    assert first == pytest.approx(1e4 * 0.3 / (1.3 * 0.4))
    assert len(nodes) == 8 and len(tetras) == 6


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"mass": 0.0}, "mass is 0.0; it has to be finite and greater than 0"),
        ({"mass": float("nan")}, "mass is nan"),
        ({"mass": 1e-320}, "1e-30 kg is the minimum"),
        ({"margin": -1.0}, "the collision margin is -1.0"),
        ({"friction": -0.5}, "friction is -0.5; it has to be finite and 0 or more"),
        ({"springs": Springs(-1.0)}, "the stiffness of springs is -1.0"),
        ({"springs": Springs(1.0, float("inf"))}, "the damping of springs is inf"),
        ({"solid": NeoHookean(1.0, -1.0)}, "lambda is -1.0"),
        ({"nodes": TETRA * np.nan}, "node 0 is not finite"),
        ({"nodes": TETRA * 1e9}, "node 1 is not finite, or farther than 1e\\+06 m away"),
        ({"nodes": TETRA * [1, 1, 0]}, "tetrahedron 0 has no volume"),
        ({"cells": ONE + 1}, "a cell names a node outside 0..3"),
        ({"cells": ONE[:, [0, 0, 2, 3]]}, "tetrahedron 0 has no volume"),
        ({"cells": ONE[:0]}, "no cells to simulate"),
        ({"cells": np.array([[0, 1, 1]]), "springs": Springs(1.0)}, "each of its faces names a node twice"),
        ({"nodes": TETRA * 0, "cells": np.array([[0, 1, 2]])}, "all corners of its cells are in one place"),
    ],
)
def test_what_makes_no_sense_is_refused(change: dict, problem: str) -> None:
    arguments = {"nodes": TETRA, "cells": ONE, "mass": 1.0, **change}
    with pytest.raises(DescriptionError, match=problem):
        soft_body("bad", arguments.pop("nodes"), arguments.pop("cells"), **arguments)


def test_files_give_the_meshes_they_hold(tmp_path: Path) -> None:
    cloth = soft_body_from_file(write_grid(tmp_path / "cloth.obj", 5), springs=Springs(10.0, 0.1, 1.0))
    assert cloth.soft is not None and cloth.name == "cloth"
    assert (len(cloth.soft.nodes), len(cloth.soft.faces), len(cloth.soft.tetras)) == (25, 32, 0)
    cube = soft_body_from_file(write_cube(tmp_path / "cube.vtk", 3), solid=NeoHookean(1.0, 1.0), scale=2.0)
    assert cube.soft is not None
    assert (len(cube.soft.nodes), len(cube.soft.faces), len(cube.soft.tetras)) == (64, 108, 162)
    assert np.ptp(cube.soft.nodes, axis=0) == pytest.approx([0.8] * 3)


# How far the nodes of two triangles that hang from a corner are from where they are without a third face,
# after 100 steps of PyBullet, by that face. One that names a node twice is no face, but its edge is a spring.
_THIRD_FACES = {
    "1 1 4": [[-0.0097, -0.0277, -0.0004], [-0.0277, -0.0097, -0.0004], [-0.0660, -0.0660, 0.0447]],
    "4 1 4": [[-0.0097, -0.0277, -0.0004], [-0.0277, -0.0097, -0.0004], [-0.0660, -0.0660, 0.0447]],
    "4 4 4": [[0.0, 0.0, 0.0]] * 3,
    "1 2 2": [[0.0, 0.0, 0.0]] * 3,
}


@pytest.mark.parametrize("face", _THIRD_FACES)
def test_faces_that_name_a_node_twice_are_none(face: str, tmp_path: Path) -> None:
    hung = []
    for name, third in (("without", ""), ("with", f"f {face}\n")):
        file = tmp_path / f"{name}.obj"
        file.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n{third}", encoding="utf-8")
        world = World()
        world.gravity = (0.0, 0.0, -10.0)
        cloth = world.load_cloth(mesh=file, stiffness=40.0, bending=0.1, damping=0.1)
        assert len(cloth.faces) == 2
        # All of them are drawn.
        assert len(cloth.surface[1]) == (3 if third else 2)
        cloth.anchor(0)
        world.step(100)
        hung.append(cloth.nodes[1:].copy())
    assert hung[1] - hung[0] == pytest.approx(np.array(_THIRD_FACES[face]), abs=1e-3)


def test_corners_in_one_place_stay_there() -> None:
    """A seam: two squares side by side, joined by triangles that have no area."""
    nodes, triangles = grid((0.2, 0.2), (2, 2))
    right, left = np.flatnonzero(nodes[:, 0] > 0.099), np.flatnonzero(nodes[:, 0] < -0.099) + len(nodes)
    seam = [[right[k], left[k], right[k + 1]] for k in range(2)] + [[right[2], left[2], left[1]]]
    both = np.concatenate([nodes, nodes + np.array([0.2, 0.0, 0.0])])
    cells = np.concatenate([triangles, triangles + len(nodes), np.array(seam, dtype=np.int32)])
    world = World()
    world.gravity = (0.0, 0.0, -10.0)
    cloth = world.load(
        soft_body(
            "seam", both, cells, mass=0.2, springs=Springs(200.0, 0.1), margin=0.02, self_collision=True
        )
    )
    assert isinstance(cloth, SoftBody)
    # Not the length of these edges, which is none.
    assert cloth.soft_spec.thickness() == pytest.approx(0.02)
    for node in np.flatnonzero(both[:, 0] < -0.099):
        cloth.anchor(int(node))
    world.step(480)
    assert cloth.nodes[:, 2].min() < -0.1
    # Half of the weight pulls at three springs.
    assert np.linalg.norm(cloth.nodes[right] - cloth.nodes[left], axis=1).max() < 0.01


def test_a_load_that_fails_leaves_the_world_as_it_was(tmp_path: Path) -> None:
    world = World()
    world.load_cloth()
    world.step(3)
    before = world.arrays.state.numpy["node_position"].copy()
    with pytest.raises(DescriptionError):
        world.load_cloth(mesh=tmp_path / "missing.obj")
    with pytest.raises(DescriptionError, match="Poisson"):
        world.load_soft_solid(poissons_ratio=0.5)
    with pytest.raises(ValueError, match="cells must be whole numbers"):
        world.load_rope(cells=0)
    assert len(world.bodies) == 1
    assert np.array_equal(world.arrays.state.numpy["node_position"], before)


@pytest.mark.parametrize(("modulus", "ratio"), [(1e4, -0.1), (1e4, 0.5), (0.0, 0.3)])
def test_a_solid_that_cannot_be_elastic_is_refused(modulus: float, ratio: float) -> None:
    world = World()
    with pytest.raises(DescriptionError, match="the first has to be greater than 0"):
        world.load_soft_solid(youngs_modulus=modulus, poissons_ratio=ratio)
    assert not world.bodies
