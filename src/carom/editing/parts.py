"""Parts of a description by kind and name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING

import numpy as np

from carom.closed import Closed
from carom.editing.elements import IN_BODIES, new, words
from carom.editing.references import kind_of, named
from carom.formats.mjcf.rules import attributes_known
from carom.formats.xml_element import Element

if TYPE_CHECKING:
    from carom.editing.description import Description

Value = str | bool | float | Sequence[float]
"""What an attribute is set to: a word, a truth value, a number or several."""
_MAX_NAMES = 12


class Part(Closed):
    """A body, joint, geom, site, actuator or anything else in a description that has a name.

    `part["damping"]` is the text of an attribute of MJCF (`None` if it is not stated), in metres, kilograms
    and radians, with poses in the frame of the body around it; `part["damping"] = 0.3` states it, and
    `del part["damping"]` leaves it out. Numbers may be given as numbers or sequences.

    Attributes:
        description: The description that it is in.
        kind: What it is: `body`, `joint`, `geom`, `site`, `actuator`...
    """

    def __init__(self, description: Description, kind: str, element: Element) -> None:
        self.description: Description = description
        self.kind: str = kind
        self._element: Element = element
        self._close(Part)

    @property
    def tag(self) -> str:
        """Name of its element in MJCF."""
        return self._element.tag

    @property
    def name(self) -> str:
        """Its name; `rename` changes it."""
        return self._element.attributes["class" if self.kind == "class" else "name"]

    @property
    def attributes(self) -> dict[str, str]:
        """A copy of all attributes that are stated."""
        return dict(self._element.attributes)

    def rename(self, name: str) -> None:
        """Give it another name, also where others name it; raises `ValueError` if the name is taken."""
        self.description.rename(self.name, name, kind=self.kind)

    def remove(self) -> list[str]:
        """Remove it, what is in it and what needs it; gives what went with it. See `Description.remove`."""
        return self.description.remove(self.name, kind=self.kind)

    def add(self, tag: str, **attributes: Value) -> Part | None:
        """Add an element to a body: a `geom`, `site`, `joint`, `camera`, `inertial` or another `body`.

        Args:
            tag: Name of the element in MJCF.
            attributes: Its attributes.

        Returns:
            The part, if it has a name.

        Raises:
            ValueError: It is no body, or has no such element or attribute, or the name is taken.
        """
        if self.kind != "body":
            raise ValueError(f"{self.kind} {self.name!r} holds no other elements; a body does")
        if tag not in (*IN_BODIES, "body"):
            raise ValueError(f"a body has no <{tag}>; it has {', '.join((*IN_BODIES, 'body'))}")
        return self.description.put(self._element, tag, attributes)

    def __getitem__(self, attribute: str) -> str | None:
        _check(self._element.tag, self.kind, attribute)
        return self._element.attributes.get(attribute)

    def __setitem__(self, attribute: str, value: Value) -> None:
        _check(self._element.tag, self.kind, attribute)
        if attribute in ("name", "class"):
            raise ValueError(f"{attribute} is not set; `rename` changes names")
        self._element.attributes[attribute] = text_of(value)

    def __delitem__(self, attribute: str) -> None:
        _check(self._element.tag, self.kind, attribute)
        if attribute in ("name", "class"):
            raise ValueError(f"{attribute} stays; `remove` removes the whole {self.kind}")
        self._element.attributes.pop(attribute, None)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name!r} of the description {self.description.name!r}>"


class Parts(Mapping[str, Part]):
    """The parts of a kind in a description, by name."""

    def __init__(self, description: Description, kind: str) -> None:
        self._description = description
        self._kind = kind

    def _elements(self) -> dict[str, Element]:
        return {name: it for (kind, name), it in named(self._description.root).items() if kind == self._kind}

    def __getitem__(self, name: str) -> Part:
        found = self._elements()
        if name not in found:
            raise KeyError(missing(self._description, self._kind, name, list(found)))
        return Part(self._description, self._kind, found[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._elements())

    def __len__(self) -> int:
        return len(self._elements())

    def __repr__(self) -> str:
        return f"<{self._kind}: {', '.join(self) or 'none'}>"


def missing(description: Description, kind: str, name: str, known: list[str]) -> str:
    """What to say of a name that is not there."""
    near = get_close_matches(name, known, 1)
    listed = ", ".join(map(repr, known[:_MAX_NAMES])) or "none"
    more = f" and {len(known) - _MAX_NAMES} more" if len(known) > _MAX_NAMES else ""
    similar = f"did you mean {near[0]!r}? " if near else ""
    return f"{description.name} has no {kind} {name!r}; {similar}it has {listed}{more}"


def element_of(tag: str, section: str, attributes: Mapping[str, Value]) -> Element:
    """An element with attributes that MJCF has; raises `ValueError` if it has not."""
    for attribute in attributes:
        _check(tag, section, attribute)
    return new(tag, None, {name: text_of(value) for name, value in attributes.items()})


def text_of(value: Value) -> str:
    """The text of a value; raises `ValueError` if it is none."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return str(value).lower()
    found = np.asarray(value, dtype=np.float64)
    if found.ndim > 1 or not found.size:
        raise ValueError(f"{value!r} is neither a word, a number nor several numbers")
    return words(found.reshape(-1).tolist())


def check_free(root: Element, element: Element, parent: Element) -> None:
    """Raise `ValueError` if the name of an element that is to be put into another one is taken."""
    kind, name = kind_of(element, parent), element.attributes.get("name", "")
    if name and (kind, name) in named(root):
        raise ValueError(f"there is a {kind} {name!r} already")


def _check(tag: str, section: str, attribute: str) -> None:
    known = attributes_known(tag, section)
    if known and attribute not in known:
        near = get_close_matches(attribute, sorted(known), 1)
        similar = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(sorted(known))}"
        raise ValueError(f"<{tag}> of MJCF has no attribute {attribute!r}; {similar}")
