"""Questions written to memory and answered."""

from struct import error as StructError

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.algorithms.ask import asking
from carom.native.tables import NUMPY_REAL, numbers_of

NUMBERS = st.floats(-1e6, 1e6)


def sums(counts):
    """Asks for the sum of all numbers and for the number of times it was asked."""
    question = np.zeros(sum(counts), dtype=NUMPY_REAL)
    answer = np.zeros(2, dtype=NUMPY_REAL)

    def answer_it():
        answer[:] = question.sum(), answer[1] + 1

    return asking(counts, numbers_of(question), answer_it, numbers_of(answer), 2)


@given(
    setting=st.tuples(NUMBERS, NUMBERS),
    lists=st.lists(st.lists(NUMBERS, max_size=20), min_size=1, max_size=4),
    kind=st.sampled_from([list, tuple, np.array]),
)
def test_all_lists_arrive_few_numbers_or_many(setting, lists, kind):
    ask = sums([2, *map(len, lists)])
    expected = sum(setting) + sum(map(sum, lists))
    for times in (1, 2):
        total, asked = ask(setting, *map(kind, lists))
        assert asked == times
        np.testing.assert_allclose(total, expected, atol=1e-6)


@pytest.mark.parametrize("count", [3, 30])
def test_what_does_not_fit_is_refused(count):
    ask = sums([1, count, count])
    good = [1.0] * count
    for bad in (good[1:], [*good, 1.0], ["x", *good[1:]]):
        with pytest.raises((ValueError, StructError)):
            ask((0.0,), bad, good)
        with pytest.raises((ValueError, StructError)):
            ask((0.0,), good, bad)
    with pytest.raises(TypeError):
        ask((0.0,), good, 1.0)
    assert ask((0.0,), good, good)[0] == 2 * count


@pytest.mark.parametrize("count", [3, 30])
def test_an_answer_that_is_not_finite_is_refused(count):
    ask = sums([1, count])
    with pytest.raises(ValueError, match="not finite"):
        ask((0.0,), [float("nan")] * count)


def test_a_new_setting_counts_and_an_old_one_is_kept():
    ask = sums([1, 1])
    setting = (5.0,)
    assert ask(setting, [1.0])[0] == 6.0
    assert ask(setting, [2.0])[0] == 7.0
    assert ask((7.0,), [1.0])[0] == 8.0
