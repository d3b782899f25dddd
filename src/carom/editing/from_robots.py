"""Robots, as readers of URDF, SDF and USD describe them, as descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf

import numpy as np

from carom.description import (
    Box,
    Capsule,
    Collision,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Inertial,
    Joint,
    JointType,
    Link,
    Mesh,
    Plane,
    Pose,
    Robot,
    Sphere,
    TriangleMesh,
    Visual,
)
from carom.description.actuator import UNBOUNDED, ActuatorSpec
from carom.description.compliance import Compliance
from carom.description.transform import compose, turn_of_z
from carom.editing.elements import new, place, section, walk, words
from carom.editing.losses import Losses
from carom.editing.masses import inertial_element
from carom.editing.moving import put_into
from carom.editing.references import WORLD
from carom.errors import DescriptionError
from carom.formats.mesh.reader import read_mesh
from carom.formats.mjcf.compiled.context import Compiler
from carom.formats.mjcf.compiled.inertia import BodyInertia, bounded
from carom.formats.placed import PlacedRobot
from carom.formats.xml_element import Element, PlacedElement
from carom.layouts.codes import ActivationDynamics
from carom.lazy_dataclasses import fields, replace

Driven = tuple[int, ActuatorSpec]
"""The number of a robot, and an actuator of it."""
_TYPES = {
    JointType.REVOLUTE: "hinge",
    JointType.CONTINUOUS: "hinge",
    JointType.PRISMATIC: "slide",
    JointType.SPHERICAL: "ball",
}
_DYNAMICS = {
    ActivationDynamics.NONE: "none",
    ActivationDynamics.INTEGRATOR: "integrator",
    ActivationDynamics.FILTER: "filter",
    ActivationDynamics.FILTER_EXACT: "filterexact",
}
_MESHES_OF_MUJOCO = (".obj", ".stl", ".msh")
_TURNS = (0.005, 0.0001)
"""Torsional and rolling friction of MJCF where nothing is stated [m]."""
_STILL = (JointType.FIXED, JointType.FLOATING)
_LEAST = 1e-15
"""Least mass and moments of bodies that move in MuJoCo."""
_UNIT = (1.0, 1.0, 1.0)
_NO_NOTE = "it is a note for scripts"


def description_of(
    robots: Sequence[PlacedRobot], actuators: Iterable[Driven], name: str, losses: Losses
) -> PlacedElement:
    """The root of a description of robots, and of actuators besides those that they have.

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
    return writer.root


