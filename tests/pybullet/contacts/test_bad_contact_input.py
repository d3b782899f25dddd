"""Degenerate meshes, impossible sizes, bodies at infinity, what was removed: a clear error, nothing lost.

Where PyBullet refuses, so do we; where it makes something of the input that works, it works here; where it
crashes or goes on with NaN, we refuse.
"""

import struct
from collections.abc import Callable, Iterator
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pybullet as p

NO_SHAPE = "createCollisionShape failed."
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
TRIANGLE = SQUARE[:3]


@pytest.fixture(autouse=True)
def witness() -> Iterator[int]:
    """A ball at rest on the floor; whatever is refused leaves it there."""
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5])
    p.createMultiBody(0, floor, basePosition=[0, 0, -0.5])
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[4, 4, 0.1])
    for _ in range(10):
        p.stepSimulation()
    bodies = p.getNumBodies()
    yield ball
    assert p.getNumBodies() >= bodies
    place = p.getBasePositionAndOrientation(ball)[0]
    p.stepSimulation()
    np.testing.assert_allclose(p.getBasePositionAndOrientation(ball)[0], place, atol=1e-9)
    assert p.getContactPoints(ball)
    p.disconnect()


def mesh(**arguments: Any) -> int:
    return p.createCollisionShape(p.GEOM_MESH, **arguments)


def falls_on_the_floor(shape: int) -> None:
    body = p.createMultiBody(1, shape, basePosition=[0, 0, 0.2])
    for _ in range(480):
        p.stepSimulation()
    lower, upper = p.getAABB(body)
    assert p.getContactPoints(body)
    assert -0.01 < lower[2] < 0.01
    assert np.isfinite([*lower, *upper]).all()


REFUSED_MESHES: dict[str, tuple[dict[str, Any], str]] = {
    "no vertices": ({"vertices": []}, "vertices is empty"),
    "a vertex is NaN": ({"vertices": [*SQUARE, [nan, 0, 1]]}, "vertices holds a number that is not finite"),
    "a vertex at infinity": ({"vertices": [*SQUARE, [inf, 0, 1]]}, "vertices holds a number that is not"),
    "a vertex with two numbers": ({"vertices": [[0, 0], [1, 0]]}, "vertices has to be a sequence of 3"),
    "an index too high": ({"vertices": SQUARE, "indices": [0, 1, 99]}, "indices names a vertex outside 0..3"),
    "an index below 0": ({"vertices": SQUARE, "indices": [0, 1, -1]}, "indices names a vertex outside 0..3"),
    "half a triangle": ({"vertices": SQUARE, "indices": [0, 1, 2, 3]}, "does not make triangles"),
    "triangles without area": (
        {"vertices": SQUARE, "indices": [0, 0, 1, 0, 1, 1]},
        "no triangle of the mesh has an area",
    ),
    "a scale of NaN": ({"vertices": SQUARE, "meshScale": [nan, 1, 1]}, "meshScale"),
    "no file": ({"fileName": "nowhere.obj"}, "There is no file"),
}


@pytest.mark.parametrize("name", REFUSED_MESHES)
def test_meshes_that_are_refused(name: str) -> None:
    arguments, particulars = REFUSED_MESHES[name]
    with pytest.raises(p.error, match=f"{NO_SHAPE}.*{particulars}"):
        mesh(**arguments)


FLAT_MESHES: dict[str, dict[str, Any]] = {
    "one point": {"vertices": [[0, 0, 0]]},
    "one point, many times": {"vertices": [[0, 0, 0]] * 9},
    "two points": {"vertices": SQUARE[:2]},
    "a line": {"vertices": [[0.1 * i, 0, 0] for i in range(9)]},
    "one triangle": {"vertices": TRIANGLE},
    "a square": {"vertices": SQUARE},
    "scaled to a point": {"vertices": SQUARE, "meshScale": [0, 0, 0]},
    "scaled flat": {"vertices": [*SQUARE, [0, 0, 1]], "meshScale": [1, 1, 0]},
    "mirrored": {"vertices": [*SQUARE, [0, 0, 1]], "meshScale": [-1, 1, 1]},
    "one triangle with indices": {"vertices": TRIANGLE, "indices": [0, 1, 2]},
    "no indices after all": {"vertices": SQUARE, "indices": []},
}


