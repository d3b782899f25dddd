"""Robots, as readers of URDF, SDF and USD describe them, as descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import fields, replace

import numpy as np

from carom.description import (
    Inertial,
    Joint,
    Link,
    Pose,
    Robot,
)
from carom.description.actuator import UNBOUNDED, ActuatorSpec
from carom.description.transform import compose
from carom.editing.elements import new, place, section, walk, words
from carom.editing.from_joints import STILL, TYPES, joint_elements
from carom.editing.from_mounts import Fittings, add_fittings
from carom.editing.from_shapes import ShapeWriter
from carom.editing.losses import Losses
from carom.editing.masses import inertial_element
from carom.editing.moving import put_into
from carom.editing.references import WORLD
from carom.errors import DescriptionError
from carom.files.xml_element import Element, PlacedElement
from carom.formats.mjcf.compiled.context import Compiler
from carom.formats.mjcf.compiled.inertia import BodyInertia, bounded
from carom.formats.placed import PlacedRobot
from carom.formats.robot.common_joints import with_common_joints
from carom.layouts.codes import ActivationDynamics

Driven = tuple[int, ActuatorSpec]
"""The number of a robot, and an actuator of it."""
_DYNAMICS = {
    ActivationDynamics.NONE: "none",
    ActivationDynamics.INTEGRATOR: "integrator",
    ActivationDynamics.FILTER: "filter",
    ActivationDynamics.FILTER_EXACT: "filterexact",
}
_LEAST = 1e-15
"""Least mass and moments of bodies that move in MuJoCo."""
_NO_NOTE = "it is a note for scripts"


def description_of(
    robots: Sequence[PlacedRobot],
    actuators: Iterable[Driven],
    name: str,
    losses: Losses,
    fittings: Fittings | None = None,
) -> PlacedElement:
    """The root of a description of robots, of actuators besides those that they have, and of fittings.

    Links are bodies, with the names of links and the masses that these state. Shapes that collide are geoms
    without mass; those that are only seen are in group 2 and collide with nothing. Roots that are not fixed
    have free joints. Couplings of joints are equalities.
    """
    writer = _Writer(losses)
    writer.root.attributes["model"] = name
    several = len({link.name for it in robots for link in it.robot.links}) < sum(
        len(it.robot.links) for it in robots
    )
    prefixes: list[str] = []
    for number, placed in enumerate(robots):
        if placed.robot.deformable is not None:
            raise DescriptionError(
                "soft bodies are not part of descriptions; load the file itself", file=placed.robot.source
            )
        prefix = f"{placed.robot.name or number}/" if several else ""
        prefixes.append(prefix)
        writer.add(placed, prefix)
    for number, spec in actuators:
        writer.actuator(spec, prefixes[number])
    if fittings is not None:
        add_fittings(writer.root, fittings, prefixes, losses)
    return writer.root


class _Writer:
    def __init__(self, losses: Losses) -> None:
        self.root = new("mujoco")
        self.losses = losses
        section(self.root, "compiler").attributes["angle"] = "radian"
        self.world = section(self.root, "worldbody")
        self.shapes = ShapeWriter(self.root, losses)
        self._prefix = ""

    def add(self, placed: PlacedRobot, prefix: str) -> None:
        self._prefix = prefix
        robot = with_common_joints(placed.robot)
        parents = {joint.child: joint for joint in robot.joints}
        children: dict[int, list[int]] = {}
        for child, joint in parents.items():
            children.setdefault(joint.parent, []).append(child)
        pending: list[tuple[int, Element]] = [(robot.root, self.world)]
        while pending:
            index, parent = pending.pop(0)
            joint = parents.get(index)
            if joint is None and placed.fixed_base and robot.links[index].name == WORLD:
                # It is the world.
                body = self._body(robot.links[index], placed.pose, moves=False)
                for element in body.all("geom"):
                    put_into(element, placed.pose)
                    self.world.children.append(element)
                for child in children.get(index, []):
                    pending.append((child, self.world))
                continue
            frame = placed.pose if joint is None else joint.frame
            if joint is not None and parent is self.world:
                frame = compose(placed.pose, frame)
            moves = not placed.fixed_base if joint is None else joint.type not in STILL
            body = self._body(robot.links[index], frame, moves=moves)
            parent.children.append(body)
            at = 1 if body.children and body.children[0].tag == "inertial" else 0
            if joint is not None:
                body.children[at:at] = joint_elements(joint, prefix + joint.name, self.losses)
            elif not placed.fixed_base:
                body.children.insert(at, self._free(robot))
            pending += [(child, body) for child in children.get(index, [])]
        if robot.is_mocap:
            self.world.children[-1].attributes["mocap"] = "true"
        for joint in robot.joints:
            self._couple(joint)
        if robot.user_data:
            self.losses.add("robot", "none: a note", _NO_NOTE, "user_data")
        for spec in robot.actuators:
            self.actuator(spec, prefix)

    def _free(self, robot: Robot) -> Element:
        name = f"{self._prefix}{robot.links[robot.root].name}_free"
        terms = {
            "damping": robot.base_damping,
            "armature": robot.base_armature,
            "stiffness": robot.base_stiffness,
        }
        stated = {term: words((value,)) for term, value in terms.items() if value}
        if stated:
            return new("joint", None, {"name": name, "type": "free", **stated})
        return new("freejoint", None, {"name": name})

    def _body(self, link: Link, pose: Pose, *, moves: bool) -> Element:
        # The world of a description has this name.
        name = f"{link.name}_link" if not self._prefix and link.name == WORLD else link.name
        body = new("body", None, {"name": self._prefix + name})
        place(body, pose)
        if link.gravity_compensation:
            body.attributes["gravcomp"] = words((link.gravity_compensation,))
        if link.inertial.mass or any(link.inertial.tensor):
            scaling = link.contact.inertia_scaling
            inertial = link.inertial
            if scaling is not None:
                a, b, c, d, e, f = (scaling * moment for moment in inertial.tensor)
                inertial = replace(inertial, tensor=(a, b, c, d, e, f))
            body.children.append(inertial_element(self._possible(link, inertial)))
        else:
            # Without it, geoms would have mass.
            body.children.append(inertial_element(Inertial(0.0)))
        if moves and (link.inertial.mass < _LEAST or max(link.inertial.tensor) < _LEAST):
            self.losses.add(
                "link/inertial",
                f"none here; MuJoCo refuses {link.name!r}",
                "bodies that move need mass there",
            )
        self._notes(link)
        body.children += self.shapes.geoms(link)
        return body

    def _notes(self, link: Link) -> None:
        if link.user_data:
            self.losses.add("link", "none: a note", _NO_NOTE, "user_data")
        if link.fluid is not None:
            self.losses.add("link", "fluids see the box of its inertia", "geoms say it", "fluid")
        known = (
            "lateral_friction",
            "rolling_friction",
            "spinning_friction",
            "friction_dimensions",
            "inertia_scaling",
        )
        stated = [("link/contact", link.contact)]
        stated += [("collision/contact", it.contact) for it in link.collisions if it.contact is not None]
        for element, contact in stated:
            for field in fields(contact):
                if field.name not in known and getattr(contact, field.name) not in (None, False, 0):
                    self.losses.add(
                        element, "contacts are as usual in MuJoCo", "MJCF has other terms", field.name
                    )

    def _possible(self, link: Link, inertial: Inertial) -> Inertial:
        """Mass and inertia that a body can have; where no body has the moments, they are made alike."""
        a, b, c, d, e, f = inertial.tensor
        found = BodyInertia(inertial.mass, np.zeros(3), np.array([[a, b, c], [b, d, e], [c, e, f]]))
        before = found.tensor
        bounded(found, Compiler(balance=True))
        if found.tensor is before:
            return inertial
        self.losses.add(
            "link/inertial",
            f"the moments of {link.name!r} are their mean, about all axes",
            "no body has those that are stated, and MuJoCo refuses them",
            "inertia",
        )
        mean = float(np.trace(before)) / 3.0
        return replace(inertial, tensor=(mean, 0.0, 0.0, mean, 0.0, mean))

    def _couple(self, joint: Joint) -> None:
        if joint.mimic is None or joint.type not in TYPES:
            return
        mimic = joint.mimic
        follower = self._prefix + joint.name
        attributes = {"name": follower, "joint1": follower}
        if self._moves(self._prefix + mimic.joint):
            attributes["joint2"] = self._prefix + mimic.joint
            attributes["polycoef"] = words((mimic.offset, mimic.multiplier, 0.0, 0.0, 0.0))
        else:
            attributes["polycoef"] = words((mimic.offset, 0.0, 0.0, 0.0, 0.0))
        section(self.root, "equality").children.append(new("joint", None, attributes))

    def _moves(self, name: str) -> bool:
        return any(it.tag == "joint" and it.attributes.get("name") == name for it in walk(self.world))

    def actuator(self, spec: ActuatorSpec, prefix: str) -> None:
        """Add an actuator as a `<general>` one; others than those of joints and sites are reported."""
        is_wrench = bool(spec.site) and not (spec.reference_site or spec.slider_site)
        if not (spec.joint or is_wrench) or spec.muscle is not None or spec.dynamics not in _DYNAMICS:
            reason = "only those of joints and sites are described"
            self.losses.add("actuator", f"{spec.name!r} does not act", reason)
            return
        on, gear = ("site", [spec.gear * it for it in spec.wrench]) if is_wrench else ("joint", [spec.gear])
        attributes = {"name": prefix + spec.name, on: prefix + (spec.site if is_wrench else spec.joint)}
        attributes["gear"] = words(gear)
        attributes["gaintype"] = "affine" if any(spec.gain[1:]) else "fixed"
        attributes["gainprm"] = words(spec.gain)
        attributes["biastype"] = "affine" if any(spec.bias) else "none"
        attributes["biasprm"] = words(spec.bias)
        attributes["dyntype"] = _DYNAMICS[spec.dynamics]
        attributes["dynprm"] = words((spec.time_constant,))
        if spec.acts_early:
            attributes["actearly"] = "true"
        for name, bounds in (
            ("ctrl", spec.control_range), ("force", spec.force_range), ("act", spec.activation_range),
        ):  # fmt: skip
            if bounds != UNBOUNDED:
                attributes[f"{name}limited"] = "true"
                attributes[f"{name}range"] = words(bounds)
        section(self.root, "actuator").children.append(new("general", None, attributes))
