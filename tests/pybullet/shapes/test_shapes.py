"""Shapes made by scripts where PyBullet gives no answer: bad input, landscapes, decomposition, filters."""

from __future__ import annotations

import sys
from importlib import import_module
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pybullet._clients.clients import clients

# Checked at run time: what is tested here is calls that are wrong, too.
p: Any = import_module("pybullet")

MESHES = Path(__file__).parents[2] / "formats" / "data" / "meshes"
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
GRID = {"numHeightfieldRows": 2, "numHeightfieldColumns": 2}


def shapes_of(client: int) -> Any:
    return clients[client].world.contact_arrays.shapes


@pytest.mark.parametrize(
    "arguments",
    [
        {"shapeType": p.GEOM_SPHERE, "radius": nan},
        {"shapeType": p.GEOM_SPHERE, "radius": inf},
        {"shapeType": p.GEOM_SPHERE, "radius": 1e200},
        {"shapeType": p.GEOM_BOX, "halfExtents": [1.0, nan, 1.0]},
        {"shapeType": p.GEOM_BOX, "halfExtents": [1.0, -1.0, 1.0]},
        {"shapeType": p.GEOM_PLANE, "planeNormal": [0, 0, 0]},
        {"shapeType": p.GEOM_BOX, "halfExtents": [1, 1, 1], "collisionFrameOrientation": [0, 0, 0, 0]},
        {"shapeType": p.GEOM_MESH, "vertices": [[0, 0, nan]]},
        {"shapeType": p.GEOM_MESH, "vertices": [[0, 0]]},
        {"shapeType": p.GEOM_MESH, "vertices": [[0, 0, 0], [1, 2]]},
        {"shapeType": p.GEOM_MESH, "vertices": "abc"},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0, 1, 9]},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0, 1, -1]},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0, 1]},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0.5, 1, 2]},
        {"shapeType": p.GEOM_MESH, "vertices": [[0, 0, 0]] * 3, "indices": [0, 1, 2]},
        {"shapeType": p.GEOM_MESH, "fileName": str(MESHES / "make_meshes.py")},
        {"shapeType": p.GEOM_HEIGHTFIELD, "heightfieldData": [0, 0, nan, 0], **GRID},
        {"shapeType": p.GEOM_HEIGHTFIELD, "heightfieldData": [0, "a", 0, 0], **GRID},
        {"shapeType": p.GEOM_HEIGHTFIELD, "heightfieldData": [0] * 4, "meshScale": [0, 1, 1], **GRID},
        {"shapeType": p.GEOM_HEIGHTFIELD, "heightfieldData": [0] * 4, "meshScale": [1, -1e-61, 1], **GRID},
        {"shapeType": p.GEOM_HEIGHTFIELD, "fileName": "nowhere.txt"},
        {
            "shapeType": p.GEOM_HEIGHTFIELD,
            "heightfieldData": [1, 2, 3],
            "numHeightfieldRows": 3,
            "numHeightfieldColumns": 1,
        },
    ],
)
def test_shapes_that_cannot_be_are_refused_and_take_no_id(client: int, arguments: dict[str, Any]) -> None:
    with pytest.raises(p.error):
        p.createCollisionShape(**arguments)
    assert p.createCollisionShape(p.GEOM_SPHERE) == 0


@pytest.mark.parametrize(
    "arguments",
    [
        {"shapeType": p.GEOM_SPHERE, "radius": nan},
        {"shapeType": p.GEOM_SPHERE, "specularColor": [1, nan, 1]},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": []},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0, 1, 2], "normals": [[0, 0, 1]]},
        {"shapeType": p.GEOM_MESH, "vertices": SQUARE, "indices": [0, 1, 2], "uvs": [[0, 0, 0]] * 4},
    ],
)
def test_visual_shapes_that_cannot_be_are_refused(client: int, arguments: dict[str, Any]) -> None:
    with pytest.raises(p.error):
        p.createVisualShape(**arguments)
    assert p.createVisualShape(p.GEOM_SPHERE) == 0


