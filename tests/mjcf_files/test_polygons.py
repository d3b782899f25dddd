"""Polygons of OBJ files become the triangles that MuJoCo makes of them, and give meshes the same masses."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.polygon import CLOUD, PRISMS, WAYS, model, obj, polygons

from carom import World
from carom.errors import DescriptionError
from carom.meshes import read_mesh
from carom.meshes.ears import cut_by_ears

ANSWERS = json.loads((Path(__file__).parent / "cases" / "polygon_answers.json").read_text())


def test_polygons_are_cut_as_mujoco_cuts_them(tmp_path):
    faces = polygons()
    corners = np.concatenate([np.array(face) for face in faces])
    sizes = np.array([len(face) for face in faces])
    found = cut_by_ears(corners, np.arange(len(corners)), sizes)
    assert found.tolist() == ANSWERS["faces"]
    (tmp_path / "faces.obj").write_text(obj(faces))
    (part,) = read_mesh(tmp_path / "faces.obj", by_ears=True)
    assert_allclose(part.vertices[part.triangles], corners[found], atol=1e-6)


def test_the_reading_of_pybullet_has_fans(tmp_path):
    (tmp_path / "star.obj").write_text(PRISMS["star"])
    for _ in range(2):  # Both are kept.
        (ears,) = read_mesh(tmp_path / "star.obj", by_ears=True)
        (fans,) = read_mesh(tmp_path / "star.obj")
        assert fans.triangles[:6].tolist() == [[7, 7 - n, 6 - n] for n in range(1, 7)]
        assert ears.triangles.tolist() != fans.triangles.tolist()


def test_polygons_of_no_area_and_of_few_corners_do_no_harm():
    points = np.zeros((9, 3))
    points[8] = 1e39, 0.0, 0.0
    sizes = np.array([2, 5, 0, 1, 6])
    found = cut_by_ears(points, np.array([0, 1, 0, 1, 2, 3, 4, 0, 0, 1, 2, 3, 8, 5]), sizes)
    assert found.shape == (7, 3)


@pytest.mark.parametrize("prism", PRISMS)
def test_meshes_have_the_masses_of_mujoco(tmp_path, prism):
    (tmp_path / f"{prism}.obj").write_text(PRISMS[prism])
    for way in WAYS:
        (tmp_path / "file.xml").write_text(model(prism, way))
        base = World().load(tmp_path / "file.xml")["b"].spec.base
        mass, *rest = ANSWERS["masses"][f"{prism} {way}"]
        assert_allclose(base.mass, mass, rtol=2e-6)
        assert_allclose(base.inertial_frame.position, rest[:3], atol=3e-6)
        assert_allclose(sorted(base.inertia), rest[3:], rtol=1e-5)


def test_files_without_faces_touch_with_the_hull_of_their_corners(tmp_path):
    (tmp_path / "cloud.obj").write_text(CLOUD)
    (tmp_path / "file.xml").write_text(model("cloud", "legacy"))
    with World() as world:
        body = world.load(tmp_path / "file.xml")["b"]
        (shape,) = body.spec.base.collisions
        assert_allclose(np.ptp(shape.geometry.points, axis=0), [1, 1, 2])
        assert world.queries().cast_ray((0.5, 0.5, 5.0), (0.5, 0.5, -5.0)).position[2] == pytest.approx(
            2.0, abs=1e-6
        )
    with pytest.raises(DescriptionError, match="no triangles"):
        read_mesh(tmp_path / "cloud.obj")
    (tmp_path / "empty.obj").write_text("# nothing\n")
    with pytest.raises(DescriptionError, match="no triangles"):
        read_mesh(tmp_path / "empty.obj", by_ears=True)
