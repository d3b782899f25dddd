"""Soft bodies in URDF files: `<deformable>` and `<reduced_deformable>`."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.soft.scenes import write_cube, write_grid

import pybullet as p
from carom import World
from carom.formats.search import AssetSearch
from carom.soft.from_urdf import urdf_body

INERTIAL = '<inertial><mass value="3"/><inertia ixx="0" iyy="0" izz="0"/></inertial>'
SOLID = '<neohookean mu="180" lambda="600" damping="0.01"/>'


@pytest.fixture(autouse=True)
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    yield
    p.disconnect()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_cube(tmp_path / "cube.vtk", 2)
    write_grid(tmp_path / "cloth.obj", 5)
    return tmp_path


def write(folder: Path, inside: str, mesh: str = "cube.vtk", tag: str = "deformable") -> str:
    path = folder / "soft.urdf"
    path.write_text(f'<robot name="r"><{tag} name="soft">{inside}<visual filename="{mesh}"/></{tag}></robot>')
    return str(path)


def nodes(body: int) -> np.ndarray:
    return np.array(p.getMeshData(body, flags=p.MESH_DATA_SIMULATION_MESH)[1])


def test_what_it_says_is_what_is_loaded(folder: Path) -> None:
    inside = INERTIAL + SOLID + '<collision_margin value="0.006"/><friction value="0.5"/>'
    body = p.loadURDF(write(folder, inside), [1, 2, 3], globalScaling=2.0)
    # As in PyBullet the body has the element's name, and its base has none.
    assert p.getBodyInfo(body) == (b"", b"soft")
    info = p.getDynamicsInfo(body, -1)
    assert (info[0], info[1], info[10], info[11]) == (pytest.approx(3.0), 0.5, 3, 0.006)
    assert np.ptp(nodes(body), axis=0) == pytest.approx([0.8] * 3)
    assert nodes(body).mean(axis=0) == pytest.approx([1, 2, 3])
    soft = urdf_body(Path(write(folder, inside)), AssetSearch(), scale=1.0, flags=8, fixed_base=False).soft
    assert soft is not None
    assert (soft.mu, soft.lam, soft.damping, soft.self_collision) == (180.0, 600.0, 0.01, True)


def test_springs_of_a_surface(folder: Path) -> None:
    springs = '<spring elastic_stiffness="40" damping_stiffness="0.1" bending_stiffness="2"/>'
    path = Path(write(folder, INERTIAL + springs, "cloth.obj"))
    body = World().load_urdf(path)
    assert body.spec.soft is not None
    assert set(body.spec.soft.spring_terms[:, 1].tolist()) == {40.0, 2.0}


def test_corotated_and_neo_hookean_stiffness_add_up(folder: Path) -> None:
    path = Path(write(folder, INERTIAL + SOLID + '<corotated mu="75" lambda="100" damping="0.01"/>'))
    soft = urdf_body(path, AssetSearch(), scale=1.0, flags=0, fixed_base=False).soft
    assert soft is not None
    assert (soft.mu, soft.lam) == pytest.approx((180 + 100, 600 + 100 + 62.5))
    assert soft.damping == pytest.approx(0.01)


@pytest.mark.parametrize("factor", [0.0, 0.5, 1.0])
def test_gravity_factor(folder: Path, factor: float) -> None:
    p.setGravity(0, 0, -10)
    body = p.loadURDF(write(folder, f'{INERTIAL}{SOLID}<gravity_factor value="{factor}"/>'))
    for _ in range(240):
        p.stepSimulation()
    # PyBullet 3.2.7 says -2.5024 for a factor of 0.5.
    assert nodes(body)[:, 2].mean() == pytest.approx(-5.0 * factor, abs=0.01)


def test_another_mesh_is_simulated(folder: Path) -> None:
    body = p.loadURDF(write(folder, INERTIAL + SOLID + '<collision filename="cube.vtk"/>', "cloth.obj"))
    assert len(nodes(body)) == 27
    assert p.getMeshData(body)[0] == 3 * 32


@pytest.mark.parametrize(
    ("inside", "mesh", "problem"),
    [
        (SOLID, "cube.vtk", "<inertial> with a <mass> is missing"),
        (INERTIAL, "missing.vtk", "missing.vtk"),
        (INERTIAL, "cube.stl", "must end in .obj or .vtk"),
        (INERTIAL + '<neohookean mu="1"/>', "cube.vtk", "'lambda' is missing"),
        (INERTIAL + '<neohookean mu="-1" lambda="5"/>', "cube.vtk", "mu is -1.0"),
        (INERTIAL + '<spring elastic_stiffness="1"/>', "cube.vtk", "'damping_stiffness' is missing"),
    ],
)
def test_what_cannot_be_used_is_refused(folder: Path, inside: str, mesh: str, problem: str) -> None:
    with pytest.raises(p.error, match=f"Cannot load URDF file.*{problem}"):
        p.loadURDF(write(folder, inside, mesh))
    assert p.getNumBodies() == 0


def test_outside_of_a_deformable_world_only_surfaces_are_loaded(folder: Path) -> None:
    p.resetSimulation()
    with pytest.raises(p.error, match="holds tetrahedra"):
        p.loadURDF(write(folder, INERTIAL + SOLID))
    with pytest.raises(p.error, match="reduced deformable bodies need a deformable world"):
        p.loadURDF(write(folder, '<mass value="1"/>', tag="reduced_deformable"))
    assert p.loadURDF(write(folder, INERTIAL, "cloth.obj")) == 0


def test_reduced_bodies_are_full_solids(folder: Path) -> None:
    p.resetSimulation(p.RESET_USE_REDUCED_DEFORMABLE_WORLD)
    inside = '<num_modes value="20"/><mass value="2"/><stiffness_scale value="50"/><friction value="0.5"/>'
    path = write(folder, inside, tag="reduced_deformable")
    body = p.loadURDF(path, [0, 0, 1])
    assert p.getDynamicsInfo(body, -1)[0] == pytest.approx(2.0)
    assert p.getTetraMeshData(body)[0] == 4 * 48
    soft = urdf_body(Path(path), AssetSearch(), scale=1.0, flags=0, fixed_base=False).soft
    assert soft is not None
    assert 0.75 * soft.mu == pytest.approx(50 * 100.0 / 2.6)


def test_reduced_bodies_are_as_stiff_as_their_modes(folder: Path) -> None:
    """One mode that stretches the cube by x along x: its energy for 1 Pa is known."""
    path = write(folder, '<mass value="2"/><stiffness_scale value="10"/>', tag="reduced_deformable")
    places = World().load_soft_solid(mesh=folder / "cube.vtk").nodes
    mode = np.zeros((27, 3))
    mode[:, 0] = places[:, 0]
    for name, numbers in (("K_r_diag_mat", [7.0]), ("modes", mode.ravel()), ("M_diag_mat", [4.0])):
        packed = struct.pack(f"<I{len(numbers)}d", len(numbers), *numbers)
        (folder / f"{name}.bin").write_bytes(packed)
    soft = urdf_body(Path(path), AssetSearch(), scale=1.0, flags=0, fixed_base=False).soft
    assert soft is not None
    lame = 0.3 / (1.3 * 0.4) + 1.0 / 1.3
    modulus = 7.0 / (0.4**3 * lame) * 10 * 2.0 / 4.0
    assert 0.75 * soft.mu == pytest.approx(modulus / 2.6)
    (folder / "modes.bin").write_bytes(b"\1\0\0\0")
    with pytest.raises(p.error, match="truncated"):
        p.loadURDF(path)


def test_reduced_bodies_with_a_flat_tetrahedron_are_refused(folder: Path) -> None:
    """Modes say nothing of the stiffness of what has no volume."""
    path = write(folder, '<mass value="2"/>', mesh="flat.vtk", tag="reduced_deformable")
    points = "0 0 0 1 0 0 0 1 0 0 0 1 1 1 0"
    (folder / "flat.vtk").write_text(
        "# vtk DataFile Version 2.0\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        f"POINTS 5 float\n{points}\nCELLS 2 10\n4 0 1 2 3\n4 0 1 2 4\nCELL_TYPES 2\n10\n10\n"
    )
    for name, numbers in (("K_r_diag_mat", [7.0]), ("modes", [1.0] * 15), ("M_diag_mat", [4.0])):
        (folder / f"{name}.bin").write_bytes(struct.pack(f"<I{len(numbers)}d", len(numbers), *numbers))
    with pytest.raises(p.error, match="tetrahedron 1 has no volume"):
        p.loadURDF(path)
