"""Changes are made by one call: as a whole, or not at all."""

from __future__ import annotations

import gc
import sys
from ctypes import addressof, c_int32
from typing import Any

import numpy as np
import pytest

from carom.layouts.contacts import Shapes
from carom.native import change as changes
from carom.native.change import Change, packed_block
from carom.native.tables import ArrayTable


class Plain:
    """An object whose attributes are in its dictionary."""

    def __init__(self) -> None:
        self.number = 1
        self.other = "old"


class Slotted:
    """An object whose attributes are in slots."""

    __slots__ = ("empty", "number")

    def __init__(self) -> None:
        self.number = 1


class Closed(Plain):
    """An object with a function for setting attributes, which a change does not call."""

    def __setattr__(self, name: str, value: object) -> None:
        if "_closed" in self.__dict__:
            raise AttributeError(name)
        object.__setattr__(self, name, value)


class Watched:
    """A value that looks at the world when it is dropped."""

    def __init__(self, look: Any) -> None:
        self._look = look

    def __del__(self) -> None:
        self._look()


@pytest.fixture(params=["native", "Python"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    if request.param == "Python":
        monkeypatch.setattr(changes._Maker, "make", staticmethod(changes._make))
    elif changes._commit() is None:
        pytest.skip("Python makes changes here")
    return request.param


@pytest.mark.usefixtures("way")
def test_a_change_is_made_by_commit_and_not_before() -> None:
    plain, slotted, closed = Plain(), Slotted(), Closed()
    closed.__dict__["_closed"] = True
    items: dict[Any, Any] = {"a": 1, "b": 2}
    content = {1: "one", 2: "two"}
    numbers = [1, 2]
    array, table = np.zeros((3, 4)), np.zeros(5, dtype=np.int32)
    change = Change()
    change.set(plain, "number", 2)
    change.set(plain, "number", 3)
    change.set(slotted, "number", 4)
    change.set(slotted, "empty", 5)
    change.set(closed, "other", "new")
    change.put(items, "a", 10)
    change.put_all(items, {"c": 3, "d": 4})
    change.drop(items, "b")
    change.drop(items, "not there")
    change.refill(content, {2: "two", 3: "three"})
    change.extend(numbers, [3])
    change.extend(numbers, [4, 5])
    change.write(array[1:, 2], [7.0, 8.0])
    change.write(array[0], 1.0)
    change.write(array[1:, :2], [[1, 2], [3, 4]])
    change.write(table[2:4], [9, 10])
    change.write(table[:0], [])
    assert change.get(plain, "number") == 3
    assert change.get(plain, "other") == "old"
    assert (plain.number, slotted.number, closed.other) == (1, 1, "old")
    assert items == {"a": 1, "b": 2}
    assert content == {1: "one", 2: "two"}
    assert numbers == [1, 2]
    assert not array.any()
    change.commit()
    assert (plain.number, slotted.number, slotted.empty, closed.other) == (3, 4, 5, "new")
    assert items == {"a": 10, "c": 3, "d": 4}
    assert list(content.items()) == [(2, "two"), (3, "three")]
    assert numbers == [1, 2, 3, 4, 5]
    assert array.tolist() == [[1, 1, 1, 1], [1, 2, 7, 0], [3, 4, 8, 0]]
    assert table.tolist() == [0, 0, 9, 10, 0]


@pytest.mark.usefixtures("way")
def test_several_attributes_join_those_noted_before() -> None:
    plain = Plain()
    change = Change()
    change.set_all(plain, number=2, other="new")
    change.set_all(plain, number=3)
    change.set(plain, "added", 4)
    assert [change.get(plain, name) for name in ("number", "other", "added")] == [3, "new", 4]
    change.commit()
    assert vars(plain) == {"number": 3, "other": "new", "added": 4}


@pytest.mark.usefixtures("way")
def test_arrays_of_any_shape_and_stride_are_written() -> None:
    whole = np.zeros((3, 4, 5, 2))
    expected = whole.copy()
    parts = [np.s_[:, 1], np.s_[1, :, 2], np.s_[::2, 1:3, 1::2], np.s_[0, 0, 0, 0:0], np.s_[2, ::-1, 4, 1:]]
    change = Change()
    for number, part in enumerate(parts, start=1):
        values = number + np.arange(expected[part].size).reshape(expected[part].shape) / 100
        change.write(whole[part], values, lasting=number % 2 == 0)
        expected[part] = values
    one = np.zeros(())
    change.write(one, 3.0)
    change.commit()
    assert np.array_equal(whole, expected)
    assert one == 3.0


@pytest.mark.usefixtures("way")
def test_nothing_is_changed_if_there_are_too_few_or_too_many_numbers() -> None:
    plain, numbers, integers = Plain(), np.zeros(4), np.zeros(4, dtype=np.int32)
    for count, target in ((3, numbers), (5, numbers), (2, integers[:1]), (4, integers)):
        change = Change()
        change.set(plain, "number", 2)
        change.write(numbers[:1], 1.0)
        change.write_numbers(target, [7.0] * count)
        with pytest.raises(ValueError, match="too few or too many numbers"):
            change.commit()
        assert plain.number == 1
        assert not numbers.any()
        assert not integers.any()


@pytest.mark.parametrize(
    "call",
    [
        lambda body: body.set_inertial_pose((1.0, 2.0), (0.0, 0.0, 0.0, 1.0)),
        lambda body: body.set_inertial_pose((1.0, 2.0, 3.0, 4.0), (0.0, 0.0, 0.0, 1.0)),
        lambda body: body.set_base_velocity((1.0, 2.0), (3.0, 4.0, 5.0, 6.0)),
        lambda body: body.set_joint_state(2, (0.1, 0.2), None),
        lambda body: body.set_joint_state(2, (), (0.1,)),
        lambda body: body.set_joint_state(2, None, ()),
        lambda body: body.set_joint_states([(2, (0.1, 0.2), None), (3, (), None)]),
    ],
)
def test_setters_of_a_body_refuse_too_few_or_too_many_numbers(call: Any) -> None:
    import carom

    world = carom.World()
    body = world.load_urdf("r2d2.urdf", (0.0, 0.0, 1.0), as_pybullet=True)
    before = world.position.tobytes(), world.velocity.tobytes()
    with pytest.raises(ValueError, match=r"too many|not enough|numbers"):
        call(body)
    assert (world.position.tobytes(), world.velocity.tobytes()) == before


def test_nothing_is_changed_if_an_array_cannot_be_written() -> None:
    if changes._commit() is None:
        pytest.skip("Python makes changes here")
    plain, array, fixed = Plain(), np.zeros(2), np.zeros(2)
    fixed.flags.writeable = False
    change = Change()
    change.set(plain, "number", 2)
    change.write(array, 1.0)
    change.write(fixed, 1.0)
    with pytest.raises(ValueError, match="read-only"):
        change.commit()
    assert plain.number == 1
    assert not array.any()
    assert not fixed.any()


def test_old_values_are_dropped_with_the_change(way: str) -> None:
    dropped: list[int] = []
    plain, items = Plain(), {"a": Watched(lambda: dropped.append(2))}
    plain.other = Watched(lambda: dropped.append(1))  # type: ignore[assignment]
    change = Change()
    change.set(plain, "other", "new")
    change.drop(items, "a")
    change.commit()
    if way == "native":
        assert not dropped
    del change
    assert sorted(dropped) == [1, 2]


@pytest.mark.usefixtures("way")
def test_rows_are_taken_out_before_memory_is_written() -> None:
    table = ArrayTable(Shapes, references={"shape_link": "link"})
    numpy = table.numpy
    numpy["shape_link"][:4] = [0, 1, 2, 3]
    numpy["shape_ccd_radius"][:4] = [0.0, 1.0, 2.0, 3.0]
    change = Change()
    table.cut(change, {"shape": 1, "link": 1}, {"shape": 1, "link": 1}, {"shape": 4, "link": 4})
    change.write(numpy["shape_ccd_radius"][:1], 5.0)
    assert numpy["shape_link"][:4].tolist() == [0, 1, 2, 3]
    change.commit()
    assert numpy["shape_link"][:4].tolist() == [0, 1, 2, 0]
    assert numpy["shape_ccd_radius"][:4].tolist() == [5.0, 2.0, 3.0, 0.0]


def test_nobody_sees_half_a_change(way: str) -> None:
    seen: list[tuple[Any, ...]] = []
    first, second, items, array = Plain(), Plain(), {"key": 1}, np.zeros(1)

    def look() -> None:
        seen.append((first.number, second.number, items["key"], array[0]))

    first.other = Watched(look)  # type: ignore[assignment]
    change = Change()
    change.set(first, "number", 2)
    change.set(first, "other", "new")
    change.set(second, "number", 2)
    change.put(items, "key", 2)
    change.write(array, 2.0)
    # Trace functions are asked at every line of the preparation and after.
    before = sys.gettrace()

    def trace(*_: object) -> Any:
        look()
        return trace

    if way == "native":
        sys.settrace(trace)
    try:
        change.commit()
    finally:
        sys.settrace(before)
    gc.collect()
    assert seen[-1] == (2, 2, 2, 2.0)
    if way == "native":
        assert set(seen) == {(1, 1, 1, 0.0), (2, 2, 2, 2.0)}


def test_nothing_is_changed_if_a_part_fails() -> None:
    if changes._commit() is None:
        pytest.skip("Python makes changes here")
    first, slotted = Plain(), Slotted()
    items, content, numbers, array = {"a": 1}, {1: "one", 2: "two"}, [1], np.zeros(1)
    change = Change()
    change.set(first, "number", 2)
    change.set(first, "new", 2)
    change.put(items, "a", 2)
    change.put(items, "b", 2)
    change.drop(items, "a")
    change.refill(content, {3: "three"})
    change.extend(numbers, [2])
    change.write(array, 2.0)
    # No list: the last of all changes of objects fails.
    change.extend(slotted, [1])  # type: ignore[arg-type]
    with pytest.raises(SystemError):
        change.commit()
    assert vars(first) == {"number": 1, "other": "old"}
    assert items == {"a": 1}
    assert list(content.items()) == [(1, "one"), (2, "two")]
    assert numbers == [1]
    assert not array.any()


def test_an_attribute_that_does_not_exist_undoes_what_was_before() -> None:
    if changes._commit() is None:
        pytest.skip("Python makes changes here")
    slotted, plain = Slotted(), Plain()
    change = Change()
    change.set(slotted, "empty", 1)
    change.set(plain, "number", 2)
    change.set(slotted, "unknown", 1)
    with pytest.raises(AttributeError):
        change.commit()
    assert not hasattr(slotted, "empty")
    assert plain.number == 1


@pytest.mark.usefixtures("way")
def test_an_array_that_grows_keeps_its_rows() -> None:
    table = ArrayTable(Shapes)
    table.numpy["shape_ccd_radius"][:3] = [1.0, 2.0, 3.0]
    replacements, capacity = table.replacements, table.capacity["shape"]
    assert table.reserve({"shape": capacity + 1})
    assert table.capacity["shape"] > capacity
    assert table.replacements == replacements + 1
    assert table.numpy["shape_ccd_radius"][:3].tolist() == [1.0, 2.0, 3.0]
    assert len(table.numpy["shape_ccd_radius"]) == table.capacity["shape"]


def test_a_kernel_runs_after_memory_is_written(way: str) -> None:
    import carom

    world = carom.World()
    body = world.load_urdf("cube_small.urdf", (0.0, 0.0, 1.0))
    launch = world.prepare_poses()
    change = Change()
    change.write(world.position[2:3], 5.0)
    change.run(launch.addresses(), body.rows.tree, launch)
    assert world.link_pose[0, 2] == 1.0
    change.commit()
    assert world.link_pose[0, 2] == 5.0
    assert way


def test_blocks_of_memory_can_be_made_beforehand() -> None:
    source, target = c_int32(7), c_int32(0)
    change = Change()
    change.copy_blocks(packed_block(addressof(source), addressof(target), 4), (source, target))
    change.commit()
    assert target.value == 7


@pytest.mark.usefixtures("way")
def test_copies_of_arrays_are_written_back() -> None:
    arrays = {"one": np.zeros((2, 3)), "other": np.arange(4.0)[::2]}
    change = Change()
    copies = change.arrays(arrays)
    assert change.arrays(arrays) is copies
    copies["one"][1] = 2.0
    copies["one"][0, 1] = 3.0
    copies["other"][1] = 5.0
    assert not arrays["one"].any()
    assert arrays["other"].tolist() == [0.0, 2.0]
    change.commit()
    assert arrays["one"].tolist() == [[0.0, 3.0, 0.0], [2.0, 2.0, 2.0]]
    assert arrays["other"].tolist() == [0.0, 5.0]


def test_what_is_noted_of_dictionaries_can_be_read() -> None:
    items, others = {1: "one", 2: "two"}, {"a": 1}
    change = Change()
    assert change.content(items) is items
    change.put(items, 3, "three")
    change.drop(items, 1)
    change.refill(others, {"b": 2})
    assert change.content(items) == {2: "two", 3: "three"}
    assert change.content(others) == {"b": 2}


def test_tables_make_room_before_a_change_and_tell_of_it() -> None:
    table, told = ArrayTable(Shapes), []
    before = table.numpy["shape_ccd_radius"]
    change = Change(told.append)
    change.make_room([table], {"shape": table.capacity["shape"]})
    assert not told
    change.make_room([table], {"shape": table.capacity["shape"] + 1})
    assert len(told) == 1
    assert len(table.numpy["shape_ccd_radius"]) > len(before)
