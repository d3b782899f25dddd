"""`<default>`: default attributes of elements."""

from __future__ import annotations

from carom.files.xml_element import Element
from carom.formats.mjcf.context import MjcfContext
from carom.formats.reading.cursor import Recorded, layered
from carom.formats.robot.context import shown

MAIN = "main"
_LIMITS = ("limited", "range")
Attributes = dict[str, str]


def read_defaults(
    context: MjcfContext, element: Element, parent: str | None = None, *, once: bool = False
) -> None:
    """Read a `<default>` and the classes nested in it; each class inherits the defaults of its parent.

    The outermost is the main class, whatever its name; several outermost ones add up, and a class inherits
    what its parent has by then. That a nested class appears `once` is checked if asked for.
    """
    name = element.attributes.get("class", MAIN if parent is None else "")
    if not name:
        raise context.error(element, "attribute 'class' is missing")
    if once and parent is not None and name in context.classes:
        raise context.error(element, f"the default class {shown(name)} is there already")
    inherited = context.classes.get(parent or MAIN, {})
    own = {kind: layered(attributes, {}) for kind, attributes in inherited.items()}
    context.classes[name] = own
    if parent is None:
        context.classes[MAIN] = own
    for child in element.children:
        if child.tag != "default":
            own[child.tag] = context.over(own.get(child.tag, {}), child.attributes)
    for child in element.all("default"):
        read_defaults(context, child, name, once=once)


def class_defaults(context: MjcfContext, element: Element, child_class: str | None) -> Attributes:
    """The defaults of an element: from its class, that of the enclosing bodies, or the main one.

    A class that does not exist is an error for MuJoCo; PyBullet takes the main one instead.
    """
    name = element.attributes.get("class") or child_class or MAIN
    if name not in context.classes and name != MAIN:
        problem = f"there is no default class {shown(name)}"
        if context.as_mujoco:
            raise context.error(element, problem)
        context.warn(element, f"{problem}; the main one is used")
        name = MAIN
    defaults = context.classes.get(name, {}).get(element.tag, {})
    if isinstance(defaults, Recorded):
        defaults.note_use()
    return defaults


def limits_left_out(
    context: MjcfContext, element: Element, child_class: str | None, defaults: Attributes
) -> Attributes:
    """The defaults of a joint, without limits from a named class if these are to be ignored as in PyBullet.

    Joints that state `limited="true"` keep them, since they may have no others: for a joint without any,
    PyBullet ends the process.
    """
    in_main = (element.attributes.get("class") or child_class or MAIN) == MAIN
    if context.as_mujoco or in_main or element.attributes.get("limited") == "true":
        return defaults
    main = context.classes.get(MAIN, {}).get(element.tag, {})
    kept = {name: text for name, text in defaults.items() if name not in _LIMITS}
    return {**kept, **{name: main[name] for name in _LIMITS if name in main}}