def one_link(**changes: Any) -> dict[str, Any]:
    lists = {
        "linkMasses": [1.0],
        "linkCollisionShapeIndices": [-1],
        "linkVisualShapeIndices": [-1],
        "linkPositions": [[0, 0, 1]],
        "linkOrientations": [[0, 0, 0, 1]],
        "linkInertialFramePositions": [[0, 0, 0]],
        "linkInertialFrameOrientations": [[0, 0, 0, 1]],
        "linkParentIndices": [0],
        "linkJointTypes": [p.JOINT_REVOLUTE],
        "linkJointAxis": [[0, 0, 1]],
    }
    return lists | changes


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ({"baseMass": -1}, "baseMass"),
        ({"baseMass": nan}, "baseMass"),
        ({"basePosition": [1, 2, nan]}, "basePosition"),
        ({"baseOrientation": [0, 0, 0, 0]}, "baseOrientation"),
        ({"batchPositions": [[0, 0, 0], [1, 1]]}, "batchPositions"),
        ({"batchPositions": 5}, "batchPositions"),
        (one_link(linkMasses=[-1.0]), r"linkMasses\[0\]"),
        (one_link(linkPositions=[[0, 0]]), r"linkPositions\[0\]"),
        (one_link(linkOrientations=[[0, 0, 0, 0]]), r"linkOrientations\[0\]"),
        (one_link(linkParentIndices=[2]), r"linkParentIndices\[0\]"),
        (one_link(linkParentIndices=[-1]), r"linkParentIndices\[0\]"),
        (one_link(linkParentIndices=[1]), "its own ancestor"),
        (one_link(linkJointTypes=[p.JOINT_PLANAR]), r"linkJointTypes\[0\]"),
        (one_link(linkJointTypes=[p.JOINT_POINT2POINT]), r"linkJointTypes\[0\]"),
        (one_link(linkJointAxis=[[0, 0, 0]]), r"linkJointAxis\[0\]"),
    ],
)
def test_bodies_that_cannot_be_are_refused_and_named(
    client: int, arguments: dict[str, Any], named: str
) -> None:
    with pytest.raises(p.error, match=named):
        p.createMultiBody(**{"baseMass": 1.0, **arguments})
    assert p.getNumBodies() == 0
    assert p.createMultiBody(1.0) == 0


@pytest.mark.parametrize("bad", ["a", None, 1.5])
def test_shape_ids_have_to_be_integers(client: int, bad: Any) -> None:
    with pytest.raises(TypeError):
        p.createMultiBody(1.0, bad)


def test_arrays_of_numpy_do_as_well(client: int) -> None:
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=np.array(SQUARE, float), indices=np.array([0, 1, 2]))
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=np.array([1.0, 2.0, 3.0]))
    links = {name: np.array(values) for name, values in one_link(linkCollisionShapeIndices=[box]).items()}
    body = p.createMultiBody(1.0, shape, basePosition=np.zeros(3), **links)
    assert p.getCollisionShapeData(body, 0)[0][3] == (2.0, 4.0, 6.0)
    ids = p.createMultiBody(1.0, box, batchPositions=np.arange(6.0).reshape(2, 3))
    assert [p.getBasePositionAndOrientation(i)[0] for i in ids] == [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)]


def test_batches_take_the_ids_that_are_free(client: int) -> None:
    for _ in range(3):
        p.createMultiBody(1.0)
    p.removeBody(0)
    p.removeBody(2)
    assert p.createMultiBody(1.0, batchPositions=[[0, 0, 0]] * 3) == (2, 0, 3)


def test_shapes_belong_to_their_client(client: int) -> None:
    other = p.connect(p.DIRECT)
    assert p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=client) == 0
    assert p.createCollisionShape(p.GEOM_SPHERE, radius=0.2, physicsClientId=other) == 0
    body = p.createMultiBody(1.0, 0, physicsClientId=other)
    assert p.getCollisionShapeData(body, -1, physicsClientId=other)[0][3] == (0.2, 0.2, 0.2)


