"""The script that installs from nothing does begin with nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.packaging import from_nothing


def test_nothing_of_here_is_left(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    for name in (
        "CAROM_CACHE_PATH",
        "PYTHONPATH",
        "XDG_CACHE_HOME",
        "WARP_CACHE_PATH",
        "ZIG_GLOBAL_CACHE_DIR",
    ):
        monkeypatch.setenv(name, "somewhere")
    monkeypatch.setenv("PIP_INDEX_URL", "the index")
    variables = from_nothing._variables(tmp_path / "home")
    assert "somewhere" not in variables.values()
    assert (variables["HOME"], variables["PIP_INDEX_URL"]) == (str(tmp_path / "home"), "the index")
    assert list((tmp_path / "home").iterdir()) == []


def test_a_way_that_fails_is_counted_and_says_why(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
):
    class Here:
        def __init__(self, folder: Path, python: str, revision: str, compiled: Path | None) -> None:
            pass

        def first_steps(self) -> str:
            return "it runs"

    def fails(here: Here) -> None:
        raise from_nothing.Failed("no module named warp")

    monkeypatch.setattr(from_nothing, "Nothing", Here)
    monkeypatch.setattr(from_nothing, "WAYS", {"well": lambda here: None, "badly": fails})
    assert from_nothing.main(["--revision", "HEAD"]) == 1
    well, badly = capsys.readouterr().out.splitlines()
    assert well == "well: installed in 0 s; it runs"
    assert badly == "badly: FAILED after 0 s: no module named warp"


def test_what_a_command_printed_is_in_the_error(tmp_path: Path):
    with pytest.raises(from_nothing.Failed, match=r"(?s)returned 3:\nwhat it said"):
        from_nothing._run(["sh", "-c", "echo what it said; exit 3"], tmp_path, {})


def test_ways_that_there_are_not_are_refused(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        from_nothing.main(["conda"])
    assert "there is no way conda; expected clone, editable" in capsys.readouterr().err


def test_what_is_kept_compiled_begins_empty(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "library").touch()
    for ways in (["clone"], ["clone", "wheel"]):
        with pytest.raises(SystemExit):
            from_nothing.main([*ways, "--compiled", str(tmp_path)])
        assert "nothing must be compiled before" in capsys.readouterr().err
