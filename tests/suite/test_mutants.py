"""Mutants are drawn by chance from all rooms, and counted as noticed only if tests fail for them alone."""

import ast
import json
from pathlib import Path
from typing import Any

import pytest
from tools.mutants import drawing, run
from tools.mutants.change import Change
from tools.mutants.copies import ROOT, take_over_code
from tools.mutants.drawing import Drawn, draw
from tools.mutants.names import named
from tools.mutants.near import near_files
from tools.mutants.python_changes import python_changes
from tools.mutants.rooms import CHANGES, room_of, rooms
from tools.mutants.table import table
from tools.mutants.text_changes import text_changes

from carom.native.building.cache import MANIFEST, content_key
from carom.native.kernel_modules import KERNEL_MODULES

PYTHON = '''"""A text of 1 + 2."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sys

__all__ = ["f"]


def f(a: int = 1, *, ä: "list[int]" = 2) -> bool:
    """Not 3 < 4."""
    while a < ä and not a:
        a += 1
        self.x = "é" * a - 2.0
        if a == 5:
            break
        do(a)
        logger.warning("%d", 7)
    if a:
        raise ValueError(f"{a + 1}")
    return a is None


@overload
def g(a: int = 1) -> int: ...


@dataclass(frozen=True, slots=True)
class C:
    a: int | None


def h(a: int | None, *b: int | str, c: int | str) -> C | None:
    for each in zip(a, b, strict=True):
        each()
'''

CPP = """// a < b
#include <x>
template <int N> struct S { };
double f(int a) {
    const double b = a < 2 ? "a < b" : 0.5 * a;
    if (a == (3) && b) {
        call(a, b);
        break;
    }
    x = a + 1;  /* y = 2; */
    return b;
}
"""


def made(source: str, changes: Any) -> dict[str, str]:
    """The lines of changed sources that differ, by the lines that were there."""
    found = {}
    for change in changes(source):
        new = change.made(source)
        lines = zip(source.splitlines(), new.splitlines(), strict=True)
        ((before, after),) = [(a.strip(), b.strip()) for a, b in lines if a != b]
        assert source.splitlines()[change.line - 1].strip() == before
        found[after] = before
    return found


def test_changes_of_python():
    changes = made(PYTHON, python_changes)
    for change in python_changes(PYTHON):
        ast.parse(change.made(PYTHON))
    assert set(changes) == {
        'def f(a: int = 2, *, ä: "list[int]" = 2) -> bool:',
        'def f(a: int = 1, *, ä: "list[int]" = 3) -> bool:',
        "while a <= ä and not a:",
        "while a < ä or not a:",
        "while a < ä and a:",
        "while not (a < ä and not a):",
        "pass",
        "a += 2",
        'self.x = "é" * a + 2.0',
        'self.x = "é" * a - 3.0',
        "if a != 5:",
        "if a == 6:",
        "if not (a == 5):",
        "if not (a):",
        "return a is not None",
        "return None",
    }
    dropped = [change for change in python_changes(PYTHON) if change.new == "pass"]
    assert [change.line for change in dropped] == [14, 15, 17, 18, 36]


def test_changes_of_other_languages():
    assert set(made(CPP, text_changes)) == {
        'const double b = a <= 2 ? "a < b" : 0.5 * a;',
        'const double b = a < 3 ? "a < b" : 0.5 * a;',
        'const double b = a < 2 ? "a < b" : (1.5 * 0.5) * a;',
        'const double b = a < 2 ? "a < b" : 0.5 / a;',
        "if (a != (3) && b) {",
        "if (a == (4) && b) {",
        "if (a == (3) || b) {",
        "if (!(a == (3) && b)) {",
        ";",
        "x = a - 1;  /* y = 2; */",
        "x = a + 2;  /* y = 2; */",
        ";  /* y = 2; */",
    }