def test_a_used_shape_stays(client: int) -> None:
    shape = p.createCollisionShape(p.GEOM_SPHERE)
    body = p.createMultiBody(1.0, shape)
    p.removeCollisionShape(shape)
    p.removeBody(body)
    p.removeCollisionShape(shape)
    assert p.getCollisionShapeData(p.createMultiBody(1.0, shape), -1)[0][2] == p.GEOM_SPHERE


def test_maximal_coordinates_are_reduced_ones_with_a_warning(
    client: int, caplog: pytest.LogCaptureFixture
) -> None:
    body = p.createMultiBody(1.0, useMaximalCoordinates=1)
    assert "useMaximalCoordinates" in caplog.text
    assert p.getDynamicsInfo(body, -1)[10] == 2


def test_air_does_not_slow_what_has_maximal_coordinates(client: int) -> None:
    bodies = [p.createMultiBody(1.0, useMaximalCoordinates=maximal) for maximal in (0, 1)]
    for body in bodies:
        p.resetBaseVelocity(body, [1.0, 2.0, 3.0])
    for _ in range(100):
        p.stepSimulation()
    # PyBullet's velocities.
    assert p.getBaseVelocity(bodies[0])[0] == pytest.approx((0.92614475, 1.85228949, 2.77843424), abs=1e-8)
    assert p.getBaseVelocity(bodies[1])[0] == (1.0, 2.0, 3.0)


def landscape(heights: list[float], replaced: int = -1) -> int:
    return p.createCollisionShape(
        p.GEOM_HEIGHTFIELD,
        meshScale=[1, 1, 2],
        heightfieldData=heights,
        numHeightfieldRows=3,
        numHeightfieldColumns=2,
        replaceHeightfieldIndex=replaced,
    )


def test_a_landscape_gets_other_heights_wherever_it_is_used(client: int) -> None:
    shape = landscape([0, 1, 2, 3, 4, 5])
    p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE))
    bodies = [p.createMultiBody(0, shape, basePosition=[10.0 * i, 0, 0]) for i in range(2)]
    assert p.getAABB(bodies[1]) == ((9.0, -0.5, -5.0), (11.0, 0.5, 5.0))
    assert landscape([7.5] * 6, replaced=shape) == shape
    for i, body in enumerate(bodies):
        low, high = p.getAABB(body)
        # The middle of the first heights, 2.5, stays at the origin.
        assert low == (10.0 * i - 1.0, -0.5, 10.0)
        assert high == (10.0 * i + 1.0, 0.5, 10.0)
    with pytest.raises(p.error, match="3 x 2 points, not 2 x 2"):
        p.createCollisionShape(
            p.GEOM_HEIGHTFIELD, heightfieldData=[1] * 4, replaceHeightfieldIndex=shape, **GRID
        )
    with pytest.raises(p.error, match="not a heightfield"):
        landscape([0] * 6, replaced=p.createCollisionShape(p.GEOM_SPHERE))


@pytest.mark.insides
def test_heights_come_from_text_the_way_pybullet_turns_it(client: int, tmp_path: Path) -> None:
    file = tmp_path / "field.txt"
    file.write_text("0, 1, 2,\n3, 4, 5,\n6, 7, 8,\n")
    shape = p.createCollisionShape(p.GEOM_HEIGHTFIELD, fileName=str(file), meshScale=[1, 1, 1])
    p.createMultiBody(0, shape)
    vertices = shapes_of(client).table.numpy["vertex_position"][:9]
    np.testing.assert_allclose(vertices[:3, :2], [(-1, -1), (0, -1), (1, -1)])
    # What comes first in the text comes first along y.
    np.testing.assert_allclose(vertices[:, 2] + 4.0, [0, 3, 6, 1, 4, 7, 2, 5, 8])