@pytest.mark.parametrize("name", FLAT_MESHES)
def test_meshes_without_thickness_fall_on_the_floor(name: str) -> None:
    falls_on_the_floor(mesh(**FLAT_MESHES[name]))


@pytest.mark.parametrize("length", [1e3, 1e6, 1e12, 1e30])
def test_needles_are_shapes(length: float) -> None:
    assert mesh(vertices=[*SQUARE, [length, 0, 1]]) >= 0


REFUSED_FILES: dict[str, tuple[str, bytes]] = {
    "nothing.obj": ("there are no triangles", b""),
    "points.obj": ("there are no triangles", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
    "far_index.obj": ("", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
    "nan.obj": ("", b"v nan 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nf 1 2 3\nf 2 3 4\n"),
    "nothing.stl": ("there are no triangles", bytes(80) + struct.pack("<I", 0)),
    "cut_off.stl": ("cut off", bytes(80) + struct.pack("<I", 10) + bytes(60)),
}


@pytest.mark.parametrize("name", REFUSED_FILES)
@pytest.mark.parametrize("flags", [0, p.GEOM_FORCE_CONCAVE_TRIMESH])
def test_files_that_are_refused(tmp_path: Path, name: str, flags: int) -> None:
    particulars, content = REFUSED_FILES[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(p.error, match=f"{NO_SHAPE}.*{name}.*{particulars}"):
        mesh(fileName=str(path), flags=flags)


@pytest.mark.parametrize("flags", [0, p.GEOM_FORCE_CONCAVE_TRIMESH])
def test_a_file_with_one_triangle(tmp_path: Path, flags: int) -> None:
    path = tmp_path / "triangle.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    falls_on_the_floor(mesh(fileName=str(path), flags=flags))


@pytest.mark.long
def test_a_million_triangles_carry_a_ball() -> None:
    """PyBullet refuses as many vertices in memory."""
    side = 708
    x, y = np.meshgrid(np.arange(side + 1) * 0.01, np.arange(side + 1) * 0.01)
    vertices = np.stack([x.ravel(), y.ravel(), 0.1 * np.sin(3.0 * x.ravel())], axis=1)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    other = corner + side + 1
    indices = np.stack([corner, corner + 1, other + 1, corner, other + 1, other], axis=1).ravel()
    assert len(indices) >= 3_000_000
    hills = p.createMultiBody(0, mesh(vertices=vertices, indices=indices), basePosition=[0, 0, 3])
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    ball = p.createMultiBody(1, shape, basePosition=[3, 3, 3.5])
    for _ in range(120):
        p.stepSimulation()
    assert p.getContactPoints(ball, hills)
    assert p.getBasePositionAndOrientation(ball)[0][2] > 2.9


SIZES: list[tuple[str, str, dict[str, Any]]] = [
    ("GEOM_SPHERE", "radius", {}),
    ("GEOM_CYLINDER", "radius", {"height": 1}),
    ("GEOM_CYLINDER", "height", {"radius": 0.5}),
    ("GEOM_CAPSULE", "radius", {"height": 1}),
    ("GEOM_CAPSULE", "height", {"radius": 0.5}),
]


@pytest.mark.parametrize(("kind", "name", "others"), SIZES)
@pytest.mark.parametrize("value", [-0.5, nan, inf, -inf, 1e200])
def test_sizes_that_are_refused(kind: str, name: str, others: dict[str, Any], value: float) -> None:
    with pytest.raises(p.error, match=f"{NO_SHAPE}.*{name}"):
        p.createCollisionShape(getattr(p, kind), **{name: value}, **others)


@pytest.mark.parametrize(("kind", "name", "others"), SIZES)
def test_no_radius_is_refused_and_no_height_is_none(kind: str, name: str, others: dict[str, Any]) -> None:
    if name == "radius":
        with pytest.raises(p.error, match=f"{NO_SHAPE} radius is 0"):
            p.createCollisionShape(getattr(p, kind), radius=0, **others)
    else:
        falls_on_the_floor(p.createCollisionShape(getattr(p, kind), height=0, **others))


@pytest.mark.parametrize("value", [-0.5, nan, inf, 1e200])
@pytest.mark.parametrize("axes", [(2,), (0, 1, 2)])
def test_boxes_that_are_refused(value: float, axes: tuple[int, ...]) -> None:
    extents = [value if axis in axes else 0.5 for axis in range(3)]
    with pytest.raises(p.error, match=f"{NO_SHAPE} .*halfExtents"):
        p.createCollisionShape(p.GEOM_BOX, halfExtents=extents)


def test_boxes_without_size() -> None:
    with pytest.raises(p.error, match=NO_SHAPE):
        p.createCollisionShape(p.GEOM_BOX)
    falls_on_the_floor(p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0]))


@pytest.mark.parametrize("normal", [[0, 0, 0], [nan, 0, 1], [0, 0, inf]])
def test_planes_that_are_refused(normal: list[float]) -> None:
    with pytest.raises(p.error, match=f"{NO_SHAPE} planeNormal"):
        p.createCollisionShape(p.GEOM_PLANE, planeNormal=normal)


@pytest.mark.parametrize(
    ("data", "rows", "columns"),
    [([], 0, 0), ([0], 1, 1), ([0] * 4, 1, 4), ([0, nan, 0, 0], 2, 2), ([0] * 5, 2, 2), ([0] * 4, -2, -2)],
)
def test_height_fields_that_are_refused(data: list[float], rows: int, columns: int) -> None:
    with pytest.raises(p.error):
        p.createCollisionShape(
            p.GEOM_HEIGHTFIELD, heightfieldData=data, numHeightfieldRows=rows, numHeightfieldColumns=columns
        )


def box() -> int:
    return p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)


