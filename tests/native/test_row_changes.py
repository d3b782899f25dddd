"""Rows that are put into all arrays of a table, and taken out, by one call."""

import numpy as np
import pytest
from tests.changes import at_once

from carom.layouts.model import Model, State
from carom.native.tables import ArrayTable

REFERENCES = {"link_parent": "link", "link_first_dof": "dof", "tree_first_link": "link"}


def table_of_tree(links: int, dofs: int) -> ArrayTable:
    """A table with one tree of these links and dofs, its numbers all different."""
    table = ArrayTable(Model, references=REFERENCES)
    numpy = table.numpy
    numpy["tree_first_link"][0] = 0
    numpy["tree_sleep_threshold"][0] = 0.25
    numpy["link_parent"][:links] = np.arange(links) - 1
    numpy["link_first_dof"][:links] = np.arange(links) % dofs
    numpy["link_axis"][:links] = np.arange(3.0 * links).reshape(links, 3)
    numpy["link_mass"][0, :links] = np.arange(links) + 0.5
    numpy["dof_damping"][0, :dofs] = np.arange(dofs) + 0.125
    return table


def test_rows_are_put_behind_others_and_their_numbers_follow() -> None:
    count = {"tree": 1, "link": 4, "dof": 3}
    alone = table_of_tree(4, 3)
    rows = alone.row_changes.first_rows(count)
    table = ArrayTable(Model, references=REFERENCES)
    table.row_changes.put(rows, {}, table.row_changes.packed(count))
    for name, array in alone.numpy.items():
        np.testing.assert_array_equal(table.numpy[name], array, err_msg=name)
    table.row_changes.put(rows, count, table.row_changes.packed(count))
    numpy = table.numpy
    assert numpy["tree_first_link"][:3].tolist() == [0, 4, 0]
    assert numpy["tree_sleep_threshold"][:3].tolist() == [0.25, 0.25, 0.0]
    assert numpy["link_parent"][:9].tolist() == [-1, 0, 1, 2, -1, 4, 5, 6, 0]
    assert numpy["link_first_dof"][:9].tolist() == [0, 1, 2, 0, 3, 4, 5, 3, 0]
    assert numpy["link_mass"][0, :9].tolist() == [0.5, 1.5, 2.5, 3.5, 0.5, 1.5, 2.5, 3.5, 0.0]
    assert numpy["dof_damping"][0, :7].tolist() == [0.125, 1.125, 2.125] * 2 + [0.0]
    np.testing.assert_array_equal(numpy["link_axis"][4:8], alone.numpy["link_axis"][:4])


def test_numbers_of_later_rows_change_when_rows_are_taken_out() -> None:
    count = {"tree": 1, "link": 2, "dof": 2}
    rows = table_of_tree(2, 2).row_changes.first_rows(count)
    table = ArrayTable(Model, references=REFERENCES)
    used = {axis: 3 * number for axis, number in count.items()}
    for place in range(3):
        first = {axis: place * number for axis, number in count.items()}
        table.row_changes.put(rows, first, table.row_changes.packed(count))
    at_once(table.cut, count, count, used)
    assert table.numpy["tree_first_link"][:3].tolist() == [0, 2, 0]
    assert table.numpy["link_parent"][:6].tolist() == [-1, 0, -1, 2, 0, 0]
    assert table.numpy["link_first_dof"][:6].tolist() == [0, 1, 2, 3, 0, 0]


def test_numbers_of_rows_elsewhere_change_as_well() -> None:
    # Trees stay; they refer to links that move.
    table = table_of_tree(6, 1)
    table.numpy["tree_first_link"][:3] = [0, 2, 4]
    at_once(table.cut, {"link": 2}, {"link": 2}, {"tree": 3, "link": 6})
    assert table.numpy["tree_first_link"][:3].tolist() == [0, 2, 2]


def test_every_world_gets_the_rows() -> None:
    table, other = ArrayTable(State, 3), ArrayTable(State)
    other.numpy["link_pose"][0, :2] = np.arange(14.0).reshape(2, 7)
    rows = other.row_changes.first_rows({"link": 2})
    table.row_changes.put(rows, {"link": 5}, table.row_changes.packed({"link": 2}))
    for world in table.numpy["link_pose"]:
        np.testing.assert_array_equal(world[5:7], other.numpy["link_pose"][0, :2])
        assert not world[:5].any()
        assert not world[7:].any()


@pytest.mark.parametrize("change", ["reserve", "spread", "copy"])
def test_arrays_that_were_replaced_are_found(change: str) -> None:
    table = table_of_tree(4, 3)
    before = table.row_changes
    if change == "reserve":
        table.reserve({"link": 100})
    elif change == "spread":
        table.spread("link_mass", 2)
    else:
        table = table.copy()
    assert table.row_changes is not before
    at_once(table.cut, {}, {"link": 1}, {"link": 4, "tree": 1, "dof": 3})
    assert (table.numpy["link_mass"][:, :4] == [1.5, 2.5, 3.5, 0.0]).all()
