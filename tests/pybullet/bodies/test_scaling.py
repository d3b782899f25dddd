"""unsupportedChangeScaling, with the numbers that PyBullet 3.2.7 gives."""

from collections.abc import Iterator
from typing import Any

import pytest

import pybullet as p
import pybullet_data
from pybullet._clients.clients import client_of


@pytest.fixture(autouse=True)
def client() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield
    p.disconnect()


def body(kind: int, **shape: Any) -> int:
    return p.createMultiBody(1, p.createCollisionShape(kind, **shape))


def bounds(number: int) -> tuple[float, ...]:
    lower, upper = p.getAABB(number)
    return (*lower, *upper)


@pytest.mark.parametrize(
    ("kind", "shape", "half"),
    [
        (p.GEOM_BOX, {"halfExtents": [0.5, 0.5, 0.5]}, (1.0, 1.5, 2.0)),
        (p.GEOM_SPHERE, {"radius": 0.5}, (1.0, 1.0, 1.0)),
        (p.GEOM_CAPSULE, {"radius": 0.5, "height": 1.0}, (1.5, 1.5, 3.5)),
    ],
    ids=["box", "ball", "capsule"],
)
def test_bounds(kind: int, shape: dict[str, Any], half: tuple[float, ...]) -> None:
    number = body(kind, **shape)
    inertia = p.getDynamicsInfo(number, -1)[2]
    p.unsupportedChangeScaling(number, [2, 3, 4])
    assert bounds(number) == pytest.approx((*(-side for side in half), *half), abs=1e-3)
    assert p.getDynamicsInfo(number, -1)[2] == inertia
    # Against the size it was loaded with, not the present one.
    p.unsupportedChangeScaling(number, [1, 1, 1])
    assert max(bounds(number)) == pytest.approx(0.5 if kind != p.GEOM_CAPSULE else 1.0, abs=1e-3)


def test_parts_move_apart() -> None:
    shape = p.createCollisionShapeArray(
        shapeTypes=[p.GEOM_BOX, p.GEOM_SPHERE],
        halfExtents=[[0.1, 0.2, 0.3], [0, 0, 0]],
        radii=[0.1, 0.2],
        collisionFramePositions=[[0, 0, 1], [1, 0, 0]],
    )
    number = p.createMultiBody(1, shape)
    p.unsupportedChangeScaling(number, [2, 2, 2])
    assert bounds(number) == pytest.approx((-0.2, -0.4, -0.4, 2.4, 0.4, 2.6), abs=1e-6)


def test_a_scaled_mesh_is_hit_and_stands_where_it_ought_to() -> None:
    number = body(p.GEOM_MESH, fileName="cube.obj")
    p.unsupportedChangeScaling(number, [2, 2, 2])
    assert p.rayTest([0, 0, 5], [0, 0, -5])[0][3][2] == pytest.approx(1.0, abs=2e-3)
    p.loadURDF("plane.urdf")
    p.resetBasePositionAndOrientation(number, [0, 0, 1.1], [0, 0, 0, 1])
    p.setGravity(0, 0, -10)
    for _ in range(240):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(number)[0][2] == pytest.approx(1.0, abs=5e-3)


def test_other_bodies_of_the_same_shape_keep_their_size() -> None:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.5])
    first, second = (p.createMultiBody(1, shape, -1, [x, 0, 0]) for x in (10, 20))
    p.unsupportedChangeScaling(first, [2, 2, 2])
    assert bounds(first)[0] == pytest.approx(9.0)
    assert bounds(second)[0] == pytest.approx(19.5)


def test_what_cannot_be_scaled_says_so_and_stays() -> None:
    cylinder = body(p.GEOM_CYLINDER, radius=0.5, height=1.0)
    before = bounds(cylinder)
    for wrong in ([2, 2], [0, 1, 1], [-1, 1, 1], [2, 3, 4], 2, [float("nan"), 1, 1]):
        with pytest.raises(p.error, match=r"scaling needs|stay round"):
            p.unsupportedChangeScaling(cylinder, wrong)  # type: ignore[arg-type]
    assert bounds(cylinder) == before
    p.unsupportedChangeScaling(cylinder, [2, 2, 4])
    assert bounds(cylinder)[2] == pytest.approx(-2.0, abs=1e-3)
    p.unsupportedChangeScaling(77, [1, 1, 1])


@pytest.mark.parametrize(
    ("kind", "sizes"),
    [
        (p.GEOM_SPHERE, {"radius": 0.1}),
        (p.GEOM_BOX, {"halfExtents": [0.1, 0.2, 0.3]}),
        (p.GEOM_CAPSULE, {"radius": 0.1, "height": 0.5}),
        (p.GEOM_CYLINDER, {"radius": 0.1, "height": 0.5}),
        (p.GEOM_MESH, {"fileName": "cube.obj"}),
    ],
)
def test_shapes_do_not_become_larger_than_contacts_can_tell(kind: int, sizes: dict[str, Any]) -> None:
    number = body(kind, **sizes)
    before = bounds(number)
    for wrong in ([1e30, 1e30, 1e30], [1e17, 1e17, 1e17]):
        with pytest.raises(p.error, match=r"greater than 1e\+15 m"):
            p.unsupportedChangeScaling(number, wrong)
    assert bounds(number) == before
    p.unsupportedChangeScaling(number, [1e14, 1e14, 1e14])


def test_bodies_from_the_same_file_keep_their_size() -> None:
    first, second = (p.loadURDF("cube.urdf") for _ in range(2))
    p.unsupportedChangeScaling(second, [2, 2, 2])
    assert (
        bounds(first) == bounds(p.loadURDF("cube.urdf")) == pytest.approx((-0.5,) * 3 + (0.5,) * 3, abs=2e-3)
    )
    assert bounds(second) == pytest.approx((-1.0,) * 3 + (1.0,) * 3, abs=2e-3)


@pytest.mark.parametrize("later", [0, 1, 16], ids=["alone", "before another", "where the arrays are full"])
def test_a_base_without_shapes_leaves_other_bodies_alone(later: int) -> None:
    bare = p.createMultiBody(1)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    for place in range(later):
        p.createMultiBody(1, ball, basePosition=[place, 0, 0])
    shapes = client_of(0).world.contact_arrays.shapes.table.numpy
    before = {name: array.copy() for name, array in shapes.items()}
    p.unsupportedChangeScaling(bare, [2, 2, 2])
    assert all((shapes[name] == array).all() for name, array in before.items())
