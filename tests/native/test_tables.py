"""Tables of arrays that grow."""

import contextlib
import ctypes
import itertools
from typing import Any

import numpy as np
import pytest
from tests.changes import at_once
from tests.interrupts.faults import Fault, Fuse

from carom.layouts.model import ENTRY_VIEWS, Model, Scratch, State
from carom.layouts.types import CACHE, PARAMETER, STATE, Rows, real, state, struct
from carom.native.tables import ArrayTable, array_view, fields_of, room_ahead


@pytest.fixture(params=[None, 1, 3], ids=["shared", "one world", "three worlds"])
def table(request) -> ArrayTable:
    return ArrayTable(Model) if request.param is None else ArrayTable(State, request.param)


def rows(table: ArrayTable, name: str) -> np.ndarray:
    """An array with its rows in front, whether or not it has a world axis."""
    array = table.numpy[name]
    return array if name in ("link_unit_axis", "dof_parent") else array.swapaxes(0, 1)


def test_fields_belong_to_the_axis_they_are_named_after():
    fields = fields_of(State)
    assert fields["link_pose"].axis == "link"
    assert fields["dof_motor"].axis == "dof"
    assert fields["link_pose"].shape == (7,)
    assert fields["dof_motor"].shape == (8,)
    assert fields["dof_velocity"].shape == ()
    assert fields["dof_velocity"].scalar == np.float64
    assert fields["tree_island"].scalar == np.int32


def test_fields_of_an_array_of_structs_are_arrays_of_their_own():
    link = fields_of(Model)["link"]
    assert (link.axis, link.shape) == ("link", ())
    assert link.scalar["joint_rotation"].base == np.float64
    numpy = ArrayTable(Model).numpy
    assert numpy["link_joint_type"].shape == (16,)
    assert numpy["link_joint_rotation"].shape == (16, 4)
    assert numpy["link_parent"].dtype == np.int32
    numpy["link_unit_axis"][3] = (1.0, 2.0, 3.0)
    assert numpy["link_unit_axis"][3].tolist() == [1.0, 2.0, 3.0]
    assert ArrayTable(Scratch, 2).numpy["link_rotation"].shape == (2, 16, 3, 3)