class _Writer:
    def __init__(self, losses: Losses) -> None:
        self.root = new("mujoco")
        self.losses = losses
        section(self.root, "compiler").attributes["angle"] = "radian"
        self.world = section(self.root, "worldbody")
        self._meshes: dict[tuple[object, ...], str] = {}
        self._names: set[str] = set()
        self._prefix = ""

    def add(self, placed: PlacedRobot, prefix: str) -> None:
        self._prefix = prefix
        robot = placed.robot
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
            moves = not placed.fixed_base if joint is None else joint.type not in _STILL
            body = self._body(robot.links[index], frame, moves=moves)
            parent.children.append(body)
            at = 1 if body.children and body.children[0].tag == "inertial" else 0
            if joint is not None:
                body.children[at:at] = self._joints(joint)
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
        friction = self._friction(link)
        for collision in link.collisions:
            if (geom := self._geom(collision)) is not None:
                geom.attributes.update(friction)
                geom.attributes["group"] = "3"
                self._bits(collision, geom)
                body.children.append(geom)
        for visual in link.visuals:
            if not visual.stands_in and (geom := self._geom(visual)) is not None:
                geom.attributes |= {"contype": "0", "conaffinity": "0", "group": "2"}
                self._look(visual, geom)
                body.children.append(geom)
        return body

    def _notes(self, link: Link) -> None:
        if link.user_data:
            self.losses.add("link", "none: a note", _NO_NOTE, "user_data")
        if link.fluid is not None:
            self.losses.add("link", "fluids see the box of its inertia", "geoms say it", "fluid")
        known = ("lateral_friction", "rolling_friction", "spinning_friction", "inertia_scaling")
        for field in fields(link.contact):
            value = getattr(link.contact, field.name)
            if field.name not in known and value not in (None, False, 0):
                self.losses.add(
                    "link/contact", "contacts are as usual in MuJoCo", "MJCF has other terms", field.name
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

    @staticmethod
    def _friction(link: Link) -> dict[str, str]:
        contact = link.contact
        stated = (contact.lateral_friction, contact.spinning_friction, contact.rolling_friction)
        if stated == (None, None, None):
            return {}
        sliding, spinning, rolling = stated
        found = {
            "friction": words(
                (
                    1.0 if sliding is None else sliding,
                    spinning or _TURNS[0],
                    rolling or _TURNS[1],
                )
            )
        }
        if rolling or spinning:
            found["condim"] = "6" if rolling else "4"
        return found

    def _bits(self, collision: Collision, geom: Element) -> None:
        if collision.group is not None or collision.mask is not None:
            group, mask = (
                0x7FFFFFFF if bits is None or bits < 0 else bits for bits in (collision.group, collision.mask)
            )
            geom.attributes |= {"contype": str(group), "conaffinity": str(mask)}
            self.losses.add(
                "collision",
                "it also collides with what either of both lets it",
                "MuJoCo needs one of both masks, Bullet both",
                "group",
                "mask",
            )

    def _look(self, visual: Visual, geom: Element) -> None:
        material = visual.material
        if visual.user_data:
            self.losses.add("visual", "none: a note", _NO_NOTE, "user_data")
        if material is None:
            return
        if material.rgba is not None:
            geom.attributes["rgba"] = words(material.rgba)
        if material.texture is not None:
            self.losses.add(
                "visual/material", "none for the dynamics: no texture", "colours are kept", "texture"
            )
        if material.specular is not None:
            self.losses.add("visual/material", "none for the dynamics", "colours are kept", "specular")

    def _geom(self, shape: Collision | Visual) -> Element | None:
        """A geom without mass; None for a shape that MJCF has not, which is reported."""
        geom = new("geom")
        if shape.name and shape.name not in self._names:
            self._names.add(shape.name)
            geom.attributes["name"] = shape.name
        pose = shape.frame
        match shape.geometry:
            case Box(half):
                stated = {"type": "box", "size": words(half)}
            case Sphere(radius):
                stated = {"type": "sphere", "size": words((radius,))}
            case Cylinder(radius, length):
                stated = {"type": "cylinder", "size": words((radius, 0.5 * length))}
            case Capsule(radius, length):
                stated = {"type": "capsule", "size": words((radius, 0.5 * length))}
            case Plane(normal):
                stated = {"type": "plane", "size": "0 0 0.01"}
                pose = compose(pose, Pose(orientation=turn_of_z(normal)))
            case Mesh() | TriangleMesh() | ConvexHull():
                stated = {"type": "mesh", "mesh": self._mesh(shape.geometry, shape)}
            case _:
                kind = type(shape.geometry).__name__
                has = (
                    "they are relative to a file"
                    if isinstance(shape.geometry, Heightfield)
                    else "no such shape"
                )
                self.losses.add("shape", f"there is no {kind}", f"MJCF: {has}", "geometry")
                return None
        sizes = [float(size) for size in stated.get("size", "1").split()]
        if stated["type"] != "plane" and not all(size > 0.0 for size in sizes):
            self.losses.add("shape", "it is missing", "MJCF has no shapes of size 0", "size")
            return None
        geom.attributes |= stated
        geom.attributes["mass"] = "0"
        place(geom, pose)
        return geom

    def _mesh(self, geometry: Geometry, shape: Collision | Visual) -> str:
        """The name of the asset of a mesh."""
        if isinstance(geometry, Mesh):
            key: tuple[object, ...] = (geometry.path, geometry.scale)
            stem = geometry.path.stem
        else:
            key, stem = (id(geometry),), "mesh"
        if isinstance(shape, Collision):
            self._hull_note(geometry)
        if key in self._meshes:
            return self._meshes[key]
        number, name = 1, stem
        while name in self._meshes.values():
            number += 1
            name = f"{stem}_{number}"
        self._meshes[key] = name
        # Their bodies state masses, so it need not be a closed surface.
        asset = new("mesh", None, {"name": name, "inertia": "shell"})
        match geometry:
            case Mesh(path, scale):
                if path.suffix.lower() in _MESHES_OF_MUJOCO:
                    asset.attributes["file"] = str(path.absolute())
                else:
                    parts = read_mesh(path)
                    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
                    _state(
                        asset,
                        np.concatenate([part.vertices for part in parts]),
                        np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=False)]),
                    )
                if scale != _UNIT:
                    asset.attributes["scale"] = words(scale)
            case TriangleMesh(vertices, triangles):
                _state(asset, vertices, triangles)
            case ConvexHull(points):
                asset.attributes["vertex"] = words(np.asarray(points).reshape(-1))
            case _:
                raise AssertionError(geometry)
        section(self.root, "asset").children.append(asset)
        return name

    def _hull_note(self, geometry: Geometry) -> None:
        if isinstance(geometry, TriangleMesh) or (isinstance(geometry, Mesh) and geometry.concave):
            self.losses.add(
                "collision", "its convex hull collides, not its triangles", "so are meshes of MJCF", "concave"
            )
        elif isinstance(geometry, Mesh) and len(read_mesh(geometry.path)) > 1:
            self.losses.add(
                "collision", "the hull of all its parts collides, not that of each", "so are meshes of MJCF"
            )

    def _joints(self, joint: Joint) -> list[Element]:
        name = self._prefix + joint.name
        if joint.safety is not None:
            self.losses.add("joint/safety_controller", "none here: no program runs it", "MJCF has none")
        if joint.limit.velocity > 0.0:
            self.losses.add(
                "joint/limit",
                "none for the dynamics: programs do not learn it",
                "MJCF has no greatest speeds",
                "velocity",
            )
        if joint.type in _STILL:
            if joint.type is JointType.FLOATING:
                self.losses.add("joint", "it is fixed", "only bodies of the world are free", "type")
            return []
        if joint.type is JointType.PLANAR:
            return self._planar(joint, name)
        element = new("joint", None, {"name": name, "type": _TYPES[joint.type]})
        if joint.type is not JointType.SPHERICAL:
            element.attributes["axis"] = words(joint.axis)
        lower, upper = joint.limit.lower, joint.limit.upper
        if joint.type not in (JointType.CONTINUOUS, JointType.SPHERICAL) and lower <= upper:
            element.attributes["range"] = words((lower, upper))
            element.attributes["limited"] = "true"
            self._yields(element, "limit", joint.limit_compliance)
            if joint.limit_margin:
                element.attributes["margin"] = words((joint.limit_margin,))
        elif joint.type is JointType.SPHERICAL and lower <= upper:
            self.losses.add(
                "joint/limit", "it turns freely", "MJCF limits the angle of all of it", "lower", "upper"
            )
        self._terms(joint, element)
        return [element]

    def _terms(self, joint: Joint, element: Element) -> None:
        terms = {
            "damping": joint.damping,
            "frictionloss": joint.friction,
            "armature": joint.armature,
            "stiffness": joint.stiffness,
            "springref": joint.spring_reference,
        }
        element.attributes.update({name: words((value,)) for name, value in terms.items() if value})
        if joint.friction:
            self._yields(element, "friction", joint.friction_compliance)
        effort = joint.limit.effort
        if 0.0 < effort < inf and joint.type is not JointType.SPHERICAL:
            element.attributes["actuatorfrcrange"] = words((-effort, effort))

    @staticmethod
    def _yields(element: Element, what: str, compliance: Compliance | None) -> None:
        if compliance is not None:
            it = compliance
            element.attributes[f"solref{what}"] = words((it.time_constant, it.damping_ratio))
            element.attributes[f"solimp{what}"] = words(
                (it.least, it.greatest, it.width, it.midpoint, it.power)
            )

    def _planar(self, joint: Joint, name: str) -> list[Element]:
        """Two sliders in the plane and a hinge about its normal."""
        turn = Pose(orientation=turn_of_z(joint.axis))
        found = []
        for suffix, kind, axis in (("x", "slide", (1.0, 0.0, 0.0)), ("y", "slide", (0.0, 1.0, 0.0))):
            along = compose(turn, Pose(axis)).position
            found.append(new("joint", None, {"name": f"{name}_{suffix}", "type": kind, "axis": words(along)}))
        found.append(new("joint", None, {"name": f"{name}_turn", "type": "hinge", "axis": words(joint.axis)}))
        for element in found:
            self._terms(replace(joint, limit=replace(joint.limit, effort=0.0)), element)
        self.losses.add(
            "joint",
            f"it is three joints, {name}_x, {name}_y and {name}_turn",
            "MJCF has no planar joints",
            "type",
        )
        return found

    def _couple(self, joint: Joint) -> None:
        if joint.mimic is None or joint.type not in _TYPES:
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
        """Add an actuator as a `<general>` one; others than those of joints are reported."""
        if not spec.joint or spec.muscle is not None or spec.dynamics not in _DYNAMICS:
            self.losses.add("actuator", f"{spec.name!r} does not act", "only those of joints are described")
            return
        attributes = {"name": prefix + spec.name, "joint": prefix + spec.joint}
        attributes["gear"] = words((spec.gear,))
        attributes["gaintype"] = "affine" if any(spec.gain[1:]) else "fixed"
        attributes["gainprm"] = words(spec.gain)
        attributes["biastype"] = "affine" if any(spec.bias) else "none"
        attributes["biasprm"] = words(spec.bias)
        attributes["dyntype"] = _DYNAMICS[spec.dynamics]
        attributes["dynprm"] = words((spec.time_constant,))
        for name, bounds in (
            ("ctrl", spec.control_range), ("force", spec.force_range), ("act", spec.activation_range),
        ):  # fmt: skip
            if bounds != UNBOUNDED:
                attributes[f"{name}limited"] = "true"
                attributes[f"{name}range"] = words(bounds)
        section(self.root, "actuator").children.append(new("general", None, attributes))


def _state(asset: Element, vertices: np.ndarray, triangles: np.ndarray) -> None:
    asset.attributes["vertex"] = words(np.asarray(vertices).reshape(-1).tolist())
    asset.attributes["face"] = " ".join(map(str, np.asarray(triangles).reshape(-1).tolist()))
