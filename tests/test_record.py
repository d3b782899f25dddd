"""`@record` makes the data classes that `@dataclass` makes, and only the time to define them differs."""

import copy
import inspect
import pickle
from dataclasses import FrozenInstanceError, dataclass, field, fields, replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.record import record


class Declared:
    """A class with fields of all kinds."""

    first: int
    second: "str"
    third: float = 3.0
    fourth: list[int] = field(default_factory=list)
    fifth: int = field(default=5, compare=False)

    def doubled(self) -> int:
        """A method."""
        return 2 * self.first


def classes(**options: bool) -> tuple[Any, Any]:
    """The same class, made by `record` and by `dataclass`."""
    space = {name: value for name, value in vars(Declared).items() if name not in ("__dict__", "__weakref__")}
    ours, theirs = type("Declared", (), dict(space)), type("Declared", (), dict(space))
    usual = {"frozen": True, **options}
    usual.pop("hot", None)
    return record(**options)(ours), dataclass(slots=True, **usual)(theirs)


@record
class Point:
    """A point."""

    x: float
    y: float = 0.0


@record(frozen=False)
class Counter:
    """Changes."""

    count: int = 0


@record
class Checked:
    """Refuses what is negative."""

    size: float

    def __post_init__(self) -> None:
        if self.size < 0:
            raise ValueError("negative")


NAMES = ("first", "second", "third", "fourth", "fifth", "sixth")
ARGUMENTS = st.tuples(
    st.lists(st.integers(0, 3), max_size=6), st.dictionaries(st.sampled_from(NAMES), st.integers(0, 3))
)


def outcome(cls: Any, values: list[int], named: dict[str, int]) -> Any:
    try:
        made = cls(*values, **named)
    except TypeError:
        return TypeError
    return repr(made), made.doubled(), [getattr(made, known.name) for known in fields(made)]


@pytest.mark.parametrize("hot", [False, True])
@given(ARGUMENTS)
def test_arguments_do_what_they_do_with_dataclasses(hot, arguments):
    ours, theirs = classes(hot=hot)
    assert outcome(ours, *arguments) == outcome(theirs, *arguments)


@given(ARGUMENTS, ARGUMENTS, st.booleans(), st.booleans(), st.booleans())
def test_comparing_and_hashing_do_what_they_do_with_dataclasses(one, other, frozen, eq, hot):
    results = []
    for cls in classes(frozen=frozen, eq=eq, hot=hot):
        if TypeError in (outcome(cls, *one), outcome(cls, *other)):
            return
        a, b = cls(*one[0], **one[1]), cls(*other[0], **other[1])
        try:
            hashed = (hash(a) == hash(b)) if eq else hash(a) == hash(a)
        except TypeError:
            hashed = TypeError
        results.append((a == b, a == a, a != b, a == 1, hashed))
    assert results[0] == results[1]


def test_what_is_frozen_cannot_be_changed():
    point = Point(1.0)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'x'"):
        point.x = 2.0  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'x'"):
        del point.x  # type: ignore[misc]
    counter = Counter()
    counter.count += 1
    assert counter == Counter(1)
    with pytest.raises(AttributeError):
        counter.counted = 1  # type: ignore[attr-defined]


@pytest.mark.parametrize("made", [Point(1.0, 2.0), Counter(3), Checked(4.0)])
def test_records_are_copied_pickled_and_replaced(made):
    assert copy.copy(made) == made
    assert copy.deepcopy(made) == made
    assert pickle.loads(pickle.dumps(made)) == made
    name = fields(made)[0].name
    assert getattr(replace(made, **{name: 9}), name) == 9


def test_records_match_patterns_and_finish_themselves():
    match Point(1.0, 2.0):
        case Point(x, y):
            assert (x, y) == (1.0, 2.0)
    with pytest.raises(ValueError, match="negative"):
        Checked(-1.0)


@pytest.mark.parametrize(
    ("values", "named", "said"),
    [
        ((), {}, "Point needs 'x'"),
        ((1, 2, 3), {}, "Point takes 2 values, not 3"),
        ((1,), {"x": 1}, "Point was given 'x' twice"),
        ((1,), {"z": 1}, "Point has no field 'z'"),
    ],
)
def test_wrong_arguments_are_named(values, named, said):
    with pytest.raises(TypeError, match=f"^{said}$"):
        Point(*values, **named)


def test_help_shows_the_arguments():
    shown = [dict(inspect.signature(cls).parameters) for cls in classes()]
    # Only a default that is made anew for each object looks otherwise.
    assert shown[0].pop("fourth").default is list
    del shown[1]["fourth"]
    assert shown[0] == shown[1]
    assert list(inspect.signature(Point).parameters) == ["x", "y"]


def test_methods_of_the_class_stay():
    @record
    class Named:
        """Shows itself."""

        name: str

        def __repr__(self) -> str:
            return f"<{self.name}>"

    assert repr(Named("a")) == "<a>"
