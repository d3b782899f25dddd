"""Names in descriptions: what has one, and which attributes name what."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from carom.editing.elements import pairs
from carom.files.xml_element import Element

BODY, JOINT, GEOM, SITE, CAMERA, LIGHT = "body", "joint", "geom", "site", "camera", "light"
TENDON, ACTUATOR, SENSOR, EQUALITY, KEY = "tendon", "actuator", "sensor", "equality", "keyframe"
MESH, MATERIAL, TEXTURE, HFIELD, SKIN, CLASS = "mesh", "material", "texture", "hfield", "skin", "class"
PAIR, EXCLUDE, FLEX, NUMERIC, TEXT, TUPLE = "pair", "exclude", "flex", "numeric", "text", "tuple"
PLUGIN = "plugin"

_BY_SECTION = {
    "tendon": TENDON,
    "actuator": ACTUATOR,
    "sensor": SENSOR,
    "equality": EQUALITY,
    "keyframe": KEY,
    "contact": "",
    "asset": "",
    "custom": "",
    "deformable": "",
}
_BY_TAG = {
    "body": BODY,
    "joint": JOINT,
    "freejoint": JOINT,
    "geom": GEOM,
    "site": SITE,
    "camera": CAMERA,
    "light": LIGHT,
    "mesh": MESH,
    "material": MATERIAL,
    "texture": TEXTURE,
    "hfield": HFIELD,
    "skin": SKIN,
    "flex": FLEX,
    "flexcomp": FLEX,
    "pair": PAIR,
    "exclude": EXCLUDE,
    "numeric": NUMERIC,
    "text": TEXT,
    "tuple": TUPLE,
    "instance": PLUGIN,
}

_FOR_ACTUATORS = {
    "joint": JOINT,
    "jointinparent": JOINT,
    "tendon": TENDON,
    "site": SITE,
    "refsite": SITE,
    "slidersite": SITE,
    "cranksite": SITE,
    "body": BODY,
    "class": CLASS,
}
_FOR_SENSORS = {
    "site": SITE,
    "joint": JOINT,
    "actuator": ACTUATOR,
    "tendon": TENDON,
    "body": BODY,
    "camera": CAMERA,
    "geom": GEOM,
    **{f"{what}{number}": what for what in (BODY, GEOM) for number in (1, 2)},
    **{f"subtree{number}": BODY for number in (1, 2)},
    "subtree1": BODY,
    "subtree2": BODY,
    "instance": PLUGIN,
}
_FOR_EQUALITIES = {
    f"{what}{number}": what for what in (BODY, JOINT, TENDON, SITE, FLEX) for number in ("", 1, 2)
}
_TYPED = {"objname": "objtype", "refname": "reftype"}
_TYPES = {"xbody": BODY}
_BY_PLACE: dict[tuple[str, str], dict[str, str]] = {
    ("contact", "pair"): {"geom1": GEOM, "geom2": GEOM},
    ("contact", "exclude"): {"body1": BODY, "body2": BODY},
    ("fixed", "joint"): {"joint": JOINT},
    ("spatial", "site"): {"site": SITE},
    ("spatial", "geom"): {"geom": GEOM, "sidesite": SITE},
    ("asset", "mesh"): {"material": MATERIAL},
    ("asset", "material"): {"texture": TEXTURE},
    ("material", "layer"): {"texture": TEXTURE},
    ("asset", "skin"): {"material": MATERIAL},
    ("deformable", "skin"): {"material": MATERIAL},
    ("deformable", "flex"): {"material": MATERIAL},
    ("skin", "bone"): {"body": BODY},
    ("tuple", "element"): {},
}
_IN_BODIES = {
    "geom": {"mesh": MESH, "material": MATERIAL, "hfield": HFIELD},
    "site": {"material": MATERIAL, "mesh": MESH},
    "camera": {"target": BODY},
    "light": {"target": BODY, "texture": TEXTURE},
    "flexcomp": {"material": MATERIAL},
    "plugin": {"instance": PLUGIN},
}
_WRAPS = ("fixed", "spatial")
WORLD = "world"
"""The name of the world, which is none of a body that could change."""


@dataclass(frozen=True, slots=True)
class Reference:
    """An attribute that names something.

    Attributes:
        owner: The element.
        attribute: Its attribute.
        kind: What it names.
        whole: What is lost with that: the element, or the tendon or tuple that it is a part of.
        around: The element that `whole` is in.
    """

    owner: Element
    attribute: str
    kind: str
    whole: Element
    around: Element

    @property
    def name(self) -> str:
        """The name that it states."""
        return self.owner.attributes[self.attribute]

    def restate(self, name: str) -> None:
        """Let it state another name."""
        self.owner.attributes[self.attribute] = name


def kind_of(element: Element, parent: Element) -> str:
    """The kind of thing that an element's `name` is for; empty if it has no name of its own."""
    if parent.tag in _WRAPS:
        return ""
    return _BY_SECTION.get(parent.tag) or _BY_TAG.get(element.tag, "")


def named(root: Element) -> dict[tuple[str, str], Element]:
    """Each element that has a name, by kind and name; of several alike the first."""
    found: dict[tuple[str, str], Element] = {}
    for parent, element in pairs(root):
        name = element.attributes.get("name", "")
        if name and (kind := kind_of(element, parent)):
            found.setdefault((kind, name), element)
        if element.tag == "default" and "class" in element.attributes:
            found.setdefault((CLASS, element.attributes["class"]), element)
    return found


def references(root: Element) -> Iterator[Reference]:
    """All attributes that name something else, with what they name; not those that name the world."""
    yield from _below(root, None)


def _below(parent: Element, around: Element | None) -> Iterator[Reference]:
    for element in parent.children:
        for attribute, kind in attributes_of(element, parent).items():
            name = element.attributes.get(attribute)
            if name and not (kind == BODY and name == WORLD):
                if parent.tag in (*_WRAPS, "tuple") and around is not None:
                    yield Reference(element, attribute, kind, parent, around)
                else:
                    yield Reference(element, attribute, kind, element, parent)
        yield from _below(element, parent)


def attributes_of(element: Element, parent: Element) -> dict[str, str]:
    """Which attributes of an element name something, and what."""
    if (parent.tag, element.tag) in _BY_PLACE:
        found = _BY_PLACE[parent.tag, element.tag]
    elif parent.tag == "actuator":
        found = _FOR_ACTUATORS
    elif parent.tag == "sensor":
        found = _FOR_SENSORS
    elif parent.tag == "equality":
        found = _FOR_EQUALITIES
    elif parent.tag in ("body", "worldbody"):
        found = _IN_BODIES.get(element.tag, {})
    else:
        found = {}
    typed = {
        attribute: _TYPES.get(element.attributes[type_name], element.attributes[type_name])
        for attribute, type_name in _TYPED.items()
        if (parent.tag == "sensor" or element.tag == "element") and element.attributes.get(type_name)
    }
    return {**found, **typed} if typed else found
