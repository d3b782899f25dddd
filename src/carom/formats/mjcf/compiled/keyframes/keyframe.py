"""`<keyframe>`: named states of all joints."""

from __future__ import annotations

from collections.abc import Mapping

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel, FileKeyframe


def read_keyframes(context: CompiledContext, element: Element, model: CompiledModel) -> None:
    """Add the keys of a `<keyframe>` to a model whose actuators and reference are known.

    Where a key has fewer numbers than there are, the others are those of the reference, or 0.

    Raises:
        DescriptionError: A key is broken, or has too many numbers.
    """
    rates = sum({"free": 6, "spherical": 3}.get(kind, 1) for _, _, kind in model.joints)
    activations = sum(it.has_activation for it in model.actuators)
    for number, key in enumerate(element.all("key")):
        attributes = key.attributes
        name = attributes.get("name", "") or str(number)

        def values(
            attribute: str, usual: list[float], what: str = "joints", of: Element = key
        ) -> tuple[float, ...]:
            text = of.attributes.get(attribute, "")
            found = context.singles(of, attribute, text)
            if len(found) > len(usual) and attribute in model.lacks:
                context.leave_out(of, "it does not count", "it has numbers for what is not built", attribute)
                return ()
            if len(found) > len(usual):
                raise context.error(
                    of, f"{attribute} has {len(found)} numbers; the {what} of the file have {len(usual)}"
                )
            return (*found, *usual[len(found) :]) if found else ()

        if name in model.keyframes:
            raise context.error(key, f"there are two keyframes {name!r}")
        model.keyframes[name] = FileKeyframe(
            name,
            context.number(key, attributes, "time", 0.0),
            values("qpos", model.reference),
            values("qvel", [0.0] * rates),
            values("ctrl", [0.0] * len(model.actuators), "actuators"),
            values("act", [0.0] * activations, "actuators with activations"),
        )


def reference_of(model: CompiledModel, bodies: Mapping[str, CompiledBody]) -> list[float]:
    """The positions of all joints at the reference, as a key has them."""
    found: list[float] = []
    for name, body, kind in model.joints:
        if kind == "free":
            x, y, z, w = bodies[body].pose.orientation
            found += [*bodies[body].pose.position, w, x, y, z]
        elif kind == "spherical":
            found += [1.0, 0.0, 0.0, 0.0]
        else:
            found.append(model.starts.get(name, 0.0))
    return found
