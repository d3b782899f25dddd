"""Bodies that are nodes of a flex: they slide along three axes, and have nothing but mass."""

from __future__ import annotations

from math import inf

import numpy as np

from carom.description.joint import SLIDES
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.body import BodyReader
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.model import NODE, CompiledBody, CompiledJoint

_SLIDERS = 3
_SQUARE = 1e-9
# A body is no node if an element of these refers to it; those of other sections know nodes.
_DRIVING = ("actuator", "tendon")
_WITHOUT_REFERENCES = ("worldbody", "asset", "default", "keyframe")
# What joints of nodes say that soft bodies cannot do.
_TERMS = ("damping", "stiffness", "frictionloss", "armature", "range", "springdamper")


class NodeBodies:
    """Finds bodies that are nodes and takes them out of those that have been read.

    Attributes:
        taken: Those that have been taken out, by name.
        scope: The reading of the flex that is looked at, for errors.
    """

    scope: Scope

    def __init__(self, reader: BodyReader, world: CompiledBody) -> None:
        self._reader, self._world = reader, world
        self.taken: dict[str, CompiledBody] = {}
        self._around: dict[str, CompiledBody] = {
            child.name: body for body in (world, *reader.bodies) for child in body.children
        }
        self._bodies = {body.name: body for body in reader.bodies}
        self._used: set[str] | None = None

    def problem(self, names: list[str]) -> str:
        """Why bodies cannot be the nodes of one flex; empty if they can."""
        moving = [name for name in names if self.is_node(name)]
        if not moving:
            return "none of its bodies is a node, which slides along three axes and has nothing else in it"
        if len(set(moving)) < len(moving):
            return "two of its vertices move with one body that slides"
        if not self.taken.keys().isdisjoint(moving):
            return "a body that slides is a node of another flex already"
        return ""

    def is_node(self, name: str) -> bool:
        """Whether a body slides along three axes, and nothing is in it or refers to what is."""
        body = self._bodies.get(name)
        if body is None or len(body.joints) != _SLIDERS or body.children or body.is_mocap:
            return False
        axes = np.array([it.joint.axis for it in body.joints])
        if any(it.joint.type not in SLIDES for it in body.joints):
            return False
        # The largest cosine between two of them.
        if max(abs(float((axes[a] * axes[b]).sum())) for a, b in ((0, 1), (1, 2), (2, 0))) > _SQUARE:
            return False
        return not self._inside(name) & self._references()

    def take(self, flex: FileFlex) -> None:
        """Take the bodies that are nodes of a flex out of the others, and report what is lost of them."""
        reader, model = self._reader, self._reader.model
        names = set(flex.bodies.values())
        for name in flex.bodies.values():
            body = self.taken[name] = self._bodies[name]
            self._report(body)
        for around in {id(self._around[name]): self._around[name] for name in names}.values():
            around.children[:] = [child for child in around.children if child.name not in names]
        reader.bodies[:] = [body for body in reader.bodies if body.name not in names]
        for geom in [geom for geom, body in reader.geom_bodies.items() if body in names]:
            del reader.geom_bodies[geom], reader.geom_frames[geom], reader.geoms[geom]
        for site in [site.name for site in model.sites.values() if site.body in names]:
            del model.sites[site]
        for camera in [it.name for it in model.cameras.values() if it.body in names]:
            del model.cameras[camera]
        model.lights = [light for light in model.lights if light.body not in names]
        for name in [joint for joint, body, _ in model.joints if body in names]:
            model.starts.pop(name, None)
        # As in MuJoCo, each counts as three sliders.
        model.joints = [(it[0], it[1], NODE) if it[1] in names else it for it in model.joints]

    def _report(self, body: CompiledBody) -> None:
        context = self.scope.context
        for it in body.joints:
            lost = [name for name in _TERMS if _says(it, name)]
            if lost:
                context.leave_out(it.element, "the node moves freely", "it is a node of a soft body", *lost)
        if body.visuals:
            context.leave_out(body.element, "its geoms are missing", "it is a node of a soft body")
        if any(site.body == body.name for site in self._reader.model.sites.values()):
            context.leave_out(body.element, "its sites are missing", "it is a node of a soft body")
        if any(
            it.body == body.name for it in (*self._reader.model.cameras.values(), *self._reader.model.lights)
        ):
            context.leave_out(
                body.element, "its cameras and lights are missing", "it is a node of a soft body"
            )
        if body.gravity_compensation:
            context.leave_out(
                body.element, "it has all its weight", "it is a node of a soft body", "gravcomp"
            )

    def _inside(self, name: str) -> set[str]:
        """Names of what is in a body, as elements may refer to it."""
        found = {f"joint:{it.joint.name}" for it in self._bodies[name].joints}
        found |= {f"geom:{geom}" for geom, body in self._reader.geom_bodies.items() if body == name and geom}
        found |= {f"site:{it.name}" for it in self._reader.model.sites.values() if it.body == name}
        return found | {f"body:{name}"}

    def _references(self) -> set[str]:
        """All that elements of sections refer to, with what it is."""
        if self._used is None:
            self._used = set()
            for scope in (Scope(self.scope.context), *self._reader.elements.attached):
                for section in scope.context.root.children:
                    if section.tag not in _WITHOUT_REFERENCES:
                        for element in section.children:
                            self._used |= _references(element, scope, section.tag)
        return self._used


def _references(element: Element, scope: Scope, section: str) -> set[str]:
    found: set[str] = set()
    pending = [element]
    while pending:
        each = pending.pop()
        pending += each.children
        if each.tag == "flex":
            continue
        # Going through items is no look-up, which would count as a use.
        for key, value in each.attributes.items():
            name = f"{scope.prefix}{value}{scope.suffix}"
            for kind in ("joint", "geom", "site"):
                if kind in key:
                    found.add(f"{kind}:{name}")
            if section in _DRIVING and "body" in key:
                found.add(f"body:{name}")
            if key in ("objname", "refname"):
                found |= {f"{kind}:{name}" for kind in ("joint", "geom", "site")}
    return found


def _says(joint: CompiledJoint, name: str) -> bool:
    """Whether a joint has a term other than 0."""
    it = joint.joint
    values = {
        "damping": it.damping,
        "stiffness": it.stiffness,
        "frictionloss": it.friction,
        "armature": it.armature,
        "range": it.limit.lower <= it.limit.upper and (it.limit.lower, it.limit.upper) != (-inf, inf),
        "springdamper": all(term > 0.0 for term in joint.spring_damper),
    }
    return bool(values[name])
