"""The reference pages of the modern API have every public name of every public class, and no other."""

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.each import each

import carom
import carom.algorithms
from carom.internal_names import INTERNAL

ROOT = Path(__file__).parents[2]
PAGES = ("carom.md", "worlds.md")

# Classes that users pass on and do not look into.
OPAQUE = {"SavedWorlds", "LinkDynamics"}
# Names of `carom` that are described elsewhere: by the pages about files, actuators and sensors.
ELSEWHERE = {"control", "__version__"}


def entries() -> Iterator[tuple[str, dict[str, Any]]]:
    """Paths and options of everything on the pages."""
    for page in PAGES:
        text = (ROOT / "docs" / "api" / page).read_text(encoding="utf-8")
        for path, options in re.findall(r"^::: (\S+)\n((?:    .*\n)*)", text, re.MULTILINE):
            found: dict[str, Any] = {}
            for name in ("members", "filters"):
                flow = re.search(rf"{name}: (\[.*\])", options)
                if flow and name == "filters":
                    found[name] = ast.literal_eval(flow[1])
                elif flow:
                    found[name] = [one.strip() for one in flow[1][1:-1].split(",") if one.strip()]
                elif f"{name}:" in options:
                    found[name] = re.findall(r"^ +- (\w+)$", options, re.MULTILINE)
            yield path, found


ENTRIES = dict(entries())


def resolved(path: str) -> Any:
    module, _, name = path.rpartition(".")
    return getattr(importlib.import_module(module), name)


CLASSES = {path: resolved(path) for path in ENTRIES if inspect.isclass(resolved(path))}


def of_class(kind: type) -> set[str]:
    """Public names that a class of Carom and its bases have, without those of its instances."""
    return {
        name
        for base in kind.__mro__
        if base.__module__.partition(".")[0] == "carom"
        for name in (*vars(base), *vars(base).get("__annotations__", {}))
        if name[0] != "_"
    }


def of_instances(kind: type) -> set[str]:
    """Public names that a class and its bases give their instances: `self.name = ...` in any method."""
    found = set()
    for base in kind.__mro__:
        if base.__module__.partition(".")[0] != "carom":
            continue
        source = Path(inspect.getfile(base)).read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ClassDef) and node.name == base.__name__:
                found |= {
                    item.attr
                    for item in ast.walk(node)
                    if isinstance(item, ast.Attribute)
                    and isinstance(item.ctx, ast.Store)
                    and isinstance(item.value, ast.Name)
                    and item.value.id == "self"
                    and item.attr[0] != "_"
                }
    return found


def listed_attributes(kind: type) -> set[str]:
    """Names under "Attributes:" in the docstrings of a class and its bases."""
    found: set[str] = set()
    for base in kind.__mro__:
        section = re.search(
            r"^Attributes:\n((?:(?:    .*)?\n?)*)", inspect.cleandoc(base.__doc__ or ""), re.M
        )
        if section is not None and base.__module__.startswith("carom"):
            found |= set(re.findall(r"^    (\w+):", section[1], re.MULTILINE))
    return found


def shown(path: str) -> set[str]:
    """What the page has of a class."""
    kind, options = CLASSES[path], ENTRIES[path]
    members = options.get("members")
    names = of_class(kind) if members is None else set(members)
    for pattern in options.get("filters", ()):
        names = {name for name in names if not re.search(pattern.removeprefix("!"), name)}
    return names | listed_attributes(kind)


@each("path", CLASSES)
def test_all_public_names_of_a_class_are_on_its_page_and_no_others(path: str) -> None:
    kind = CLASSES[path]
    if kind.__name__ in OPAQUE:
        assert ENTRIES[path]["members"] == []
        return
    public = of_class(kind) | of_instances(kind)
    internal = INTERNAL.get(kind.__name__, frozenset())
    assert internal <= public, "INTERNAL names what is not there"
    assert shown(path) == public - internal


def test_every_class_and_function_of_the_packages_is_on_a_page() -> None:
    on_pages = {path.rpartition(".")[2] for path in ENTRIES}
    descriptions = {
        name
        for name in carom.__all__
        if name not in ELSEWHERE and getattr(carom, name).__module__.startswith("carom.description")
    }
    expected = {*carom.__all__, *carom.algorithms.__all__} - ELSEWHERE - descriptions
    assert expected <= on_pages
