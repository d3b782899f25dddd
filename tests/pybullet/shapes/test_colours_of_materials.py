"""Colours of mesh files: which call decides whether they count. The answers are those of PyBullet 3.2.7."""

from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

CUBE = f"{pybullet_data.getDataPath()}/cube_small.urdf"
WHITE = (1.0, 1.0, 1.0, 1.0)
GLASS = "newmtl glass\nKd 0.2 0.4 0.6\nd 0.5\n"
PYRAMID = """mtllib glass.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
usemtl glass
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
"""
MODEL = """<mujoco model="m"><asset><mesh name="g" file="glass.obj"/></asset>
<worldbody><body><geom type="mesh" mesh="g" mass="1"/></body></worldbody></mujoco>"""
SCENE = """<sdf version="1.6"><world name="w"><model name="m"><link name="l"><inertial><mass>1</mass><inertia>
<ixx>1</ixx><ixy>0</ixy><ixz>0</ixz><iyy>1</iyy><iyz>0</iyz><izz>1</izz></inertia></inertial></link></model>
</world></sdf>"""
COLOURS = p.URDF_USE_MATERIAL_COLORS_FROM_MTL
SEE_THROUGH = COLOURS | p.URDF_USE_MATERIAL_TRANSPARANCY_FROM_MTL
OPAQUE = (0.2, 0.4, 0.6, 1.0)


@pytest.fixture(autouse=True)
def glass(client: int, tmp_path: Path) -> Path:
    """A folder with a mesh of glass, and files of robots that name it."""
    for name, content in (
        ("glass.mtl", GLASS),
        ("glass.obj", PYRAMID),
        ("glass.xml", MODEL),
        ("scene.sdf", SCENE),
    ):
        (tmp_path / name).write_text(content)
    p.setAdditionalSearchPath(str(tmp_path))
    return tmp_path


def colour(flags: int = 0) -> tuple[float, ...]:
    """The colour of a new body of glass that is made with flags of its own."""
    shape = p.createCollisionShape(p.GEOM_MESH, fileName="glass.obj")
    return p.getVisualShapeData(p.createMultiBody(1, shape, flags=flags))[0][7]


@pytest.mark.parametrize(
    ("flags", "expected"), [(0, WHITE), (COLOURS, OPAQUE), (SEE_THROUGH, (0.2, 0.4, 0.6, 0.5))]
)
def test_the_last_urdf_file_decides_for_bodies_made_of_shapes(
    flags: int, expected: tuple[float, ...]
) -> None:
    p.loadURDF(CUBE, flags=flags)
    assert colour() == colour(flags=SEE_THROUGH) == pytest.approx(expected)
    visual = p.createVisualShape(p.GEOM_MESH, fileName="glass.obj")
    assert p.getVisualShapeData(p.createMultiBody(1, -1, visual))[0][7] == pytest.approx(expected)
    p.resetSimulation()
    assert colour() == pytest.approx(expected)
    p.loadURDF(CUBE)
    assert colour() == WHITE


def test_it_decides_for_shapes_without_a_colour_too() -> None:
    p.loadURDF(CUBE, flags=p.URDF_GOOGLEY_UNDEFINED_COLORS)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    green = (0.234375, 0.7265625, 0.328125, 1.0)
    assert p.getVisualShapeData(p.createMultiBody(1, box))[0][7] == green


def test_flags_of_the_call_itself_do_not() -> None:
    assert colour(flags=COLOURS) == WHITE


def test_it_decides_for_mjcf_files_as_well() -> None:
    def of_model(flags: int) -> tuple[float, ...]:
        return p.getVisualShapeData(p.loadMJCF("glass.xml", flags=flags)[-1])[0][7]

    assert of_model(COLOURS) == WHITE
    p.loadURDF(CUBE, flags=COLOURS)
    assert of_model(0) == colour() == pytest.approx(OPAQUE)


def test_an_sdf_file_ends_it_and_a_missing_file_does_not() -> None:
    p.loadURDF(CUBE, flags=COLOURS)
    with pytest.raises(p.error):
        p.loadURDF("nothing.urdf")
    assert colour() == pytest.approx(OPAQUE)
    p.loadSDF("scene.sdf")
    assert colour() == WHITE


def test_links_without_a_colour_get_those_of_the_window_where_they_were_asked_for() -> None:
    p.loadURDF(CUBE, flags=p.URDF_GOOGLEY_UNDEFINED_COLORS)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    assert p.getVisualShapeData(p.createMultiBody(1, box))[0][7] == (0.234375, 0.7265625, 0.328125, 1.0)


CORNERS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
FRONT, BACK = "f 1 3 2\nf 1 2 4\n", "f 2 3 4\nf 3 1 4\n"
PAINTS = "newmtl red\nKd 1 0.5 0.25\nnewmtl blue\nKd 0 0 1\nnewmtl shiny\nKs 1 1 1\n"
RED, BLUE, BLACK = (1.0, 0.5, 0.25, 1.0), (0.0, 0.0, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (FRONT, BLACK),
        (f"usemtl red\n{FRONT}", RED),
        (f"usemtl red or so\n{FRONT}", RED),
        (f"usemtl shiny\n{FRONT}", BLACK),
        (f"usemtl green\n{FRONT}", BLACK),
        (f"usemtl red\n{FRONT}usemtl blue\n{BACK}usemtl red\n{FRONT}", RED),
        (f"usemtl red\n{FRONT}usemtl blue\n", BLUE),
        (f"usemtl red\n{FRONT}o b\nusemtl blue\n", RED),
        (f"usemtl red\n{FRONT}o b\n{BACK}", RED),
        (f"usemtl red\n{FRONT}g b\nusemtl green\n{BACK}", BLACK),
        (f"{FRONT}o b\nusemtl blue\n{BACK}", BLUE),
    ],
)
def test_a_mesh_has_the_material_of_its_last_group_and_is_black_without_one(
    glass: Path, lines: str, expected: tuple[float, ...]
) -> None:
    (glass / "paints.mtl").write_text(PAINTS)
    (glass / "glass.obj").write_text(f"mtllib paints.mtl\n{CORNERS}{lines}")
    p.loadURDF(CUBE, flags=COLOURS)
    assert colour() == expected


def test_a_material_counts_only_after_its_file_was_named(glass: Path) -> None:
    (glass / "paints.mtl").write_text(PAINTS)
    (glass / "glass.obj").write_text(f"{CORNERS}usemtl red\nmtllib paints.mtl\n{FRONT}")
    p.loadURDF(CUBE, flags=COLOURS)
    assert colour() == BLACK
