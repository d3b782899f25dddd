"""Extras that pages, examples and messages tell users to install are those of pyproject.toml, and quoted."""

import re
import shlex
from collections.abc import Iterator
from functools import cache

from tests.docs.blocks import PAGES, ROOT
from tests.each import each

PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
FILES = sorted(
    [
        *PAGES,
        *ROOT.glob("*.md"),
        *(path for folder in ("src", "examples") for path in (ROOT / folder).rglob("*.py")),
    ]
)
# What follows `pip install` there, up to the end of the code, of the text in Python, or of the line.
_COMMAND = re.compile(r"pip install ((?:'[^'\n]*'|[^'\"`\n<])*)")
_EXTRAS = re.compile(r"(?:\.|carom)\[([\w,]+)\]")
# Extras that `all` leaves out: large ones, those for one other program, and what developers need.
NOT_IN_ALL = {"foxglove", "mcap", "rerun", "train", "ray", "gpu", "usd", "build"}


@cache
def extras() -> dict[str, str]:
    """The extras of pyproject.toml, and what is written in their lists."""
    table = PROJECT.partition("[project.optional-dependencies]")[2].partition("\n[")[0]
    return dict(re.findall(r"^(\w+) = \[(.*?)\]$", table, re.MULTILINE | re.DOTALL))


def commands() -> Iterator[tuple[str, str]]:
    """Files, and what they say to install by pip; only commands with brackets."""
    for path in set(FILES):
        for found in _COMMAND.finditer(path.read_text(encoding="utf-8")):
            if "[" in found[1]:
                yield path.relative_to(ROOT).as_posix(), found[1].strip()


COMMANDS = sorted(set(commands()))


def test_there_are_commands_with_extras():
    assert len(COMMANDS) > 20


@each(("file", "command"), COMMANDS)
def test_extras_exist_and_are_quoted(file: str, command: str):
    # Shells such as zsh take brackets without quotes for a pattern of file names.
    assert "[" not in re.sub(r"'[^']*'", "", command).partition("#")[0], command
    for word in shlex.split(command, comments=True):
        found = _EXTRAS.fullmatch(word)
        if found:
            assert set(found[1].split(",")) <= set(extras()), command


def test_the_page_about_installing_has_all_extras():
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    table = page.partition("\n## Extras\n")[2].partition("\n## ")[0]
    assert sorted(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == sorted(extras())


def test_the_page_counts_what_all_brings():
    (found,) = re.findall(r"carom\[([\w,]+)\]", extras()["all"])
    words = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight")
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    assert f"| `all` | the {words[len(found.split(','))]} above |" in page
    assert set(re.findall(r"^\| `(\w+)` \|", page.partition("| `all` |")[0], re.MULTILINE)) == set(
        found.split(",")
    )


def test_all_is_all_but_what_is_large_or_for_developers():
    (found,) = re.findall(r"carom\[([\w,]+)\]", extras()["all"])
    assert set(found.split(",")) == set(extras()) - NOT_IN_ALL - {"all"}
