"""`python -m carom examples`: lists, copies and runs the examples."""

from __future__ import annotations

import argparse
import ast
import runpy
import shutil
import sys
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from carom.cli.shipped import example_files


def add_examples(commands: Any) -> None:
    """Add the command to those of the command line.

    Args:
        commands: What `ArgumentParser.add_subparsers` returned.
    """
    parser = commands.add_parser("examples", help="list, copy and run the examples")
    parser.add_argument("name", nargs="?", help="the example to run; without it they are listed")
    parser.add_argument(
        "--copy", type=Path, metavar="FOLDER", help="copy the example, or all of them, instead of running it"
    )
    parser.add_argument(
        "arguments", nargs=argparse.REMAINDER, help="arguments of the example, such as --headless"
    )
    parser.set_defaults(command=_examples)


def _examples(options: argparse.Namespace) -> None:
    files = example_files()
    name, copy, arguments = options.name, options.copy, list(options.arguments)
    if name is not None:
        name = name.removesuffix(".py")
        if name not in files:
            near = get_close_matches(name, files, 1)
            similar = f"; did you mean {near[0]!r}?" if near else ""
            raise ValueError(f"there is no example {name!r}{similar} `python -m carom examples` lists them")
    if copy is None and arguments[:1] == ["--copy"] and len(arguments) == 2:
        copy = Path(arguments[1])
    if copy is not None:
        _copy(files, name, copy)
    elif name is None:
        width = max(map(len, files))
        for each, file in files.items():
            print(f"{each:{width}}  {summary(file)}")
    else:
        _run(files[name], arguments)


def summary(file: Path) -> str:
    """What a script says of itself in its first line."""
    return (ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or "").partition("\n")[0]


def _copy(files: dict[str, Path], name: str | None, folder: Path) -> None:
    """Copy an example with those that it imports, or all; files that are there stay as they are."""
    wanted = [*files] if name is None else _needed(files, name)
    there = [each for each in wanted if (folder / f"{each}.py").exists()]
    if there:
        raise FileExistsError(f"{folder / there[0]}.py is there already: nothing was copied")
    folder.mkdir(parents=True, exist_ok=True)
    for each in wanted:
        shutil.copyfile(files[each], folder / f"{each}.py")
        print(folder / f"{each}.py")


def _needed(files: dict[str, Path], name: str) -> list[str]:
    """An example and the others that it imports."""
    found, pending = [], [name]
    while pending:
        each = pending.pop()
        if each in found:
            continue
        found.append(each)
        for node in ast.walk(ast.parse(files[each].read_text(encoding="utf-8"))):
            modules = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            pending += [module for module in modules if module in files]
    return sorted(found)


def _run(file: Path, arguments: list[str]) -> None:
    """Run a script as `python FILE ARGUMENTS` does."""
    sys.argv = [str(file), *arguments]
    sys.path.insert(0, str(file.parent))
    runpy.run_path(str(file), run_name="__main__")
