"""`<default>`: attributes that elements have unless they say otherwise."""

from __future__ import annotations

from carom.formats.mjcf.context import MjcfContext
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element

MAIN = "main"
_LIMITS = ("limited", "range")
Attributes = dict[str, str]


def read_defaults(context: MjcfContext, element: Element, parent: str | None = None) -> None:
    """A `<default>` with the classes inside of it, each of which begins with what its parent has.

    The outermost is the main class, whatever its name; several of them add up.
    """
    name = element.attributes.get("class", MAIN if parent is None else "")
    if not name:
        raise context.error(element, "attribute 'class' is missing")
    inherited = context.classes.get(parent or MAIN, {})
    own = {kind: dict(attributes) for kind, attributes in inherited.items()}
    context.classes[name] = own
    if parent is None:
        context.classes[MAIN] = own
    for child in element.children:
        if child.tag != "default":
            own.setdefault(child.tag, {}).update(child.attributes)
    for child in element.all("default"):
        read_defaults(context, child, name)


def class_defaults(context: MjcfContext, element: Element, child_class: str | None) -> Attributes:
    """The defaults of an element: from its class, that of the enclosing bodies, or the main one."""
    name = element.attributes.get("class") or child_class or MAIN
    if name not in context.classes:
        if name != MAIN:
            raise context.error(element, f"there is no default class {shown(name)}")
        return {}
    return context.classes[name].get(element.tag, {})


def limits_left_out(
    context: MjcfContext, element: Element, child_class: str | None, defaults: Attributes
) -> Attributes:
    """The defaults of a joint without the limits that a named class gives it, unless these count.

    They do also where a joint that says it is limited has no other: PyBullet ends the process there.
    """
    in_main = (element.attributes.get("class") or child_class or MAIN) == MAIN
    if context.as_mujoco or in_main or element.attributes.get("limited") == "true":
        return defaults
    main = context.classes.get(MAIN, {}).get(element.tag, {})
    kept = {name: text for name, text in defaults.items() if name not in _LIMITS}
    return {**kept, **{name: main[name] for name in _LIMITS if name in main}}
