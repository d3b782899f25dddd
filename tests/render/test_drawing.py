"""What is drawn: the nearest surface of every pixel, found again by rays."""

from typing import Any

import numpy as np
import pytest
from drawing import FAR, NEAR, add_collision_only, add_shape, draw, first_hit, rays
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

from carom.description import Box, Cylinder, Material, Plane, Sphere, TriangleMesh
from carom.description.transform import rotation_matrix
from carom.render import parallel
from carom.render.appearance import appearance_of
from carom.render.lights import Light
from carom.render.projection import look_at, parallel_projection
from carom.render.renderer import MAX_SIDE, Renderer, renderer_of
from carom.world.world import World

PLACES = st.floats(-1.5, 1.5)
SIDES = st.floats(0.1, 1.0)
ANGLES = st.floats(-1.0, 1.0)


@st.composite
def boxes(draw_value):
    quaternion = np.array([draw_value(ANGLES) for _ in range(3)] + [1.5])
    quaternion /= np.linalg.norm(quaternion)
    sides = tuple(draw_value(SIDES) for _ in range(3))
    return Box(sides), tuple(draw_value(PLACES) for _ in range(3)), tuple(quaternion.tolist())


@settings(max_examples=cases(30), deadline=None)
@given(st.lists(boxes(), min_size=1, max_size=4), st.tuples(PLACES, st.floats(-6.0, -4.0), PLACES))
def test_every_pixel_shows_the_box_its_ray_meets_first(placed, eye):
    size, focal, target = (40, 30), 30.0, (0.0, 0.0, 0.0)
    world = World()
    directions = rays(eye, target, size, focal)
    hits = []
    for box, position, orientation in placed:
        add_shape(world, box, position, orientation)
        hits.append(first_hit(eye, directions, box, np.array(rotation_matrix(orientation)), position))
    image = draw(world, eye, target, size, focal)
    nearest = np.min(hits, axis=0)
    shown = np.where(image.label < 0, np.inf, np.choose(np.maximum(image.label, 0), hits))
    # The box shown is hit, and none is hit before it; only rays that graze an edge may say otherwise.
    agrees = np.isclose(shown, nearest, rtol=1e-6) & np.isclose(image.distance, nearest, rtol=1e-5)
    assert np.mean(agrees) > 0.995


def test_depth_is_that_of_opengl():
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)))
    image = draw(world)
    seen = image.label >= 0
    z = image.distance[seen].astype(float)
    assert image.depth[seen] == pytest.approx(FAR * (z - NEAR) / (z * (FAR - NEAR)), abs=1e-6)
    assert np.all(image.depth[~seen] == 1.0)
    assert np.all(np.isinf(image.distance[~seen]))


def test_nothing_is_drawn_nearer_than_the_near_plane_or_beyond_the_far_one():
    world = World()
    add_shape(world, Plane())
    near = draw(world, eye=(0.0, 0.0, 0.05), target=(0.0, 1.0, 0.03))
    assert NEAR <= near.distance.min() < 1.15 * NEAR
    far = draw(world, eye=(0.0, 0.0, 1.0), target=(0.0, FAR, 0.0), focal=2000.0)
    assert 0.95 * FAR < far.distance[far.label >= 0].max() <= FAR
    assert -1 in far.label


def test_a_triangle_that_reaches_behind_the_eye_is_cut_at_the_near_plane():
    world = World()
    add_shape(world, Plane())
    size, focal, eye, target = (40, 30), 20.0, (0.3, 0.2, 1.0), (1.0, 0.7, 0.2)
    image = draw(world, eye, target, size, focal)
    down = rays(eye, target, size, focal)[:, :, 2]
    expected = np.where(down < 0.0, -eye[2] / np.minimum(down, -1e-12), np.inf)
    seen = (expected > NEAR) & (expected < FAR)
    assert np.array_equal(image.label == 0, seen)
    assert image.distance[seen] == pytest.approx(expected[seen], rel=1e-5)


def test_of_equally_near_surfaces_the_last_one_is_seen():
    world = World()
    for _ in range(2):
        add_shape(world, Box((1.0, 1.0, 1.0)))
    assert set(np.unique(draw(world).label)) == {-1, 1}


def test_neighbouring_triangles_leave_no_gap():
    world = World()
    add_shape(world, Sphere(1.0))
    add_shape(world, Box((0.3, 0.3, 0.3)))
    image = draw(world, size=(200, 200), focal=300.0)
    assert 0 in image.label
    assert 1 not in image.label


def test_round_shapes_are_round():
    world = World()
    add_shape(world, Sphere(1.0))
    size, focal = (101, 101), 200.0
    image = draw(world, size=size, focal=focal)
    column, row = np.meshgrid(np.arange(101) - 50, np.arange(101) - 50)
    radius = focal / np.sqrt(5.0**2 - 1.0)
    assert np.mean((image.label == 0) == (np.hypot(column, row) < radius)) > 0.99
    assert image.distance[50, 50] == pytest.approx(4.0, abs=0.01)