@pytest.mark.parametrize("z", [nan, inf, -inf])
def test_bodies_are_not_put_at_infinity(z: float) -> None:
    shape = box()
    with pytest.raises(p.error, match="createMultiBody failed"):
        p.createMultiBody(1, shape, basePosition=[0, 0, z])
    body = p.createMultiBody(1, shape, basePosition=[0, 0, 1])
    calls: list[Callable[[], object]] = [
        lambda: p.resetBasePositionAndOrientation(body, [0, 0, z], [0, 0, 0, 1]),
        lambda: p.resetBasePositionAndOrientation(body, [0, 0, 1], [0, 0, 0, z]),
        lambda: p.resetBaseVelocity(body, [0, 0, z]),
        lambda: p.applyExternalForce(body, -1, [0, 0, z], [0, 0, 0], p.LINK_FRAME),
        lambda: p.changeDynamics(body, -1, mass=z),
    ]
    for call in calls:
        with pytest.raises(p.error):
            call()
    assert p.getBasePositionAndOrientation(body) == ((0, 0, 1), (0, 0, 0, 1))


@pytest.mark.parametrize("z", [1e18, 1e30])
def test_bodies_very_far_away_do_no_harm(z: float) -> None:
    shape = box()
    body, other = (p.createMultiBody(1, shape, basePosition=[x, 0, 1]) for x in (0, 1))
    p.resetBasePositionAndOrientation(body, [0, 0, z], [0, 0, 0, 1])
    for _ in range(5):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(body)[0][2] == pytest.approx(z)
    assert not p.getContactPoints(body)
    assert not p.getClosestPoints(body, other, 1.0)
    assert p.rayTest([1, 0, 5], [1, 0, -5])[0][0] == other


@pytest.mark.parametrize("z", [1e31, 1e160, 1e300])
def test_bodies_are_not_put_farther_away_than_numbers_reach(z: float) -> None:
    body = p.createMultiBody(1, box())
    with pytest.raises(p.error, match=r"it has to be from -1e\+30 to 1e\+30"):
        p.resetBasePositionAndOrientation(body, [0, 0, z], [0, 0, 0, 1])
    assert p.getBasePositionAndOrientation(body)[0] == (0, 0, 0)


