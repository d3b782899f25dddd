"""Every page of the documentation is followed as a stranger would: its code, its scripts and its commands."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from tests.docs.as_printed import FIRST_STEPS, TUTORIALS, Step, failure, failures, steps
from tests.docs.blocks import PAGES, ROOT, blocks, run_blocks

PLAYED = [page for page in PAGES if run_blocks(page)]
# Carom from the sources, and what follows the pages.
HERE = f"{ROOT / 'src'}{os.pathsep}{ROOT}"


def test_the_first_steps_work_as_printed(tmp_path: Path):
    assert failures(FIRST_STEPS, tmp_path, path=HERE) == []
    assert {"panda.py", "first.py", "first.html", "ant.urdf"} >= {
        path.name for path in tmp_path.iterdir()
    } - {"carom"}
    assert (tmp_path / "first.html").stat().st_size > 100_000


def test_a_step_that_fails_is_told(tmp_path: Path):
    (tmp_path / "wrong.py").write_text("print('so far')\nimport no_such_module\n", encoding="utf-8")
    step = Step(FIRST_STEPS[0], "wrong.py", ("-m", "tests.docs.bounded", "wrong.py"))
    told = failure(step, Path(sys.executable), tmp_path, HERE)
    assert (
        told is not None and told.startswith("README.md: wrong.py: 1\nso far\n") and "no_such_module" in told
    )


def test_every_script_of_a_page_has_the_name_of_its_example():
    named = [(block.example, block.title) for page in PAGES for block in blocks(page) if block.example]
    assert len(named) > 30
    assert [pair for pair in named if pair[1] != f"{pair[0]}.py"] == []


def test_nothing_that_pages_need_is_hidden():
    """Set-up that readers do not see, and files that only a clone has."""
    pages = [*FIRST_STEPS, *TUTORIALS]
    assert [page.name for page in pages for block in blocks(page) if block.first] == []
    scripts = [block for page in pages for block in blocks(page) if block.title is not None]
    assert [block.title for block in scripts if re.search(r"__file__|from _window", block.code)] == []


@pytest.mark.long
def test_tutorials_work_as_printed(tmp_path: Path):
    assert failures(TUTORIALS, tmp_path, path=HERE) == []


@pytest.mark.long
def test_everything_works_as_printed_with_an_installed_wheel(tmp_path: Path):
    wheels = pytest.importorskip("tools.wheels.build")
    pytest.importorskip("warp", reason="it builds the wheel")
    from carom.native.targets import this_target

    wheel = wheels.build_wheel(this_target(), tmp_path)
    environment = tmp_path / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
    python = environment / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", python, "--quiet", "install"]
    subprocess.run([*pip, "--no-deps", "--no-index", wheel], check=True)
    # What Carom requires is taken from here; an editable installation does not come with it in this way.
    (packages,) = (environment / "lib").glob("*/site-packages")
    others = [path for path in sys.path if path.endswith("site-packages")]
    (packages / "others.pth").write_text("".join(f"{path}\n" for path in others), encoding="utf-8")
    folder = tmp_path / "empty"
    folder.mkdir()
    assert failures([*FIRST_STEPS, *TUTORIALS], folder, python, str(ROOT)) == []


@pytest.mark.long
def test_the_code_of_all_other_pages_runs(tmp_path: Path):
    told = []
    for number, page in enumerate(page for page in PLAYED if page not in {*FIRST_STEPS, *TUTORIALS}):
        folder = tmp_path / str(number)
        folder.mkdir()
        (step,) = [step for step in steps(page) if step.name == "blocks"]
        told.append(failure(step, Path(sys.executable), folder, HERE))
    assert [problem for problem in told if problem is not None] == []


def test_most_pages_with_code_are_run():
    skipped = [block.reason for page in PAGES for block in blocks(page) if block.reason is not None]
    assert len(PLAYED) >= 12
    assert len(skipped) <= 6
    assert all(len(reason) > 10 for reason in skipped)


def test_every_example_on_a_page_has_a_test():
    tests = "".join(
        file.read_text(encoding="utf-8")
        for folder in ("examples", "viewer", "cluster", "vector")
        for file in (ROOT / "tests" / folder).glob("*.py")
    )
    shown = {block.example for page in PAGES for block in blocks(page) if block.example is not None}
    assert len(shown) > 20
    assert [name for name in sorted(shown) if f'"{name}"' not in tests and f"{name}.py" not in tests] == []
