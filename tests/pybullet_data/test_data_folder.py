"""The folder of assets: what is in it, that its files fit together, and that they are what the tools make."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from original_facts import DATA
from tests.each import each
from tools.assets.build import binary_files, mesh_files, scene_files, urdf_files
from tools.assets.tetras import SOLIDS

import pybullet_data
from carom.description import Mesh
from carom.formats.urdf import read_urdf
from carom.meshes.vtk import read_vtk
from carom.render.plain_png import read_plain_png

# Half the extent [m] and the volume [m³] of the originals in bullet3.
MEASURED = {
    "ball.vtk": ((0.983, 0.982, 1.0), 3.941),
    "reduced_cube/cube_mesh.vtk": ((0.5, 0.5, 0.5), 1.0),
    "torus.vtk": ((0.75, 0.2475, 0.75), 0.5689),
    "tube.vtk": ((0.433, 0.619, 0.431), 0.6503),
}
URDFS = sorted(str(path.relative_to(DATA)) for path in DATA.rglob("*.urdf"))


def test_data_path_is_the_package_folder() -> None:
    path = pybullet_data.getDataPath()
    assert isinstance(path, str)
    assert Path(path) == Path(pybullet_data.__file__).parent


def test_the_folder_is_small() -> None:
    assert sum(path.stat().st_size for path in DATA.rglob("*") if path.is_file()) < 3_300_000


@pytest.mark.parametrize("file", sorted(SOLIDS))
def test_solids_are_whole_and_as_large_as_bullets(file: str) -> None:
    mesh = read_vtk(DATA / file)
    corners = mesh.points[mesh.tetras]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    extent, volume = MEASURED[file]
    assert volumes.min() > 0.05 * volumes.mean()
    assert high == pytest.approx(extent, abs=0.02) and low == pytest.approx(-high, abs=0.01)
    assert volumes.sum() == pytest.approx(volume, rel=0.06)


def test_every_file_is_made_by_the_tools() -> None:
    made = {
        *urdf_files(),
        *scene_files(),
        *mesh_files(),
        *binary_files(),
        "__init__.py",
        "_copies.py",
        "py.typed",
    }
    kept = {str(path.relative_to(DATA)) for path in DATA.rglob("*") if path.is_file()}
    assert {path for path in kept if "__pycache__" not in path} == made


def test_robot_files_are_what_the_tables_say() -> None:
    for path, text in (urdf_files() | scene_files()).items():
        assert (DATA / path).read_text() == text, f"{path} is stale: run python -m tools.assets.build"


def test_the_floors_picture_begins_blue_as_pybullets() -> None:
    read = read_plain_png((DATA / "checker_blue.png").read_bytes())
    assert read is not None
    corners = [read[0][y, x, :3].tolist() for y, x in ((0, 0), (0, -1), (-1, 0), (-1, -1))]
    assert corners == [[173, 199, 239], [255, 255, 255], [255, 255, 255], [173, 199, 239]]


def test_no_two_visuals_of_an_sdf_file_share_a_name() -> None:
    # PyBullet gives all visuals of a name the colour of the last one.
    for path, text in scene_files().items():
        names = [element.get("name") for element in ElementTree.fromstring(text).iter("visual")]
        assert len(set(names)) == len(names), path


@each("file", URDFS)
def test_robots_are_read_and_their_meshes_found(file: str) -> None:
    robot = read_urdf(DATA / file)
    shapes = [shape for link in robot.links for shape in (*link.visuals, *link.collisions)]
    meshes = [shape.geometry.path for shape in shapes if isinstance(shape.geometry, Mesh)]
    assert all(path.is_file() for path in meshes)
    stated = [element.get("filename") for element in ElementTree.parse(DATA / file).iter("mesh")]
    assert len(meshes) == len(stated)


@each("mesh", sorted(DATA.rglob("*.obj")), ids=lambda path: path.name)
def test_meshes_name_materials_and_pictures_that_exist(mesh: Path) -> None:
    for line in mesh.read_text().splitlines():
        if line.startswith("mtllib "):
            library = mesh.parent / line.split()[1]
            pictures = [
                text.split()[1] for text in library.read_text().splitlines() if text.startswith("map_Kd")
            ]
            assert pictures
            assert all((library.parent / picture).is_file() for picture in pictures)


def test_rrbot_is_the_robot_of_the_gazebo_tutorials() -> None:
    robot = read_urdf(DATA / "rrbot.urdf")
    assert [joint.name for joint in robot.joints] == [
        "fixed",
        "joint1",
        "joint2",
        "hokuyo_joint",
        "camera_joint",
    ]
    hinges = [joint for joint in robot.joints if joint.type.value == "continuous"]
    assert [joint.frame.position for joint in hinges] == [(0.0, 0.1, 1.95), (0.0, 0.1, 0.9)]
    assert all(joint.axis == (0.0, 1.0, 0.0) and joint.damping == 0.7 for joint in hinges)
