"""Sites with sensors, and cameras, of files that are no MJCF, as elements of a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf

from carom.description.sensor import FRAME_KINDS, SensorKind, SensorSpec
from carom.editing.elements import bodies, new, place, section, words
from carom.editing.losses import Losses
from carom.files.xml_element import Element
from carom.formats.sdf.scene import Mount, SdfCamera

_NEVER = 1000.0
"""Reach of a range finder that states none [m]."""


@dataclass(slots=True)
class Fittings:
    """What is on the links of robots.

    Attributes:
        mounts: The number of a robot, and a site on one of its links with the sensors there.
        cameras: The number of a robot, and a camera on one of its links.
        options: Numbers of `<option>`, by name.
    """

    mounts: list[tuple[int, Mount]] = field(default_factory=list)
    cameras: list[tuple[int, SdfCamera]] = field(default_factory=list)
    options: dict[str, Sequence[float]] = field(default_factory=dict)


def add_fittings(root: Element, fittings: Fittings, prefixes: Sequence[str], losses: Losses) -> None:
    """Add sites, sensors, cameras and options to a description; `prefixes` are those of its robots."""
    known = {body.attributes["name"]: body for body in bodies(root)}
    for number, mount in fittings.mounts:
        prefix = prefixes[number]
        site = new("site", None, {"name": prefix + mount.name, "size": words((mount.reach,))})
        place(site, mount.frame)
        known[prefix + mount.link].children.append(site)
        for spec in mount.sensors:
            _add_sensor(root, prefix, spec, losses)
    for number, camera in fittings.cameras:
        prefix = prefixes[number]
        attributes = {
            "name": prefix + camera.name,
            "fovy": words((camera.field_of_view,)),
            "resolution": words(camera.resolution),
        }
        element = new("camera", None, attributes)
        place(element, camera.seen)
        known[prefix + camera.link].children.append(element)
    _add_options(root, fittings.options)


def _add_sensor(root: Element, prefix: str, spec: SensorSpec, losses: Losses) -> None:
    attributes = {"name": prefix + spec.name}
    if spec.kind in FRAME_KINDS:
        attributes |= {"objtype": "site", "objname": prefix + spec.object}
    else:
        attributes["site"] = prefix + spec.object
    for name, value in (("cutoff", spec.cutoff), ("delay", spec.delay), ("interval", spec.period)):
        if value:
            attributes[name] = words((value,))
    section(root, "sensor").children.append(new(spec.kind.value, None, attributes))
    for name, is_stated in (("noise", spec.noise), ("bias", any(spec.bias))):
        if is_stated:
            losses.add("sensor", f"{spec.name!r} has none", "sensors of MJCF are without", name)
    if spec.kind is SensorKind.RANGE_FINDER and spec.reach not in (_NEVER, inf):
        losses.add("sensor", f"{spec.name!r} sees farther", "rays of MJCF have no end", "reach")
    if spec.image is not None:
        losses.add(
            "sensor", f"{spec.name!r} has one ray", "images of ranges are those of cameras in MJCF", "image"
        )


def _add_options(root: Element, options: Mapping[str, Sequence[float]]) -> None:
    for name, values in options.items():
        section(root, "option").attributes[name] = words(values)
