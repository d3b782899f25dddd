"""Scaling a description: all lengths by a factor, with densities as they are."""

from __future__ import annotations

from carom.editing.elements import numbers, pairs, words
from carom.editing.keys import joints_of
from carom.files.xml_element import Element

# Powers of the factor, by element and attribute; of sites and geoms `size` is all lengths.
_OF_BODIES = {
    "body": {"pos": 1},
    "joint": {"pos": 1},
    "geom": {"pos": 1, "size": 1, "fromto": 1, "mass": 3, "margin": 1, "gap": 1},
    "site": {"pos": 1, "size": 1, "fromto": 1},
    "camera": {"pos": 1},
    "light": {"pos": 1},
    "inertial": {"pos": 1, "mass": 3, "diaginertia": 5, "fullinertia": 5},
}
_OF_SLIDERS = {"range": 1, "ref": 1, "springref": 1, "margin": 1}
_OF_SECTIONS = {
    ("asset", "mesh"): {"refpos": 1},
    ("asset", "hfield"): {"size": 1},
    ("tendon", "spatial"): {"range": 1, "springlength": 1, "margin": 1},
    ("equality", "connect"): {"anchor": 1},
    ("equality", "weld"): {"anchor": 1},
    ("contact", "pair"): {"margin": 1, "gap": 1},
    ("sensor", "distance"): {"cutoff": 1},
    ("sensor", "normal"): {"cutoff": 1},
    ("sensor", "fromto"): {"cutoff": 1},
}
_ONE = (1.0, 1.0, 1.0)


def scale_tree(root: Element, factor: float) -> None:
    """Multiply lengths; masses by the third power, moments of inertia by the fifth.

    Keys are scaled as positions are. Gains, gears, damping, stiffness and ranges of actuators stay.
    """
    sliders = _coordinates(root)
    for parent, element in pairs(root):
        powers = _OF_SECTIONS.get((parent.tag, element.tag))
        if powers is None and parent.tag in ("body", "worldbody"):
            powers = _OF_BODIES.get(element.tag)
        if powers is not None:
            _scale(element, powers, factor)
        if element.tag == "joint" and element.attributes.get("type") == "slide":
            _scale(element, _OF_SLIDERS, factor)
        if parent.tag == "asset" and element.tag == "mesh":
            scale = numbers(element, "scale", _ONE)
            element.attributes["scale"] = words(factor * value for value in scale)
        if element.tag == "weld" and "relpose" in element.attributes:
            x, y, z, *turn = numbers(element, "relpose")
            element.attributes["relpose"] = words((factor * x, factor * y, factor * z, *turn))
        if element.tag == "key":
            _scale_key(element, sliders, factor)


def _scale(element: Element, powers: dict[str, int], factor: float) -> None:
    for name, power in powers.items():
        if name in element.attributes:
            values = numbers(element, name)
            element.attributes[name] = words(value * factor**power for value in values)


def _coordinates(root: Element) -> dict[str, list[bool]]:
    """Which numbers of keys are lengths."""
    found: dict[str, list[bool]] = {"qpos": [], "qvel": []}
    for joint in joints_of(root):
        kind = "free" if joint.tag == "freejoint" else joint.attributes.get("type", "hinge")
        moved = {"free": 3, "slide": 1}.get(kind, 0)
        turned = {"free": (4, 3), "ball": (4, 3), "hinge": (1, 1)}.get(kind, (0, 0))
        found["qpos"] += [True] * moved + [False] * turned[0]
        found["qvel"] += [True] * moved + [False] * turned[1]
    return found


def _scale_key(key: Element, lengths: dict[str, list[bool]], factor: float) -> None:
    for name, are in lengths.items():
        if name in key.attributes:
            values = zip(numbers(key, name), are, strict=False)
            key.attributes[name] = words(
                factor * value if is_length else value for value, is_length in values
            )
    if "mpos" in key.attributes:
        key.attributes["mpos"] = words(factor * value for value in numbers(key, "mpos"))
