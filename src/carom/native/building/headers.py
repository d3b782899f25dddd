"""The header `layouts.h`: what the library's hand-written C++ shares with Python, as declared there.

It has the records of `carom.layouts`, with assertions that their sizes and places are those that Python uses,
and the constants and codes of some of its modules, each in a namespace of the module's name.
"""

from __future__ import annotations

import ctypes
import re
import textwrap
from collections.abc import Iterator
from enum import IntEnum
from inspect import cleandoc
from types import ModuleType
from typing import Any

from carom.layouts import (
    codes,
    contacts,
    gates,
    hulls,
    magnitudes,
    motor_commands,
    programs,
    queries,
    status,
    table_rows,
)
from carom.layouts.dynamics_parameters import CHANGE_DYNAMICS, OF_BODY, SURFACE
from carom.layouts.quick import bodies as quick_bodies
from carom.layouts.quick import calls as quick_calls
from carom.layouts.quick import world as quick_world
from carom.layouts.quick.calls import NUMBERS_OF_KIND
from carom.layouts.records import CType, Record

HEADER = "layouts.h"

_CONSTANTS = (codes, contacts, motor_commands, status, magnitudes, queries)
_RECORDS = (contacts, gates, hulls, programs, table_rows, quick_world, quick_bodies, quick_calls)
# Structs that kernels and hand-written C++ share.
_SHARED_WITH_KERNELS = (contacts.Candidate,)
_INTRODUCTION = f"""\
// Records, constants and codes of `carom.layouts`. Written by `{__name__}`; changes belong there.
#pragma once

#include <stdint.h>

#include "functions.h"
"""
_WIDTH = 118


def header() -> str:
    """The header."""
    parts = [_INTRODUCTION]
    parts += [_namespace(module.__name__, _constants(module)) for module in _CONSTANTS]
    for module in _RECORDS:
        parts += [_enum(kind) for kind in _of(module, IntEnum)]
        if module not in _CONSTANTS:
            parts.append("\n".join(_constants(module)))
        parts += [_record(kind) for kind in _of(module, Record)]
        parts += [_record(kind) for kind in _SHARED_WITH_KERNELS if kind.__module__ == module.__name__]
    parts.append(_namespace("change_dynamics", _change_dynamics()))
    return "\n".join(part for part in parts if part) + "\n"


def _of(module: ModuleType, base: type) -> list[Any]:
    """The subclasses of a class that a module outside `_CONSTANTS` declares."""
    if module in _CONSTANTS:
        return []
    kinds = (kind for kind in vars(module).values() if isinstance(kind, type))
    return [kind for kind in kinds if issubclass(kind, base) and kind.__module__ == module.__name__]


def _namespace(name: str, lines: Iterator[str]) -> str:
    inside = "\n".join(lines)
    return f"namespace {name.rpartition('.')[2]} {{\n{inside}\n}}\n"


def _constants(module: ModuleType) -> Iterator[str]:
    """Whole and real numbers with names in capitals."""
    for name, value in vars(module).items():
        if name.isupper() and not name.startswith("_") and type(value) in (int, float):
            kind = "double" if isinstance(value, float) else "int32_t"
            yield f"constexpr {kind} {name} = {value!r};"


def _enum(kind: Any) -> str:
    members = ", ".join(f"{member.name} = {member.value}" for member in kind)
    return f"{_comment(kind.__doc__)}\nenum {kind.__name__} {{ {members} }};\n"


def _record(kind: Any) -> str:
    name, fields = kind.__name__, kind.fields
    declared = [f"    {_declaration(field_name, field)};" for field_name, field in fields.items()]
    checks = [f'static_assert(sizeof({name}) == {ctypes.sizeof(kind)}, "size of {name}");']
    for field in fields:
        offset = getattr(kind, field).offset
        checks.append(
            f'static_assert(__builtin_offsetof({name}, {field}) == {offset}, "place of {name}.{field}");'
        )
    return "\n".join([_comment(kind.__doc__), f"struct {name} {{", *declared, "};", *checks, ""])


def _declaration(name: str, field: Any) -> str:
    if isinstance(field, CType):
        lengths = "".join(f"[{length}]" for length in field.lengths)
        return f"{field.name} {name}{lengths}"
    if isinstance(field, type):
        return f"{field.__name__} {name}"
    # A type of kernels.
    scalar = {"int32": "int32_t", "float64": "double"}[field.scalar]
    return f"{scalar} {name}" + "".join(f"[{length}]" for length in field.shape)


def _comment(docstring: str | None) -> str:
    lines = cleandoc(docstring or "").splitlines()
    wrapped = (textwrap.wrap(line, _WIDTH - 3, subsequent_indent="    ") or [""] for line in lines)
    return "\n".join(f"// {line}".rstrip() for group in wrapped for line in group)


def _change_dynamics() -> Iterator[str]:
    """Indices of the arguments of `changeDynamics` among its numbers, and of those that belong together."""
    place = 0
    for name, kind in CHANGE_DYNAMICS.items():
        yield f"constexpr int {_in_capitals(name)} = {place};"
        place += NUMBERS_OF_KIND[kind]
    surface, of_body = [[name.upper() for name in names] for names in (SURFACE, OF_BODY)]
    numbers = [_in_capitals(name) for name, kind in CHANGE_DYNAMICS.items() if kind in "ri"]
    handled = {"LINK_INDEX", "MASS", *surface, *of_body}
    others = [name for name in numbers if name not in handled]
    for group, names in {"OF_SURFACE": surface, "OF_BODY": of_body, "OTHERS": others}.items():
        yield f"constexpr int {group}[] = {{{', '.join(names)}}};"


def _in_capitals(name: str) -> str:
    return re.sub(r"([A-Z])", r"_\1", name).upper()
