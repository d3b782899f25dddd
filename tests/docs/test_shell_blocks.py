"""What the documentation says to type at a prompt exists: commands, options, targets, files, extras."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.docs.blocks import PAGES, ROOT, blocks
from tests.each import each

from carom.cli import command_line as cli

MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
# Programs of others, and scripts that readers have written themselves.
FOREIGN = {"bash", "git", "kill", "ray", "ssh", "twine"}
OF_READERS = {"panda.py", "first.py"}
_INLINE = re.compile(r"(?<!`)`((?:python |make |carom |pip install )[^`]*)`")


def commands() -> Iterator[tuple[str, str]]:
    """Pages, and what they say to type there."""
    for page in PAGES:
        name = str(page.relative_to(ROOT))
        for block in blocks(page):
            if block.language not in ("sh", "bash", "console"):
                continue
            lines = block.text.replace("\\\n", " ").splitlines()
            if block.language == "console":
                lines = [line[2:] for line in lines if line.startswith("$ ")]
            yield from ((name, line) for line in lines if line.strip())
        for inline in _INLINE.finditer(page.read_text(encoding="utf-8")):
            yield name, " ".join(inline[1].split())


@each(("page", "line"), sorted(set(commands())))
def test_what_is_to_be_typed_exists(page: str, line: str):
    words = [word for word in shlex.split(line, comments=True) if "=" not in word or word.startswith("-")]
    program, *arguments = words
    if program == "python" and arguments[:1] == ["-m"]:
        program, *arguments = arguments[1:]
    if program == "carom":
        understood_by_carom(arguments)
    elif program == "make":
        for target in arguments:
            assert re.search(rf"^{target}:", MAKEFILE, re.MULTILINE), target
    elif program == "python":
        understood_by_script(arguments)
    elif program == "pip":
        understood_by_pip(arguments)
    else:
        assert program in FOREIGN or module(program).exists(), line


def understood_by_carom(arguments: list[str]) -> None:
    """Fails if the command line does not take these words."""
    if len(arguments) > 1:
        cli._parser().parse_args(arguments)
        return
    # Only the name of a command is mentioned.
    with pytest.raises(SystemExit) as end:
        cli._parser().parse_args([*arguments, "--help"])
    assert end.value.code == 0


def understood_by_script(arguments: list[str]) -> None:
    """Fails if a script is not there or does not know an option."""
    script, *words = [word for word in arguments if word != "&"]
    if script == "-c":
        compile(words[0], script, "exec")
        return
    if script in OF_READERS:
        return
    path = ROOT / script if "/" in script else ROOT / "examples" / script
    known = path.read_text(encoding="utf-8")
    if "carom.examples.window" in known:
        known += (ROOT / "src/carom/examples/window.py").read_text(encoding="utf-8")
    for word in words:
        if word.startswith("--"):
            assert f'"{word.split("=")[0]}"' in known, word


def understood_by_pip(arguments: list[str]) -> None:
    """Fails if a folder or an extra is not there; other people's packages are theirs."""
    assert arguments[0] in ("install", "show", "uninstall")
    for word in arguments[1:]:
        found = re.fullmatch(r"(\.|carom)\[([\w,]+)\]", word)
        if found:
            extras = PROJECT.partition("[project.optional-dependencies]")[2].partition("\n[")[0]
            for extra in found[2].split(","):
                assert re.search(rf"^{extra} = ", extras, re.MULTILINE), word
        elif word.startswith("."):
            assert (ROOT / word / "pyproject.toml").exists(), word


def module(name: str) -> Path:
    """Where a module of the repository is, by its name."""
    paths = [root.joinpath(*name.split(".")) for root in (ROOT, ROOT / "src")]
    path = next((path for path in paths if path.is_dir()), paths[0])
    return path if path.is_dir() else path.with_suffix(".py")
