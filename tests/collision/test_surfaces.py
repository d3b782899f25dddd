"""Shapes on triangle meshes and height fields against the same shapes on planes and boxes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import (
    Scene,
    Shape,
    box,
    capsule,
    cylinder,
    height_field,
    hull,
    plane,
    sphere,
    triangles,
)

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.5
SHAPES = {
    "sphere": lambda **at: sphere(0.5, **at),
    "box": lambda **at: box((0.5, 0.5, 0.5), margin=0.001, **at),
    "capsule": lambda **at: capsule(0.5, 0.7, **at),
    "cylinder": lambda **at: cylinder(0.5, 0.5, margin=0.001, **at),
    "hull": lambda **at: hull(CUBE, margin=0.001, **at),
}
# Extents of what they touch flat ground with, the capsule lying along x.
EXTENTS = {"sphere": (0, 0), "box": (1, 1), "capsule": (1.4, 0), "cylinder": (1, 1), "hull": (1, 1)}


def flat_mesh(cells: int = 12, **at) -> Shape:
    """A flat square of many triangles with sides of 6 m."""
    side = np.linspace(-3, 3, cells + 1)
    x, y = np.meshgrid(side, side)
    vertices = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    corners = [i + (cells + 1) * j for i in range(cells) for j in range(cells)]
    faces = [f for a in corners for f in ((a, a + 1, a + cells + 1), (a + 1, a + cells + 2, a + cells + 1))]
    return triangles(vertices, faces, **at)


GROUND = {"mesh": flat_mesh, "height field": lambda **at: height_field(np.zeros((13, 13)), (0.5, 0.5), **at)}


@pytest.mark.parametrize("ground", GROUND)
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("place", [(0.03, 0.01), (0.25, -0.25), (1.0, 0.5)])
def test_flat_ground_is_like_a_slab(name, ground, place):
    scene = Scene([SHAPES[name](position=(*place, 0.4995)), GROUND[ground]()])
    flat = Scene([SHAPES[name](position=(*place, 0.4995)), box((9, 9, 9), position=(0, 0, -9), static=True)])
    for one in (scene, flat):
        if name == "capsule":
            one.place(0, (*place, 0.4995), (0, np.sqrt(0.5), 0, np.sqrt(0.5)))
        one.collide()
    distance, normal = scene.contacts("distance"), scene.contacts("normal")
    assert distance.min() == pytest.approx(flat.contacts("distance").min(), abs=1e-6)
    touching = distance < 0
    assert_allclose(normal[touching], [[0, 0, 1]] * touching.sum(), atol=1e-6)
    extent = np.ptp(scene.contacts("point_b"), axis=0)[:2]
    assert_allclose(extent, EXTENTS[name], atol=0.3)


@pytest.mark.parametrize("ground", GROUND)
@pytest.mark.parametrize("name", SHAPES)
def test_nearest_distance_to_flat_ground(name, ground):
    scene = Scene([SHAPES[name](position=(0.1, 0.2, 1.5)), GROUND[ground](margin=0.0), plane()])
    to_surface, to_plane = scene.closest([(0, 1), (0, 2)])
    assert_allclose(to_surface[3:7], to_plane[3:7], atol=1e-6)
    swapped = scene.closest([(1, 0)])[0]
    assert_allclose(swapped[3:6], -to_surface[3:6], atol=1e-9)


def test_the_margin_of_triangles_lies_outside_but_not_for_balls():
    scene = Scene(
        [sphere(0.5, position=(0.1, 0.1, 2)), box((0.5,) * 3, position=(0, 0, 2)), flat_mesh(margin=0.01)]
    )
    ball, cube = scene.closest([(0, 2), (1, 2)])[:, 6]
    assert ball == pytest.approx(1.5, abs=1e-9)
    assert cube == pytest.approx(1.49, abs=1e-9)


def test_a_box_that_slides_over_the_edges_of_flat_triangles_is_not_stopped():
    scene = Scene([SHAPES["box"](position=(0, 0, 0.4999)), flat_mesh()])
    for x in np.linspace(0.0, 1.0, 50):
        scene.place(0, (x, 0.1, 0.4999))
        scene.collide()
        normals = scene.contacts("normal")
        assert len(normals) >= 3
        assert_allclose(normals, [[0, 0, 1]] * len(normals), atol=1e-6)


def test_contacts_of_a_ball_in_a_corner_of_a_mesh():
    vertices = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0], [-2, -2, 3], [-2, 2, 3]]
    corner = triangles(vertices, [[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4]])
    scene = Scene([sphere(0.5, position=(-1.501, 0.3, 0.499)), corner])
    scene.collide()
    normals = scene.contacts("normal")[np.argsort(scene.contacts("distance"))[:2]]
    assert_allclose(sorted(normals.tolist()), [[0, 0, 1], [1, 0, 0]], atol=1e-9)


def test_surfaces_and_planes_make_no_contacts_with_each_other():
    scene = Scene([plane(), flat_mesh(), height_field(np.zeros((4, 4)))])
    scene.numpy("model")["link_dof_count"][:3] = 6
    scene.collide()
    assert len(scene.contacts("distance")) == 0
    assert (scene.closest([(0, 1), (1, 2), (0, 2)])[:, 7] == 0).all()
