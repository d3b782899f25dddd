"""Small changes of a Python file: operators, constants, branches, statements."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tools.mutants.change import Change

_OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "-",
    ast.Sub: "+",
    ast.Mult: "/",
    ast.Div: "*",
    ast.FloorDiv: "*",
    ast.Mod: "*",
    ast.BitOr: "&",
    ast.BitAnd: "|",
    ast.LShift: ">>",
    ast.RShift: "<<",
    ast.Lt: "<=",
    ast.LtE: "<",
    ast.Gt: ">=",
    ast.GtE: ">",
    ast.Eq: "!=",
    ast.NotEq: "==",
    ast.In: "not in",
    ast.NotIn: "in",
    ast.Is: "is not",
    ast.IsNot: "is",
    ast.And: "or",
    ast.Or: "and",
}
# What nothing of a run depends on, or nearly nothing.
_IGNORED_CALLS = ("warn", "warning", "debug", "info", "overload", "cast", "TypeVar", "ParamSpec")
# Keyword arguments that find errors of the code itself: without them everything is the same.
_GUARDS = ("strict", "frozen", "slots")


def python_changes(source: str) -> Iterator[Change]:
    """All changes of a file, in the order of its lines."""
    lines = Lines(source)
    for node in _executed(ast.parse(source)):
        yield from _of(node, lines)


class Lines:
    """Where the nodes of a source are in its text. Columns of `ast` count bytes."""

    def __init__(self, source: str) -> None:
        self.source = source
        self._lines = source.splitlines(keepends=True)
        self._starts = [0]
        for line in self._lines:
            self._starts.append(self._starts[-1] + len(line))

    def place(self, line: int, column: int) -> int:
        """The index of a character, from its line and its column in bytes."""
        text = self._lines[line - 1].encode()[:column].decode()
        return self._starts[line - 1] + len(text)

    def span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        """Where the text of a node begins and ends."""
        assert node.end_lineno is not None and node.end_col_offset is not None
        return self.place(node.lineno, node.col_offset), self.place(node.end_lineno, node.end_col_offset)

    def replaced(self, node: ast.expr | ast.stmt, new: str, kind: str) -> Change:
        """A node with another text in its place."""
        return Change(*self.span(node), new, kind, node.lineno)

    def between(self, left: ast.expr, right: ast.expr, new: str, kind: str) -> Change | None:
        """Another operator between two operands; None where a comment or a parenthesis is in the way."""
        start, end = self.span(left)[1], self.span(right)[0]
        if set(self.source[start:end]) & set("()#\n\\"):
            return None
        return Change(start, end, f" {new} ", kind, left.end_lineno or left.lineno)


def _executed(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes of a tree, without texts, types and what only type checkers see."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test):
            continue
        if isinstance(child, ast.arguments):
            yield from _defaults(child)
            continue
        if isinstance(child, ast.keyword) and child.arg in _GUARDS:
            continue
        if isinstance(child, ast.AnnAssign):
            yield from _parts([child.value] if child.value else [])
            continue
        called = child.value if isinstance(child, ast.Expr) else child
        if isinstance(called, ast.Call) and _name(called.func) in _IGNORED_CALLS:
            continue
        if isinstance(child, ast.Raise | ast.JoinedStr | ast.Import | ast.ImportFrom):
            # That it raises is seen by its condition.
            continue
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            if any(_name(decorator) == "overload" for decorator in child.decorator_list):
                continue
            yield from _defaults(child.args)
            for statement in child.body:
                yield statement
                yield from _executed(statement)
            continue
        if isinstance(child, ast.Assign) and _name(child.targets[0]).startswith("__"):
            continue
        yield child
        yield from _executed(child)


def _defaults(arguments: ast.arguments) -> Iterator[ast.AST]:
    yield from _parts(arguments.defaults + [default for default in arguments.kw_defaults if default])


def _parts(nodes: list[ast.expr]) -> Iterator[ast.AST]:
    for node in nodes:
        yield node
        yield from _executed(node)


def _name(node: ast.AST) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _of(node: ast.AST, lines: Lines) -> Iterator[Change]:
    """The changes of a single node."""
    match node:
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _OPERATORS:
            change = lines.between(left, right, _OPERATORS[type(op)], "operator")
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            texts = any(
                isinstance(side, ast.Constant | ast.JoinedStr) and not _number(side) for side in (left, right)
            )
            change = None if texts else lines.between(left, right, _OPERATORS[type(op)], "operator")
        case ast.BoolOp(op=op, values=[left, right]):
            change = lines.between(left, right, _OPERATORS[type(op)], "operator")
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            start, end = lines.span(operand)
            change = lines.replaced(node, lines.source[start:end], "operator")
        case ast.Constant(value=bool(value)):
            change = lines.replaced(node, str(not value), "constant")
        case ast.Constant(value=int(number) | float(number)):
            change = lines.replaced(node, _other(number), "constant")
        case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
            start, end = lines.span(test)
            change = lines.replaced(test, f"not ({lines.source[start:end]})", "branch")
        case ast.Expr(value=ast.Call()) | ast.AugAssign() | ast.Delete():
            change = lines.replaced(node, "pass", "statement")
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            change = lines.replaced(node, "pass", "statement")
        case ast.Break() | ast.Continue():
            change = lines.replaced(node, "pass", "statement")
        case ast.Return(value=ast.expr() as value) if not isinstance(value, ast.Constant):
            change = lines.replaced(value, "None", "statement")
        case _:
            change = None
    if change is not None:
        yield change


def _number(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, int | float)


def _other(value: float) -> str:
    """Another number: the next one, or one that is half as large again."""
    return str(value + 1) if isinstance(value, int) else repr(value * 1.5 if value else 1.0)
