"""The present looks of shapes: first values, changes, texture numbers."""

import gc
import weakref

import numpy as np
import pytest
from drawing import add_collision_only, add_shape, draw
from PIL import Image

from carom.description import Box, Material, Mesh, Plane, Sphere, Visual
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BodySpec, LinkSpec
from carom.render.appearance import GREY, WHITE, appearance_of
from carom.render.renderer import renderer_of
from carom.world.world import World

RED = (1.0, 0.0, 0.0, 1.0)
UNIT_BOX = Box((0.5, 0.5, 0.5))


@pytest.fixture
def world():
    return World()


def only_look(world, body):
    (look,) = appearance_of(world).shapes(body, -1)
    return look


@pytest.mark.parametrize(
    ("material", "rgba"),
    [
        (None, WHITE),
        (Material("just a name"), WHITE),
        (Material("red", rgba=RED), RED),
        (Material("shiny", specular=(1.0, 1.0, 1.0)), GREY),
    ],
)
def test_first_colour(world, material, rgba):
    assert only_look(world, add_shape(world, UNIT_BOX, material=material)).rgba == rgba


def test_what_has_no_looks_looks_like_its_collision_shapes(world):
    look = only_look(world, add_collision_only(world, Sphere(0.3)))
    assert (look.geometry, look.rgba) == (Sphere(0.3), WHITE)


def test_undefined_colours_depend_on_the_link_if_asked_for(world):
    links = [LinkSpec(f"l{i}", visuals=(Visual(UNIT_BOX),), mass=1.0, inertia=(1, 1, 1)) for i in range(6)]
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(Visual(UNIT_BOX),))
    body = world.load(BodySpec("b", base, links, flags=LoadFlags.GOOGLY_UNDEFINED_COLORS))
    colours = [appearance_of(world).shapes(body, link)[0].rgba for link in range(-1, 6)]
    assert colours[0] == colours[1] == colours[5]
    assert len(set(colours)) == 4


def test_one_shape_of_a_link_changes_or_all(world):
    visuals = (Visual(UNIT_BOX), Visual(Sphere(1.0)))
    body = world.load(BodySpec("b", LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=visuals)))
    appearance = appearance_of(world)
    appearance.change(body, -1, 1, rgba=RED)
    assert [look.rgba for look in appearance.shapes(body, -1)] == [WHITE, RED]
    appearance.change(body, -1, specular=(0.0, 0.5, 0.0))
    assert [look.specular for look in appearance.shapes(body, -1)] == [(0.0, 0.5, 0.0)] * 2
    with pytest.raises(IndexError):
        appearance.change(body, -1, 2, rgba=RED)


def test_bodies_of_the_same_kind_change_one_by_one(world):
    first, second = add_shape(world, UNIT_BOX), add_shape(world, UNIT_BOX)
    appearance_of(world).change(first, -1, rgba=RED)
    assert only_look(world, second).rgba == WHITE


def test_a_change_shows_in_the_next_image(world):
    body = add_shape(world, Box((1.0, 1.0, 1.0)))
    assert np.ptp(draw(world).rgba[18, 24, :3]) == 0
    appearance_of(world).change(body, -1, rgba=RED)
    assert draw(world).rgba[18, 24, 1] == 0
    appearance = appearance_of(world)
    texture = appearance.textures.add(np.full((2, 2, 3), (0, 250, 250), dtype=np.uint8))
    appearance.change(body, -1, rgba=WHITE, texture=texture)
    assert draw(world).rgba[18, 24, 0] == 0
    appearance.textures.replace(texture, np.full((3, 5, 3), (250, 250, 0), dtype=np.uint8))
    assert draw(world).rgba[18, 24, 2] == 0
    appearance.change(body, -1, texture=-1)
    assert np.ptp(draw(world).rgba[18, 24, :3]) == 0


def test_texture_numbers_follow_the_order_of_loading_and_are_never_used_twice(world):
    plane = add_shape(world, Plane())
    appearance = appearance_of(world)
    appearance.number_textures(list(world.bodies.values()))
    assert appearance.textures.add(np.zeros((1, 1, 3), np.uint8)) == 1
    assert only_look(world, plane).texture == 0
    world.clear()
    assert appearance_of(world) is appearance
    assert 1 not in appearance.textures
    assert appearance.textures.add(np.zeros((1, 1, 3), np.uint8)) == 2


