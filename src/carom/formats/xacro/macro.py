"""Macros: their parameters, and the values and blocks that a call gives them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from carom.files.xml_element import Element
from carom.formats.xacro.limits import ExpressionError

_DEFAULT = r"""(?:\$\{[^}]*\}|\$\([^)]*\)|'[^']*'|"[^"]*"|[^\s'"$]|\$(?!\{[^}]*\}|\([^)]*\)))*"""
_PARAMETER = re.compile(
    rf"\s*(?P<name>\*{{0,2}}[^\s:=*]+)(?:\s*:?=\s*(?P<forward>\^\|?)?(?P<default>{_DEFAULT}))?(?=\s|$)"
)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a macro.

    Attributes:
        name: Its name, without asterisks.
        stars: 0 for a value; 1 for a block, an element of the call; 2 for the content of one.
        default: The text of its default; None without one.
        is_forwarded: The call's own scope gives the value if it has one of this name.
    """

    name: str
    stars: int = 0
    default: str | None = None
    is_forwarded: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Macro:
    """A macro.

    Attributes:
        name: Its name.
        parameters: Its parameters, in order.
        element: The element that defines it; its children are the body.
        file: The file that contains it.
    """

    name: str
    parameters: tuple[Parameter, ...]
    element: Element
    file: Path


def parse_parameters(text: str) -> tuple[Parameter, ...]:
    """The parameters that the attribute `params` states.

    Raises:
        ExpressionError: It is malformed, or names one twice.
    """
    parameters: list[Parameter] = []
    at = 0
    while text[at:].strip():
        match = _PARAMETER.match(text, at)
        if match is None:
            raise ExpressionError(f"params is malformed at {text[at:].strip()[:60]!r}")
        at = match.end()
        name = match["name"].lstrip("*")
        stars = len(match["name"]) - len(name)
        default = match["default"]
        if match["forward"] == "^":
            # Only `^|` has a default behind it.
            default = None if default == "" else default
        if stars and default is not None:
            raise ExpressionError(f"the block {name!r} can have no default")
        if any(name == other.name for other in parameters):
            raise ExpressionError(f"params names {name!r} twice")
        parameters.append(Parameter(name, stars, default, match["forward"] is not None))
    return tuple(parameters)
