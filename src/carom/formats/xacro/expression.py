"""Evaluation of expressions in Python's syntax: a chosen part of it, none of which reaches the system."""

from __future__ import annotations

import ast
import difflib
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from carom.formats.xacro.functions import NAMES, Namespace, check_call, method
from carom.formats.xacro.limits import (
    MAX_BITS,
    MAX_EXPRESSION,
    MAX_NESTING,
    Allowance,
    ExpressionError,
    check_length,
)
from carom.formats.xacro.values import Value, checked, size_of

_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
}
_UNARY: dict[type, Callable[[Any], Any]] = {
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
}
_COMPARE: dict[type, Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
}
# Fields of up to two digits: wider ones would make long texts of nothing.
_FORMAT = re.compile(r"%(?:%|[-+ #0]*\d{0,2}(?:\.\d{0,2})?[diouxXeEfFgGcsr])")
_SEQUENCES = (str, list, tuple)
# Nodes that give out what is there already.
_ACCESSES = (ast.Name, ast.Attribute, ast.Subscript)
_LIST_COST = 8
_FAILURES = (TypeError, ValueError, ArithmeticError, LookupError, RecursionError, AttributeError)


def evaluate(text: str, names: Mapping[str, Value], budget: Allowance) -> Value:
    """The value of an expression; `names` count before functions and constants.

    Arithmetic, comparisons, `and`, `or`, `not`, `if` and `else`, indices and slices, lists, tuples, dicts,
    comprehensions, and calls of the functions in `carom.formats.xacro.functions`.

    Raises:
        ExpressionError: It is no such expression, fails, or takes too long.
    """
    if len(text) > MAX_EXPRESSION:
        raise ExpressionError(f"an expression longer than {MAX_EXPRESSION} characters")
    if not text.strip():
        raise ExpressionError("an expression is empty")
    try:
        tree = ast.parse(f"({text.strip()}\n)", mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ExpressionError(f"{text.strip()[:80]!r} is no expression") from None
    try:
        return _Evaluation(names, budget).value(tree.body)
    except ExpressionError as error:
        raise ExpressionError(f"in {text.strip()[:80]!r}: {error}") from None
    except _FAILURES as error:
        raise ExpressionError(f"{text.strip()[:80]!r} fails: {error}") from None


class _Evaluation:
    """The evaluation of one expression."""

    def __init__(self, names: Mapping[str, Value], budget: Allowance) -> None:
        self.names = names
        self.budget = budget
        self.locals: dict[str, Value] = {}
        self.depth = 0

    def value(self, node: ast.expr) -> Value:
        """The value of a node."""
        handler = _HANDLERS.get(type(node))
        if handler is None:
            raise ExpressionError(f"{type(node).__name__} is not accepted in expressions")
        if self.depth >= MAX_NESTING:
            raise ExpressionError(f"operations nested deeper than {MAX_NESTING}")
        self.depth += 1
        result = handler(self, node)
        self.depth -= 1
        if type(node) not in _ACCESSES:
            self._charge(result)
        return result

    def _charge(self, *values: Value) -> None:
        """Count an operation that makes or goes through these values."""
        for value in values:
            if isinstance(value, (list, tuple, dict)):
                self.budget.step(_LIST_COST * size_of(value))
            else:
                self.budget.step(len(value) if isinstance(value, str) else 0)

    def constant(self, node: ast.Constant) -> Value:
        if isinstance(node.value, (bytes, complex)) or node.value is ...:
            raise ExpressionError(f"{node.value!r} is not accepted in expressions")
        return checked(node.value)

    def name(self, node: ast.Name) -> Value:
        name = node.id
        if name in self.locals:
            return self.locals[name]
        if name in self.names:
            return self.names[name]
        if name in NAMES:
            return NAMES[name]
        close = difflib.get_close_matches(name, [*self.names, *NAMES], 1)
        hint = f"; did you mean {close[0]!r}?" if close else ""
        raise ExpressionError(f"the name {name!r} is not defined{hint}")

    def attribute(self, node: ast.Attribute) -> Value:
        owner = self.value(node.value)
        if isinstance(owner, dict) and node.attr in owner:
            return owner[node.attr]
        if isinstance(owner, Namespace):
            raise ExpressionError(f"{ast.unparse(node)[:60]!r} is not defined")
        self._charge(owner)
        return method(owner, node.attr)

    def unary(self, node: ast.UnaryOp) -> Value:
        return checked(_UNARY[type(node.op)](self.value(node.operand)))

    def binary(self, node: ast.BinOp) -> Value:
        work = _BINARY.get(type(node.op))
        if work is None:
            raise ExpressionError(f"{type(node.op).__name__} is not accepted in expressions")
        left, right = self.value(node.left), self.value(node.right)
        _check_operands(node.op, left, right)
        return checked(work(left, right))

    def boolean(self, node: ast.BoolOp) -> Value:
        stops = isinstance(node.op, ast.Or)
        result: Value = None
        for part in node.values:
            result = self.value(part)
            if bool(result) is stops:
                break
        return result

    def comparison(self, node: ast.Compare) -> bool:
        left = self.value(node.left)
        for kind, part in zip(node.ops, node.comparators, strict=True):
            right = self.value(part)
            self._charge(left, right)
            if not _COMPARE[type(kind)](left, right):
                return False
            left = right
        return True

    def conditional(self, node: ast.IfExp) -> Value:
        return self.value(node.body if self.value(node.test) else node.orelse)

    def sequence(self, node: ast.List | ast.Tuple) -> Value:
        values = [self.value(entry) for entry in node.elts]
        return tuple(values) if isinstance(node, ast.Tuple) else values

    def mapping(self, node: ast.Dict) -> dict[Value, Value]:
        result = {}
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                raise ExpressionError("** is not accepted in expressions")
            result[self.value(key)] = self.value(value)
        return result

    def item(self, node: ast.Subscript) -> Value:
        owner = self.value(node.value)
        if not isinstance(owner, (*_SEQUENCES, dict)):
            raise ExpressionError(f"a {type(owner).__name__} has no items")
        if isinstance(node.slice, ast.Slice):
            self._charge(owner)
            ends = (node.slice.lower, node.slice.upper, node.slice.step)
            return owner[slice(*(None if end is None else self.value(end) for end in ends))]
        key = self.value(node.slice)
        try:
            return owner[key]
        except KeyError:
            known = ", ".join(map(str, list(owner)[:8]))
            raise ExpressionError(f"there is no {key!r}; there are {known or 'none'}") from None

    def call(self, node: ast.Call) -> Value:
        function = self.value(node.func)
        arguments: list[Value] = []
        for part in node.args:
            if isinstance(part, ast.Starred):
                arguments += self.value(part.value)
            else:
                arguments.append(self.value(part))
        named: dict[str, Value] = {}
        for keyword in node.keywords:
            if keyword.arg is None or keyword.arg == "key":
                raise ExpressionError("** and key= are not accepted in expressions")
            named[keyword.arg] = self.value(keyword.value)
        check_call(function, [*arguments, *named.values()])
        self._charge(*arguments, *named.values())
        return checked(function(*arguments, **named))

    def comprehension(self, node: ast.ListComp | ast.GeneratorExp) -> list[Value]:
        result: list[Value] = []
        before = dict(self.locals)
        self._loop(node.generators, lambda: result.append(self.value(node.elt)))
        self.locals = before
        return result

    def _loop(self, generators: list[ast.comprehension], inner: Callable[[], None]) -> None:
        if not generators:
            inner()
            return
        first, *others = generators
        values = self.value(first.iter)
        self._charge(values)
        for entry in list(values):
            self._assign(first.target, entry)
            if all(self.value(condition) for condition in first.ifs):
                self._loop(others, inner)

    def _assign(self, target: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Name):
            self.locals[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            for part, entry in zip(target.elts, value, strict=True):
                self._assign(part, entry)
        else:
            raise ExpressionError("a comprehension assigns to names only")


_HANDLERS: dict[type, Callable[[_Evaluation, Any], Value]] = {
    ast.Constant: _Evaluation.constant,
    ast.Name: _Evaluation.name,
    ast.Attribute: _Evaluation.attribute,
    ast.UnaryOp: _Evaluation.unary,
    ast.BinOp: _Evaluation.binary,
    ast.BoolOp: _Evaluation.boolean,
    ast.Compare: _Evaluation.comparison,
    ast.IfExp: _Evaluation.conditional,
    ast.List: _Evaluation.sequence,
    ast.Tuple: _Evaluation.sequence,
    ast.Dict: _Evaluation.mapping,
    ast.Subscript: _Evaluation.item,
    ast.Call: _Evaluation.call,
    ast.ListComp: _Evaluation.comprehension,
    ast.GeneratorExp: _Evaluation.comprehension,
}


def _check_operands(kind: ast.operator, left: Value, right: Value) -> None:
    """Refuse operations whose result would be too large, before they begin."""
    if isinstance(kind, ast.Pow) and isinstance(left, int) and isinstance(right, int):
        if right > 0 and left.bit_length() * right > 2 * MAX_BITS and abs(left) > 1:
            raise ExpressionError(f"a whole number of more than {MAX_BITS} bits is refused")
    elif isinstance(kind, ast.LShift) and isinstance(right, int):
        if right > MAX_BITS:
            raise ExpressionError(f"a whole number of more than {MAX_BITS} bits is refused")
    elif isinstance(kind, ast.Mult):
        for text, count in ((left, right), (right, left)):
            if isinstance(text, _SEQUENCES) and isinstance(count, int):
                check_length(len(text) * max(count, 0))
    elif isinstance(kind, ast.Add) and isinstance(left, _SEQUENCES) and isinstance(right, _SEQUENCES):
        check_length(len(left) + len(right))
    elif isinstance(kind, ast.Mod) and isinstance(left, str) and "%" in _FORMAT.sub("", left):
        raise ExpressionError(f"the format {left[:60]!r} is not accepted; fields have at most two digits")
