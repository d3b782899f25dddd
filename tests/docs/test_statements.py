"""What the documentation says of the code is what the code says."""

import runpy
from pathlib import Path

from carom.cli.command_line import main

ROOT = Path(__file__).parents[2]


def test_the_pages_about_the_drop_in_are_up_to_date():
    generator = runpy.run_path(str(ROOT / "tools" / "docs" / "drop_in.py"))
    for path, page in generator["PAGES"].items():
        assert path.read_text(encoding="utf-8") == page(), "run: python tools/docs/drop_in.py"


def test_every_tutorial_shows_an_example_that_exists_and_every_example_is_shown():
    pages = "".join(
        page.read_text(encoding="utf-8")
        for folder in ("tutorials", "tasks")
        for page in (ROOT / "docs" / folder).glob("*.md")
    )
    for example in (ROOT / "examples").glob("*.py"):
        if example.stem != "demo":
            assert f'--8<-- "examples/{example.name}"' in pages


def test_the_table_on_the_command_line_page_is_what_the_command_prints(capsys):
    main(["info", "cartpole.urdf"])
    written = (ROOT / "docs" / "api" / "cartpole.txt").read_text(encoding="utf-8")
    assert written == capsys.readouterr().out, (
        "run: python -m carom info cartpole.urdf > docs/api/cartpole.txt"
    )
