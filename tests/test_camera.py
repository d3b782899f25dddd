"""Cameras: where points appear, how far they are, whose they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

from carom import Camera, World
from carom.camera import DAYLIGHT
from carom.description import Box, JointType, Plane, Pose, Sphere, Visual
from carom.model.body_spec import BodySpec, LinkSpec
from carom.render.lights import Light
from carom.scene.body import Body


def body_of(world: World, geometry, position=(0.0, 0.0, 0.0), name="thing") -> Body:
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(Visual(geometry),))
    return world.load(BodySpec(name, base), position)


def arm_in(world: World, name="arm") -> Body:
    """A fixed base with a link that turns about z, half a metre out along x."""
    link = LinkSpec(
        "hand",
        mass=1.0,
        inertia=(1.0, 1.0, 1.0),
        joint_type=JointType.REVOLUTE,
        joint_name="turn",
        joint_axis=(0.0, 0.0, 1.0),
        inertial_frame=Pose((0.2, 0.0, 0.0)),
        visuals=(Visual(Sphere(0.1), Pose((0.5, 0.0, 0.0))),),
    )
    base = LinkSpec("root", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(Visual(Sphere(0.1)),))
    return world.load(BodySpec(name, base, [link], fixed_base=True))


COORDINATES = st.floats(-0.8, 0.8)


@settings(max_examples=cases(25), deadline=None)
@given(st.tuples(COORDINATES, COORDINATES, COORDINATES), st.tuples(COORDINATES, COORDINATES))
def test_a_point_appears_where_the_intrinsics_say(point, centre):
    world = World()
    body_of(world, Sphere(0.08), point)
    cx, cy = 60.0 + 20.0 * centre[0], 45.0 + 20.0 * centre[1]
    camera = Camera(120, 90, fx=70.0, fy=90.0, cx=cx, cy=cy).look_at((0.5, -4.0, 1.0), (0.0, 0.0, 0.0))
    image = camera.capture(world)
    position, orientation = camera.pose
    x, y, z = turned_back(orientation, np.array(point) - position)
    column, row = 70.0 * x / z + cx, 90.0 * y / z + cy
    rows, columns = np.nonzero(image.body_ids == 0)
    if 3 < column < 116 and 3 < row < 86:
        assert columns.mean() == pytest.approx(column, abs=0.7)
        assert rows.mean() == pytest.approx(row, abs=0.7)
        assert image.depth[rows, columns].min() == pytest.approx(z - 0.08, abs=0.03)


def turned_back(quaternion, vector):
    """A vector in the axes of a frame whose orientation is given."""
    x, y, z, w = quaternion
    q = np.array([-x, -y, -z])
    return vector + 2.0 * np.cross(q, np.cross(q, vector) + w * vector)


def test_the_axes_of_the_camera_point_right_down_and_forwards():
    camera = Camera(4, 3, fx=3.0).look_at((0.0, -2.0, 0.0), (0.0, 0.0, 0.0))
    _, orientation = camera.pose
    for axis, expected in (((1, 0, 0), (1, 0, 0)), ((0, 0, -1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1))):
        assert turned_back(orientation, np.array(axis, dtype=float)) == pytest.approx(expected, abs=1e-12)


def test_depth_is_along_the_optical_axis_in_metres():
    world = World()
    body_of(world, Box((2.0, 0.5, 2.0)))
    image = Camera(30, 20, fx=20.0).look_at((0.0, -3.0, 0.0), (0.0, 0.0, 0.0)).capture(world)
    seen = image.body_ids == 0
    assert image.depth[seen] == pytest.approx(2.5, rel=1e-6)
    assert np.all(np.isinf(image.depth[~seen]))


@pytest.mark.parametrize("frame", ["world", "camera"])
def test_the_points_of_a_floor_lie_in_a_plane(frame):
    world = World()
    body_of(world, Plane())
    body_of(world, Box((0.1, 0.1, 0.1)), (0.0, 0.0, 0.5))
    camera = Camera(60, 40, fx=50.0).look_at((1.0, -2.0, 1.5), (0.0, 0.0, 0.0))
    image = camera.capture(world)
    cloud = image.point_cloud(frame=frame)
    assert len(cloud.points) == len(cloud.colours) == len(cloud.bodies) == np.sum(image.body_ids >= 0)
    points = cloud.points
    if frame == "camera":
        position, orientation = camera.pose
        x, y, z, w = orientation
        points = np.array([turned_back((-x, -y, -z, w), point) + position for point in points])
    assert points[cloud.bodies == 0][:, 2] == pytest.approx(0.0, abs=1e-5)
    box = points[cloud.bodies == 1]
    assert np.abs(box - (0.0, 0.0, 0.5)).max(axis=1) == pytest.approx(0.1, abs=1e-5)


def test_masks_by_handle_id_and_name():
    world = World()
    arm = arm_in(world)
    ball = body_of(world, Sphere(0.1), (-0.5, 0.0, 0.0), name="ball")
    image = Camera(90, 60, fx=60.0).look_at((0.0, -2.0, 0.0), (0.0, 0.0, 0.0)).capture(world)
    hand = image.mask("arm", "hand")
    assert 0 < hand.sum() < image.mask("arm").sum()
    numbers = np.array([arm.id, 0])
    for same in (image.mask(arm, 0), image.mask(arm.id, arm.links["hand"]), image.mask(*numbers)):
        assert np.array_equal(same, hand)
    assert np.array_equal(image.mask(arm), image.mask(arm, -1) | hand)
    assert image.names() == {
        "arm/root": image.mask("arm", "root").sum(),
        "arm/hand": hand.sum(),
        "ball/base": image.mask(ball).sum(),
    }
    columns = [np.nonzero(mask)[1].mean() for mask in (image.mask("ball"), image.mask("arm", -1), hand)]
    assert columns == sorted(columns)
    world.remove(ball.id)
    assert image.mask("ball").any()


def test_bodies_of_the_same_name_are_told_apart():
    world = World()
    for x in (-0.5, 0.5):
        body_of(world, Sphere(0.1), (x, 0.0, 0.0))
    body_of(world, Sphere(0.1), (0.0, 0.0, 0.0), name="other")
    image = Camera(60, 40, fx=40.0).look_at((0.0, -2.0, 0.0), (0.0, 0.0, 0.0)).capture(world)
    assert image.names() == {
        "thing#0/base": image.mask(0).sum(),
        "thing#1/base": image.mask(1).sum(),
        "other/base": image.mask("other").sum(),
    }
    assert min(image.names().values()) > 0
    assert np.array_equal(image.mask("thing#1", "base"), image.body_ids == 1)
    with pytest.raises(KeyError, match=r"several bodies are called 'thing': thing#0, thing#1"):
        image.mask("thing")


def test_a_field_of_view_comes_with_a_light():
    world = World()
    body_of(world, Sphere(0.5))
    dark, bright = (
        Camera.with_field_of_view(9, 9, 60.0, light=Light(ambient=ambient, diffuse=0.0, specular=0.0))
        .look_at((0.0, -2.0, 0.0), (0.0, 0.0, 0.0))
        .capture(world)
        .colour[4, 4]
        for ambient in (0.0, 1.0)
    )
    assert dark.tolist() == [0, 0, 0]
    assert bright.tolist() == [255, 255, 255]


@pytest.mark.parametrize("size", [(20, 20), (84, 84), (320, 240)])
def test_parallel_light_casts_the_same_shadow_in_images_of_any_size(size):
    world = World()
    body_of(world, Plane())
    body_of(world, Box((0.5, 0.5, 0.5)), (0.0, 0.0, 1.0))
    view = {"eye": (0.5, 0.0, 5.0), "target": (0.5, 0.0, 0.0)}
    plain, shadowed = (
        Camera.with_field_of_view(
            size[0], size[1], 60.0, light=replace(DAYLIGHT, direction=(-1.0, 0.0, 1.0), shadow=shadow)
        )
        .look_at(**view)
        .capture(world)
        for shadow in (False, True)
    )
    floor = plain.body_ids == 0
    dark = floor & (shadowed.colour < plain.colour).any(axis=2)
    points = plain.point_cloud().points.reshape(-1, 3)[dark[plain.body_ids >= 0]]
    pixel = 2.0 * 5.0 * np.tan(np.radians(30.0)) / size[1]
    # The shadow reaches from 0 to 2 m along x; seen from above, the box hides it up to 0.5 m.
    assert points[:, 0].max() == pytest.approx(2.0, abs=0.02 + 1.5 * pixel)
    assert np.abs(points[:, 1]).max() == pytest.approx(0.5, abs=0.02 + 1.5 * pixel)
    assert np.sum(dark) * pixel**2 == pytest.approx(1.5, abs=0.02 + 2.0 * pixel)


@pytest.mark.parametrize("arguments", [("nobody",), (7,), ("arm", "nose"), ("arm", 4), ("arm", -2)])
def test_masks_of_what_was_not_there_are_refused(arguments):
    world = World()
    arm_in(world)
    image = Camera(4, 3, fx=3.0).capture(world)
    with pytest.raises(KeyError):
        image.mask(*arguments)


def test_a_mounted_camera_moves_with_its_link():
    world = World()
    arm = arm_in(world)
    body_of(world, Box((0.2, 0.2, 0.2)), (0.0, 3.0, 0.0), name="target")
    camera = Camera(30, 20, fx=20.0).mount(arm.links["hand"]).look_at((0.7, 0.0, 0.0), (1.7, 0.0, 0.0))
    assert "target/base" not in camera.capture().names()
    arm.set_joint_state(0, [np.pi / 2], None)
    position, _ = camera.pose
    assert position == pytest.approx([0.0, 0.7, 0.0], abs=1e-9)
    image = camera.capture()
    rows, columns = np.nonzero(image.mask("target"))
    assert (columns.mean(), rows.mean()) == pytest.approx((14.5, 9.5), abs=0.1)
    assert image.depth[10, 15] == pytest.approx(2.8 - 0.7, rel=1e-5)


def test_projections_of_several_fields_of_view():
    camera = Camera.with_field_of_view(64, 48, 40.0)
    for degrees, matrix in zip((30.0, 75.0), camera.projections(np.array([30.0, 75.0])), strict=True):
        expected = Camera.with_field_of_view(64, 48, degrees).projection
        np.testing.assert_allclose(matrix, expected, rtol=1e-14, atol=1e-14)
    with pytest.raises(ValueError, match="an orthographic camera has no field of view"):
        Camera.orthographic(64, 48, 2.0).projections(np.array([30.0]))


def test_field_of_view():
    camera = Camera.with_field_of_view(80, 60, 90.0)
    assert camera.intrinsics == pytest.approx(np.array([[30, 0, 39.5], [0, 30, 29.5], [0, 0, 1]]))


@pytest.mark.parametrize(
    "options",
    [
        {"width": 0},
        {"fx": 0.0},
        {"fy": -1.0},
        {"cx": np.nan},
        {"near": 0.0},
        {"near": 2.0, "far": 1.0},
        {"position": (0.0, 0.0)},
        {"orientation": (0.0, 0.0, 0.0, 0.0)},
    ],
)
def test_bad_cameras_are_refused(options):
    with pytest.raises(ValueError):
        Camera(**{"width": 4, "height": 3, "fx": 3.0, **options})


def test_bad_uses_are_refused():
    world, other = World(), World()
    camera = Camera(4, 3, fx=3.0)
    with pytest.raises(ValueError, match="which world"):
        camera.capture()
    with pytest.raises(ValueError, match="another world"):
        camera.mount(arm_in(world).links.base).capture(other)
    with pytest.raises(ValueError, match="distance"):
        camera.look_at((1.0, 1.0, 1.0), (1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="180"):
        Camera.with_field_of_view(4, 3, 180.0)
    with pytest.raises(ValueError, match="frame"):
        Camera(4, 3, fx=3.0).capture(world).point_cloud(frame="link")  # type: ignore[arg-type]
