"""Every page of the documentation is run: its code, block after block, as a reader would type it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.docs.blocks import PAGES, ROOT, blocks, to_run
from tests.patience import PATIENCE

PLAYED = [page for page in PAGES if to_run(page)]


def named(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", PLAYED, ids=named)
def test_the_code_of_a_page_runs(page: Path, tmp_path: Path):
    # Readers of the README are in a clone; windows open no browser; servers meet nobody else's clients.
    (tmp_path / "examples").symlink_to(ROOT / "examples", target_is_directory=True)
    told = {"CI": "1", "XDG_RUNTIME_DIR": str(tmp_path), "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT}"}
    done = subprocess.run(
        [sys.executable, "-m", "tests.docs.blocks", page],
        cwd=tmp_path,
        env=os.environ | told,
        capture_output=True,
        text=True,
        timeout=10 * PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


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
