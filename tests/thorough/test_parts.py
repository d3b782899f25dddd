"""The parts of `make thorough`, its command line, and the profiles of tests."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.each import each
from tools.differ.pair import ORACLE
from tools.thorough import parts, run
from tools.thorough.parts import PARTS, ROOT, all_pieces
from tools.thorough.pieces import Piece

PIECES = all_pieces(list(PARTS))


def test_pieces_have_names_of_their_own():
    assert len({piece.key for piece in PIECES}) == len(PIECES)
    # Without real PyBullet there is nothing to differ from, and the last changes may touch nothing long.
    assert {piece.part for piece in PIECES} | {"changed"} == {
        part for part in PARTS if part != "differ" or ORACLE.exists()
    }


@each("part", PARTS)
def test_pieces_run_modules_and_tests_that_are_there(part: str):
    for piece in PARTS[part]():
        option, module, *arguments = piece.arguments
        assert option == "-m"
        if module == "pytest":
            assert (ROOT / arguments[-1].partition("::")[0]).exists()
        else:
            assert ROOT.joinpath(*module.split(".")).with_suffix(".py").exists()


def test_the_suite_has_every_file_of_tests_once():
    files = [name for piece in parts.suite() for name in piece.arguments if name.endswith(".py")]
    assert sorted(files) == sorted(
        path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("test_*.py")
    )


@pytest.fixture
def two(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two parts of a piece each, one of which fails."""
    failing = Piece("second", "b", ("-c", "raise SystemExit(1)"))
    monkeypatch.setattr(run, "PARTS", {"first": None, "second": None})
    pieces = {"first": Piece("first", "a", ("-c", "")), "second": failing}
    monkeypatch.setattr(run, "all_pieces", lambda names: [pieces[name] for name in names])


@pytest.mark.usefixtures("two")
def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    for chosen, status, said in (
        ("first", 0, "0 of 1 pieces are done"),
        ("first,second", 1, "1 of 2 pieces are done"),
        ("first,second", 1, "FAILED second: b"),
        ("first", 0, "0 passed, 0 failed, 0 left"),
    ):
        with pytest.raises(SystemExit) as end:
            run.main(["--parts", chosen, "--folder", str(tmp_path), "--minutes", "5"])
        assert end.value.code == status
        assert said in capsys.readouterr().out
    run.main(["--list", "--parts", "first,second", "--folder", str(tmp_path)])
    assert capsys.readouterr().out == "second: b\n"
    with pytest.raises(SystemExit):
        run.main(["--parts", "third"])


def collected(tmp_path: Path, *arguments: str, **environment: str) -> str:
    """What pytest collects, or with which error it ends."""
    command = [sys.executable, "-m", "pytest", "-q", "--collect-only", "-p", "no:cacheprovider", *arguments]
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, env={**os.environ, **environment}, check=False
    )
    return done.stdout + done.stderr


@pytest.mark.long
def test_what_is_thorough_runs_only_when_asked_for(tmp_path: Path):
    pytest.importorskip("warp", reason="what is thorough compiles kernels")
    file = "tests/gpu/test_compile.py"
    test = parts.gpu()[0].arguments[-1]
    assert "test_a_module_compiles" not in collected(tmp_path, file)
    assert "test_a_module_compiles" not in collected(tmp_path, "-m", "not insides", file)
    assert "test_a_module_compiles" in collected(tmp_path, "-m", "thorough", file)
    assert test in collected(tmp_path, test)


def test_profiles(tmp_path: Path):
    code = "from tests.thorough.profiles import cases; print(cases(10))"
    for profile, count in (("short", "10"), ("thorough", "200"), ("other", "choose from short, thorough")):
        done = subprocess.run(
            [sys.executable, "-c", code],
            cwd=ROOT,
            capture_output=True,
            text=True,
            env={**os.environ, "CAROM_TEST_PROFILE": profile},
            check=False,
        )
        assert count in done.stdout + done.stderr