def test_surfaces_are_seen_from_outside_only_unless_they_have_two_sides():
    world = World()
    body = add_shape(world, Cylinder(2.0, 4.0))
    inside: dict[str, Any] = {"eye": (0.0, 0.0, 0.0), "target": (0.0, 1.0, 0.0)}
    assert np.all(draw(world, **inside).label == -1)
    appearance_of(world).change(body, -1, two_sided=True)
    assert np.all(draw(world, **inside).label == 0)


def test_parallel_rays():
    world = World()
    add_shape(world, Box((1.0, 0.5, 0.5)))
    view = look_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0))
    image = renderer_of(world).draw(world, view, parallel_projection(2.0, 1.0, 10.0), 40, 40, Light())
    assert np.any(image.label == 0)
    rows, columns = np.nonzero(image.label == 0)
    assert (np.ptp(columns) + 1, np.ptp(rows) + 1) == pytest.approx((20, 10), abs=1.1)
    assert image.depth[rows, columns] == pytest.approx((4.5 - 1.0) / 9.0)


def test_a_mirrored_image_shows_the_same_surfaces():
    world = World()
    add_shape(world, Box((1.0, 0.5, 0.5)), orientation=(0.2, 0.1, 0.3, 0.9))
    view = look_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0))
    mirror = np.diag([-1.0, 1.0, 1.0, 1.0])
    projection = parallel_projection(2.0, 1.0, 10.0)
    plain, mirrored = (
        renderer_of(world).draw(world, view, matrix @ projection, 41, 40, Light())
        for matrix in (np.eye(4), mirror)
    )
    # The middle of the view lies half a pixel to the right of the middle column.
    assert np.mean(plain.label[:, 1:] == mirrored.label[:, :0:-1]) > 0.99
    assert np.nanmax(np.abs(plain.depth[:, 1:] - mirrored.depth[:, :0:-1])[plain.label[:, 1:] >= 0]) < 0.2


def test_a_link_without_looks_shows_what_it_collides_with():
    world = World()
    add_collision_only(world, Box((1.0, 1.0, 1.0)))
    assert np.any(draw(world).label == 0)


def test_a_texture_repeats_and_its_first_row_is_the_top():
    world = World()
    body = add_shape(world, Plane())
    textures = appearance_of(world).textures
    corners = np.array([[[200, 0, 0], [0, 200, 0]], [[0, 0, 200], [100, 100, 100]]], dtype=np.uint8)
    appearance_of(world).change(body, -1, texture=textures.add(corners))
    # From above with y upwards in the image; texture coordinates are 0.5 in x and y there.
    image = draw(world, eye=(0.5, 0.5, 4.0), target=(0.5, 0.5, 0.0), size=(4, 4), focal=8.0)
    channel = image.rgba[:, :, :3].argmax(axis=2)
    grey = np.ptp(image.rgba[:, :, :3], axis=2) == 0
    assert set(np.unique(np.where(grey, 3, channel))) == {0, 1, 2, 3}


def test_images_are_the_same_bit_for_bit_whatever_the_number_of_threads(monkeypatch):
    def scene():
        world = World()
        add_shape(world, Plane())
        for i in range(12):
            add_shape(world, Sphere(0.4), (i % 4 - 2.0, i // 4 - 1.0, 0.3))
        return world

    images = []
    for workers in (1, 2, 7):
        monkeypatch.setattr(parallel, "worker_count", lambda workers=workers: workers)
        images.append(draw(scene(), eye=(1.0, -5.0, 3.0), size=(64, 48), light=Light()))
    for image in images[1:]:
        assert np.array_equal(image.rgba, images[0].rgba)
        assert np.array_equal(image.depth, images[0].depth)
        assert np.array_equal(image.label, images[0].label)


@pytest.mark.parametrize("size", [(0, 5), (5, 0), (-1, 5), (100_000, 100_000), (MAX_SIDE + 1, 1)])
def test_sizes_out_of_range_are_refused(size):
    world = World()
    with pytest.raises(ValueError, match="cannot be drawn"):
        renderer_of(world).draw(world, np.eye(4), np.eye(4), size[0], size[1], Light())


@pytest.mark.parametrize("matrix", [np.full((4, 4), np.nan), np.diag([1.0, 1.0, np.inf, 1.0])])
def test_matrices_that_are_not_finite_are_refused(matrix):
    world = World()
    for view, projection in ((matrix, np.eye(4)), (np.eye(4), matrix)):
        with pytest.raises(ValueError, match="matrix is"):
            renderer_of(world).draw(world, view, projection, 4, 4, Light())


def test_matrices_that_squeeze_space_flat_show_nothing():
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)))
    flat = np.diag([1.0, 1.0, 0.0, 1.0])
    seen = renderer_of(world).draw(world, np.eye(4), flat, 4, 4, Light())
    assert seen.rgba.min() == 255
    assert seen.depth.min() == 1.0
    assert seen.label.max() == -1


