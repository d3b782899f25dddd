"""`python -m carom docs`: the manual in a terminal."""

from __future__ import annotations

import argparse
import importlib
import inspect
import re
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from carom.cli.shipped import example_files, manual_pages
from carom.internal_names import INTERNAL

_SNIPPET = re.compile(r'^--8<-- "examples/(\w+)\.py"$')
_PACKAGES = ("carom", "pybullet", "pybullet_envs", "pybullet_data")
_OBJECT = re.compile(r"^::: (\S+)$")
_LAYOUT = re.compile(r"^</?div\b[^>]*>$")


def add_docs(commands: Any) -> None:
    """Add the command to those of the command line.

    Args:
        commands: What `ArgumentParser.add_subparsers` returned.
    """
    parser = commands.add_parser("docs", help="print a page of the manual, or search it")
    parser.add_argument("topic", nargs="?", help="the page, such as contact; without it all are listed")
    parser.add_argument(
        "--search", nargs="+", metavar="WORD", help="print the lines with all of these words instead"
    )
    parser.set_defaults(command=_docs)


def _docs(options: argparse.Namespace) -> None:
    pages = manual_pages()
    if options.search is not None:
        _search(pages, " ".join(options.search))
    elif options.topic is None:
        print(contents())
    else:
        print(page(options.topic))


def page(topic: str) -> str:
    """A page of the manual with the scripts and the reference that it shows, or what is said of one name.

    Args:
        topic: The name of the page, with or without the folder; or a class, a method or a function, such as
            "carom.Worlds.images".

    Raises:
        ValueError: There is no such page; the message names the nearest.
    """
    pages = manual_pages()
    if (said := _of_one_name(topic)) is not None:
        return said
    topic = topic.removesuffix(".md").lower()
    found = [name for name in pages if name == topic] or [
        name for name in pages if name.rpartition("/")[2] == topic
    ]
    if not found:
        near = get_close_matches(topic, [*pages, *(name.rpartition("/")[2] for name in pages)], 3, 0.4)
        similar = f"; did you mean {', '.join(near)}?" if near else ""
        raise ValueError(
            f"there is no page {topic!r}{similar} `python -m carom docs` lists them, and "
            "`python -m carom docs --search WORDS` searches them"
        )
    return "\n".join(_lines(pages[found[0]]))


def _of_one_name(path: str) -> str | None:
    """What is said of a class, a method or a function; None if there is none of this name."""
    package, *names = path.split(".")
    if package not in _PACKAGES or not names:
        return None
    it: Any = importlib.import_module(package)
    for name in names:
        it = getattr(it, name, None)
        if it is None:
            return None
    if inspect.isclass(it):
        return "\n".join(_entry(path, it))
    return f"## {path}{_signature(it)}\n\n{inspect.getdoc(it) or ''}"


def contents() -> str:
    """All pages with their titles, and how to read one."""
    pages = manual_pages()
    width = max(map(len, pages))
    listed = [f"{name:{width}}  {title(file)}" for name, file in pages.items()]
    how = (
        "python -m carom docs TOPIC prints a page, or what is said of one name, such as carom.Worlds.images;",
        "--search WORDS searches all pages.",
    )
    return "\n".join([*listed, "", *how])


def title(file: Path) -> str:
    """The title of a page."""
    text = file.read_text(encoding="utf-8")
    found = re.search(r"^# (.+)$", text, re.MULTILINE)
    return file.stem if found is None else found[1]


def overview() -> str:
    """The text of `llms.txt`: what Carom is, and each page with its first sentence."""
    lines = [
        "# Carom",
        "",
        "> A robot simulator for Python: a drop-in `pybullet`, and a modern API, `carom`, for one world and "
        "for many at once.",
        "",
        "In a terminal, without a network: `python -m carom docs` lists the pages below, "
        "`python -m carom docs TOPIC` prints one, `python -m carom docs --search WORDS` searches them, and "
        "`python -m carom examples` lists scripts that run.",
        "",
        "## Pages",
        "",
    ]
    for name, file in manual_pages().items():
        lines.append(f"- [{title(file)}]({name}.md): {_first_sentence(file)}")
    return "\n".join([*lines, ""])


def _first_sentence(file: Path) -> str:
    """The first sentence of a page that is prose."""
    prose = re.sub(r"^```.*?^```$", "", file.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    for block in re.split(r"\n\s*\n", prose):
        text = " ".join(block.split())
        if text and text[0] not in "#<|`!*-:[" and not text.startswith("---"):
            sentence = re.split(r"(?<=[.:])\s", text)[0].rstrip(":")
            return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", sentence)
    return title(file) + "."


def _lines(file: Path) -> Iterator[str]:
    """The lines of a page, with what is included."""
    scripts = example_files()
    skipping = False
    for line in file.read_text(encoding="utf-8").splitlines():
        # Options of the entry before.
        skipping = skipping and line.startswith("    ")
        if skipping or _LAYOUT.match(line):
            continue
        snippet, entry = _SNIPPET.match(line), _OBJECT.match(line)
        if snippet is not None and snippet[1] in scripts:
            yield scripts[snippet[1]].read_text(encoding="utf-8").rstrip()
        elif entry is not None:
            skipping = True
            yield from _reference(entry[1])
        else:
            yield line


def _reference(path: str) -> Iterator[str]:
    """What is said of a class, a function or a module, and of the members of a class."""
    module, _, name = path.rpartition(".")
    try:
        it = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError):
        try:
            it = importlib.import_module(path)
        except ImportError as missing:
            yield f"{path}: {missing}"
            return
    yield from _entry(path, it)


def _entry(path: str, it: Any) -> Iterator[str]:
    yield f"## {path}{_signature(it)}"
    yield ""
    yield inspect.getdoc(it) or ""
    if not inspect.isclass(it):
        return
    for member in _members(it):
        own = inspect.getattr_static(it, member)
        says = inspect.getdoc(own.fget if isinstance(own, property) else getattr(it, member, own)) or ""
        yield f"- {member}{_signature(getattr(it, member, own))}: {says.partition(chr(10))[0]}"


def _members(kind: type) -> list[str]:
    """Names of a class for users: not those for other packages, nor those of tuples, arrays and the like."""
    hidden: set[str] = set()
    for base in kind.__mro__:
        hidden |= INTERNAL.get(base.__name__, frozenset())
        if base.__module__.partition(".")[0] not in _PACKAGES:
            hidden |= set(vars(base)) - set(vars(kind))
    return sorted(name for name in dir(kind) if name[0] != "_" and name not in hidden)


def _signature(it: Any) -> str:
    try:
        return str(inspect.signature(it)) if callable(it) else ""
    except (TypeError, ValueError):
        return ""


def _search(pages: dict[str, Path], words: str) -> None:
    """Print the lines with all of some words, or, if there are none, the pages with all of them."""
    wanted = words.lower().split()
    texts = {name: file.read_text(encoding="utf-8") for name, file in pages.items()}
    found = [
        f"{name}:{number}: {line.strip()}"
        for name, text in texts.items()
        for number, line in enumerate(text.splitlines(), start=1)
        if all(word in line.lower() for word in wanted)
    ]
    if not found:
        found = [f"{name}: {title(pages[name])}" for name, text in texts.items() if _has(text, wanted)]
    if not found:
        raise ValueError(f"no page of the manual has {words!r}")
    print("\n".join(found))


def _has(text: str, words: list[str]) -> bool:
    return all(word in text.lower() for word in words)
