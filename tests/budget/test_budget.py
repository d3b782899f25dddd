"""The budget of reading: small files cannot take gigabytes or hours, and the limits can be set."""

from __future__ import annotations

import os
import re
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from tests.budget.hostile import GREEDY, urdf, written, xacro
from tests.budget.limits import limited

import carom
from carom.errors import DescriptionError
from carom.files import budget
from carom.files.boundary import reading
from carom.files.budget import Budget, BudgetError, charge, set_budget
from carom.formats.kinds import kind_of
from carom.formats.xacro.globs import matches


@pytest.mark.parametrize("name", GREEDY)
def test_a_file_that_asks_for_too_much_is_refused(name: str, tmp_path: Path) -> None:
    file = written(GREEDY[name](), tmp_path)
    world = carom.World()
    # The limits of macros are lower here than the defaults, so that the tests are quick.
    with (
        limited(steps=20_000, elements=20_000),
        pytest.raises(DescriptionError, match="set_budget") as caught,
    ):
        world.load(file)
    assert caught.value.file is not None
    assert caught.value.file.is_relative_to(tmp_path)
    assert not world.bodies


def test_rows_without_properties_take_nothing(tmp_path: Path) -> None:
    from tests.budget.hostile import ply

    file = written({"a.urdf": urdf("m.ply"), "m.ply": ply("element x 4000000000\n")}, tmp_path)
    assert len(carom.World().load(file).bodies) == 1


def test_amounts_of_all_files_of_a_reading_add_up(tmp_path: Path) -> None:
    with limited(vertices=10):
        with reading(tmp_path / "a"):
            charge("vertices", 6)
            with reading(tmp_path / "b"), pytest.raises(BudgetError, match="12 vertices") as caught:
                charge("vertices", 6)
            assert caught.value.file == tmp_path / "b"
        charge("vertices", 6)


def test_time_of_the_processor_is_limited(tmp_path: Path) -> None:
    loop = "${[i for i in range(1000)]}" * 20
    content = f'<xacro:property name="x" value="{loop}"/><link name="${{x}}"/>'
    file = written({"a.xacro": xacro(content)}, tmp_path)
    with limited(seconds=1e-9), pytest.raises(BudgetError, match="1e-09 seconds"):
        carom.World().load(file)


def test_limits_are_set_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    with limited(vertices=5):
        assert budget.budget() == Budget(vertices=5)
        set_budget()
        assert budget.budget() == Budget()
    for limits in ({"corners": 1}, {"vertices": 0}, {"vertices": float("nan")}, {"seconds": float("inf")}):
        with pytest.raises(ValueError, match="limit"):
            set_budget(**limits)
    monkeypatch.setattr(budget._Kept, "own", None)
    monkeypatch.setenv(budget.VARIABLE, "vertices=1e3, seconds=7.5")
    assert budget.budget() == Budget(vertices=1000, seconds=7.5)
    monkeypatch.setattr(budget._Kept, "own", None)
    monkeypatch.setenv(budget.VARIABLE, "vertices")
    with pytest.raises(ValueError, match="name=number"):
        budget.budget()


@pytest.mark.skipif(sys.platform == "win32", reason="there are no named pipes in folders")
def test_nobody_waits_for_a_named_pipe(tmp_path: Path) -> None:
    pipe = tmp_path / "robot.urdf"
    os.mkfifo(pipe)
    content = b"<robot/>".ljust(300)
    end = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    try:
        os.write(end, content)
        with pytest.raises(DescriptionError, match="not a regular file"):
            carom.World().load(pipe)
        # Nothing was read, so that nothing would have waited for it.
        assert os.read(end, 1000) == content
    finally:
        os.close(end)


def test_patterns_match_as_those_of_the_standard_library(tmp_path: Path) -> None:
    import glob

    for name in ("a/x.xacro", "a/.y.xacro", "ab/z.xacro", "b/c/x.xacro", "a/dir.xacro/w"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    patterns = "*/*.xacro a*/?.xacro [b]/*/x.xacro */.* a/../a/* */none/* b/c/x.xacr[o]"
    for pattern in patterns.split():
        expected = [it for it in sorted(glob.glob(str(tmp_path / pattern))) if Path(it).is_file()]
        assert matches(str(tmp_path / pattern), lambda: None) == expected


def test_comments_that_are_never_closed_are_gone_through_once(tmp_path: Path) -> None:
    # With a search from each of them to the end of the file this would take hours.
    (tmp_path / "a.urdf").write_bytes(b"<!--" * 1_000_000 + b"<robot>")
    assert kind_of(tmp_path / "a.urdf").value == "URDF"


def test_the_documentation_has_all_limits() -> None:
    page = (Path(__file__).parents[2] / "docs" / "reading-files.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(\w+)` \| ([\d.]+) \|", page, re.MULTILINE))
    assert rows == {name: str(value) for name, value in asdict(Budget()).items()}
