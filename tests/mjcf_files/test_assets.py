"""Height fields, mesh files and looks of MJCF files."""

import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError
from carom.formats.mjcf.compiled.shapes.builtin_meshes import builtin_mesh
from carom.geometry.heightfield import heightfield_surface

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


@pytest.fixture
def load(tmp_path):
    with World() as world:

        def load(assets, geom, compiler=""):
            (tmp_path / "file.xml").write_text(
                f'<mujoco>{compiler}<asset>{assets}</asset><worldbody><body name="b"><freejoint/>'
                f"<geom {geom}/></body></worldbody></mujoco>"
            )
            return world.load(tmp_path / "file.xml", missing_meshes="warn")

        yield load


def msh(corners=CORNERS, faces=FACES):
    floats = struct.pack(f"<{3 * len(corners)}f", *np.ravel(corners))
    return struct.pack("<4i", len(corners), 0, 0, len(faces)) + floats + np.array(faces, "<i4").tobytes()


def test_an_msh_file_is_the_mesh_that_its_numbers_state(load, tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "a.msh").write_bytes(msh())
    scene = load('<mesh file="a.msh"/>', 'type="mesh" mesh="a"', '<compiler meshdir="meshes"/>')
    link = scene["b"].spec.base
    assert_allclose(link.mass, 1000.0)
    assert_allclose(link.inertial_frame.position, (0.25, 0.5, 0.75))


def test_an_msh_file_that_is_cut_off_is_refused(load, tmp_path):
    (tmp_path / "a.msh").write_bytes(msh()[:-4])
    with pytest.raises(DescriptionError, match="need 112 bytes; it has 108"):
        load('<mesh file="a.msh"/>', 'type="mesh" mesh="a"')


def test_a_missing_mesh_is_left_out_if_one_wants_that(load):
    scene = load('<mesh file="no.stl"/>', 'type="mesh" mesh="no"')
    assert [(one.element, one.consequence) for one in scene.ignored.that_matter] == [
        ("body/geom", "the shape is missing")
    ]


def surface(scene):
    field = scene["b"].spec.base.collisions[0].geometry
    return heightfield_surface(field.heights, field.scale, field.middle).vertices


def test_heights_begin_at_the_greatest_y_and_fill_the_size(load):
    field = '<hfield name="h" nrow="2" ncol="3" size="2 1 3 1" elevation="1 2 3 4 5 7"/>'
    # As MuJoCo 4.0 has them in `hfield_data`.
    heights = (1.5, 2.0, 3.0, 0.0, 0.5, 1.0)
    found = surface(load(field, 'type="hfield" hfield="h"'))
    assert_allclose(found[:, 2], heights, atol=1e-15)
    assert_allclose(found[0, :2], (-2, -1))
    assert_allclose(found[-1, :2], (2, 1))


def test_a_file_of_heights_begins_at_the_least_y(load, tmp_path):
    heights = np.array([0, 1, 2, 4], "<f4")
    (tmp_path / "h.bin").write_bytes(struct.pack("<2i", 2, 2) + heights.tobytes())
    found = surface(load('<hfield name="h" file="h.bin" size="1 1 8 1"/>', 'type="hfield" hfield="h"'))
    assert_allclose(found[:, 2], (0, 2, 4, 8))


@pytest.mark.parametrize(
    ("geom", "rgba"),
    [
        ('size="1"', (0.5, 0.5, 0.5, 1)),
        ('size="1" material="red"', (1, 0, 0, 1)),
        ('size="1" material="red" rgba="0 0 1 1"', (0, 0, 1, 1)),
    ],
)
def test_the_colour_of_a_geom_comes_before_that_of_its_material(load, geom, rgba):
    scene = load('<material name="red" rgba="1 0 0 1"/>', geom)
    material = scene["b"].spec.base.visuals[0].material
    assert material is not None
    assert material.rgba == rgba


def made(name, parameters):
    mesh = builtin_mesh(name, parameters)
    assert not isinstance(mesh, str)
    return mesh


def test_plates_and_wedges_have_the_points_of_mujoco():
    # What MuJoCo 4.0 has, in the frame of the mesh.
    plate, triangles = made("plate", [3, 2])
    third = 2.0 / 3.0
    expected = [(x, y, -1.0) for x in (-third, 0.0, third) for y in (-0.5, 0.5)]
    assert_allclose(plate, expected, atol=1e-15)
    assert len(triangles) == 4
    wedge, triangles = made("wedge", [3, 3, 45, 45, 0.5])
    assert_allclose(np.linalg.norm(wedge, axis=1), 1.0)
    expected = [(-0.3972, -0.443, -0.8037), (-0.443, 0.0, -0.8965), (-0.3972, 0.443, -0.8037)]
    assert_allclose(wedge[:3], expected, atol=5e-5)
    for a, b, c in triangles:
        assert np.cross(wedge[b] - wedge[a], wedge[c] - wedge[a]) @ wedge[a] > 0.0
    even, _ = made("wedge", [4, 3, 45, 30, 0])
    assert_allclose(even[0], (-0.5221, -0.342, -0.7813), atol=5e-5)


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("plate", [1, 2]), ("plate", [2]), ("wedge", [3, 3, 45, 45]), ("torus", []), ("hemisphere", []),
        ("hemisphere", [11]), ("hemisphere", [-1]), ("supersphere", [6]), ("supersphere", [2, 1, 1]),
        ("supersphere", [3, 1, -1]), ("supertorus", [5, 0.3]), ("supertorus", [2, 0.3, 1, 1]),
        ("supertorus", [5, 1.5, 1, 1]), ("supertorus", [5, 0, 1, 1]), ("supertorus", [5, 0.3, 0, 1]),
    ],
)  # fmt: skip
def test_unknown_meshes_are_named(name, parameters):
    assert isinstance(builtin_mesh(name, parameters), str)


@pytest.mark.parametrize(
    ("name", "parameters", "last", "triangles"),
    [
        ("hemisphere", [2], (0.0, 0.0, 0.0), [(0, 1, 2), (24, 25, 13)]),
        ("supersphere", [7, 0.5, 1.5], (0.0, 0.0, 1.0), [(0, 2, 1), (42, 36, 43)]),
        ("supertorus", [5, 0.3, 0.5, 1.5], (0.2004, -1.0822, -0.2926), [(0, 5, 1), (4, 0, 20)]),
    ],
)
def test_curved_meshes_have_the_points_of_mujoco(name, parameters, last, triangles):
    # What MuJoCo 4.0 has, in the frame of the mesh.
    points, found = made(name, parameters)
    assert_allclose(points[-1], last, atol=5e-5)
    assert [tuple(it) for it in found[[0, -1]].tolist()] == triangles
    corners = points[found]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    assert volume > 0.0
