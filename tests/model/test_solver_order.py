"""Properties of the order in which the solver visits constraints."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.changes import at_once

from carom.model.solver_order import IslandTags, batch_islands, quicksort_order, remove_unordered


@given(st.lists(st.integers(-5, 5), max_size=60))
def test_quicksort_order_is_a_permutation_that_sorts(keys):
    order = quicksort_order(keys)
    assert sorted(order) == list(range(len(keys)))
    assert [keys[i] for i in order] == sorted(keys)


@pytest.mark.parametrize(
    ("keys", "order"),
    [
        ([], []),
        ([7], [0]),
        ([0, 0], [1, 0]),
        ([0, 0, 0], [2, 1, 0]),
        ([0, 0, 0, 0], [2, 3, 0, 1]),
        ([3, 1, 2], [1, 2, 0]),
    ],
)
def test_quicksort_order_moves_equal_keys_in_a_fixed_way(keys, order):
    assert quicksort_order(keys) == order


def sorted_as_bullet_does(items: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Quicksort of (key, index) by key: partition by exchange around the middle key, then both parts."""
    if len(items) < 2:
        return items
    items, pivot = list(items), items[(len(items) - 1) // 2][0]
    left, right = 0, len(items) - 1
    while left <= right:
        left = next(i for i in range(left, len(items)) if items[i][0] >= pivot)
        right = next(i for i in range(right, -1, -1) if items[i][0] <= pivot)
        if left <= right:
            items[left], items[right] = items[right], items[left]
            left, right = left + 1, right - 1
    between = items[right + 1 : left]
    return [*sorted_as_bullet_does(items[: right + 1]), *between, *sorted_as_bullet_does(items[left:])]


@given(st.lists(st.integers(-3, 3), max_size=40))
def test_quicksort_order_leaves_equal_keys_where_the_recursion_does(keys):
    expected = sorted_as_bullet_does([(key, index) for index, key in enumerate(keys)])
    assert quicksort_order(keys) == [index for _, index in expected]


def test_quicksort_order_of_very_many_keys_needs_no_recursion():
    keys = [n % 7 for n in range(20_000)]
    assert [keys[i] for i in quicksort_order(keys)] == sorted(keys)


@given(st.lists(st.integers(0, 8), max_size=40).map(sorted), st.integers(0, 10))
def test_batches_join_whole_islands_until_they_are_large_enough(tags, minimum_size):
    runs = batch_islands(tags, minimum_size)
    covered = [index for first, length in runs for index in range(first, first + length)]
    assert covered == list(range(len(tags)))
    for first, length in runs:
        end = first + length
        assert length > 0
        assert end == len(tags) or tags[end] != tags[end - 1]
        if end < len(tags):
            assert length > minimum_size
        # Without its last island it would have been too small.
        before_last = tags[first:end].index(tags[end - 1])
        assert before_last <= minimum_size


def test_remove_unordered_puts_the_last_in_the_gap():
    items = list("abcde")
    remove_unordered(items, "b")
    assert items == list("aecd")
    remove_unordered(items, "d")
    assert items == list("aec")
    with pytest.raises(ValueError, match="not in list"):
        remove_unordered(items, "z")


class ListOfObjects:
    """What `IslandTags` stands for, step by step: a list where a removed object is replaced by the last."""

    def __init__(self) -> None:
        self.objects: list[tuple[int, int]] = []
        self.moves: dict[tuple[int, int], bool] = {}

    def add(self, body: int, moving: list[bool]) -> None:
        for link, moves in enumerate(moving):
            self.objects.append((body, link))
            self.moves[body, link] = moves

    def take_out(self, key: tuple[int, int]) -> None:
        at = self.objects.index(key)
        last = self.objects.pop()
        if last != key:
            self.objects[at] = last

    def remove(self, body: int, link_count: int) -> None:
        for link in range(link_count):
            self.take_out((body, link))

    def move_base_to_end(self, body: int, moving: list[bool]) -> None:
        self.take_out((body, 0))
        self.objects.append((body, 0))
        self.moves.update({(body, link): moves for link, moves in enumerate(moving)})

    def tags(self) -> dict[int, int]:
        numbers = {}
        moving = [key for key in self.objects if self.moves[key]]
        for body in {body for body, _ in moving}:
            last_link = max(link for owner, link in moving if owner == body)
            numbers[body] = moving.index((body, last_link))
        return numbers


@given(st.data())
def test_island_tags_follow_the_list_of_objects(data):
    tags, expected = IslandTags(), ListOfObjects()
    bodies: dict[int, int] = {}
    for number in range(data.draw(st.integers(1, 12))):
        action = data.draw(st.sampled_from(["add", "add", "remove", "free"] if bodies else ["add"]))
        if action == "add":
            moving = data.draw(st.lists(st.booleans(), min_size=1, max_size=4))
            bodies[number] = len(moving)
            at_once(tags.add, number, moving)
            expected.add(number, moving)
        else:
            body = data.draw(st.sampled_from(sorted(bodies)))
            if action == "remove":
                count = bodies.pop(body)
                at_once(tags.remove, body, count)
                expected.remove(body, count)
            else:
                moving = data.draw(st.lists(st.booleans(), min_size=bodies[body], max_size=bodies[body]))
                at_once(tags.move_base_to_end, body, moving)
                expected.move_base_to_end(body, moving)
        assert tags.tags() == expected.tags()


def test_a_body_is_named_after_its_last_moving_link():
    tags = IslandTags()
    at_once(tags.add, "fixed arm", [False, True, True])
    at_once(tags.add, "table", [False])
    at_once(tags.add, "free arm", [True, True])
    assert tags.tags() == {"fixed arm": 1, "free arm": 3}
    at_once(tags.remove, "fixed arm", 3)
    assert set(tags.tags()) == {"free arm"}
