"""Scopes: what properties, macros, blocks and namespaces a place in a document sees."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from carom.files.xml_element import Element
from carom.formats.xacro.functions import Namespace
from carom.formats.xacro.limits import MAX_PROPERTIES, Allowance, ExpressionError
from carom.formats.xacro.values import Value, literal

if TYPE_CHECKING:
    from carom.formats.xacro.macro import Macro

Evaluate = Callable[[str, "Scope"], Value]


class Unevaluated(str):
    """The text of a property that is evaluated when it is first used."""

    file: Path


@dataclass(frozen=True, eq=False, slots=True)
class Block:
    """Elements that a property or a parameter of a macro stands for.

    Attributes:
        elements: The elements.
        text: Text before them.
        is_expanded: Whether they have been expanded already, where a macro was called.
    """

    elements: list[Element]
    text: str
    is_expanded: bool


class Scope(Mapping[str, Value]):
    """Properties by name, those of the scopes around it included; and macros, blocks and namespaces.

    Args:
        parent: The scope around it.
        evaluate: How the text of a property is evaluated.
        budget: What the document has used of its bounds.
    """

    def __init__(self, parent: Scope | None, evaluate: Evaluate, budget: Allowance) -> None:
        self.parent = parent
        self.evaluate = evaluate
        self.budget = budget
        self.properties: dict[str, Value] = {}
        self.macros: dict[str, Macro] = {}
        self.blocks: dict[str, Block] = {}
        self.namespaces: dict[str, Scope] = {}
        self._open: list[str] = []

    def inner(self) -> Scope:
        """A new scope inside this one."""
        return Scope(self, self.evaluate, self.budget)

    @property
    def outermost(self) -> Scope:
        """The scope of the document."""
        return self if self.parent is None else self.parent.outermost

    @property
    def around(self) -> Scope:
        """The scope around this one; the outermost for itself."""
        return self if self.parent is None else self.parent

    def chain(self) -> Iterator[Scope]:
        """This scope and those around it, from the inside."""
        scope: Scope | None = self
        while scope is not None:
            yield scope
            scope = scope.parent

    def put(self, name: str, value: Value) -> None:
        """Set a property in this scope."""
        self.properties[name] = value if isinstance(value, Unevaluated) else literal(value)

    def macro(self, name: str) -> tuple[Macro, Scope] | None:
        """A macro by its name, and the scope that it sees; `ns.name` is one of a namespace."""
        for scope in self.chain():
            if name in scope.macros:
                # Found by its plain name, it sees what the call sees.
                return scope.macros[name], self
        space, _, rest = name.partition(".")
        for scope in self.chain() if rest else ():
            if space in scope.namespaces:
                return scope.namespaces[space].macro(rest)
        return None

    def block(self, name: str) -> Block | None:
        """A block by its name."""
        return next((scope.blocks[name] for scope in self.chain() if name in scope.blocks), None)

    def __getitem__(self, name: str) -> Value:
        for scope in self.chain():
            if name in scope.properties:
                return scope._own(name)
            if name in scope.namespaces:
                return _View(scope.namespaces[name])
        raise KeyError(name)

    def __contains__(self, name: object) -> bool:
        return any(name in scope.properties or name in scope.namespaces for scope in self.chain())

    def __iter__(self) -> Iterator[str]:
        return iter({name: None for scope in self.chain() for name in (*scope.properties, *scope.namespaces)})

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def _own(self, name: str) -> Value:
        """A property of this scope; it is evaluated if it has not been used yet."""
        value = self.properties[name]
        if not isinstance(value, Unevaluated):
            return value
        if name in self._open:
            raise ExpressionError(
                f"properties refer to each other in a circle: {' -> '.join([*self._open, name])}"
            )
        if self.budget.properties >= MAX_PROPERTIES:
            raise ExpressionError(f"more than {MAX_PROPERTIES} properties refer to each other in a chain")
        self._open.append(name)
        self.budget.properties += 1
        try:
            result = literal(self.evaluate(value, self))
        except ExpressionError as error:
            raise ExpressionError(f"in property {name!r}: {error}") from None
        finally:
            self._open.pop()
            self.budget.properties -= 1
        self.properties[name] = result
        return result


class _View(Namespace):
    """The properties of a namespace, looked up when they are used."""

    def __init__(self, scope: Scope) -> None:
        super().__init__()
        self._scope = scope

    def __contains__(self, name: object) -> bool:
        return name in self._scope.properties or name in self._scope.namespaces

    def __getitem__(self, name: str) -> Value:
        return self._scope[name]
