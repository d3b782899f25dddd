"""Textures of soft bodies: coordinates from files and numbers, images, numbers of textures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import pybullet as p
from carom import World
from carom.description import TriangleMesh
from carom.model.body_spec import BodySpec
from carom.render.appearance import appearance_of
from carom.render.soft_surfaces import surface_mesh
from carom.render.textures import CHECKER, NO_TEXTURE
from carom.scene.soft_body import SoftBody
from carom.soft.files import soft_body_from_file
from carom.soft.materials import Springs

# Two triangles that share an edge, whose ends have other texture coordinates in each of them.
SEAM = """mtllib paint.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 0.25 0
vt 0.25 1
vt 0.75 0
vt 1 1
vt 0.75 1
usemtl paint
f 1/1 2/2 3/3
f 1/4 3/5 4/6
"""
CORNERS = [[0, 0], [0.25, 0], [0.25, 1], [0.75, 0], [1, 1], [0.75, 1]]


def write_seam(folder: Path, text: str = SEAM) -> Path:
    (folder / "paint.mtl").write_text("newmtl paint\nmap_Kd paint.png\n")
    Image.new("RGB", (2, 2), (200, 30, 10)).save(folder / "paint.png")
    file = folder / "seam.obj"
    file.write_text(text)
    return file


def cloth(file: Path) -> BodySpec:
    return soft_body_from_file(file, springs=Springs(100.0, 0.1, 0.0))


def uvs_of(spec: BodySpec) -> NDArray[np.float64] | None:
    mesh = spec.base.visuals[0].geometry
    assert isinstance(mesh, TriangleMesh)
    return mesh.uvs


def test_every_corner_keeps_its_texture_coordinate(tmp_path: Path) -> None:
    spec = cloth(write_seam(tmp_path))
    assert spec.soft is not None
    assert len(spec.soft.nodes) == 4
    assert np.asarray(uvs_of(spec)).tolist() == CORNERS
    material = spec.base.visuals[0].material
    assert material is not None
    assert material.texture == tmp_path / "paint.png"


def test_a_second_object_of_a_file_is_neither_simulated_nor_drawn(tmp_path: Path) -> None:
    spec = cloth(write_seam(tmp_path, f"o first\n{SEAM}o second\nf 1/1 2/2 4/6\n"))
    assert np.asarray(uvs_of(spec)).tolist() == CORNERS


def test_cloth_without_texture_coordinates_is_plain(tmp_path: Path) -> None:
    spec = cloth(write_seam(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
    assert uvs_of(spec) is None


def test_a_broken_texture_coordinate_is_a_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    spec = cloth(write_seam(tmp_path, SEAM.replace("vt 0.25 0\n", "vt one 0\n")))
    assert uvs_of(spec) is None
    assert "seam.obj:7" in caplog.text


def test_an_image_that_is_missing_leaves_the_cloth_plain(tmp_path: Path) -> None:
    file = write_seam(tmp_path)
    (tmp_path / "paint.png").unlink()
    world = World()
    body = world.load_cloth(mesh=file)
    assert appearance_of(world).shapes(body, -1)[0].texture == NO_TEXTURE


def test_the_window_has_vertices_apart_where_there_is_a_texture(tmp_path: Path) -> None:
    world = World()
    textured, plain = world.load_cloth(mesh=write_seam(tmp_path)), world.load_rope()
    assert isinstance(textured, SoftBody)
    assert not appearance_of(world).shapes(plain, -1)
    textured.set_nodes([[0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 2, 0]])
    mesh = surface_mesh(textured)
    assert mesh.uvs.tolist() == CORNERS
    assert mesh.positions[4] - mesh.positions[3] == pytest.approx(np.array([1, 1, 0]), abs=1e-6)
    assert mesh.positions[5] - mesh.positions[3] == pytest.approx(np.array([-1, 2, 0]), abs=1e-6)


def test_cloth_by_numbers_has_one_image_over_all_of_it() -> None:
    uvs = uvs_of(World().load_cloth((2.0, 0.5), (4, 3)).spec)
    assert uvs is not None
    assert uvs.min(axis=0).tolist() == [0.0, 0.0]
    assert uvs.max(axis=0).tolist() == [1.0, 1.0]


def test_solids_are_checkered_in_squares_of_five_centimetres() -> None:
    world = World()
    body = world.load_soft_solid((0.2, 0.2, 0.2))
    look = appearance_of(world).shapes(body, -1)[0]
    assert look.texture < NO_TEXTURE
    assert np.array_equal(appearance_of(world).textures.image(look.texture), CHECKER)
    # An image of two by two squares for each 10 cm.
    assert look.mesh.uvs.max() == pytest.approx(1.0)


def test_textures_of_soft_bodies_have_no_number_for_scripts(tmp_path: Path) -> None:
    client = p.connect(p.DIRECT)
    try:
        p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        body = p.loadSoftBody(str(write_seam(tmp_path)), mass=1, useMassSpring=1, springElasticStiffness=10)
        flag = p.VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS
        assert p.getVisualShapeData(body, flag)[0][8] == -1
        assert p.loadTexture(str(tmp_path / "paint.png")) == 0
        p.changeVisualShape(body, -1, textureUniqueId=0)
        assert p.getVisualShapeData(body, flag)[0][8] == 0
    finally:
        p.disconnect(client)


def test_a_saved_world_keeps_the_texture(tmp_path: Path) -> None:
    world = World()
    world.load_cloth(mesh=write_seam(tmp_path))
    world.save(tmp_path / "world.carom")
    for name in ("paint.png", "paint.mtl", "seam.obj"):
        (tmp_path / name).unlink()
    loaded = World()
    (body,) = loaded.load(tmp_path / "world.carom")
    appearance = appearance_of(loaded)
    look = appearance.shapes(body, -1)[0]
    assert look.mesh.uvs.tolist() == CORNERS
    assert appearance.textures.image(look.texture)[0, 0].tolist() == [200, 30, 10]
