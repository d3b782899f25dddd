"""Pieces of the long checks: their order, where the next run continues, limits, and failures."""

import json
import sys
import time
from pathlib import Path

import pytest
from tests.patience import PATIENCE
from tools.thorough.pieces import SEED, Piece
from tools.thorough.record import Record
from tools.thorough.runner import Runner, Summary, in_order

FOREVER = "import time; time.sleep(600)"


def piece(name: str, code: str = "", part: str = "some") -> Piece:
    return Piece(part, name, ("-c", code, SEED))


def keys(pieces: list[Piece]) -> list[str]:
    return [piece.name for piece in pieces]


@pytest.fixture
def record(tmp_path: Path) -> Record:
    return Record(tmp_path / "record.json", "digest")


def run(record: Record, folder: Path, *pieces: Piece, seconds: float = PATIENCE, jobs: int = 1) -> Summary:
    return Runner(record, folder, folder / "logs", jobs).run(in_order(pieces, record), seconds)


@pytest.mark.parametrize("jobs", [1, 3])
def test_what_passed_is_not_run_again(record: Record, tmp_path: Path, jobs: int):
    note = "import sys; open('ran', 'a').write('x'); print('done')"
    pieces = [piece(name, note) for name in "abcd"]
    assert sorted(keys(run(record, tmp_path, *pieces, jobs=jobs).passed)) == ["a", "b", "c", "d"]
    again = run(record, tmp_path, *pieces, jobs=jobs)
    assert again == Summary()
    assert (tmp_path / "ran").read_text() == "xxxx"
    assert (tmp_path / "logs" / "some-a.txt").read_text().strip() == "done"


def test_a_failure_is_listed_and_comes_first_next_time(
    record: Record, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    bad = piece("bad", "import sys; print('the reason'); sys.exit(3)")
    summary = run(record, tmp_path, piece("a"), bad, piece("b"))
    assert (keys(summary.passed), keys(summary.failed), summary.left) == (["a", "b"], ["bad"], [])
    printed = capsys.readouterr().out
    assert "[2/3] some: bad: FAILED" in printed
    assert "the reason" in printed
    assert f"again: {sys.executable} -c" in printed
    assert keys(in_order([piece("a"), piece("new"), bad], record)) == ["bad", "new"]


def test_a_run_that_failed_is_repeated_with_its_seed_and_one_that_passed_is_not(
    record: Record, tmp_path: Path
):
    code = "import os, sys; print(sys.argv[1]); sys.exit(os.path.exists('fail'))"
    it = Piece("some", "a", ("-c", code, SEED), first_seed=7)
    seeds = []
    for fails in (True, True, False, False):
        (tmp_path / "fail").touch() if fails else (tmp_path / "fail").unlink(missing_ok=True)
        Runner(record, tmp_path, tmp_path / "logs").run(in_order([it], record, again=True))
        seeds.append(int((tmp_path / "logs" / "some-a.txt").read_text()))
    assert seeds[:3] == [7, 7, 7]
    assert seeds[3] != 7


@pytest.mark.parametrize("jobs", [1, 2])
def test_at_the_limit_what_runs_is_ended_and_counts_as_not_done(record: Record, tmp_path: Path, jobs: int):
    pieces = [piece("long", FOREVER), piece("endless", FOREVER), piece("never")]
    summary = run(record, tmp_path, *pieces, seconds=0.5, jobs=jobs)
    assert (summary.passed, summary.failed) == ([], [])
    assert keys(summary.left) == ["long", "endless", "never"]
    assert not any(record.is_done(it.key) for it in pieces)
    assert keys(in_order(pieces, record)) == ["long", "endless", "never"]


def test_without_time_nothing_starts(record: Record, tmp_path: Path):
    summary = run(record, tmp_path, piece("a", "open('ran', 'w')"), seconds=0.0)
    assert keys(summary.left) == ["a"]
    assert not (tmp_path / "ran").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="groups of processes of POSIX")
def test_what_an_ended_piece_has_started_is_ended_as_well(record: Record, tmp_path: Path):
    child = "import time, pathlib; time.sleep(2); pathlib.Path('alive').touch()"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    run(record, tmp_path, piece("parent", parent), seconds=1.0)
    run(record, tmp_path, piece("wait", "import time; time.sleep(2.5)"))
    assert not (tmp_path / "alive").exists()


def test_parts_alternate_and_what_ran_longest_ago_comes_first(tmp_path: Path):
    pieces = [piece(f"a{n}", part="a") for n in range(4)] + [piece(f"b{n}", part="b") for n in range(2)]
    record = Record(tmp_path / "record.json", "old")
    assert keys(in_order(pieces, record)) == ["a0", "b0", "a1", "a2", "b1", "a3"]
    for it in (pieces[2], pieces[0], pieces[4]):
        record.add(it.key, True, 1.0)
    assert keys(in_order(pieces, record)) == ["a1", "b1", "a3"]
    newer = Record(tmp_path / "record.json", "new")
    assert keys(in_order(pieces, newer)) == ["a1", "b1", "a3", "a2", "a0", "b0"]


def test_environment_of_a_piece(record: Record, tmp_path: Path):
    code = "import json, os; print(json.dumps([os.environ['OWN'], os.environ['TMPDIR']]))"
    run(record, tmp_path, Piece("some", "a", ("-c", code), environment={"OWN": "value"}))
    value, folder = json.loads((tmp_path / "logs" / "some-a.txt").read_text())
    assert value == "value"
    assert not Path(folder).exists()


def test_a_piece_may_pass_with_another_status_than_0(record: Record, tmp_path: Path):
    ending = ("-c", "raise SystemExit(5)")
    assert run(record, tmp_path, Piece("some", "a", ending, passing=(0, 5))).passed
    assert run(record, tmp_path, Piece("some", "b", ending)).failed


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells the environment of a process")
def test_what_began_a_session_of_its_own_is_ended_too(record: Record, tmp_path: Path):
    child = f"import os; open({str(tmp_path / 'child')!r}, 'w').write(str(os.getpid())); {FOREVER}"
    code = (
        f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}], start_new_session=True)"
    )
    run(record, tmp_path, piece("compiles", code), seconds=3)
    told = Path("/proc") / (tmp_path / "child").read_text() / "stat"
    # Who has been ended is gone before long, or waits ("Z") for its parent to notice.
    end = time.monotonic() + PATIENCE
    while told.exists() and told.read_text().rpartition(")")[2].split()[0] != "Z":
        assert time.monotonic() < end
        time.sleep(0.05)