def test_an_image_of_one_pixel_and_one_of_an_empty_world():
    world = World()
    assert draw(world, size=(1, 1)).label.tolist() == [[-1]]
    add_shape(world, Box((1.0, 1.0, 1.0)))
    assert draw(world, size=(1, 1)).label.tolist() == [[0]]


def test_an_image_shows_the_world_as_it_is_now():
    world = World()
    first = add_shape(world, Box((0.5, 0.5, 0.5)))
    assert set(np.unique(draw(world).label)) == {-1, 0}
    second = add_shape(world, Box((0.1, 0.1, 0.1)), (0.0, -2.0, 0.0))
    assert set(np.unique(draw(world).label)) == {-1, 0, 1}
    second.set_inertial_pose((100.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    assert set(np.unique(draw(world).label)) == {-1, 0}
    world.remove(first.id)
    assert set(np.unique(draw(world).label)) == {-1}
    world.clear()
    add_shape(world, Sphere(1.0))
    assert set(np.unique(draw(world).label)) == {-1, 0}


def test_drawing_leaves_the_state_as_it_was():
    world = World()
    body = add_shape(world, Box((0.5, 0.5, 0.5)))
    body.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step()
    before = world.link_pose.copy()
    draw(world)
    assert np.array_equal(world.link_pose, before)


def test_the_image_after_a_step_shows_where_things_are_after_it():
    world = World()
    body = add_shape(world, Box((0.5, 0.5, 0.5)))
    body.set_base_velocity((240.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step()
    columns = np.nonzero(draw(world, focal=20.0).label == 0)[1]
    body.set_inertial_pose(world.position[:3].tolist(), (0.0, 0.0, 0.0, 1.0))
    assert columns.tolist() == np.nonzero(draw(world, focal=20.0).label == 0)[1].tolist()
    # The front is 4.5 m away.
    assert columns.mean() == pytest.approx(23.5 + 20.0 * world.position[0] / 4.5, abs=0.6)
    assert world.position[0] > 0.3


def test_memory_is_kept_for_a_few_sizes_only():
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)))
    renderer = Renderer()
    for width in range(1, 12):
        renderer.draw(world, np.eye(4), np.eye(4), width, 2, Light())
    assert len(renderer._targets) <= 4


def test_alpha_0_hides_a_shape_and_any_other_alpha_does_not():
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)), material=Material("glass", rgba=(1.0, 1.0, 1.0, 0.1)))
    assert np.any(draw(world).label == 0)
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)), material=Material("air", rgba=(1.0, 1.0, 1.0, 0.0)))
    assert np.all(draw(world).label == -1)


NUMBERS = st.floats(width=32)
FINITE = st.floats(width=32, allow_nan=False, allow_infinity=False)


@settings(max_examples=cases(15), deadline=None, phases=[Phase.generate], report_multiple_bugs=False)
@given(
    st.lists(st.tuples(FINITE, FINITE, FINITE), min_size=3, max_size=6),
    st.lists(st.tuples(NUMBERS, NUMBERS), min_size=6, max_size=6),
    st.lists(st.tuples(*[st.integers(0, 2)] * 3), min_size=1, max_size=4),
    st.lists(NUMBERS, min_size=16, max_size=16),
)
def test_triangles_texture_coordinates_and_projectors_of_any_numbers_do_no_harm(
    vertices, uvs, triangles, projector
):
    world = World()
    mesh = TriangleMesh(
        np.array(vertices), np.array(triangles, dtype=np.int32), uvs=np.array(uvs[: len(vertices)])
    )
    body = add_shape(world, mesh)
    floor = add_shape(world, Plane(), (0.0, 0.0, -1.0))
    appearance = appearance_of(world)
    texture = appearance.textures.add(np.full((3, 2, 3), 9, dtype=np.uint8))
    for each in (body, floor):
        appearance.change(each, -1, texture=texture, two_sided=True)
    with np.errstate(all="ignore"):
        image = draw(world, light=Light(shadow=True))
        cast = renderer_of(world).draw(
            world,
            look_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0)),
            parallel_projection(2.0, 1.0, 10.0),
            16,
            12,
            Light(),
            np.array(projector).reshape(4, 4),
        )
    for picture in (image, cast):
        assert set(np.unique(picture.label)) <= {-1, 0, 1}
        assert np.all((picture.depth >= 0.0) & (picture.depth <= 1.0))
