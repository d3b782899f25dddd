"""Attributes of elements: their names, and texts of their values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches

import numpy as np

from carom.editing.elements import new, words
from carom.editing.references import kind_of, named
from carom.files.xml_element import Element
from carom.formats.mjcf.rules import attributes_known

Value = str | bool | float | Sequence[float]
"""What an attribute is set to: a word, a truth value, a number or several."""
_MAX_NAMES = 12


def missing(owner: str, kind: str, name: str, known: list[str]) -> str:
    """What to say of a name that is not in a description, whose name is `owner`."""
    near = get_close_matches(name, known, 1)
    listed = ", ".join(map(repr, known[:_MAX_NAMES])) or "none"
    more = f" and {len(known) - _MAX_NAMES} more" if len(known) > _MAX_NAMES else ""
    similar = f"did you mean {near[0]!r}? " if near else ""
    return f"{owner} has no {kind} {name!r}; {similar}it has {listed}{more}"


def element_of(tag: str, section: str, attributes: Mapping[str, Value]) -> Element:
    """An element with attributes that MJCF has; raises `ValueError` if it has not."""
    for attribute in attributes:
        check_attribute(tag, section, attribute)
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


def check_attribute(tag: str, section: str, attribute: str) -> None:
    """Raise `ValueError` if an element has no such attribute."""
    known = attributes_known(tag, section)
    if known and attribute not in known:
        near = get_close_matches(attribute, sorted(known), 1)
        similar = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(sorted(known))}"
        raise ValueError(f"<{tag}> of MJCF has no attribute {attribute!r}; {similar}")
