"""Named tuples without compiled annotations are those of `typing`."""

from __future__ import annotations

import pickle
import typing

import pytest

from carom.named_tuples import NamedTuple


class Ours(NamedTuple):
    """Two numbers."""

    first: int
    second: Unknown = 2  # type: ignore[name-defined]  # noqa: F821

    @property
    def total(self) -> int:
        return self.first + self.second

    @classmethod
    def of(cls, numbers: str) -> Ours:
        return cls(*map(int, numbers.split()))


class Usual(typing.NamedTuple):
    """Two numbers."""

    first: int
    second: int = 2


def test_it_is_a_tuple_with_names():
    made = Ours(1)
    assert made == (1, 2) == Usual(1)
    assert (made.first, made.second, made.total) == (1, 2, 3)
    assert made._replace(second=5) == Ours.of("1 5")
    assert made._asdict() == {"first": 1, "second": 2}
    assert repr(made) == repr(Usual(1)).replace("Usual", "Ours")
    assert (Ours._fields, Ours._field_defaults) == (Usual._fields, Usual._field_defaults)
    assert (Ours.__doc__, Ours.__module__, Ours.__qualname__) == (Usual.__doc__, __name__, "Ours")
    assert Ours.__annotations__ == {"first": "int", "second": "Unknown"}
    assert not hasattr(made, "__dict__")


def test_it_can_be_pickled():
    assert type(pickle.loads(pickle.dumps(Ours(3)))) is Ours


def test_wrong_arguments_are_named():
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'first'"):
        Ours()  # type: ignore[call-arg]
