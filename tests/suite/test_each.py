"""One test for many values runs all of them, and lists those that fail."""

import pytest
from tests.each import each
from tests.rings import few


def test_all_values_run_and_those_that_fail_are_listed():
    seen = []

    @each("number", [1, 2, 3, 4], ids=lambda number: f"no {number}")
    def odd(number: int, folder: str) -> None:
        seen.append((number, folder))
        assert number % 2, "it is even"

    with pytest.raises(pytest.fail.Exception, match=r"2 of 4 fail") as failure:
        odd(folder="here")
    listed = str(failure.value).splitlines()[1:]
    assert [line.partition(": ")[0] for line in listed if line.startswith("no ")] == ["no 2", "no 4"]
    assert "it is even" in listed[0]
    assert seen == [(number, "here") for number in (1, 2, 3, 4)]


def test_several_arguments_are_taken_from_tuples_and_others_are_fixtures():
    @each(("a", "b"), [(1, 2), (3, 4)], ids=["first", "second"])
    def sums(a: int, b: int, wanted: dict[int, int]) -> None:
        assert a + b == wanted[a]

    assert list(sums.__signature__.parameters) == ["wanted"]  # type: ignore[attr-defined]
    sums(wanted={1: 3, 3: 7})
    with pytest.raises(pytest.fail.Exception, match="second: "):
        sums(wanted={1: 3, 3: 8})


def test_nothing_to_check_is_a_failure():
    @each("number", [])
    def never(number: int) -> None:
        raise AssertionError

    with pytest.raises(AssertionError, match="there is nothing to check"):
        never()


def test_few_values_are_spread_and_the_others_are_long():
    params = few(range(10), 3)
    assert [value for value in params if isinstance(value, int)] == [0, 4, 9]
    others = [param for param in params if not isinstance(param, int)]
    assert [param.values for param in others] == [(number,) for number in (1, 2, 3, 5, 6, 7, 8)]
    assert all([mark.name for mark in param.marks] == ["long"] for param in others)
    (marked,) = few([pytest.param(1, 2, id="x", marks=pytest.mark.insides)], 0)
    assert marked.values == (1, 2) and marked.id == "x"
    assert [mark.name for mark in marked.marks] == ["insides", "long"]
