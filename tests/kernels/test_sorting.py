"""Sorts of shapes, pairs and manifolds by themselves, against NumPy's."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false, reportArgumentType=false

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.contact.hierarchy import sort_by_code
from carom.kernels.contact.neighbour_list import MANY_OF_ONE, sort_list
from carom.kernels.solver.island_sort import sort_by_island
from carom.kernels.structs import PairRows, Pairs, Settings
from carom.kernels.types import Index2, Int32, kernel
from carom.layouts.contacts import COLUMNS, LISTED, RADIX

codes = st.lists(st.one_of(st.integers(0, 3), st.integers(0, 2**31 - 1)), max_size=300)


@kernel
def sort_by_code_kernel(pairs: Pairs, count: Int32):
    """Sort shapes."""
    sort_by_code(pairs, 0, count)


@kernel
def sort_list_kernel(settings: Settings, pairs: Pairs):
    """Sort pairs of shapes."""
    sort_list(settings, pairs, 0)


@kernel
def sort_by_island_kernel(pair_rows: PairRows, count: Int32):
    """Sort manifolds."""
    sort_by_island(pair_rows, 0, count)


def integers(values: Any) -> Any:
    """Numbers of the only world."""
    return wp.array(np.asarray(values, dtype=np.int32).reshape(1, -1), dtype=Int32, device="cpu")


@settings(max_examples=cases(200), deadline=None)
@given(codes, st.randoms(use_true_random=False))
def test_shapes_are_sorted_by_code(values: list[int], random: Any) -> None:
    # Some shapes are not sorted: those behind.
    order = list(range(len(values)))
    random.shuffle(order)
    order = sorted(order[: len(order) - 2]) + order[len(order) - 2 :]
    count = max(0, len(order) - 2)
    pairs = Pairs()
    pairs.shape_code = integers([*values, 0])
    pairs.shape_order = integers([*order, 0])
    pairs.shape_sorted = integers([0] * (len(values) + 1))
    pairs.bucket_end = integers([0] * RADIX)
    wp.launch(sort_by_code_kernel, dim=1, inputs=[pairs, count], device="cpu")
    chosen = np.array(order[:count], dtype=int)
    keys = np.array(values, dtype=int)[chosen]
    # Equal ones stay in their order, which is that of shapes.
    expected = [*chosen[np.argsort(keys, kind="stable")], *order[count:]]
    np.testing.assert_array_equal(pairs.shape_order.numpy()[0, : len(order)], expected)


def check_sorted_list(found: set[tuple[int, int]], shapes: int, random: Any) -> None:
    """Sort pairs of shapes from an order by chance, and compare."""
    rows = sorted(found)
    random.shuffle(rows)
    room = len(rows) + 5
    pairs = Pairs()
    filled = np.zeros((1, room, 2), dtype=np.int32)
    filled[0, : len(rows)] = np.array(rows).reshape(-1, 2)
    counts = np.zeros((1, COLUMNS), dtype=np.int32)
    counts[0, LISTED] = len(rows)
    pairs.listed_found = wp.array(filled, dtype=Index2, device="cpu")
    pairs.listed_shapes = wp.zeros((1, room), dtype=Index2, device="cpu")
    pairs.shape_pair_end = integers([0] * shapes)
    pairs.count_pairs = wp.array(counts, dtype=Int32, device="cpu")
    setting = Settings()
    setting.shape_count = shapes
    wp.launch(sort_list_kernel, dim=1, inputs=[setting, pairs], device="cpu")
    kept = pairs.listed_shapes.numpy()[0]
    assert [tuple(row) for row in kept[: len(rows)].tolist()] == sorted(rows)
    assert not kept[len(rows) :].any()
    # Where the pairs of each first shape end.
    ends = np.searchsorted([a for a, _ in sorted(rows)], range(shapes), side="right")
    np.testing.assert_array_equal(pairs.shape_pair_end.numpy()[0], ends)


@settings(max_examples=cases(200), deadline=None)
@given(st.sets(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=80), st.randoms())
def test_pairs_are_sorted_by_first_then_by_second_shape(found: set[tuple[int, int]], random: Any) -> None:
    check_sorted_list(found, 13, random)


@settings(max_examples=cases(50), deadline=None)
@given(
    st.sets(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=80),
    st.integers(0, 12),
    st.integers(MANY_OF_ONE - 2, MANY_OF_ONE + 90),
    st.randoms(),
)
def test_pairs_of_a_floor_are_sorted_as_well(
    found: set[tuple[int, int]], floor: int, meeting: int, random: Any
) -> None:
    check_sorted_list(found | {(floor, shape) for shape in range(meeting)}, MANY_OF_ONE + 90, random)


def quicksort(items: list[tuple[int, int]], low: int, high: int) -> None:
    """Hoare's quicksort around the middle element, as textbooks have it; not stable."""
    if low >= high:
        return
    i, j, pivot = low, high, items[(low + high) // 2][0]
    while i <= j:
        while items[i][0] < pivot:
            i += 1
        while pivot < items[j][0]:
            j -= 1
        if i <= j:
            items[i], items[j] = items[j], items[i]
            i, j = i + 1, j - 1
    quicksort(items, low, j)
    quicksort(items, i, high)


@settings(max_examples=cases(200), deadline=None)
@given(st.lists(st.integers(0, 20), max_size=300))
def test_manifolds_are_sorted_by_island_in_the_order_of_quicksort(islands: list[int]) -> None:
    rows = PairRows()
    rows.order_island = integers([*islands, 0])
    rows.order_row = integers(range(100, 101 + len(islands)))
    wp.launch(sort_by_island_kernel, dim=1, inputs=[rows, len(islands)], device="cpu")
    expected = [(island, 100 + place) for place, island in enumerate(islands)]
    quicksort(expected, 0, len(expected) - 1)
    sorted_islands = rows.order_island.numpy()[0, :-1].tolist()
    assert sorted_islands == sorted(islands)
    assert list(zip(sorted_islands, rows.order_row.numpy()[0, :-1].tolist(), strict=True)) == expected