def test_every_room_is_drawn_from_and_the_same_for_the_same_seed():
    found = rooms()
    assert {"kernels", "C++", "JavaScript", "vector", "render", "gpu", "controllers", "pybullet"} <= set(
        found
    )
    few = {room: found[room] for room in ("vector", "C++", "JavaScript")}
    mutants = draw(few, 24, seed=3)
    assert mutants == draw(few, 24, seed=3) != draw(few, 24, seed=4)
    assert [mutant.room for mutant in mutants[:3]] == list(few)
    for room in few:
        kinds = [mutant.change.kind for mutant in mutants if mutant.room == room]
        assert len(kinds) == 8 and len(set(kinds)) == 4
    for mutant in mutants:
        assert mutant.change.made(mutant.source) != mutant.source
        assert mutant.name.startswith(mutant.file)


def test_rooms_are_packages_and_languages():
    assert room_of("src/carom/world/scene.py") == "world"
    assert room_of("src/carom/camera.py") == "carom"
    assert room_of("src/pybullet/_joints/joints.py") == "pybullet"
    assert room_of("src/carom/native/source/rows.h") == "C++"
    assert room_of("src/carom/viewer/page/app.js") == "JavaScript"
    assert set(CHANGES) == {Path(file).suffix for files in rooms().values() for file in files}


def test_the_likeliest_tests_come_first():
    file = "src/carom/controllers/box_qp.py"
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    line = next(number for number, text in enumerate(lines, 1) if text.startswith("def "))
    found = near_files(Drawn("controllers", file, Change(0, 1, "", "operator", line), ""))
    assert found[0] == "tests/controllers/test_ilqr.py"
    assert len(found) == len(set(found)) > 2


class FakeCopy:
    """Tests fail with whatever is mutated in some files; in some they fail anyway."""

    def tried(self, file: str, mutated: str, tests: list[str]) -> str:
        return "killed" if file.endswith(("gae.py", "spaces.py")) else "survived"

    def builds(self) -> None:
        return None

    def passes(self, tests: list[str], limit: float | None) -> str | None:
        return "killed" if self.broken else None

    broken = False


@pytest.fixture
def mutant() -> Drawn:
    return next(drawn for drawn in draw({"control": rooms()["control"]}, 4, 0))


def test_what_was_noticed_is_not_tried_again(tmp_path: Path, mutant: Drawn):
    results = run.Results(tmp_path / "known.json")
    tests = near_files(mutant)
    assert results.of(mutant, tests) is None
    results.add(mutant, tests, "survived")
    assert run.Results(tmp_path / "known.json").of(mutant, tests) == "survived"
    # With other tests it may be noticed.
    assert results.of(mutant, [*tests, "tests/test_layers.py"]) is None
    results.add(mutant, tests, "killed")
    assert results.of(mutant, [*tests, "tests/test_layers.py"]) == "killed"
    assert json.loads((tmp_path / "known.json").read_text())[mutant.name][0] == "killed"


@pytest.mark.parametrize("broken", [False, True])
def test_a_mutant_counts_as_noticed_only_if_its_tests_pass_without_it(
    tmp_path: Path, mutant: Drawn, broken: bool
):
    copy: Any = FakeCopy()
    copy.broken = broken
    copy.tried = lambda file, mutated, tests: "killed"
    trial = run.Trial(run.Results(tmp_path / "known.json"), [copy], float("inf"))
    assert trial.outcome(mutant) == ("fails without it" if broken else "killed")


def test_an_equivalent_mutant_is_not_tried(tmp_path: Path, mutant: Drawn, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "why.json").write_text(json.dumps({mutant.name: "it is the same"}))
    monkeypatch.setattr(run, "REASONS", tmp_path / "why.json")
    trial = run.Trial(run.Results(tmp_path / "known.json"), [], float("inf"))
    assert trial.outcome(mutant) == "equivalent"


def test_each_equivalent_mutant_has_a_reason_and_a_file():
    for name, reason in run.equivalent().items():
        file, _, rest = name.partition(" ")
        assert (ROOT / file).is_file() and " -> " in rest and len(reason) > 20, name


LEFT = """class A:
    def f(self, a: int = 1) -> int:
        if a < 2:
            return a + 1
        return a + 1


def g(
    a: int,
    b: int,
) -> int:
    while a < 2:
        a += b
    return a + 1
"""


def names(file: str, source: str, changes: Any) -> list[str]:
    return [name for name, _ in named(file, source, changes(source))]