@pytest.mark.parametrize("mass", [nan, inf, -1])
def test_masses_that_are_refused(mass: float) -> None:
    shape = box()
    with pytest.raises(p.error):
        p.createMultiBody(mass, shape)


def test_a_shape_that_is_removed_stays_with_its_bodies() -> None:
    shape = box()
    body = p.createMultiBody(1, shape, basePosition=[0, 0, 0.1])
    p.removeCollisionShape(shape)
    for _ in range(60):
        p.stepSimulation()
    assert p.getContactPoints(body)
    assert p.getBasePositionAndOrientation(body)[0][2] == pytest.approx(0.1, abs=1e-4)
    assert p.getCollisionShapeData(body, -1)[0][3] == (0.2, 0.2, 0.2)
    for unknown in (-1, 99):
        p.removeCollisionShape(unknown)


def tied() -> tuple[int, int, int]:
    shape = box()
    first, second = (p.createMultiBody(1, shape, basePosition=[x, 0, 2]) for x in (0, 1))
    tie = p.createConstraint(first, -1, second, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0.5, 0, 0], [-0.5, 0, 0])
    return first, second, tie


@pytest.mark.parametrize("which", [0, 1])
def test_constraints_go_with_their_bodies(which: int) -> None:
    *bodies, tie = tied()
    p.removeBody(bodies[which])
    left = bodies[1 - which]
    assert p.getNumConstraints() == 0
    with pytest.raises(p.error, match="Couldn't get user constraint info"):
        p.getConstraintInfo(tie)
    with pytest.raises(p.error, match="Couldn't getConstraintState"):
        p.getConstraintState(tie)
    p.changeConstraint(tie, maxForce=1)
    p.removeConstraint(tie)
    for _ in range(24):
        p.stepSimulation()
    # It falls freely.
    assert p.getBasePositionAndOrientation(left)[0][2] == pytest.approx(2 - 0.0519836978451028, abs=1e-9)


ZERO = [0.0] * 3
REFUSED_TIES: dict[str, dict[str, Any]] = {
    "no parent": {"parentBodyUniqueId": 99},
    "the world as parent": {"parentBodyUniqueId": -1},
    "no child": {"childBodyUniqueId": 99},
    "no parent link": {"parentLinkIndex": 5},
    "no child link": {"childLinkIndex": 5},
    "no such joint": {"jointType": 99},
    "a turning joint": {"jointType": p.JOINT_REVOLUTE},
    "a pivot of NaN": {"parentFramePosition": [nan, 0, 0]},
    "a pivot at infinity": {"childFramePosition": [inf, 0, 0]},
    "no rotation": {"parentFrameOrientation": [0, 0, 0, 0]},
    "a gear on what has no joint": {"jointType": p.JOINT_GEAR},
}


@pytest.mark.parametrize("name", REFUSED_TIES)
def test_constraints_that_are_refused(name: str) -> None:
    shape = box()
    first, second = (p.createMultiBody(1, shape, basePosition=[x, 0, 2]) for x in (0, 1))
    arguments = {
        "parentBodyUniqueId": first,
        "parentLinkIndex": -1,
        "childBodyUniqueId": second,
        "childLinkIndex": -1,
        "jointType": p.JOINT_FIXED,
        "jointAxis": [0, 0, 1],
        "parentFramePosition": ZERO,
        "childFramePosition": ZERO,
    }
    with pytest.raises(p.error, match="createConstraint failed"):
        p.createConstraint(**{**arguments, **REFUSED_TIES[name]})
    assert p.getNumConstraints() == 0


@pytest.mark.parametrize(
    "change",
    [
        {"jointChildPivot": [nan, 0, 0]},
        {"jointChildFrameOrientation": [0, 0, 0, 0]},
        {"maxForce": nan},
        {"maxForce": inf},
        {"erp": nan},
        {"gearRatio": nan},
        {"relativePositionTarget": nan},
    ],
)
def test_changes_of_constraints_that_are_refused(change: dict[str, Any]) -> None:
    *_, tie = tied()
    before = p.getConstraintInfo(tie)
    with pytest.raises(p.error):
        p.changeConstraint(tie, **change)
    assert p.getConstraintInfo(tie) == before
