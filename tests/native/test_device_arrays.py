"""Arrays on a device, here Warp's processor, are indexed and combined as NumPy's; nothing is compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytest.importorskip("warp", reason="has the memory")

from carom import World
from carom.gpu import arithmetic, array
from carom.gpu.array import DeviceArray
from carom.gpu.memory import CountingDevice
from carom.gpu.workspace import DeviceWorkspace
from carom.kernels.arrays.arithmetic import ADD, DIVIDE, GREATEST, LEAST, MULTIPLY, SUBTRACT

OPERATIONS: dict[int, Callable[[Any, Any], Any]] = {
    ADD: np.add, SUBTRACT: np.subtract, MULTIPLY: np.multiply, DIVIDE: np.divide,
    LEAST: np.minimum, GREATEST: np.maximum,
}  # fmt: skip
NUMBERS = np.arange(1.0, 25.0).reshape(2, 3, 4)


@pytest.fixture(autouse=True)
def combined_by_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the kernel does, which `tests/gpu` compiles."""

    def combine(operation: int, first: DeviceArray, second: DeviceArray) -> DeviceArray:
        return here(OPERATIONS[operation](first.numpy(), second.numpy()))

    monkeypatch.setattr(array, "combine", combine)
    monkeypatch.setattr(arithmetic, "combine", combine)


def here(values: Any) -> DeviceArray:
    values = np.asarray(values)
    made = DeviceArray.zeros(values.shape, values.dtype, "cpu")
    made[...] = values
    return made


@pytest.mark.parametrize(
    "key",
    [
        *(1, -1, (0, 2), (1, 2, 3), slice(None), slice(1, None), (slice(None), slice(None, None, 2))),
        *((..., 1), (0, ..., slice(1, 3)), [1, 0], [-1], ([True, False],), (slice(None), [2, 0, 2])),
        *((slice(1, 2), slice(None), [0, -1]), (..., np.array([False, True, True, False])), slice(2, 2), []),
    ],
    ids=str,
)
def test_parts_are_those_of_numpy(key: Any) -> None:
    device, host = here(NUMBERS), NUMBERS.copy()
    found, expected = device[key], host[key]
    assert (found.shape, found.ndim, found.size, found.nbytes) == (
        *(expected.shape, expected.ndim, expected.size, expected.nbytes),
    )
    np.testing.assert_array_equal(found.numpy(), expected)
    device[key] = host[key] = -7.0
    np.testing.assert_array_equal(device.numpy(), host)


def test_what_is_no_index_is_refused() -> None:
    device = here(NUMBERS)
    with pytest.raises(IndexError, match="index 2 is out of range for an axis of 2"):
        device[2]
    with pytest.raises(IndexError, match="out of range for an axis of 2"):
        device[[0, -3]]
    with pytest.raises(IndexError, match="too many indices for an array of 3 axes"):
        device[0, 0, 0, 0]
    with pytest.raises(IndexError, match="only one axis"):
        device[[0], [1]]
    with pytest.raises(IndexError, match=r"mask of shape \(3,\) does not fit an axis of 2"):
        device[[True, False, True]]


def test_views_share_memory_and_other_arrays_are_copied_to_where_they_go() -> None:
    device = here(NUMBERS)
    part = device[:, 1]
    part[...] = 0.0
    assert not device.numpy()[:, 1].any()
    # Of the same shape and strides, but elsewhere.
    device[:, 0] = device[:, 2]
    np.testing.assert_array_equal(device.numpy()[:, 0], NUMBERS[:, 2])
    # What is assigned to itself stays.
    device[...] = device
    device[0] += 1.0
    np.testing.assert_array_equal(device.numpy()[0, 2], NUMBERS[0, 2] + 1.0)


def test_fields_of_structs_are_views() -> None:
    kind = np.dtype([("count", np.int32), ("place", np.float64, (3,))], align=True)
    records = DeviceArray.zeros((2,), kind, "cpu")
    records["place"][1] = [1.0, 2.0, 3.0]
    records["count"][...] = [4, 5]
    assert records["place"].numpy().tolist() == [[0.0] * 3, [1.0, 2.0, 3.0]]
    assert records["count"].numpy().tolist() == [4, 5]


def test_numbers_are_combined_as_by_numpy() -> None:
    first, second = NUMBERS, NUMBERS[::-1] + 0.5
    device = here(first)
    for found, expected in (
        (device + second, first + second), (1.0 + device, 1.0 + first), (device - second, first - second),
        (1.0 - device, 1.0 - first), (device * 2, first * 2), (3 * device, 3 * first),
        (device / second, first / second),
    ):  # fmt: skip
        np.testing.assert_array_equal(found.numpy(), expected)
    a, b = NUMBERS.reshape(-1, 3), NUMBERS[::-1].reshape(-1, 3) ** 2
    numpy: Any = np
    np.testing.assert_allclose(numpy.cross(here(a), b).numpy(), np.cross(a, b), rtol=1e-14)
    np.testing.assert_array_equal(numpy.clip(here(a), 3.0, 7.0).numpy(), np.clip(a, 3.0, 7.0))
    joined = numpy.concatenate([here(a), here(b)], axis=-1).numpy()
    np.testing.assert_array_equal(joined, np.concatenate([a, b], axis=-1))


def test_shapes_are_those_of_numpy() -> None:
    device = here(NUMBERS)
    assert device.reshape(6, -1).shape == (6, 4)
    np.testing.assert_array_equal(device[:, ::2].reshape(-1).numpy(), NUMBERS[:, ::2].reshape(-1))
    np.testing.assert_array_equal(here([1.0, 2.0]).spread((3, 2)).numpy(), [[1.0, 2.0]] * 3)
    with pytest.raises(ValueError, match=r"shape \(2,\) does not broadcast to \(3,\)"):
        here([1.0, 2.0]).spread((3,))
    assert len(device) == 2
    assert (device == NUMBERS).all() and not (device < NUMBERS).any()


def test_arrays_that_are_only_counted_take_the_memory_of_an_entry() -> None:
    device = CountingDevice()
    counted = device.zeros((1000, 1000), np.dtype(np.float64))
    assert device.bytes == 8_000_000
    assert counted.shape == (1000, 1000) and counted.strides == (0, 0)
    counted[3, 4] = 2.0
    assert counted[0, 0] == 2.0


def load_cloth(world: World) -> None:
    world.load_cloth(size=(1.0, 1.0), cells=(2, 2))


def load_a_robot(world: World) -> None:
    world.load_urdf("r2d2.urdf")


def load_a_robot_on_a_floor(world: World) -> None:
    world.add_plane()
    load_a_robot(world)


@pytest.mark.parametrize(
    ("load", "pairs", "rows"),
    [(load_cloth, 1, 64), (load_a_robot, 1, 1), (load_a_robot_on_a_floor, 16, 64)],
)
def test_there_is_room_for_what_can_touch(load: Callable[[World], None], pairs: int, rows: int) -> None:
    world = World(contact="bullet")
    load(world)
    workspace = DeviceWorkspace(CountingDevice(), 3)
    workspace.fit(world.arrays, world.contact_arrays)
    assert workspace.pairs.capacity["pair"] == pairs
    assert workspace.pair_rows.capacity["row"] == rows
