"""Tests belong to rings, and run where they are asked for; the tests nearest to a file are known."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests import rings
from tests.each import each
from tests.rings import LONG, TESTS, is_long
from tools.nearest_tests import NEAREST, ROOT, changed_files, nearest_tests, touched_tests


def item(*markers: str) -> Any:
    return SimpleNamespace(get_closest_marker=lambda name: name if name in markers else None)


def left_out(*arguments: str, markexpr: str = "", long: bool = False) -> list[str]:
    tests = {"short": item(), "long": item("long"), "thorough": item("thorough")}
    config: Any = SimpleNamespace(args=arguments, option=SimpleNamespace(markexpr=markexpr, long=long))
    out = rings.left_out(config, tests.values())
    return [name for name, test in tests.items() if test in out]


def test_each_ring_runs_what_belongs_to_it():
    assert left_out() == left_out("tests/worlds") == ["long", "thorough"]
    assert left_out("tests/worlds/test_worlds.py::test_steps") == []
    assert left_out(long=True) == left_out(markexpr="long") == ["thorough"]
    assert left_out(markexpr="thorough") == []
    assert left_out(markexpr="not insides") == ["long", "thorough"]


@each("place", LONG)
def test_long_places_are_there_and_say_why(place: str):
    assert (TESTS / place).exists()
    assert LONG[place].strip()


def test_what_is_long_as_a_whole_is_found_where_it_is_named():
    place = next(place for place in LONG if not place.endswith(".py"))
    folder = TESTS / place
    file = folder / "test_any.py"
    assert rings.is_long(folder) and rings.is_long(file)
    assert not rings.is_long(TESTS) and not rings.is_long(folder.parent)
    assert rings.names(str(folder), file) and rings.names(str(file), folder)
    assert rings.names(f"{file}::test_it", file)
    assert not rings.names(str(file), folder / "test_other.py")
    assert not rings.names(str(TESTS), file)
    assert not rings.names(str(Path.home()), file)


@each("folder", NEAREST)
def test_nearest_tests_are_there(folder: str):
    assert (ROOT / folder).exists()
    assert all((TESTS / place).exists() for place in NEAREST[folder])


@each("package", sorted({path.parent for path in (ROOT / "src").rglob("*.py")}))
def test_every_package_has_tests_near_it(package: Path):
    assert nearest_tests((package / "any.py").relative_to(ROOT).as_posix())


# What looks at everything, or at nothing that is drawn from.
_NEAREST_TO_NOTHING = {
    "clients": "scripts of others, which look at everything",
    "fuzz": "random files and calls, which look at everything",
    "interrupts": "calls that are broken off, wherever",
    "memory": "what is left in memory, whatever it is",
    "surface": "every function of the drop-in, by chance the one that changes",
    "test_layers.py": "imports",
    "test_patiently.py": "the patience of other tests",
    "test_requirements.py": "imports",
    "user_scripts": "scripts that use a bit of everything",
}


def test_every_test_is_the_nearest_to_something():
    """A folder that nothing is near to notices no mutant, whatever it tests."""
    near = {place for places in NEAREST.values() for place in places} | _NEAREST_TO_NOTHING.keys()
    forgotten = []
    for path in sorted(TESTS.rglob("test_*.py")):
        place = path.relative_to(TESTS)
        if not is_long(path) and near.isdisjoint(map(str, (place, *place.parents))):
            forgotten.append(str(place))
    assert not forgotten, f"tools/nearest_tests.py says of nothing that it is near to {forgotten}"


def test_the_longest_folder_counts():
    assert nearest_tests("src/carom/formats/sdf/joint.py") == ["tests/formats", "tests/scenes"]
    assert nearest_tests("src/carom/formats/bullet/any.py") == ["tests/formats"]
    assert nearest_tests("tests/worlds/test_worlds.py") == ["tests/worlds/test_worlds.py"]
    assert nearest_tests("tests/worlds/scene.py") == ["tests/worlds"]
    assert nearest_tests("tests/conftest.py") == nearest_tests("LICENSE") == []


def test_a_change_runs_no_test_twice():
    files = ["src/carom/worlds/saved.py", "tests/worlds/test_worlds.py", "tests/worlds/gone/test_gone.py"]
    assert touched_tests(files) == ["tests/face", "tests/worlds"]


def test_what_has_changed_is_asked_of_git(monkeypatch: pytest.MonkeyPatch):
    answers = {"log": "1000000", "rev-list": "abc", "diff": "a.py\nb.py", "ls-files": "c.py"}
    asked = []
    monkeypatch.setattr(
        "tools.nearest_tests._git", lambda *words: (asked.append(words), answers[words[0]])[1]
    )
    assert changed_files() == ["a.py", "b.py", "c.py"]
    assert ("rev-list", "-1", "--before=985600", "HEAD") in asked
    assert ("diff", "--name-only", "abc") in asked
    changed_files("def")
    assert ("diff", "--name-only", "def") in asked
