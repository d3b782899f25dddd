"""A reading cursor: which elements and attributes of a document a reader has taken.

A reader that gets its elements from a `Cursor` needs no list of what it ignores: what it has not taken when
it has finished is what it ignores. So nothing can be left out silently, also by a reader that changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from carom.files.xml_element import Element, PlacedElement
from carom.formats.reading.ignored import Ignored, IgnoredList
from carom.formats.reading.rules import Rules


class Recorded(dict[str, str]):
    """Attributes that remember which of them were looked up; looking for a missing one counts as well.

    Iterating over them, or copying them, is no look-up.

    Attributes:
        taken: Names that were looked up.
        origins: Where values came from that `layered` brought together, by name.
        is_used: Whether an element has them as its defaults, see `note_use`.
    """

    __slots__ = ("is_used", "layers", "origins", "taken")

    def __init__(self, values: Mapping[str, str]) -> None:
        super().__init__(values)
        self.taken: set[str] = set()
        self.origins: dict[str, tuple[Recorded, ...]] = {}
        self.layers: tuple[Recorded, ...] = ()
        self.is_used = False

    def note_use(self) -> None:
        """Note that an element has them as its defaults, also if it looks none of them up."""
        self.is_used = True
        for layer in self.layers:
            layer.note_use()

    def take(self, name: str) -> None:
        """Note that a value was used, here and where it came from."""
        if name in self.taken:
            return
        self.taken.add(name)
        for origin in self.origins.get(name, ()):
            origin.take(name)

    # Readers look up more than anything else: calls of `take` that would do nothing take half the time.

    def __getitem__(self, name: str) -> str:
        if name not in self.taken:
            self.take(name)
        return dict.__getitem__(self, name)

    def __contains__(self, name: object) -> bool:
        if name not in self.taken and isinstance(name, str):
            self.take(name)
        return dict.__contains__(self, name)

    def get(self, name: str, default: str | None = None) -> str | None:  # pyright: ignore
        """The value of an attribute, or the default."""
        if name not in self.taken:
            self.take(name)
        return dict.get(self, name, default)


def layered(
    lower: Mapping[str, str], upper: Mapping[str, str], joined: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Attributes of `lower`, such as defaults, under those of `upper`, which count where both have one.

    Looking up one of the result counts as looking it up where it came from. Those `joined` have values made
    from both; looking one up counts in both.
    """
    joined = joined or {}
    if not isinstance(lower, Recorded) and not isinstance(upper, Recorded):
        return {**lower, **upper, **joined}
    result = Recorded({**lower, **upper, **joined})
    result.layers = tuple(source for source in (lower, upper) if isinstance(source, Recorded))
    for source in result.layers:
        result.origins.update(dict.fromkeys(source.keys(), (source,)))
    result.origins.update(dict.fromkeys(joined, result.layers))
    return result


class TracedElement(Element):
    """An element that remembers whether it was taken, and which of its attributes.

    It is taken if `first` or `all` of its parent gave it out, if one of its attributes was looked up, or if
    one of its children was taken. Going through `children` takes none of them; `note` takes one.

    Attributes:
        file: The file that contains it.
        calls: Where the macros that made it were called, see `PlacedElement`.
        is_taken: Whether `first`, `all` or `note` took it.
    """

    __slots__ = ("calls", "file", "is_taken")

    def __init__(self, element: Element, file: Path) -> None:
        super().__init__(element.tag, Recorded(element.attributes), element.line)
        self.children = [TracedElement(child, file) for child in element.children]
        self.text = element.text
        self.file = element.file if isinstance(element, PlacedElement) else file
        self.calls = element.calls if isinstance(element, PlacedElement) else ()
        self.is_taken = False

    def first(self, tag: str) -> Element | None:
        """The first child of that name."""
        child = super().first(tag)
        if child is not None:
            child.note()
        return child

    def all(self, tag: str) -> Iterator[Element]:
        """Every child of that name, in order."""
        for child in super().all(tag):
            child.note()
            yield child

    def note(self) -> None:
        """Note that a reader has used it."""
        self.is_taken = True


class Cursor:
    """What a reader has taken of one file and of all files that it includes.

    Args:
        rules: Consequences and reasons of what may be left out, by format.
    """

    def __init__(self, rules: Rules) -> None:
        self.rules = rules
        self.roots: list[TracedElement] = []
        self._stated: list[Ignored] = []

    def trace(self, root: Element, file: Path) -> TracedElement:
        """The same document, with elements that remember whether they were taken."""
        traced = TracedElement(root, file)
        traced.note()
        self.roots.append(traced)
        return traced

    def leave_out(
        self, element: Element, consequence: str, reason: str, *, attributes: Iterable[str] = ()
    ) -> None:
        """Report something that a reader took and does not use, or uses in another way than stated."""
        file = element.file if isinstance(element, TracedElement) else self.roots[0].file
        path = next((found for root in self.roots if (found := root.path_to(element))), [element])
        place = "/".join(step.tag for step in path[-2:])
        self._stated.append(Ignored(place, file, element.line, tuple(attributes), 1, consequence, reason))

    def reported(self) -> IgnoredList:
        """What `leave_out` reported, equal entries together, by file and line."""
        return IgnoredList.of(self._stated)

    def ignored(self) -> IgnoredList:
        """What was not taken, and what `leave_out` reported, equal entries together, by file and line."""
        found = list(self._stated)
        for root in self.roots:
            found += self._below(root, (root.tag,))
        return IgnoredList.of(found)

    def _below(self, element: TracedElement, path: tuple[str, ...]) -> Iterator[Ignored]:
        """Of an element that was taken: its attributes and children that were not, and those below."""
        by_rule: dict[tuple[str, str], list[str]] = {}
        attributes = element.attributes
        taken = attributes.taken if isinstance(attributes, Recorded) else set(attributes)
        for name in attributes:
            if not _declares_namespace(name):
                says = self.rules.of(path, name, taken=name in taken)
                if says is not None:
                    by_rule.setdefault(says, []).append(name)
        for (consequence, reason), names in by_rule.items():
            yield Ignored(
                "/".join(path[-2:]), element.file, element.line, tuple(names), 1, consequence, reason
            )
        children = [child for child in element.children if isinstance(child, TracedElement)]
        used = {child.tag for child in children if _was_taken(child)}
        for child in children:
            below = (*path, child.tag)
            is_taken = _was_taken(child)
            says = self.rules.of(below, None, taken=is_taken)
            if child.tag in used and not is_taken and not self.rules.know(below):
                says = "only another one of its kind counts", "one is used"
            if says is not None:
                yield Ignored("/".join(below[-2:]), child.file, child.line, (), 1, *says)
            else:
                yield from self._below(child, below)


def _was_taken(element: TracedElement) -> bool:
    attributes = element.attributes
    if element.is_taken or (isinstance(attributes, Recorded) and (attributes.taken or attributes.is_used)):
        return True
    return any(isinstance(child, TracedElement) and _was_taken(child) for child in element.children)


def _declares_namespace(name: str) -> bool:
    return name == "xmlns" or name.startswith("xmlns:")
