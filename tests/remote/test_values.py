"""What becomes of values on the way to another process."""

import math
from array import array
from contextlib import suppress
from decimal import Decimal
from enum import IntEnum
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgpack
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as numpy_st

from carom.remote.errors import Malformed
from carom.remote.values import ALIGNMENT, Opaque, pack, unpack

plain = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**200), 2**200)
    | st.floats()
    | st.text(st.characters())
    | st.binary(),
    lambda values: st.lists(values).map(tuple) | st.dictionaries(st.text() | st.integers(-9, 9), values),
    max_leaves=20,
)
numbers = numpy_st.arrays(
    numpy_st.boolean_dtypes()
    | numpy_st.integer_dtypes()
    | numpy_st.unsigned_integer_dtypes()
    | numpy_st.floating_dtypes(sizes=(16, 32, 64))
    | numpy_st.complex_number_dtypes(sizes=(64, 128)),
    numpy_st.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
)


def contents(arrays: list[memoryview]) -> memoryview:
    """The contents of arrays as they stand in a frame."""
    return memoryview(bytearray(b"".join(bytes(one) + bytes(-len(one) % ALIGNMENT) for one in arrays)))


def there(value: Any, *, lists: bool = False) -> Any:
    """A value on the other side."""
    message, arrays = pack(value)
    return unpack(message, contents(arrays), lists=lists)


def same(one: Any, other: Any) -> bool:
    """Equal to the last bit, and of the same types."""
    if type(one) is not type(other):
        return False
    if isinstance(one, float):
        return one == other or (math.isnan(one) and math.isnan(other))
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict):
        return list(one) == list(other) and all(same(value, other[key]) for key, value in one.items())
    return one == other


@given(plain)
def test_plain_values_arrive_as_they_are(value: Any) -> None:
    assert same(there(value), value)


@given(numbers, numbers)
def test_arrays_arrive_as_they_are(first: np.ndarray, second: np.ndarray) -> None:
    for sent, received in zip((first, second), there((first, second)), strict=True):
        assert received.shape == sent.shape
        assert received.dtype == sent.dtype.newbyteorder("=")
        assert received.tobytes() == np.ascontiguousarray(sent, received.dtype).tobytes()
        assert received.flags.writeable and received.flags.aligned


def test_views_arrive_as_arrays() -> None:
    numbers = np.arange(12.0).reshape(3, 4)
    assert (there(numbers.T) == numbers.T).all()
    assert (there(numbers[::2, 1:]) == numbers[::2, 1:]).all()


class Mode(IntEnum):
    ONE = 1


class Index:
    def __index__(self) -> int:
        return 3


class Refusing:
    """A type with a mind of its own."""

    def __index__(self) -> int:
        raise RuntimeError

    __float__ = __iter__ = __index__  # type: ignore[assignment]

    def __repr__(self) -> str:
        raise RuntimeError


@pytest.mark.parametrize(
    ("sent", "received"),
    [
        ([1, (2.5, "a")], [1, [2.5, "a"]]),
        (Mode.ONE, 1),
        (Index(), 3),
        (np.float64(0.1), 0.1),
        (np.float32(0.5), 0.5),
        (np.int64(-5), -5),
        (np.uint8(200), 200),
        (Decimal("0.5"), 0.5),
        (Fraction(1, 4), 0.25),
        (range(3), [0, 1, 2]),
        (array("d", [1.0, 2.0]), [1.0, 2.0]),
        ({5}, [5]),
        ((number for number in (1, 2)), [1, 2]),
        (bytearray(b"a\0"), b"a\0"),
        ("\udcff", "\udcff"),
        (np.array(["a"]), ["a"]),
    ],
)
def test_arguments_become_the_nearest_plain_value(sent: object, received: object) -> None:
    result = there(sent, lists=True)
    assert result == received
    assert type(result) is type(received)


def test_a_bool_of_numpy_counts_as_one() -> None:
    assert there(np.bool_(True)) == 1


def test_integers_beyond_all_measure_stay_beyond_it() -> None:
    assert there(10**5000) > 10**300
    assert there(-(10**5000)) < -(10**300)


@pytest.mark.parametrize("value", [object(), Path("a"), print, Refusing(), 1j])
def test_what_has_nothing_of_a_number_keeps_its_type_name_and_text(value: object) -> None:
    result = there(value)
    assert isinstance(result, Opaque)
    assert type(result).__name__ == type(value).__name__
    with pytest.raises(TypeError, match=type(value).__name__):
        float(result)  # pyright: ignore[reportArgumentType]
    if not isinstance(value, Refusing):
        assert repr(result) == repr(value)


@given(st.binary(max_size=200), st.binary(max_size=64))
def test_any_bytes_are_a_value_or_malformed(message: bytes, behind: bytes) -> None:
    for lists in (True, False):
        with suppress(Malformed):
            unpack(message, memoryview(behind), lists=lists)


@given(plain, st.data())
def test_a_damaged_message_is_a_value_or_malformed(value: Any, data: st.DataObject) -> None:
    message = bytearray(pack((value, np.zeros((2, 3)), object(), 2**70))[0])
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(message) - 1))
        message[place] = data.draw(st.integers(0, 255))
    with suppress(Malformed):
        unpack(bytes(message), memoryview(bytes(48)), lists=True)


@pytest.mark.parametrize("code", [0, 4, 127])
def test_a_value_of_an_unknown_kind_is_malformed(code: int) -> None:
    message: Any = msgpack.packb(msgpack.ExtType(code, b"name\0text"))
    with pytest.raises(Malformed, match=f"unknown kind {code}"):
        unpack(message, memoryview(b""), lists=True)


def test_the_text_of_a_value_of_another_type_has_a_limit() -> None:
    for size, complaint in ((4000, None), (4500, "unknown kind 3")):
        message: Any = msgpack.packb(msgpack.ExtType(3, b"name\0" + b"x" * size))
        if complaint is None:
            assert repr(unpack(message, memoryview(b""), lists=True)) == "x" * size
        else:
            with pytest.raises(Malformed, match=complaint):
                unpack(message, memoryview(b""), lists=True)


def test_nesting_without_end_is_malformed() -> None:
    with pytest.raises(Malformed):
        unpack(b"\x91" * 100_000 + b"\x90", memoryview(b""), lists=True)


def test_promises_of_length_cost_no_memory() -> None:
    for start in (b"\xdd", b"\xdf", b"\xc6", b"\xdb"):
        with pytest.raises(Malformed):
            unpack(start + b"\xff\xff\xff\xff", memoryview(b""), lists=True)
