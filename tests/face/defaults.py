"""The defaults of everything public, as text: what a script gets that leaves an argument out.

`python -m tests.face.defaults` writes them to `defaults.txt`.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from dataclasses import is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any

from tests.face.scene import made
from tests.face.test_names import PARTS

from carom import Worlds
from carom.internal_names import INTERNAL
from carom.viewer import Viewer

RECORDED = Path(__file__).with_name("defaults.txt")
_MODULES = (
    "carom",
    *(f"carom.{name}" for name in ("algorithms", "control", "controllers", "identification")),
)
_PLAIN = (bool, int, float, str, Enum)


def defaults() -> list[str]:
    """Arguments of public functions and methods whose defaults are numbers, truths or words, one a line."""
    return sorted({line for name, value in _public() for line in _of(name, value)})


def _public() -> Iterator[tuple[str, Any]]:
    for module in map(import_module, _MODULES):
        for name in module.__all__:
            value = getattr(module, name)
            if inspect.isclass(value) or inspect.isfunction(value):
                yield name, value
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    for part in (
        worlds,
        world.parameters,
        *(find(one) for find in PARTS.values() for one in (arm, worlds[arm])),
    ):
        yield type(part).__name__, type(part)
    yield "Viewer", Viewer


def _of(name: str, value: Any) -> Iterator[str]:
    yield from _line(name, value)
    for member in dir(value) if inspect.isclass(value) else ():
        if member[0] != "_" and member not in INTERNAL.get(name, ()):
            function = inspect.getattr_static(value, member)
            if isinstance(function, classmethod | staticmethod):
                function = function.__func__
            if inspect.isfunction(function):
                yield from _line(f"{name}.{member}", function)


def _line(name: str, function: Any) -> Iterator[str]:
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:
        # Exceptions have none.
        return
    for each in parameters:
        if _is_plain(each.default):
            yield f"{name}: {each.name}={_shown(each.default)}"


def _is_plain(value: Any) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_plain, value))
    return isinstance(value, _PLAIN) or is_dataclass(value)


def _shown(value: Any) -> str:
    return repr(value.value if isinstance(value, Enum) else value)


if __name__ == "__main__":
    RECORDED.write_text("\n".join(defaults()) + "\n", encoding="utf-8")
