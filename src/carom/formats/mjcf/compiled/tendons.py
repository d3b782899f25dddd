"""`<tendon>`: fixed ones over joints, and spatial ones through sites and around geoms."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.tendon import PathPart, TendonLook, TendonSpec
from carom.description.transform import compose
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.ties import Ties
from carom.formats.mjcf.compiled.body import WORLD, BodyReader
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.joint import actuator_range, first_number, is_limited
from carom.formats.mjcf.compiled.looks.material import GREY, read_material
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel, FilePart, FileTendon, Site
from carom.formats.mjcf.compiled.names import Names, in_order, resolved, section_attributes
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown
from carom.layouts.codes import PathKind

_LOST = "it does not pull"
_BUILT = ("fixed", "spatial")


class TendonReader:
    """Reads all `<tendon>` sections into a model whose robots are known."""

    def __init__(
        self, model: CompiledModel, names: Names, bodies: BodyReader, world: CompiledBody, ties: Ties
    ) -> None:
        self.model = model
        self._ties = ties
        self._names = names
        self._bodies = bodies
        self._lines: dict[str, int] = {}
        self._kinds = {name: kind for name, _, kind in model.joints if name}
        self._robot_of_joint = {
            joint.name: placed.robot.name for placed in model.robots for joint in placed.robot.joints
        }
        # World poses of bodies that do not move, and names of the robots of those that do.
        self.still: dict[str, Pose] = {WORLD: IDENTITY}
        self.moving: dict[str, str] = {}
        for body in world.children:
            pending = [(body, WORLD)]
            while pending:
                each, parent = pending.pop()
                if parent in self.still and not each.joints and not each.is_free and not each.is_mocap:
                    self.still[each.name] = compose(self.still[parent], each.pose)
                else:
                    self.moving[each.name] = body.name
                pending += [(child, each.name) for child in each.children]

    def read(self, scope: Scope) -> None:
        """Read the tendons of a file and of all that it attaches; raises `DescriptionError`."""
        scopes: list[Scope] = []
        for element, of in self._names.sections(scope, "tendon"):
            if element.tag not in _BUILT:
                raise of.context.error(element, f"<{element.tag}> is not known as a tendon")
            element.note()
            attributes = section_attributes(of, element, "tendon")
            for copy in self._copies(of, element):
                parts = self._parts(copy, element)
                name, robot = self._name(copy, element), self._robot(copy, element, parts)
                spring = copy.context.numbers(
                    element, "springlength", attributes.get("springlength", "-1"), 1, 2
                )
                text = attributes.get("stiffness", "0")
                stiffness, *terms = copy.context.numbers(element, "stiffness", text, 1, 3)
                tendon = FileTendon(
                    name,
                    parts,
                    robot,
                    stiffness,
                    first_number(copy, element, attributes, "damping", may_drive=True),
                    None if spring[0] == -1.0 else (spring[0], spring[-1]),
                    _range(copy, element, attributes),
                    copy.context.number(element, attributes, "frictionloss", 0.0),
                    replace(
                        read_compliance(copy, element, attributes, "limit"),
                        inverse_mass=self._inverse_mass(robot, parts),
                    ),
                    copy.context.number(element, attributes, "margin", 0.0),
                    self._armature(copy, element, attributes),
                    actuator_range(copy, element, attributes),
                    _look(copy, element, attributes),
                    ((*terms, 0.0, 0.0)[0], (*terms, 0.0, 0.0)[1]),
                )
                self._check(copy, element, tendon)
                self.model.tendons[name] = self._in_world(tendon)
                scopes.append(copy)
        self.model.tendons = dict(in_order([*self.model.tendons.items()], scopes))

    def add_ball_limits(self) -> None:
        """Add the limits of spherical joints: tendons along the angles of their rotations."""
        for name, (_, joint) in self._names.joints.items():
            if (limit := joint.ball_limit) is not None:
                robot, inverse_mass = self._robot_of_joint[name], self.model.joint_weights[name]
                self.model.tendons[f"{name}@limit"] = FileTendon(
                    f"{name}@limit",
                    (FilePart(PathKind.BALL, name, size=1.0),),
                    robot,
                    stiffness=0.0,
                    damping=0.0,
                    spring_range=None,
                    range=(-inf, limit.angle),
                    friction=0.0,
                    limit_compliance=replace(limit.compliance, inverse_mass=inverse_mass),
                    limit_margin=limit.margin,
                )

    @staticmethod
    def _armature(scope: Scope, element: Element, attributes: Attributes) -> float:
        armature = scope.context.number(element, attributes, "armature", 0.0)
        if armature and any(child.tag == "geom" for child in element.children):
            consequence = "its armature is as if moment arms of parts around geoms were constant"
            scope.context.leave_out(element, consequence, "what their rates add is not built", "armature")
        return armature

    def _copies(self, scope: Scope, element: Element) -> list[Scope]:
        """The scopes in which what a tendon refers to is known."""
        for kind, known in (("joint", self._kinds), ("site", self.model.sites)):
            wanted = [scope.context.required(child, kind) for child in element.children if child.tag == kind]
            if wanted:
                return self._names.copies_or_missing(scope, element, wanted, {*known}, kind)
        raise scope.context.error(element, "its path is empty")

    def _parts(self, scope: Scope, element: Element) -> tuple[FilePart, ...]:
        context, found = scope.context, []
        for child in element.children:
            child.note()
            match element.tag, child.tag:
                case "fixed", "joint":
                    name = resolved(scope, context.required(child, "joint"), self._kinds)
                    coefficient = context.parse_number(child, "coef", context.required(child, "coef"))
                    found.append(FilePart(PathKind.JOINT, name, size=coefficient))
                case "spatial", "site":
                    site = self._site(scope, child, context.required(child, "site"))
                    found.append(FilePart(PathKind.SITE, site.body, site.frame))
                case "spatial", "pulley":
                    divisor = context.parse_number(child, "divisor", context.required(child, "divisor"))
                    found.append(FilePart(PathKind.PULLEY, "", size=divisor))
                case "spatial", "geom":
                    found.append(self._geom(scope, child))
                case _:
                    raise context.error(child, f"<{child.tag}> is not known in a {element.tag} tendon")
        return tuple(found)

    def _site(self, scope: Scope, element: Element, name: str) -> Site:
        site = self.model.sites.get(resolved(scope, name, self.model.sites))
        if site is None:
            raise scope.context.error(element, f"there is no site {shown(name)}")
        return site

    def _geom(self, scope: Scope, element: Element) -> FilePart:
        name = scope.context.required(element, "geom")
        geom = self._bodies.geoms.get(resolved(scope, name, self._bodies.geoms))
        if geom is None:
            raise scope.context.error(element, f"there is no geom {shown(name)}")
        shape = geom.geometry
        if shape.tendon_path is None:
            raise scope.context.error(element, f"geom {shown(name)} is no sphere and no cylinder")
        on = self._bodies.geom_bodies[geom.name]
        part = FilePart(shape.tendon_path, on, geom.frame, shape.lengths()[0])
        side = element.attributes.get("sidesite")
        if not side:
            return part
        site = self._site(scope, element, side)
        return replace(part, side_on=site.body, side=site.frame.position)

    def _robot(self, scope: Scope, element: Element, parts: tuple[FilePart, ...]) -> str:
        """The robot that a tendon moves; empty if there is not one."""
        if any(part.kind is PathKind.JOINT and part.on not in self._names.joints for part in parts) or any(
            part.kind is PathKind.JOINT and self._kinds[part.on] == "spherical" for part in parts
        ):
            scope.context.leave_out(element, _LOST, "free and ball joints have no tendons")
            return ""
        robots = {
            self._robot_of_joint[part.on] if part.kind is PathKind.JOINT else self.moving.get(on, "")
            for part in parts
            for on in (part.on, part.side_on)
            if on
        }
        robots.discard("")
        reason = self._ties.join(robots) if robots else "it moves nothing"
        if reason:
            scope.context.leave_out(element, _LOST, reason)
            return ""
        return min(robots)

    def _inverse_mass(self, robot: str, parts: tuple[FilePart, ...]) -> float:
        """Inverse mass at the reference along a tendon over joints; 0 for others."""
        if not robot or any(part.kind is not PathKind.JOINT for part in parts):
            return 0.0
        of_robots: dict[str, list[tuple[str, float]]] = {}
        for part in parts:
            of_robots.setdefault(self._robot_of_joint[part.on], []).append((part.on, part.size))
        return sum(self.model.weight_along[name](shares) for name, shares in of_robots.items())

    def _check(self, scope: Scope, element: Element, tendon: FileTendon) -> None:
        path = tuple(PathPart(part.kind, size=part.size) for part in tendon.parts)
        try:
            TendonSpec(
                tendon.name, path, tendon.stiffness, tendon.damping, tendon.spring_range, tendon.range,
                tendon.friction, armature=tendon.armature, stiffness_terms=tendon.stiffness_terms,
            ).check()  # fmt: skip
        except DescriptionError as problem:
            raise scope.context.error(element, problem.reason) from None

    def _in_world(self, tendon: FileTendon) -> FileTendon:
        """A tendon with what is on bodies that do not move placed in the world."""
        parts = []
        for part in tendon.parts:
            if part.kind is not PathKind.JOINT and part.on in self.still:
                part = replace(part, on=WORLD, frame=compose(self.still[part.on], part.frame))
            if part.side_on in self.still:
                side = compose(self.still[part.side_on], Pose(part.side)).position
                part = replace(part, side_on=WORLD, side=side)
            parts.append(part)
        return replace(tendon, parts=tuple(parts))

    def _name(self, scope: Scope, element: Element) -> str:
        name = scope.name(element)
        if not name:
            return f"tendon{len(self.model.tendons)}_{scope.context.next_number()}"
        scope.context.refuse_duplicate(element, name, self._lines)
        return name


def _look(scope: Scope, element: Element, attributes: Attributes) -> TendonLook:
    context = scope.context
    return TendonLook(
        context.number(element, attributes, "width", 0.003),
        read_material(context, element, attributes).rgba or GREY,
        int(context.number(element, attributes, "group", 0.0)),
    )


def _range(scope: Scope, element: Element, attributes: dict[str, str]) -> tuple[float, float]:
    if not is_limited(scope, element, attributes, "limited", "range"):
        return -inf, inf
    text = attributes.get("range")
    if text is None:
        raise scope.context.error(element, "a limited tendon needs a range")
    lower, upper = scope.context.bounds(element, "range", text)
    return lower, upper
