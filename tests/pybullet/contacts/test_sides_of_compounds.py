"""Which of two links a contact names first; the expected values are what PyBullet 3.2.7 answers."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

import pybullet as p

_HALF = 0.1
_FACES = ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
_SHAPES = {
    "box": ('<box size="0.2 0.2 0.2"/>', 0.0),
    "placed box": ('<box size="0.2 0.2 0.2"/>', 0.01),
    "mesh": ('<mesh filename="one.obj"/>', 0.0),
    "placed mesh": ('<mesh filename="one.obj"/>', 0.01),
    "two": ('<mesh filename="two.obj"/>', 0.0),
    "placed two": ('<mesh filename="two.obj"/>', 0.01),
}
# Of each shape, the side that is named first where the other is each of these shapes: a is below, and older.
_FIRST = {
    "box": "abbbbb",
    "placed box": "aaabab",
    "mesh": "aaabab",
    "placed mesh": "aaaaaa",
    "two": "aaabab",
    "placed two": "aaaaaa",
}


def write_cubes(path: Path, parts: int) -> None:
    """An OBJ file of cubes beside each other, 20 cm wide."""
    lines = []
    for part in range(parts):
        lines.append(f"o part{part}")
        for z, y, x in product((-_HALF, _HALF), repeat=3):
            lines.append(f"v {x + 0.3 * part} {y} {z}")
        lines += ["f " + " ".join(str(int(corner) + 8 * part) for corner in face.split()) for face in _FACES]
    path.write_text("\n".join(lines) + "\n")


def load(folder: Path, name: str, height: float) -> int:
    geometry, place = _SHAPES[name]
    file = folder / f"{name.replace(' ', '-')}.urdf"
    file.write_text(
        '<robot name="body"><link name="link"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><origin xyz="{place} 0 0"/><geometry>{geometry}</geometry></collision></link></robot>'
    )
    return p.loadURDF(str(file), [0, 0, height])


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize("below", _SHAPES)
def test_what_is_in_more_compounds_is_named_first(below: str, tmp_path: Path) -> None:
    write_cubes(tmp_path / "one.obj", 1)
    write_cubes(tmp_path / "two.obj", 2)
    found = ""
    for above in _SHAPES:
        p.resetSimulation()
        older = load(tmp_path, below, 0.0)
        load(tmp_path, above, 0.199)
        p.performCollisionDetection()
        sides = {"a" if point[1] == older else "b" for point in p.getContactPoints()}
        found += "".join(sorted(sides)) or "-"
    assert found == _FIRST[below]


@pytest.mark.usefixtures("client")
def test_shapes_of_scripts_are_in_one_compound_at_most(tmp_path: Path) -> None:
    write_cubes(tmp_path / "two.obj", 2)
    two = {"fileName": str(tmp_path / "two.obj"), "collisionFramePosition": [0.01, 0, 0]}
    p.createMultiBody(
        1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[_HALF] * 3, collisionFramePosition=[0.01, 0, 0])
    )
    mesh = p.createCollisionShape(p.GEOM_MESH, **two)
    p.createMultiBody(1, mesh, -1, [0, 0, 0.199], baseInertialFramePosition=[0.02, 0, 0])
    p.performCollisionDetection()
    assert {point[1] for point in p.getContactPoints()} == {0}


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize(("angle", "first"), [("1.57075", 0), ("0.7", 0), ("2.0", 0), ("1.1", 1), ("1.3", 1)])
def test_rounding_decides_whether_a_turned_shape_is_in_place(tmp_path: Path, angle: str, first: int) -> None:
    # The shape lies in the inertial frame, but their product is the identity only up to rounding.
    turned, deep = f'<origin rpy="0 {angle} 0"/>', '<origin xyz="0 0 -5"/>'
    for name, mass, frame, place, size in (
        ("leg", 1, turned, turned, "0.6 0.2 0.1"),
        ("floor", 0, "", deep, "30 30 10"),
    ):
        (tmp_path / f"{name}.urdf").write_text(
            f'<robot name="{name}"><link name="link"><inertial>{frame}<mass value="{mass}"/>'
            '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
            f'<collision>{place}<geometry><box size="{size}"/></geometry></collision></link></robot>'
        )
    p.loadURDF(str(tmp_path / "leg.urdf"), [0, 0, 0.2])
    p.loadURDF(str(tmp_path / "floor.urdf"))
    p.stepSimulation()
    assert {point[1] for point in p.getContactPoints()} == {first}