@pytest.mark.parametrize("text", ["", "1,2\n3\n", "1,2\n3,x\n", "1,2,3\n"])
def test_text_that_is_no_landscape_is_refused(client: int, tmp_path: Path, text: str) -> None:
    file = tmp_path / "field.txt"
    file.write_text(text)
    with pytest.raises(p.error, match=r"createCollisionShape failed\. ."):
        p.createCollisionShape(p.GEOM_HEIGHTFIELD, fileName=str(file))


@pytest.mark.insides
def test_heights_come_from_the_red_of_images(client: int, tmp_path: Path) -> None:
    from PIL import Image

    pixels = np.zeros((2, 3, 3), np.uint8)
    pixels[0, :, 0] = (0, 51, 255)
    file = tmp_path / "field.png"
    Image.fromarray(pixels).save(file)
    shape = p.createCollisionShape(p.GEOM_HEIGHTFIELD, fileName=str(file))
    p.createMultiBody(0, shape)
    heights = shapes_of(client).table.numpy["vertex_position"][:6, 2]
    np.testing.assert_allclose(heights + 0.5, [1.0, 0.2, 0.0, 0.0, 0.0, 0.0], atol=1e-7)


@pytest.mark.insides
def test_filters_reach_the_shapes(client: int) -> None:
    body = p.createMultiBody(1.0, **one_link())
    other = p.createMultiBody(0)
    p.setCollisionFilterPair(other, body, -1, 0, 0)
    p.setCollisionFilterPair(body, body, 0, -1, 1)
    p.setCollisionFilterGroupMask(body, 0, 4, 3)
    shapes = shapes_of(client)
    assert shapes.filter_count == 2
    numpy = shapes.table.numpy
    rules = [[int(numpy[f"filter_{name}"][i]) for name in ("link_a", "link_b", "enabled")] for i in range(2)]
    assert rules == [[0, 1, 1], [1, 2, 0]]
    assert numpy["link_group"][:3].tolist() == [1, 4, 2]
    assert numpy["link_mask"][:3].tolist() == [-1, 3, -3]
    p.removeBody(body)
    assert shapes.filter_count == 0


def test_a_robots_shapes_are_bounded_wherever_it_goes(client: int) -> None:
    body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 2, 3]))
    p.resetBasePositionAndOrientation(body, [10, 0, 0], p.getQuaternionFromEuler([0, 0, np.pi / 2]))
    low, high = p.getAABB(body)
    np.testing.assert_allclose([low, high], [(8, -1, -3), (12, 1, 3)], atol=1e-12)


def test_a_mesh_is_cut_into_convex_pieces(client: int, tmp_path: Path) -> None:
    pytest.importorskip("coacd", reason="cuts meshes")
    target, log = tmp_path / "pieces.obj", tmp_path / "log.txt"
    p.vhacd(str(MESHES / "two_boxes.obj"), str(target), str(log), maxNumVerticesPerCH=32)
    assert target.read_text().count("o convex_") == 2
    assert "most_vertices=32" in log.read_text()
    body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_MESH, fileName=str(target)))
    assert len(p.getCollisionShapeData(body, -1)) == 2
    whole = p.createMultiBody(
        1.0, p.createCollisionShape(p.GEOM_MESH, fileName=str(MESHES / "two_boxes.obj"))
    )
    np.testing.assert_allclose(p.getAABB(body), p.getAABB(whole), atol=5e-3)


def test_decomposition_says_what_it_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = [str(tmp_path / name) for name in ("pieces.obj", "log.txt")]
    with pytest.raises(p.error, match=r"nowhere\.obj"):
        p.vhacd("nowhere.obj", *names)
    monkeypatch.setitem(sys.modules, "coacd", None)
    with pytest.raises(p.error, match=r"pip install 'carom\[decompose\]'"):
        p.vhacd(str(MESHES / "two_boxes.obj"), *names)
