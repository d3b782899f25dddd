"""The manual and the examples in a terminal: `python -m carom docs` and `examples`."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from carom.cli.command_line import FAILED, OK, main
from carom.cli.docs_command import overview, page
from carom.cli.shipped import example_files, manual_pages

ROOT = Path(__file__).parents[2]


def test_pages_are_listed_printed_and_found(capsys: Any) -> None:
    assert main(["docs"]) == OK
    listed = capsys.readouterr().out
    assert "tutorials/constraints" in listed
    assert main(["docs", "constraints"]) == OK
    printed = capsys.readouterr().out
    assert printed.startswith("# Constraints")
    # The script itself, not a mark for it.
    assert "import pybullet as p" in printed
    assert "--8<--" not in printed
    assert main(["docs", "--search", "world.constrain", "hinge"]) == OK
    unquoted = capsys.readouterr().out
    assert main(["docs", "--search", "world.constrain hinge"]) == OK
    assert "tutorials/constraints" in unquoted == capsys.readouterr().out
    assert main(["docs", "contract"]) == FAILED
    assert "did you mean contact" in capsys.readouterr().err
    assert main(["docs", "--search", "xyzzyplugh"]) == FAILED


def test_one_name_is_explained_with_its_arguments(capsys: Any) -> None:
    assert main(["docs", "carom.Worlds.images"]) == OK
    printed = capsys.readouterr().out
    assert printed.startswith("## carom.Worlds.images(self, camera")
    assert "poses: Where the camera is placed in each of the n worlds chosen" in printed
    assert "time_step" in page("carom.World")
    assert main(["docs", "carom.Worlds.imges"]) == FAILED
    assert "there is no page 'carom.worlds.imges'" in capsys.readouterr().err


def test_the_reference_is_printed_with_what_is_said_of_each_name() -> None:
    printed = page("api/carom")
    assert "Bodies that move under gravity, motors and limits." in printed
    assert "- force_between(" in printed
    assert "\n::: " not in printed
    # Neither names for other packages, nor those of tuples and arrays.
    assert "note_constraint" not in printed
    assert "- argsort(" not in printed
    assert "Return first index of value" not in printed
    assert "<div" not in page("tasks/arms")
    assert "mujoco.MjSpec" in page("tasks/arms")
    for name in manual_pages():
        assert page(name)


def test_examples_are_listed_copied_and_run(capsys: Any, tmp_path: Path, monkeypatch: Any) -> None:
    assert main(["examples"]) == OK
    listed = capsys.readouterr().out
    assert set(example_files()) <= set(listed.split())
    assert "Ten cubes stand on each other" in listed
    assert main(["examples", "stacking", "--copy", str(tmp_path / "mine")]) == OK
    # With what it imports.
    assert sorted(file.name for file in (tmp_path / "mine").iterdir()) == ["camera.py", "stacking.py"]
    assert main(["examples", "--copy", str(tmp_path / "mine")]) == FAILED
    assert "is there already: nothing was copied" in capsys.readouterr().err
    monkeypatch.setattr("sys.argv", ["carom"])
    monkeypatch.setattr("sys.path", ["", *__import__("sys").path])
    assert main(["examples", "robot_info", "--headless"]) == OK
    assert capsys.readouterr().out
    assert main(["examples", "stakcing"]) == FAILED
    assert "did you mean 'stacking'" in capsys.readouterr().err


def test_the_overview_for_agents_names_every_page() -> None:
    written = (ROOT / "docs" / "llms.txt").read_text(encoding="utf-8")
    # After a change of a page: write `carom.cli.docs_command.overview()` to docs/llms.txt.
    assert written == overview()


def test_the_wheel_has_the_manual_and_the_examples() -> None:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except ImportError as missing:
        pytest.skip(f"needs Hatchling: {missing}")
    targets = {target for _, target in module._manual_and_examples()}
    assert {"carom/manual/contact.md", "carom/manual/llms.txt", "carom/manual/tutorials/pid.md"} <= targets
    assert "carom/examples/scripts/stacking.py" in targets