def test_an_unknown_texture_is_refused(world):
    body = add_shape(world, UNIT_BOX)
    with pytest.raises(KeyError):
        appearance_of(world).change(body, -1, texture=5)
    assert only_look(world, body).texture == -1


@pytest.fixture
def painted_mesh(tmp_path):
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 0.5 0.25 0\nd 0.5\nmap_Kd a.png\n")
    path = tmp_path / "m.obj"
    path.write_text("mtllib m.mtl\nv -9 0 -9\nv 9 0 -9\nv 0 0 9\nusemtl a\nf 1 2 3\n")
    return Mesh(path)


def test_a_mesh_brings_its_texture(world, painted_mesh):
    Image.new("RGB", (4, 4), (0, 0, 200)).save(painted_mesh.path.with_name("a.png"))
    look = only_look(world, add_shape(world, painted_mesh))
    assert (look.texture, look.rgba) == (0, WHITE)
    assert draw(world).rgba[18, 24, :2].tolist() == [0, 0]


@pytest.mark.parametrize("content", [None, b"no image"])
def test_a_mesh_whose_texture_cannot_be_read_goes_without(world, painted_mesh, content, caplog):
    if content is not None:
        painted_mesh.path.with_name("a.png").write_bytes(content)
    assert only_look(world, add_shape(world, painted_mesh)).texture == -1
    assert np.any(draw(world).label == 0)
    assert "a.png" in caplog.text


@pytest.mark.parametrize(
    ("flags", "rgba"),
    [
        (0, WHITE),
        (LoadFlags.USE_MATERIAL_COLORS_FROM_MTL, (0.5, 0.25, 0.0, 1.0)),
        (
            LoadFlags.USE_MATERIAL_COLORS_FROM_MTL | LoadFlags.USE_MATERIAL_TRANSPARENCY_FROM_MTL,
            (0.5, 0.25, 0.0, 0.5),
        ),
    ],
)
def test_colours_of_mesh_files_count_only_if_asked_for(world, painted_mesh, flags, rgba):
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(Visual(painted_mesh),))
    assert only_look(world, world.load(BodySpec("b", base, flags=int(flags)))).rgba == rgba


@pytest.mark.parametrize(
    ("flags", "rgba"),
    [(LoadFlags.NONE, (0.0, 0.0, 0.0, 1.0)), (LoadFlags.ONLY_MATERIALS_THERE_ARE, WHITE)],
)
def test_a_mesh_without_material_is_black_unless_it_keeps_its_colour(world, painted_mesh, flags, rgba):
    painted_mesh.path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(Visual(painted_mesh),))
    flags |= LoadFlags.USE_MATERIAL_COLORS_FROM_MTL
    assert only_look(world, world.load(BodySpec("b", base, flags=int(flags)))).rgba == rgba


def test_a_mesh_that_has_gone_is_not_shown(world, painted_mesh, caplog):
    add_shape(world, painted_mesh)
    painted_mesh.path.unlink()
    assert np.all(draw(world).label == -1)
    assert "not shown" in caplog.text


def test_a_mesh_that_goes_after_the_first_image_stays_in_view(world, painted_mesh):
    add_shape(world, painted_mesh)
    assert np.any(draw(world).label == 0)
    painted_mesh.path.unlink()
    add_shape(world, Sphere(0.1), (0.0, -2.0, 0.0))
    assert {0, 1} <= set(np.unique(draw(world).label))


def test_a_mirrored_mesh_is_seen_from_outside(world, painted_mesh):
    add_shape(world, Mesh(painted_mesh.path, (-1.0, 1.0, 1.0)))
    assert np.any(draw(world).label == 0)


def test_worlds_and_bodies_do_not_live_on_for_their_looks():
    world = World()
    body = add_shape(world, UNIT_BOX)
    draw(world)
    gone_body, gone_world, gone_renderer = (
        weakref.ref(body),
        weakref.ref(world),
        weakref.ref(renderer_of(world)),
    )
    world.remove(body.id)
    del body
    draw(world)
    gc.collect()
    assert gone_body() is None
    del world
    gc.collect()
    assert gone_world() is None
    assert gone_renderer() is None
