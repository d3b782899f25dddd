"""Data classes made when they are needed look like those of the standard library in all respects."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import subprocess
import sys
import threading
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom import lazy_dataclasses
from carom.lazy_dataclasses import FIRST_OBJECTS, dataclass, field, field_names


@dataclass(frozen=True, slots=True)
class Point:
    """A point."""

    x: float
    y: float = 0.0
    names: list[str] = field(default_factory=list)
    note: str = field(default="", compare=False)

    @property
    def doubled(self) -> float:
        return 2 * self.x


@dataclasses.dataclass(frozen=True, slots=True)
class UsualPoint:
    """A point."""

    x: float
    y: float = 0.0
    names: list[str] = dataclasses.field(default_factory=list)
    note: str = dataclasses.field(default="", compare=False)

    @property
    def doubled(self) -> float:
        return 2 * self.x


@dataclass(slots=True)
class Base:
    first: int
    second: int = 2

    def __post_init__(self) -> None:
        self.second += 10


@dataclass(slots=True)
class Derived(Base):
    second: int = 3
    third: tuple[int, ...] = ()


@dataclasses.dataclass(slots=True)
class UsualBase:
    first: int
    second: int = 2

    def __post_init__(self) -> None:
        self.second += 10


@dataclasses.dataclass(slots=True)
class UsualDerived(UsualBase):
    second: int = 3
    third: tuple[int, ...] = ()


@dataclass(eq=False, slots=True)
class Single:
    value: object = None


@dataclass(slots=True)
class Nothing:
    pass


numbers = st.floats(allow_nan=False)


@given(numbers, numbers, st.lists(st.text()), st.text(), numbers)
def test_values_print_compare_and_hash_alike(x, y, names, note, other):
    ours, usual = Point(x, y, names, note), UsualPoint(x, y, names, note)
    assert repr(ours) == repr(usual).replace("UsualPoint", "Point")
    assert (ours == Point(other, y, names)) == (usual == UsualPoint(other, y, names))
    assert ours == Point(x, y, list(names), "another note")
    assert ours != usual
    assert dataclasses.astuple(ours) == dataclasses.astuple(usual)
    assert dataclasses.replace(ours, y=other) == Point(x, other, names)


def test_signatures_are_those_of_the_standard_library():
    for ours, usual in ((Point, UsualPoint), (Derived, UsualDerived), (Base, UsualBase)):
        assert list(inspect.signature(ours).parameters) == list(inspect.signature(usual).parameters)
        assert ours.__init__.__annotations__ == usual.__init__.__annotations__
        assert ours.__match_args__ == usual.__match_args__
        assert ours.__slots__ == usual.__slots__


def test_bases_give_their_fields_first():
    ours, usual = Derived(1, third=(4,)), UsualDerived(1, third=(4,))
    assert repr(ours) == repr(usual).replace("Usual", "")
    assert [known.name for known in dataclasses.fields(Derived)] == ["first", "second", "third"]
    assert field_names(Derived) == field_names(UsualDerived) == ("first", "second", "third")
    assert not hasattr(ours, "__dict__")


def test_frozen_ones_refuse_changes():
    point = Point(1.0)
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'x'"):
        point.x = 2.0  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'x'"):
        del point.x  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        point.new = 2.0  # type: ignore[attr-defined]


def test_others_change_and_are_not_hashable():
    base = Base(1)
    base.first = 5
    assert base == Base(5)
    with pytest.raises(TypeError, match="unhashable"):
        hash(base)
    with pytest.raises(AttributeError):
        base.third = 1  # type: ignore[attr-defined]


def test_without_eq_they_are_told_by_identity():
    one = Single()
    assert one == one
    assert one != Single()
    assert len({one, Single()}) == 2


def test_a_class_without_fields_is_one():
    assert Nothing() == Nothing()
    assert repr(Nothing()) == "Nothing()"


@pytest.mark.parametrize("made", [Point(1.0, 2.0, ["a"], "b"), Derived(1), Single([1]), Base(3)])
def test_they_can_be_copied_and_pickled(made):
    for twin in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
        assert type(twin) is type(made)
        assert dataclasses.astuple(twin) == dataclasses.astuple(made)


def test_an_object_from_a_pickle_may_be_the_first_of_its_class():
    text = (
        "import pickle, sys\n"
        "from carom.description import Box\n"
        "assert '_Initialiser' in repr(vars(Box)['__init__'])\n"
        "box = pickle.loads(bytes.fromhex(sys.argv[1]))\n"
        "assert box == Box((1.0, 2.0, 3.0)) and hash(box) and repr(box).startswith('Box(')\n"
    )
    from carom.description import Box

    content = pickle.dumps(Box((1.0, 2.0, 3.0))).hex()
    subprocess.run([sys.executable, "-c", text, content], check=True)


def test_wrong_arguments_are_named():
    with pytest.raises(TypeError, match=r"Point.__init__\(\) missing 1 required positional argument: 'x'"):
        Point()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"Point.__init__\(\) got an unexpected keyword argument 'z'"):
        Point(1.0, z=1)  # type: ignore[call-arg]


def test_nothing_is_compiled_before_it_is_needed(monkeypatch):
    made = []
    usual = dataclasses.dataclass
    monkeypatch.setattr(dataclasses, "dataclass", lambda **options: made.append(options) or usual(**options))

    @dataclass(frozen=True, slots=True)
    class Late:
        x: int
        y: int = 3

    assert type(vars(Late)["__init__"]).__name__ == "_Initialiser"
    assert Late(1) == Late(1, 3)
    assert hash(Late(1)) == hash(Late(1, 3))
    assert field_names(Late) == ("x", "y")
    match Late(4):
        case Late(x, y):
            assert (x, y) == (4, 3)
    assert not made
    assert dataclasses.replace(Late(1), y=4) == Late(1, 4)
    assert repr(Late(1)).endswith("Late(x=1, y=3)")
    assert dataclasses.is_dataclass(Late)
    assert len(made) == 1


def test_many_objects_have_the_methods_compiled():
    @dataclass(frozen=True, slots=True)
    class Many:
        x: int
        y: list[int] = field(default_factory=list)

    made = [Many(number, y=[number]) for number in range(FIRST_OBJECTS)]
    assert type(vars(Many)["__init__"]).__name__ == "_Initialiser"
    made += [Many(FIRST_OBJECTS, [FIRST_OBJECTS])]
    assert type(vars(Many)["__init__"]).__name__ == "function"
    assert [one.x for one in made] == [one.y[0] for one in made] == list(range(FIRST_OBJECTS + 1))
    assert Many(1).y is not Many(1).y


@pytest.mark.parametrize("first", [0, FIRST_OBJECTS])
def test_derived_classes_may_have_methods_of_their_own(first):
    @dataclass(slots=True)
    class Plain:
        x: int
        y: int = 0

    class Own(Plain):
        __slots__ = ("left",)

        def __init__(self, left: int, *arguments: int) -> None:
            super().__init__(*arguments)
            self.left = left

        def __repr__(self) -> str:
            return f"{self.left} beside {super().__repr__()}"

    for number in range(first):
        Plain(number)
    own = Own(1, 2)
    assert (own.left, own.x, own.y) == (1, 2, 0)
    assert repr(own).startswith("1 beside ")
    with pytest.raises(TypeError, match=r"Plain\.__init__\(\) missing 1 required positional argument: 'x'"):
        Own(1)


@pytest.mark.parametrize("arguments", [(), (1, 2, 3, 4, 5, 6)])
@pytest.mark.parametrize("named", [{}, {"x": 1}, {"unknown": 1}, {"x": 1, "unknown": 2}])
def test_first_objects_refuse_what_later_ones_refuse(arguments, named):
    if named == {"x": 1} and not arguments:
        return

    @dataclass(slots=True)
    class First:
        x: int
        y: int = 0

    @dataclasses.dataclass(slots=True)
    class Later:
        x: int
        y: int = 0

    with pytest.raises(TypeError) as ours:
        First(*arguments, **named)
    with pytest.raises(TypeError) as usual:
        Later(*arguments, **named)
    assert str(ours.value) == str(usual.value).replace("Later", "First")


@pytest.mark.parametrize(
    "options", [{}, {"slots": True, "order": True}, {"slots": True, "kw_only": True}, {"frozen": True}]
)
def test_unusual_options_are_left_to_the_standard_library(options):
    @dataclass(**options)
    class Other:
        x: int = 1

    assert type(vars(Other)["__init__"]).__name__ == "function"
    assert Other(x=2).x == 2


def test_unusual_fields_are_left_to_the_standard_library():
    @dataclass(slots=True)
    class WithShared:
        shared: ClassVar[int] = 5
        x: int = 1

    @dataclass(slots=True)
    class WithDerived:
        x: int = 1
        square: int = field(init=False)

        def __post_init__(self) -> None:
            self.square = self.x**2

    @dataclass(slots=True)
    class OfThem(WithDerived):
        y: int = 2

    assert (WithShared.shared, WithShared().x) == (5, 1)
    assert WithDerived(3).square == 9
    assert OfThem(3, y=4) == OfThem(3, 4)
    for made in (WithShared, WithDerived, OfThem):
        assert type(vars(made)["__init__"]).__name__ == "function"


def test_standard_ones_may_be_derived_from_them():
    @dataclasses.dataclass
    class After(Base):
        fourth: str = "x"

    assert dataclasses.astuple(After(1, 2, "y")) == (1, 12, "y")


def test_threads_that_make_the_first_object_get_the_same_class():
    for _ in range(20):

        @dataclass(frozen=True, slots=True)
        class Shared:
            x: int
            y: tuple[Any, ...] = ()

        found: list[Any] = []
        start = threading.Barrier(4)

        def make(of: Any = Shared, found: list[Any] = found, start: threading.Barrier = start) -> None:
            start.wait()
            found.append((of(1), repr(of(2)), dataclasses.fields(of)))

        threads = [threading.Thread(target=make) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len({(made, text) for made, text, _ in found}) == 1


def test_type_checkers_see_the_standard_library():
    text = inspect.getsource(lazy_dataclasses)
    assert "if TYPE_CHECKING:\n    from dataclasses import dataclass, field, fields, replace\n" in text


def test_fields_of_the_standard_library_are_understood():
    @dataclass(slots=True)
    class Mixed:
        value: list[int] = dataclasses.field(default_factory=list)
        note: str = field(default="none", repr=False)

    assert repr(Mixed()) == f"{Mixed.__qualname__}(value=[])"
    assert Mixed([1]) == Mixed([1], "none") != Mixed([1], "some")
