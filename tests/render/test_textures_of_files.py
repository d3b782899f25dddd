"""Textures of MJCF files lie on shapes as MuJoCo has them, and groups and sites are seen as there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.render.drawing import draw

from carom import World
from carom.description import Box, Capsule, Cylinder, Plane, Sphere
from carom.description.texture import LateTexels, Texture
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled.looks.builtin_textures import made_texture
from carom.render.appearance import appearance_of
from carom.render.primitives import primitive_mesh
from carom.render.textured import texture_image, with_texture

RED, BLUE, YELLOW = (255, 0, 0), (0, 0, 255), (255, 255, 0)
CHECKER = (
    '<texture name="c" type="2d" builtin="checker" rgb1="1 0 0" rgb2="0 0 1" width="8" height="8"/>'
    '<material name="{name}" texture="c" {more}/>'
)


def scene(tmp_path: Path, worldbody: str, assets: str = "") -> World:
    file = tmp_path / "scene.xml"
    file.write_text(f"<mujoco><asset>{assets}</asset><worldbody>{worldbody}</worldbody></mujoco>")
    world = World()
    world.load(file)
    return world


def at(mesh, image: np.ndarray, point) -> tuple[int, ...]:
    """The texel of a mesh where it has a point."""
    corners = mesh.positions[mesh.triangles].astype(float)
    for triangle, (a, b, c) in enumerate(corners):
        shares = np.linalg.lstsq(np.column_stack([b - a, c - a]), np.array(point) - a, rcond=None)[0]
        u, v = shares
        near = np.linalg.norm(a + u * (b - a) + v * (c - a) - point) < 1e-6
        if near and min(u, v, 1.0 - u - v) >= -1e-9:
            uv = np.array((1.0 - u - v, u, v)) @ mesh.uvs[mesh.triangles[triangle]]
            row, column = (1.0 - uv[1] % 1.0) * len(image), uv[0] % 1.0 * image.shape[1]
            return tuple(image[min(int(row), len(image) - 1), min(int(column), image.shape[1] - 1)].tolist())
    raise AssertionError(f"{point} is not on the mesh")


def look_of(world: World):
    (look,) = appearance_of(world).shapes(world.bodies[0], -1)
    return look, appearance_of(world).textures.image(look.texture)


def test_a_plane_of_a_size_ends_there_and_has_its_image_as_often_as_stated(tmp_path: Path):
    world = scene(
        tmp_path,
        '<geom type="plane" size="2 1 .1" material="m"/>',
        CHECKER.format(name="m", more='texrepeat="3 1"'),
    )
    look, image = look_of(world)
    assert look.geometry == Plane(size=(2.0, 1.0))
    assert np.abs(look.mesh.positions).max(axis=0).tolist() == [2.0, 1.0, 0.0]
    # Measured in a picture of MuJoCo's: the image begins at the left edge, red above.
    for x, y, colour in ((-1.9, 0.5, RED), (-1.2, 0.5, BLUE), (-1.9, -0.5, BLUE), (-0.6, 0.5, RED)):
        assert at(look.mesh, image, (x, y, 0.0)) == colour


@pytest.mark.parametrize(("uniform", "repeats"), [("false", (1.5, 0.5)), ("true", (3.0, 0.5))])
def test_images_begin_at_a_corner_of_a_plane_and_may_end_within_themselves(
    tmp_path: Path, uniform: str, repeats: tuple[float, float]
):
    more = f'texrepeat="1.5 0.5" texuniform="{uniform}"'
    geom = '<geom type="plane" size="2 1 .1" material="m"/>'
    look, _ = look_of(scene(tmp_path, geom, CHECKER.format(name="m", more=more)))
    shares = look.mesh.positions[:, :2] / (2.0, 1.0) * 0.5 + 0.5
    np.testing.assert_allclose(look.mesh.uvs, shares * repeats, atol=1e-6)


def test_the_image_of_an_endless_plane_has_its_middle_at_the_origin(tmp_path: Path):
    world = scene(
        tmp_path,
        '<geom type="plane" size="0 0 .1" material="m"/>',
        CHECKER.format(name="m", more='texrepeat="3 1" texuniform="true"'),
    )
    look, image = look_of(world)
    third = 1.0 / 3.0
    for x, y, colour in ((-0.5 * third, 0.5, RED), (0.5 * third, 0.5, BLUE), (1.5 * third, 0.5, RED)):
        assert at(look.mesh, image, (x, y, 0.0)) == colour


@pytest.mark.parametrize("shape", [Box((0.5, 0.4, 0.3)), Sphere(0.5), Capsule(0.2, 0.6), Cylinder(0.3, 0.8)])
def test_each_point_shows_what_the_ray_through_it_meets_on_the_cube(shape):
    colours = [np.full((4, 4, 3), 40 * side, np.uint8) for side in range(6)]
    texture = Texture(np.concatenate(colours, axis=1), is_cube=True, size=(1.0, 1.0, 1.0))
    mesh = with_texture(primitive_mesh(shape), shape, texture)
    image = texture_image(texture)
    assert image is not None
    corners = mesh.positions[mesh.triangles].astype(float)
    middles, uvs = corners.mean(axis=1), mesh.uvs[mesh.triangles].mean(axis=1)
    axis = np.abs(middles).argmax(axis=1)
    expected = 40 * (2 * axis + (np.take_along_axis(middles, axis[:, None], axis=1)[:, 0] < 0.0))
    columns = (uvs[:, 0] * image.shape[1]).astype(int)
    np.testing.assert_array_equal(image[0, columns, 0], expected)
    # No triangle reaches over an edge of the cube, and the surface is as before.
    clear = np.abs(corners[np.arange(len(corners)), :, axis])
    assert (np.abs(corners).max(axis=2) <= clear + 1e-6).all()
    before = primitive_mesh(shape)
    areas = [
        np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1).sum()
        for c in (corners, before.positions[before.triangles].astype(float))
    ]
    assert areas[0] == pytest.approx(areas[1], rel=1e-5)


def test_each_side_of_a_box_has_the_whole_image_with_z_upwards():
    image = np.array([[RED, BLUE], [YELLOW, (0, 0, 0)]], dtype=np.uint8)
    shape = Box((1.0, 2.0, 3.0))
    mesh = with_texture(primitive_mesh(shape), shape, Texture(image, size=shape.half_extents))
    # Seen from outside, the first pixel is in the upper left corner.
    for point in ((1, -1.5, 2), (-1, 1.5, 2), (0.5, 2, 2), (-0.5, -2, 2), (-0.5, 1, 3), (0.5, 1, -3)):
        assert at(mesh, image, point) == RED


def test_builtin_textures_are_those_of_mujoco():
    one, other, mark = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 0.0)
    checker = made_texture("checker", 8, 8, one, other, "edge", mark, 0.0, is_cube=False)
    assert [tuple(checker[at].tolist()) for at in ((2, 2), (2, 5), (5, 2), (0, 4))] == [
        RED,
        BLUE,
        BLUE,
        YELLOW,
    ]
    flat = made_texture("flat", 4, 4, one, other, "none", mark, 0.0, is_cube=True)
    assert flat.shape == (4, 24, 3)
    assert [tuple(flat[1, 4 * side + 1].tolist()) for side in range(6)] == [RED, RED, RED, BLUE, RED, RED]
    # Of cubes the first colour is above, which is y.
    gradient = made_texture("gradient", 9, 9, one, other, "none", mark, 0.0, is_cube=True)
    up, down = gradient[4, 9 * 2 + 4], gradient[4, 9 * 3 + 4]
    assert up.tolist() == [255, 0, 0] and down.tolist() == [0, 0, 255]
    assert gradient[4, 4].tolist() == [128, 0, 128]
    dots = made_texture("flat", 64, 64, one, other, "random", mark, 0.1, is_cube=False)
    assert 0.05 < (dots == YELLOW).all(axis=2).mean() < 0.15


def test_builtin_textures_are_made_when_they_are_drawn_and_then_once():
    calls: list[int] = []

    def make() -> np.ndarray:
        calls.append(0)
        return np.zeros((2, 2, 3), dtype=np.uint8)

    late = LateTexels(make)
    one, other = Texture(late=late), Texture(late=late, uniform=True)
    assert not calls
    assert texture_image(one) is texture_image(other)
    assert len(calls) == 1


def test_sides_of_a_cube_come_from_files_and_layouts(tmp_path: Path):
    cells = {side: np.full((2, 2, 3), 30 + 30 * place, np.uint8) for place, side in enumerate("RLUDFB")}
    none = np.zeros((2, 2, 3), np.uint8)
    layout = (".U..", "LFRB", ".D..")
    whole = np.concatenate(
        [np.concatenate([cells.get(letter, none) for letter in row], axis=1) for row in layout]
    )
    Image.fromarray(whole).save(tmp_path / "whole.png")
    cut = texture_image(Texture(None, (tmp_path / "whole.png",), True, layout))
    assert cut is not None
    assert cut[0, ::2, 0].tolist() == [30, 60, 90, 120, 150, 180]
    for side, image in cells.items():
        Image.fromarray(image).save(tmp_path / f"{side}.png")
    files = tuple(tmp_path / f"{side}.png" for side in "RLUDFB")
    np.testing.assert_array_equal(texture_image(Texture(None, files, True)), cut)


def test_files_without_textures_have_planes_of_their_colour(tmp_path: Path):
    world = scene(tmp_path, '<geom type="plane" size="1 1 .1" rgba=".2 .4 .6 1"/>')
    (look,) = appearance_of(world).shapes(world.bodies[0], -1)
    assert look.texture == -1
    assert look.rgba == (0.2, 0.4, 0.6, 1.0)


def test_images_show_groups_up_to_two(tmp_path: Path):
    shapes = '<geom type="box" size=".5 .5 .5" group="{}" rgba="1 0 0 1"/>'
    assert (draw(scene(tmp_path, shapes.format(2))).label >= 0).any()
    assert not (draw(scene(tmp_path, shapes.format(3))).label >= 0).any()


def test_images_show_sites_of_shown_groups(tmp_path: Path):
    site = '<site type="{}" size=".6 .4 .5" group="{}" rgba="0 1 0 1"/>'
    body = f'<body><geom type="box" size=".1 .1 .1"/>{site}</body>'
    covered = {}
    for kind in ("sphere", "ellipsoid", "box", "capsule", "cylinder"):
        covered[kind] = (draw(scene(tmp_path, body.format(kind, 2))).label >= 0).sum()
        alone = (draw(scene(tmp_path, body.format(kind, 3))).label >= 0).sum()
        assert covered[kind] > 4 * alone
    assert covered["ellipsoid"] < covered["sphere"] < covered["capsule"]


@pytest.mark.parametrize(
    ("assets", "reason"),
    [
        ('<texture name="t" type="2d" builtin="stripes" width="4" height="4"/>', "checker"),
        ('<texture name="t" type="2d" builtin="checker"/>', "width and height"),
        ('<texture name="t" type="2d" builtin="checker" width="4" height="4" mark="dot"/>', "mark"),
        ('<texture name="t" type="3d" file="a.png"/>', "skybox"),
        ("", "there is no texture"),
    ],
)
def test_textures_without_a_meaning_are_refused(tmp_path: Path, assets: str, reason: str):
    with pytest.raises(DescriptionError, match=reason):
        scene(
            tmp_path,
            '<geom type="sphere" size="1" material="m"/>',
            assets + '<material name="m" texture="t"/>',
        )