def test_names_of_mutants_say_where_and_what_and_are_different():
    found = names("a.py", LEFT, python_changes)
    assert len(set(found)) == len(found)
    assert {
        "a.py A: def f(self, a: int = 1) -> int: | 1 -> 2",
        "a.py A.f: if a < 2: | < -> <=",
        "a.py A.f: return a + 1 | + -> -",
        "a.py A.f: return a + 1 | + -> - (2)",
        "a.py g: a += b | a += b -> pass",
        "a.py g: return a + 1 | + -> -",
    } <= set(found)
    assert "a.cpp f: call(a, b); | call(a, b); -> ;" in names("a.cpp", CPP, text_changes)


def test_names_of_mutants_stay_when_other_lines_come_and_go():
    moved = LEFT.replace("class A:", "import x\n\n\nclass A:").replace("while a < 2:", "while a <= 2:")
    before, after = (set(names("a.py", source, python_changes)) for source in (LEFT, moved))
    assert len(before - after) == len(after - before) == 3
    assert all("while" in name for name in before ^ after)


def test_other_lines_of_a_file_do_not_change_what_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    drawn = []
    for source in (LEFT, "import x\n\n\n" + LEFT):
        (tmp_path / "a.py").write_text(source, encoding="utf-8")
        monkeypatch.setattr(drawing, "ROOT", tmp_path)
        drawn.append([mutant.name for mutant in draw({"a": ["a.py"]}, 5, 0)])
    assert drawn[0] == drawn[1] and len(drawn[0]) == 5


class Stages(FakeCopy):
    """Notes which tests run; those of the last files fail."""

    def __init__(self, failing: str) -> None:
        self.failing, self.ran = failing, []

    def tried(self, file: str, mutated: str, tests: list[str]) -> str:
        self.ran.append(list(tests))
        return "killed" if self.failing in tests else "survived"


@pytest.mark.parametrize(("place", "stages"), [(0, 1), (-1, 2)])
def test_the_likeliest_files_run_first_and_alone(tmp_path: Path, place: int, stages: int):
    drawn = draw({"formats": rooms()["formats"]}, 1, 0)[0]
    tests = near_files(drawn)
    assert len(tests) > run.LIKELIEST
    copy: Any = Stages(tests[place])
    trial = run.Trial(run.Results(tmp_path / "known.json"), [copy], float("inf"))
    assert trial.outcome(drawn) == "killed"
    assert copy.ran == [tests[: run.LIKELIEST], tests[run.LIKELIEST :]][:stages]


def test_generated_code_is_taken_over_for_other_sources_by_hand(tmp_path: Path):
    pytest.importorskip("warp", reason="the key of the code holds its settings")
    import warp

    settings = Path(str(warp.__file__)).with_name("config.py").read_bytes()
    old, new = (tmp_path / "code" / content_key(it, settings, *KERNEL_MODULES) for it in ("one", "two"))
    old.mkdir(parents=True)
    (old / "a.cpp").write_text("int a;")
    (old / MANIFEST).write_text('{"digest":"one"}')
    take_over_code(tmp_path, "another", "two")
    assert not new.exists()
    take_over_code(tmp_path, "one", "two")
    assert (new / "a.cpp").read_text() == "int a;"
    assert (new / MANIFEST).read_text() == '{"digest":"two"}'


def test_no_mutant_is_begun_when_the_time_is_over(tmp_path: Path, mutant: Drawn):
    trial = run.Trial(run.Results(tmp_path / "known.json"), [], 0.0)
    assert trial.outcome(mutant) is None


def test_the_table_says_which_rooms_have_their_share(mutant: Drawn):
    results = ["killed"] * 8 + ["timed out", "survived", None, "does not build", "equivalent"]
    text, passed = table([(mutant, result) for result in results], 0.9)
    assert passed and "| control | 10 | 9 | 90% |" in text and "| all | 10 | 9 | 90% |" in text
    assert "1 not tried, 1 equivalent, 1 do not build" in text and f"survived: {mutant.name}" in text
    assert not table([(mutant, "survived")], 0.9)[1]
