"""Signatures and texts of the builtins are what `inspect` makes of the Python functions behind them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from tests.each import each

import pybullet as p
from pybullet._calls.builtin import _documentation, _plain_signature, exports

assert p


def _everything(
    a: int, b: float = 1.5, /, c: str = "x", *rest: Any, d: int, e: Any = None, **more: Any
) -> None:
    """First line.

    Second line:
        indented.
    """


def _by_name(*, only: Any = ()) -> None: ...


def _two_kinds(a: int, *, b: int = -1) -> None: ...


def _without() -> None: ...


def _as_inspect_says(function: Callable[..., Any]) -> str:
    signature = inspect.signature(function)
    bare = [p.replace(annotation=inspect.Parameter.empty) for p in signature.parameters.values()]
    return str(signature.replace(parameters=bare, return_annotation=inspect.Signature.empty))


FUNCTIONS = [_everything, _by_name, _two_kinds, _without, *(export.function for export in exports.values())]


@each("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_signature_and_text(function: Callable[..., Any]) -> None:
    if function.__closure__ is None:
        assert _plain_signature(function) == _as_inspect_says(function)
    assert _documentation(function) == (inspect.getdoc(function) or "")
