"""Descriptions of bodies made from shapes are kept, and used again for the same arguments only."""

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import client_of
from pybullet._loading.kept_descriptions import key_of


@pytest.fixture
def world():
    p.connect(p.DIRECT)
    yield client_of(0).world
    p.disconnect()


def linked(shape: int, count: int = 3, **changes) -> int:
    arguments = {
        "baseMass": 1.0,
        "baseCollisionShapeIndex": shape,
        "linkMasses": [0.5] * count,
        "linkCollisionShapeIndices": [shape] * count,
        "linkVisualShapeIndices": [-1] * count,
        "linkPositions": [[0, 0, 0.3]] * count,
        "linkOrientations": [[0, 0, 0, 1]] * count,
        "linkInertialFramePositions": [[0, 0, 0]] * count,
        "linkInertialFrameOrientations": [[0, 0, 0, 1]] * count,
        "linkParentIndices": list(range(count)),
        "linkJointTypes": [p.JOINT_REVOLUTE] * count,
        "linkJointAxis": [[0, 1, 0]] * count,
    }
    return p.createMultiBody(**(arguments | changes))


def box(size: float = 0.1) -> int:
    return p.createCollisionShape(p.GEOM_BOX, halfExtents=[size] * 3)


def report(body: int) -> list:
    joints = [p.getJointInfo(body, joint) for joint in range(p.getNumJoints(body))]
    return [joints, *[p.getDynamicsInfo(body, link) for link in range(-1, len(joints))]]


def test_bodies_with_the_same_links_share_a_description(world):
    shape = box()
    bodies = [linked(shape) for _ in range(4)]
    specs = {id(world.bodies[body].spec) for body in bodies}
    assert len(specs) == 1
    assert all(report(body) == report(bodies[0]) for body in bodies[1:])
    other = linked(shape, linkMasses=[0.5, 0.5, 0.75])
    assert id(world.bodies[other].spec) not in specs
    assert p.getDynamicsInfo(other, 2)[0] == 0.75


def test_arrays_and_lists_with_the_same_numbers_move_alike(world):
    shape = box()
    as_lists = linked(shape)
    as_arrays = linked(shape, linkPositions=np.tile([0.0, 0.0, 0.3], (3, 1)), linkMasses=np.full(3, 0.5))
    assert report(as_arrays) == report(as_lists)


def test_a_removed_shape_whose_number_is_given_again_is_another_one(world):
    shape = box(0.1)
    linked(shape)
    first = linked(shape)
    client_of(0).shapes.collisions.remove(shape)
    assert box(0.2) == shape
    second = linked(shape)
    assert p.getDynamicsInfo(second, -1)[2][0] == pytest.approx(4 * p.getDynamicsInfo(first, -1)[2][0])


def test_what_was_right_before_does_not_hide_a_mistake(world):
    shape = box()
    linked(shape)
    with pytest.raises(p.error, match="own ancestor"):
        linked(shape, linkParentIndices=[0, 3, 2])
    with pytest.raises(p.error, match="at least 0"):
        linked(shape, linkMasses=[0.5, 0.5, -0.5])
    with pytest.raises(p.error, match="same size"):
        linked(shape, linkMasses=[0.5] * 2)


def test_missing_shapes_are_told_of_each_time(world, caplog):
    box()
    for _ in range(2):
        caplog.clear()
        linked(7)
        assert "there is no collision shape 7" in caplog.text


@pytest.mark.parametrize(
    ("one", "other"),
    [(0.0, -0.0), (1, 1.0), (1.0, np.nextafter(1.0, 2.0)), ([1, 2], (1, 2)), ([[1], [2]], [[1, 2]])],
)
def test_keys_tell_numbers_apart_to_the_last_bit(one, other):
    assert key_of((one,)) != key_of((other,))
    assert key_of((one,)) == key_of((one,)) is not None


def test_equal_arrays_have_equal_keys_whatever_their_memory():
    values = np.arange(6.0).reshape(3, 2)
    assert key_of((values,)) == key_of((np.asfortranarray(values),)) is not None
    assert key_of((values,)) != key_of((values.astype(np.int32),))
    assert key_of((np.float32(0.5),)) == key_of((np.float64(0.5),))
    row = [1.0, 2.0]
    assert key_of(([row, row],)) == key_of(([row, [1.0, 2.0]],))


def test_objects_of_the_user_have_no_key_and_none_of_their_code_runs():
    class Loud:
        def __reduce__(self):
            raise AssertionError

    looped: list = []
    looped.append(looped)
    assert key_of(([Loud()],)) is None
    assert key_of((looped,)) is None
