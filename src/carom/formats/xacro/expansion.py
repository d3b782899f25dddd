"""The expansion of a document: every element in turn, into a new document without macros."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from pathlib import Path

from carom.errors import DescriptionError
from carom.files.xml_element import PlacedElement, from_calls
from carom.formats.xacro.limits import MAX_DEPTH, Allowance, ExpressionError
from carom.formats.xacro.macro import Macro, Parameter, parse_parameters
from carom.formats.xacro.scope import Block, Scope, Unevaluated
from carom.formats.xacro.sources import Sources
from carom.formats.xacro.texts import Texts
from carom.formats.xacro.values import truth

PREFIX = "xacro:"
_MAX_CALLS_SHOWN = 6


class Expansion:
    """The expansion of one document and of all files that it includes.

    Args:
        texts: Evaluates texts.
        sources: Reads files.
        budget: What the document has used of its bounds.
    """

    def __init__(self, texts: Texts, sources: Sources, budget: Allowance) -> None:
        self.texts = texts
        self.sources = sources
        self.budget = budget
        self.scope = Scope(None, texts.evaluate, budget)
        self.declared: set[str] = set()
        self._calls: list[str] = []
        self._including: list[Path] = []
        self._depth = 0

    def document(self, root: PlacedElement) -> PlacedElement:
        """The document of a root element without macros.

        Raises:
            DescriptionError: It has an error, or exceeds the bounds.
        """
        holder = PlacedElement("", {}, root.line, root.file)
        self._including.append(root.file)
        try:
            self._one(root, self.scope, holder)
        except RecursionError:
            raise DescriptionError("its macros are nested too deeply", file=root.file) from None
        return holder.children[0]  # pyright: ignore

    def _all(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        """Expand the content of an element."""
        if element.text.strip() and not into.children:
            into.text += self.texts.as_text(element.text, scope)
        for child in element.children:
            self._one(child, scope, into)  # pyright: ignore

    def _one(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        before = self.texts.file
        self.texts.file = element.file
        self._depth += 1
        try:
            self.budget.element()
            if self._depth > MAX_DEPTH:
                raise ExpressionError(f"elements, macros and includes are nested deeper than {MAX_DEPTH}")
            if not element.tag.startswith(PREFIX):
                self._plain(element, element.tag, element.attributes, scope, into)
            elif element.tag in _HANDLERS:
                _HANDLERS[element.tag](self, element, scope, into)
            else:
                name = element.tag.removeprefix(PREFIX)
                self._call(element, name, element.attributes, scope, into)
        except ExpressionError as error:
            raise self._error(element, str(error)) from None
        finally:
            self._depth -= 1
            self.texts.file = before

    def _error(self, element: PlacedElement, reason: str) -> DescriptionError:
        calls = from_calls(_Called(tuple(reversed(self._calls))))
        return DescriptionError(reason + calls, file=element.file, line=element.line, element=_label(element))

    def _plain(
        self,
        element: PlacedElement,
        tag: str,
        attributes: dict[str, str],
        scope: Scope,
        into: PlacedElement,
    ) -> None:
        """An element that is not one of xacro's."""
        new = self._new(element, tag)
        for name, value in attributes.items():
            if name == "xmlns:xacro":
                continue
            try:
                new.attributes[name] = self.texts.as_text(value, scope)
            except ExpressionError as error:
                raise ExpressionError(f"attribute {name!r}: {error}") from None
        into.children.append(new)
        self._all(element, scope, new)

    def _new(self, element: PlacedElement, tag: str) -> PlacedElement:
        calls = tuple(reversed(self._calls[-_MAX_CALLS_SHOWN:]))
        return PlacedElement(tag, {}, element.line, element.file, element.calls or calls)

    def _element(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        """`<xacro:element xacro:name="...">`: an element whose name is an expression."""
        tag = self._text(element, "xacro:name", scope)
        others = {name: value for name, value in element.attributes.items() if name != "xacro:name"}
        self._plain(element, tag, others, scope, into)

    def _attribute(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        """`<xacro:attribute name="..." value="..."/>`: an attribute of the element around it."""
        _check_attributes(element, ("name", "value"))
        into.attributes[self._text(element, "name", scope)] = self._text(element, "value", scope)

    def _if(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("value",))
        wanted = element.tag == "xacro:if"
        if truth(self.texts.evaluate(_required(element, "value"), scope)) is wanted:
            self._all(element, scope, into)

    def _property(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("name", "value", "default", "remove", "scope", "lazy_eval"))
        name = self._text(element, "name", scope)
        if not name.isidentifier() or name.startswith("__"):
            raise ExpressionError(f"{name!r} cannot be the name of a property")
        where = element.attributes.get("scope", "")
        if where not in ("", "parent", "global"):
            raise ExpressionError(f"scope is {where!r}; expected parent or global")
        target = {"": scope, "parent": scope.around, "global": scope.outermost}[where]
        given = element.attributes
        if truth(self.texts.evaluate(given.get("remove", "false"), scope)):
            target.properties.pop(name, None)
            target.blocks.pop(name, None)
            return
        value = given.get("value")
        if value is None and "default" in given:
            if name in scope:
                return
            value = given["default"]
        if value is None:
            target.blocks[name] = Block(element.children, element.text, False)
        elif where or not truth(given.get("lazy_eval", "true")) or "$" not in value:
            target.put(name, self.texts.evaluate(value, scope))
        else:
            lazy = Unevaluated(value)
            lazy.file = element.file
            target.put(name, lazy)

    def _arg(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("name", "default"))
        name = _required(element, "name")
        self.declared.add(name)
        if name not in self.texts.arguments and "default" in element.attributes:
            self.texts.arguments[name] = self._text(element, "default", scope)

    def _include(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("filename", "ns", "optional"))
        name = self._text(element, "filename", scope)
        is_optional = truth(self.texts.as_text(element.attributes.get("optional", "false"), scope))
        files = self.sources.included(name, self.texts, is_optional=is_optional)
        if "ns" in element.attributes:
            space = self._text(element, "ns", scope)
            if not space.isidentifier():
                raise ExpressionError(f"{space!r} cannot be the name of a namespace")
            scope.namespaces[space] = scope = scope.inner()
        for file in files:
            if file in self._including:
                raise ExpressionError(f"{name!r} includes itself")
            self._including.append(file)
            try:
                self._all(self.sources.root(file), scope, into)
            finally:
                self._including.pop()

    def _macro(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("name", "params"))
        name = _required(element, "name").removeprefix(PREFIX)
        if PREFIX + name in _HANDLERS:
            raise ExpressionError(f"{name!r} is an element of xacro and cannot be the name of a macro")
        parameters = parse_parameters(element.attributes.get("params", ""))
        scope.macros[name] = Macro(name, parameters, element, element.file)

    def _dynamic_call(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        """`<xacro:call macro="..."/>`: the macro's name is an expression."""
        name = self._text(element, "macro", scope).removeprefix(PREFIX)
        others = {key: value for key, value in element.attributes.items() if key != "macro"}
        self._call(element, name, others, scope, into)

    def _call(
        self,
        element: PlacedElement,
        name: str,
        attributes: dict[str, str],
        scope: Scope,
        into: PlacedElement,
    ) -> None:
        found = scope.macro(name)
        if found is None:
            names = [name for it in scope.chain() for name in it.macros]
            close = difflib.get_close_matches(name, names, 1)
            hint = f"; did you mean {close[0]!r}?" if close else ""
            raise ExpressionError(f"there is no macro {name!r}{hint}")
        macro, seen = found
        inner = seen.inner()
        values = {parameter.name for parameter in macro.parameters if not parameter.stars}
        for key, value in attributes.items():
            if key.startswith("xmlns"):
                continue
            if key not in values:
                raise ExpressionError(
                    f"macro {name!r} has no parameter {key!r}; it has {', '.join(sorted(values)) or 'none'}"
                )
            try:
                inner.put(key, self.texts.evaluate(value, scope))
            except ExpressionError as error:
                raise ExpressionError(f"attribute {key!r}: {error}") from None
        holder = PlacedElement("", {}, element.line, element.file)
        self._all(element, scope, holder)
        self._give_blocks(macro, holder, inner)
        for parameter in macro.parameters:
            if not parameter.stars and parameter.name not in attributes:
                self._give_default(macro, parameter, scope, (seen, inner))
        self._calls.append(f"macro {name!r} called at {element.file}:{element.line}")
        self._all(macro.element, inner, into)  # pyright: ignore
        self._calls.pop()

    def _give_default(
        self, macro: Macro, parameter: Parameter, scope: Scope, into: tuple[Scope, Scope]
    ) -> None:
        """Give a parameter the value of that name where the call is, or its default."""
        seen, inner = into
        if parameter.is_forwarded and parameter.name in scope:
            inner.put(parameter.name, scope[parameter.name])
        elif parameter.default is not None:
            before, self.texts.file = self.texts.file, macro.file
            try:
                inner.put(parameter.name, self.texts.evaluate(parameter.default, seen))
            finally:
                self.texts.file = before
        else:
            raise ExpressionError(f"macro {macro.name!r} needs a value for {parameter.name!r}")

    @staticmethod
    def _give_blocks(macro: Macro, holder: PlacedElement, inner: Scope) -> None:
        blocks = list(holder.children)
        for parameter in macro.parameters:
            if parameter.stars:
                if not blocks:
                    raise ExpressionError(
                        f"macro {macro.name!r} needs an element for block {parameter.name!r}"
                    )
                block = blocks.pop(0)
                inner.blocks[parameter.name] = (
                    Block([block], "", True)
                    if parameter.stars == 1
                    else Block(block.children, block.text, True)
                )
        if blocks:
            raise ExpressionError(f"macro {macro.name!r} has no block for <{blocks[0].tag}>")

    def _insert_block(self, element: PlacedElement, scope: Scope, into: PlacedElement) -> None:
        _check_attributes(element, ("name",))
        name = self._text(element, "name", scope)
        block = scope.block(name)
        if block is None:
            known = ", ".join(sorted({it for one in scope.chain() for it in one.blocks})) or "none"
            raise ExpressionError(f"there is no block {name!r}; there are {known}")
        if not into.children:
            into.text += block.text if block.is_expanded else self.texts.as_text(block.text, scope)
        for child in block.elements:
            if block.is_expanded:
                into.children.append(self._copy(child))  # pyright: ignore
            else:
                self._one(child, scope, into)  # pyright: ignore

    def _copy(self, element: PlacedElement) -> PlacedElement:
        self.budget.element()
        self.budget.text(len(element.text) + sum(map(len, element.attributes.values())))
        copy = PlacedElement(element.tag, dict(element.attributes), element.line, element.file, element.calls)
        copy.text = element.text
        copy.children = [self._copy(child) for child in element.children]  # pyright: ignore
        return copy

    def _text(self, element: PlacedElement, attribute: str, scope: Scope) -> str:
        """The text of a required attribute."""
        return self.texts.as_text(_required(element, attribute), scope)


class _Called(PlacedElement):
    """Only the calls around a place."""

    def __init__(self, calls: tuple[str, ...]) -> None:
        super().__init__("", {}, 0, Path(), calls[:_MAX_CALLS_SHOWN])


_HANDLERS: dict[str, Callable[[Expansion, PlacedElement, Scope, PlacedElement], None]] = {
    "xacro:arg": Expansion._arg,
    "xacro:attribute": Expansion._attribute,
    "xacro:call": Expansion._dynamic_call,
    "xacro:element": Expansion._element,
    "xacro:if": Expansion._if,
    "xacro:include": Expansion._include,
    "xacro:insert_block": Expansion._insert_block,
    "xacro:macro": Expansion._macro,
    "xacro:property": Expansion._property,
    "xacro:unless": Expansion._if,
}


def _required(element: PlacedElement, name: str) -> str:
    if name not in element.attributes:
        raise ExpressionError(f"attribute {name!r} is missing")
    return element.attributes[name]


def _check_attributes(element: PlacedElement, known: tuple[str, ...]) -> None:
    for name in element.attributes:
        if name not in known and not name.startswith("xmlns"):
            raise ExpressionError(f"attribute {name!r} is not known; there are {', '.join(known)}")


def _label(element: PlacedElement) -> str:
    name = element.attributes.get("name")
    return f"<{element.tag}>" if name is None else f'<{element.tag} name="{name[:60]}">'