def test_a_first_question_that_is_interrupted_leaves_no_half_of_an_answer():
    last, whole = list(ArrayTable(Model).numpy)[-1], Fuse()
    whole.blow(lambda: ArrayTable(Model).field_of(last))
    for place in range(1, whole.count + 1, whole.count // 10):
        table = ArrayTable(Model)
        with contextlib.suppress(Fault):
            Fuse(place).blow(lambda table=table: table.field_of(last))
        assert table.field_of(last).axis


def test_arrays_start_zeroed_with_some_room(table):
    for array in table.numpy.values():
        assert not array.any()
    assert set(table.capacity.values()) == {16}


def test_reserving_what_there_is_changes_nothing(table):
    before = dict(table.numpy)
    assert table.reserve({"link": 16, "dof": 3, "no such axis": 99}) is False
    assert all(table.numpy[name] is array for name, array in before.items())


def test_growth_is_geometric_and_keeps_what_was_there(table):
    name = "link_unit_axis" if "link_unit_axis" in table.numpy else "link_pose"
    view = rows(table, name)
    view[:] = np.arange(16.0).reshape(16, *[1] * (view.ndim - 1))
    assert table.reserve({"link": 17}) is True
    assert table.capacity["link"] == 32
    assert table.capacity["dof"] == 16
    grown = rows(table, name)
    assert len(grown) == 32
    np.testing.assert_array_equal(grown[:16], view)
    assert not grown[16:].any()
    table.reserve({"link": 1000})
    assert table.capacity["link"] == 1000
    np.testing.assert_array_equal(rows(table, name)[:16], view)


def test_adding_rows_one_by_one_replaces_arrays_seldom():
    table = ArrayTable(Model)
    assert sum(table.reserve({"link": count}) for count in range(1, 2000)) == 7


@pytest.mark.parametrize(
    ("start", "count", "used"),
    [(0, 4, 16), (5, 3, 16), (13, 3, 16), (15, 1, 16), (0, 16, 16), (5, 3, 12), (9, 3, 12)],
)
def test_deleted_rows_close_up_and_leave_zeros(table, start, count, used):
    name = "link_unit_axis" if "link_unit_axis" in table.numpy else "link_twist"
    view = rows(table, name)
    view[:] = np.arange(1.0, 17.0).reshape(16, *[1] * (view.ndim - 1))
    other = rows(table, "dof_parent" if "dof_parent" in table.numpy else "dof_velocity")
    other[:] = 5
    kept = np.delete(view[:used], np.s_[start : start + count], axis=0)
    expected = np.concatenate([kept, 0 * view[:count], view[used:]])
    at_once(table.cut, {"link": start}, {"link": count}, {"link": used})
    np.testing.assert_array_equal(view, expected)
    assert (other == 5).all()


def shown(view, dtype) -> np.ndarray:
    """What a kernel sees of the first axes of an array, as an array over the same memory."""
    shape, strides = view.shape[: view.ndim], view.strides[: view.ndim]
    memory: Any = (
        ctypes.c_char * sum(n * step for n, step in zip(shape, strides, strict=True))
    ).from_address(view.data)
    return np.ndarray(shape, dtype, memory, strides=strides)


def test_structs_share_the_memory_of_the_arrays(table):
    struct = table.struct()
    for number, (name, array) in enumerate(table.numpy.items()):
        array.fill(number % 100)
        field, _, part = name.partition("_")
        whole = name in struct.fields
        view = getattr(struct, name if whole else field)
        assert view.data <= array.ctypes.data < view.data + view.shape[0] * max(view.strides[0], 1)
        assert view.strides[: view.ndim] == list(array.strides[: view.ndim]) or view.strides[0] == 0
        assert view.shape[: view.ndim] == list(array.shape[: view.ndim])
        assert not any((*view.shape[view.ndim :], *view.strides[view.ndim :]))
        assert whole or part in struct.fields[field].entry.fields


@pytest.mark.parametrize("declared", [Model, State])
def test_the_first_arrays_lie_in_one_block_of_memory(declared):
    table = ArrayTable(declared)
    arrays = [getattr(table.struct(), name) for name in table.struct().fields]
    starts = [view.data for view in arrays]
    assert all((start - starts[0]) % 64 == 0 for start in starts)
    spans = sorted((table._memory[name].ctypes.data, table._memory[name].nbytes) for name in table._memory)
    assert all(first + size <= after for (first, size), (after, _) in itertools.pairwise(spans))
    assert spans[-1][0] + spans[-1][1] - spans[0][0] < sum(size + 64 for _, size in spans)
    assert {view.data for view in arrays} == {start for start, _ in spans}


def test_tables_grow_again_only_when_there_are_several_times_as_many_rows():
    table, made = ArrayTable(Model), 0
    for count in range(1, 301):
        needed = {"link": count, "dof": 6 * count, "position": 7 * count}
        assert table.lacks(needed) == any(table.capacity[axis] < rows for axis, rows in needed.items())
        if table.lacks(needed):
            made += 1
            table.reserve(room_ahead(needed))
    assert made <= 5


def test_entry_views_show_blocks_column_by_column():
    table = ArrayTable(Scratch, 2, ENTRY_VIEWS)
    assert not set(ENTRY_VIEWS) & set(table.numpy)
    struct = table.struct()
    for name, source in ENTRY_VIEWS.items():
        blocks = table.numpy[source]
        blocks[:] = np.arange(blocks.size).reshape(blocks.shape)
        entries = getattr(struct, name)
        assert entries.data == blocks.ctypes.data
        np.testing.assert_array_equal(shown(entries, np.float64), blocks.reshape(2, -1))


def test_all_worlds_share_a_single_row_until_it_is_spread():
    table = ArrayTable(Model)
    table.numpy["link_mass"][:, 3] = 2.5
    shared = table.struct().link_mass
    assert shared.strides[0] == 0
    assert table.spread("link_mass", 4) is True
    assert table.spread("link_mass", 4) is False
    own = table.struct().link_mass
    assert own.strides[0] == own.shape[1] * 8
    np.testing.assert_array_equal(table.numpy["link_mass"][:, 3], 2.5)
    table.reserve({"link": 17})
    assert table.numpy["link_mass"].shape == (4, 32)
    assert table.numpy["link_inertia"].shape == (1, 32, 3)


def test_growth_that_fails_leaves_everything_as_it_was(monkeypatch):
    table = ArrayTable(Model)
    before = dict(table.numpy)
    allocate, made = ArrayTable._allocate, []

    def run_short(self, name, capacity):
        made.append(name)
        if len(made) > 2:
            raise MemoryError
        return allocate(self, name, capacity)

    monkeypatch.setattr(ArrayTable, "_allocate", run_short)
    with pytest.raises(MemoryError):
        table.reserve({"link": 1000})
    assert set(table.capacity.values()) == {16}
    assert all(table.numpy[name] is array for name, array in before.items())


def test_clear_sets_everything_to_zero(table):
    for array in table.numpy.values():
        array.fill(3)
    table.clear()
    assert not any(array.any() for array in table.numpy.values())


def test_bytes_of_a_field_follow_it_when_it_is_replaced():
    table = ArrayTable(Model)
    table.numpy["link_unit_axis"][0] = 2.5
    before = table.bytes_of("link")
    assert table.bytes_of("link") is before
    table.reserve({"link": 1000})
    after = table.bytes_of("link")
    assert len(after) > len(before)
    assert after[: len(before)] == before


def test_kernels_are_given_arrays_whose_rows_are_contiguous_only():
    entries = np.zeros((4, 6, 3))
    assert array_view(entries, 2).strides[:2] == [6 * 24, 24]
    assert array_view(entries[::2], 2).strides[0] == 2 * 6 * 24
    for array, axes in ((entries[:, ::2], 2), (entries[:, :, :2], 2), (entries[0, :, 0], 1)):
        with pytest.raises(ValueError, match="next to each other"):
            array_view(array, axes)


@pytest.mark.parametrize("first", [1, 3], ids=["in the middle", "at the end"])
def test_rows_that_are_removed_leave_zeros_in_every_world(first, table):
    arrays = {
        name: array.swapaxes(0, 1) if table.is_per_world(name) else array
        for name, array in table.numpy.items()
        if name.startswith("link_")
    }
    assert arrays
    for array in arrays.values():
        array[:] = 1
        for row in range(5):
            array[row] = row + 2
    before = {name: array.copy() for name, array in arrays.items()}
    at_once(table.cut, {"link": first}, {"link": 2}, {"link": 5})
    for name, array in arrays.items():
        kept = np.delete(before[name][:5], [first, first + 1], axis=0)
        assert np.array_equal(array[:3], kept), name
        assert not array[3:5].any(), name
        assert np.array_equal(array[5:], before[name][5:]), name


def test_fields_of_a_world_say_what_they_are_for() -> None:
    uses = {name: field.use for name, field in fields_of(State).items()}
    assert (uses["late_joint"].kind, uses["late_joint"].axis) == (STATE, "late")
    assert {name for name, use in uses.items() if use.kind == CACHE} == {
        *("status_entry", "batch_tree", "batch_constraint")
    }
    assert {name for name, use in uses.items() if use.joints} == {"dof_motor", "dof_pd"}
    assert {field.use.kind for field in fields_of(Model).values()} == {PARAMETER}
    table = ArrayTable(Model)
    assert table.axis_of("tree_first_link") == "tree"
    assert table.of_kind(PARAMETER).keys() == table.numpy.keys()
    assert not table.of_kind(STATE)


def test_a_struct_whose_fields_say_only_in_part_what_they_are_for_is_refused() -> None:
    class Mixed:
        position: Rows[real] = state("position")
        dof_rate: Rows[real]

    with pytest.raises(TypeError, match=r"Mixed\.dof_rate: say whether it is state, parameter or cache"):
        struct(Mixed)
