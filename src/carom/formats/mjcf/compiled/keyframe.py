"""`<keyframe>`: named states of all joints."""

from __future__ import annotations

from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.model import CompiledModel, FileKeyframe
from carom.formats.xml_element import Element

_COORDINATES = {"free": 7, "spherical": 4}


def read_keyframes(context: CompiledContext, element: Element, model: CompiledModel) -> None:
    """Add the keys of a `<keyframe>` to a model whose actuators are known; raises `DescriptionError`."""
    count = sum(_COORDINATES.get(kind, 1) for _, _, kind in model.joints)
    rates = sum({"free": 6, "spherical": 3}.get(kind, 1) for _, _, kind in model.joints)
    for number, key in enumerate(element.all("key")):
        attributes = key.attributes
        name = attributes.get("name", "") or str(number)

        def values(attribute: str, needed: int, what: str = "joints", of: Element = key) -> tuple[float, ...]:
            text = of.attributes.get(attribute, "")
            found = context.singles(of, attribute, text)
            if found and len(found) != needed:
                raise context.error(
                    of, f"{attribute} has {len(found)} numbers; the {what} of the file have {needed}"
                )
            return tuple(found)

        if name in model.keyframes:
            raise context.error(key, f"there are two keyframes {name!r}")
        model.keyframes[name] = FileKeyframe(
            name,
            context.number(key, attributes, "time", 0.0),
            values("qpos", count),
            values("qvel", rates),
            values("ctrl", len(model.actuators), "actuators"),
            values("act", sum(it.has_activation for it in model.actuators), "actuators with activations"),
        )
