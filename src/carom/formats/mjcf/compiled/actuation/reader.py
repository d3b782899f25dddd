"""Reading `<actuator>`: motors, servos, general actuators and muscles of joints, tendons and sites."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf

from carom.description.actuator import ActuatorSpec
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.balls import BALL, add_ball_sites, add_free_sites
from carom.formats.mjcf.compiled.actuation.law import (
    ADHESION,
    FILTER,
    FILTER_EXACT,
    INTEGRATOR,
    KINDS,
    MUSCLE,
    NONE,
    PID,
    PLUGIN,
    Law,
    Laws,
)
from carom.formats.mjcf.compiled.actuation.length_range import length_range
from carom.formats.mjcf.compiled.actuation.muscle import read_muscle
from carom.formats.mjcf.compiled.actuation.pid import bound_sums, inputs_of
from carom.formats.mjcf.compiled.actuation.plugins import apply_plugin, memories
from carom.formats.mjcf.compiled.actuation.ranges import has_activation, range_of, time_of, within_share
from carom.formats.mjcf.compiled.actuation.ties import Ties
from carom.formats.mjcf.compiled.elements import WORLD, Scope
from carom.formats.mjcf.compiled.equality import has_equalities
from carom.formats.mjcf.compiled.joint import FREE
from carom.formats.mjcf.compiled.model import CompiledModel, FileActuator
from carom.formats.mjcf.compiled.names import Names, full, in_order
from carom.formats.mjcf.defaults import MAIN, Attributes
from carom.formats.reading.cursor import Recorded
from carom.formats.robot.context import shown
from carom.layouts.codes import ActivationDynamics, PathKind

_DYNAMICS = {
    NONE: ActivationDynamics.NONE,
    INTEGRATOR: ActivationDynamics.INTEGRATOR,
    FILTER: ActivationDynamics.FILTER,
    FILTER_EXACT: ActivationDynamics.FILTER_EXACT,
    MUSCLE: ActivationDynamics.MUSCLE,
}
_UNBOUNDED = (-inf, inf)
_NO_FORCE = (0.0, 0.0)
_LOST = "it does not act"


class ActuatorReader:
    """Reads all `<actuator>` sections into a model."""

    def __init__(self, model: CompiledModel, names: Names, moving: Mapping[str, str], ties: Ties) -> None:
        """`moving` has the body of the world of each body that can move; `ties` joins these."""
        self.model = model
        self._ties = ties
        self.names = names
        self.moving = moving
        self._kinds = {name: kind for name, _, kind in model.joints if name}
        self._scopes: list[Scope] = []
        self._above = {child.name: body.name for body in names.bodies.values() for child in body.children}
        self._elements: dict[str, tuple[Element, Scope]] = {}
        # Of an input other than the first one of an element, what the name has behind that of the element.
        self._suffix = ""
        self._sums: list[tuple[FileActuator, Element, Scope]] = []

    def read(self, scope: Scope) -> None:
        """Read the actuators of a file and of all that it attaches; raises `DescriptionError`."""
        for element, of in self.names.sections(scope, "actuator"):
            if element.tag not in KINDS:
                raise of.context.error(element, f"<{element.tag}> is not known as an actuator")
            attributes, law = _law(of, element)
            is_unknown = element.tag == PLUGIN and not apply_plugin(of.context, element, attributes, law)
            if element.tag == PLUGIN and memories(of.context, element):
                self.model.lacks.add("act")
            if element.tag != PID:
                self._read_one(of, element, attributes, law, is_unknown=is_unknown)
                continue
            if law.pid.memories:
                self.model.lacks.add("act")
            for self._suffix, changed, of_input in inputs_of(of, element, attributes, law):
                self._read_one(of, element, changed, of_input)
            self._suffix = ""
        self.model.actuators = in_order(self.model.actuators, self._scopes)
        self._bound_joints()
        bound_sums(self.model, self.names.joints, self._sums)

    def _read_one(
        self, of: Scope, element: Element, attributes: Attributes, law: Law, *, is_unknown: bool = False
    ) -> None:
        """Add an actuator, or what an input of it adds."""
        known = set(self._kinds)
        joint = attributes.get("joint") or attributes.get("jointinparent") or ""
        tendon, site = attributes.get("tendon") or "", attributes.get("site") or ""
        crank = attributes.get("cranksite") or ""
        body = attributes.get("body") or ""
        if is_unknown or law.unbuilt() or not (joint or tendon or site or crank or body):
            self._leave_out(of, element, attributes, law)
        elif joint:
            for copy in self.names.copies_or_missing(of, element, [joint], known, "joint"):
                if self._kinds[full(copy, joint)] == FREE:
                    self._add_to_free(copy, element, attributes, law, full(copy, joint))
                elif self._kinds[full(copy, joint)] == BALL:
                    self._add_to_ball(copy, element, attributes, law, full(copy, joint))
                else:
                    self._add(copy, element, attributes, law, full(copy, joint))
        elif tendon:
            tendons = {*self.model.tendons}
            for copy in self.names.copies_or_missing(of, element, [tendon], tendons, "tendon"):
                self._add_to_tendon(copy, element, attributes, law, full(copy, tendon))
        elif crank:
            self._read_crank(of, element, attributes, law, crank)
        elif body:
            self._add_to_body(of, element, attributes, law, body)
        else:
            self._read_sites(of, element, attributes, law, site)

    def _add_to_ball(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, joint: str
    ) -> None:
        """Add an actuator that turns a spherical joint: a torque of one site relative to another."""
        body, _ = self.names.joints[joint]
        ball, socket = add_ball_sites(self.model, body, self._above.get(body.name, WORLD), joint)
        gear = scope.context.numbers(element, "gear", attributes.get("gear", "1"), 1, 6)
        x, y, z = (*gear, 0.0, 0.0)[:3]
        problem = "" if any((x, y, z)) else "its gear is 0"
        if len(body.joints) > 1:
            problem = "its body has other joints as well"
        if not attributes.get("joint"):
            # Along axes of what is around the joint.
            of_site, of_reference = ball, socket
        elif self.model.sites[socket].body in self.moving:
            of_site, of_reference = socket, ball
            x, y, z = -x, -y, -z
        else:
            # Such a torque may come from the world, but has no length then.
            of_site, of_reference = ball, ""
            if law.is_muscle or law.gains[1] or law.biases[1]:
                problem = problem or "its force depends on angles, and what is around its joint does not move"
            elif not problem:
                lost = "none for the motion: its length is 0"
                scope.context.leave_out(element, lost, "what is around its joint does not move", "joint")
        spec = ActuatorSpec(
            "", "", site=of_site, reference_site=of_reference, wrench=(0.0, 0.0, 0.0, x, y, z)
        )
        self._add_path(scope, element, attributes, law, spec, problem, None)

    def _add_to_free(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, joint: str
    ) -> None:
        """Add an actuator of a free joint: a force along axes of the world, or a torque.

        That is about axes of the body, or of the world with `jointinparent`. Its length is always 0.
        """
        body = next(of for name, of, _ in self.model.joints if name == joint)
        gear = scope.context.numbers(element, "gear", attributes.get("gear", "1"), 1, 6)
        fx, fy, fz, tx, ty, tz = (*gear, *(0.0,) * 6)[:6]
        of_body = bool(attributes.get("joint")) and any((tx, ty, tz))
        problem = "" if any(gear) else "its gear is 0"
        if of_body and any((fx, fy, fz)):
            problem = "its force is along axes of the world, its torque about those of the body"
        if law.is_muscle:
            problem = "its length is always 0"
        own, world = add_free_sites(self.model, body)
        spec = ActuatorSpec(
            "", "", site=own, reference_site="" if of_body else world, wrench=(fx, fy, fz, tx, ty, tz)
        )
        self._add_path(scope, element, attributes, law.without_length(), spec, problem, None)

    def _read_sites(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, site: str
    ) -> None:
        reference, sites = attributes.get("refsite") or "", {*self.model.sites}
        copies = self.names.copies_or_missing(scope, element, [site, reference], sites, "site")
        if self.names.crosses(copies, element, [site, reference], sites):
            return
        for copy in copies:
            of_site, of_reference = full(copy, site), full(copy, reference)
            moved = self.moving.get(self.model.sites[of_site].body, "")
            around = moved
            if reference:
                around = self.moving.get(self.model.sites[of_reference].body, "")
            problem = "it moves nothing" if not moved and not around else ""
            if moved and around:
                problem = self._ties.join([moved, around])
            gear = copy.context.numbers(element, "gear", attributes.get("gear", "1"), 1, 6)
            fx, fy, fz, tx, ty, tz = (*gear, *(0.0,) * 6)[:6]
            if not moved and not problem:
                # What acts on the world is the opposite at the other site, along the axes of that.
                of_site, of_reference = of_reference, ""
                fx, fy, fz, tx, ty, tz = -fx, -fy, -fz, -tx, -ty, -tz
                if law.is_muscle or law.gains[1] or law.biases[1]:
                    problem = (
                        "its first site is in the world, and its force depends on where the other one is"
                    )
            spec = ActuatorSpec(
                "", "", site=of_site, reference_site=of_reference, wrench=(fx, fy, fz, tx, ty, tz)
            )
            self._add_path(copy, element, attributes, law, spec, problem, None)

    def _add_to_body(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, body: str
    ) -> None:
        """Add an actuator that pulls a body towards all that touches it; its length is always 0."""
        if element.tag == ADHESION and law.gain[0] < 0.0:
            raise scope.context.error(element, f"gain={law.gain[0]:g} of adhesion must not be negative")
        bodies = {*self.names.bodies, WORLD}
        for copy in self.names.copies_or_missing(scope, element, [body], bodies, "body"):
            name = full(copy, body)
            problem = "its length is always 0" if law.is_muscle else ""
            if name not in self.moving:
                problem = "it pulls what does not move: let the other body have it"
            spec = ActuatorSpec("", "", link=name)
            self._add_path(copy, element, attributes, law.without_length(), spec, problem, None)

    def _read_crank(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, crank: str
    ) -> None:
        context, sites = scope.context, {*self.model.sites}
        slider = attributes.get("slidersite") or ""
        if not slider:
            raise context.error(element, "a crank needs a slidersite")
        rod = context.number(element, attributes, "cranklength", 0.0)
        if not rod > 0.0:
            raise context.error(element, f"cranklength={rod:g} must be greater than 0")
        gear = context.numbers(element, "gear", attributes.get("gear", "1"), 1, 6)[0]
        copies = self.names.copies_or_missing(scope, element, [crank, slider], sites, "site")
        if self.names.crosses(copies, element, [crank, slider], sites):
            return
        for copy in copies:
            ends = full(copy, crank), full(copy, slider)
            moved = {self.moving.get(self.model.sites[name].body, "") for name in ends} - {""}
            problem = "" if gear else "its gear is 0"
            problem = problem or (self._ties.join(moved) if moved else "it moves nothing")
            spec = ActuatorSpec("", "", site=ends[0], gear=gear or 1.0, slider_site=ends[1], rod=rod)
            self._add_path(copy, element, attributes, law, spec, problem, None)

    def _add_to_tendon(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law, tendon: str
    ) -> None:
        found = self.model.tendons[tendon]
        gear = scope.context.number(element, attributes, "gear", 1.0)
        problem = "its tendon is not simulated" if not found.robot else ""
        bounds = found.actuator_range
        spec = ActuatorSpec("", "", tendon=tendon, gear=gear or 1.0, joint_range=bounds)
        self._add_path(
            scope, element, attributes, law, spec, problem or ("" if gear else "its gear is 0"), found.range
        )

    def _add_path(
        self,
        scope: Scope,
        element: Element,
        attributes: Attributes,
        law: Law,
        spec: ActuatorSpec,
        problem: str,
        bounds: tuple[float, float] | None,
    ) -> None:
        """Add an actuator of a tendon or a site, which `spec` has; `bounds` are those of its length."""
        name, keeps = self._name(scope, element), has_activation(law)
        muscle = None
        if not problem and law.is_muscle:
            lengths, doubt = self._lengths(scope, element, spec, attributes)
            muscle, problem = read_muscle(scope, element, attributes, law, lengths, doubt)
        if problem:
            scope.context.leave_out(element, _LOST, problem)
            self._note(scope, FileActuator(name, None, keeps))
            return
        ranges = self._ranges(scope, element, attributes, law)
        if law.inherited:
            ranges["act" if law.dynamics == INTEGRATOR else "ctrl"] = within_share(
                scope, element, law, bounds or _UNBOUNDED, f"tendon {shown(spec.tendon)}"
            )
        whole = replace(
            spec,
            name=name,
            gain=law.gains,
            bias=law.biases,
            control_range=ranges["ctrl"],
            force_range=ranges["force"],
            dynamics=_DYNAMICS[law.dynamics],
            time_constant=time_of(law),
            activation_range=ranges["act"],
            muscle=muscle,
        )
        self._finish(scope, element, attributes, whole, law)

    def _lengths(
        self, scope: Scope, element: Element, spec: ActuatorSpec, attributes: Attributes
    ) -> tuple[tuple[float, float] | None, str]:
        """The range of lengths of a muscle at a tendon, times its gear, and what is in doubt about it.

        It is None if it is not found, or if the element states one.
        """
        stated = scope.context.numbers(element, "lengthrange", attributes.get("lengthrange", "0 0"), 2, 2)
        if not spec.tendon or stated[0] < stated[1]:
            return None, ""
        tendon, doubt = self.model.tendons[spec.tendon], self._doubt(scope)
        found, is_only = length_range(tendon.parts, self.names.bodies, self._above, self.names.joints)
        if found is not None and not is_only:
            doubt = doubt or "there are several ranges, and MuJoCo's simulation may find another one"
        lower, upper = found or (-inf, inf)
        # Limits of the tendon itself stop it, too.
        lower, upper = max(lower, tendon.range[0]), min(upper, tendon.range[1])
        if not -inf < lower < upper < inf:
            return None, ""
        if found is None:
            doubt = "joints that move the tendon may stop it before"
        return (spec.gear * lower, spec.gear * upper), doubt

    def _doubt(self, scope: Scope) -> str:
        """Why limits of joints alone may not bound the lengths of muscles; empty if they do."""
        held = has_equalities(self.names, scope)
        return "equality constraints may hold the joints that move it" if held else ""

    def _ranges(
        self, scope: Scope, element: Element, attributes: Attributes, law: Law
    ) -> dict[str, tuple[float, float]]:
        ranges = {
            kind: range_of(scope, element, attributes, kind, law)
            for kind in ("ctrl", "force", "act")
        }  # fmt: skip
        if law.motor is not None and law.motor.torque > 0.0:
            ranges["force"] = (-law.motor.torque, law.motor.torque)
        if self._is_off(scope, element, attributes):
            ranges["force"] = _NO_FORCE
        return ranges

    def _finish(
        self, scope: Scope, element: Element, attributes: Attributes, spec: ActuatorSpec, law: Law
    ) -> None:
        is_early = scope.context.flag(element, attributes, "actearly", default=False)
        if is_early and has_activation(law):
            spec = replace(spec, acts_early=True)
        try:
            spec.check()
        except DescriptionError as problem:
            raise scope.context.error(element, problem.reason) from None
        made = FileActuator(spec.name, spec, has_activation(law), law.damping_ratio)
        if element.tag == PID and len(law.pid.inputs) > 1 and spec.force_range != _UNBOUNDED:
            self._sums.append((made, element, scope))
        self._note(scope, made)

    def _leave_out(self, scope: Scope, element: Element, attributes: Attributes, law: Law) -> None:
        if element.tag == PLUGIN:
            reason = "actuators of plugins other than mujoco.pid are not built"
        elif law.unbuilt():
            reason = f"{law.unbuilt()} actuators are not built"
        else:
            raise scope.context.error(element, "it states nothing that it acts on, such as a joint")
        scope.context.leave_out(element, _LOST, reason)
        element.note()
        self._note(scope, FileActuator(self._name(scope, element), None, has_activation(law)))

    def _add(self, scope: Scope, element: Element, attributes: Attributes, law: Law, joint: str) -> None:
        name, keeps = self._name(scope, element), has_activation(law)
        gear = scope.context.number(element, attributes, "gear", 1.0)
        reason = "its gear is 0" if gear == 0.0 else ""
        muscle = None
        if not reason and law.is_muscle:
            limit = self.names.joints[joint][1].joint.limit
            finite = -inf < limit.lower < limit.upper < inf
            length = (limit.lower * gear, limit.upper * gear) if finite else None
            muscle, reason = read_muscle(scope, element, attributes, law, length, self._doubt(scope))
        if reason:
            scope.context.leave_out(element, _LOST, reason)
            self._note(scope, FileActuator(name, None, keeps))
            return
        _, of_joint = self.names.joints[joint]
        ranges = self._ranges(scope, element, attributes, law)
        if law.inherited:
            inherits = "act" if law.dynamics == INTEGRATOR else "ctrl"
            limit = of_joint.joint.limit
            ranges[inherits] = within_share(
                scope, element, law, (limit.lower, limit.upper), f"joint {shown(joint)}"
            )
        spec = ActuatorSpec(
            name,
            joint,
            law.gains,
            law.biases,
            gear,
            ranges["ctrl"],
            ranges["force"],
            _DYNAMICS[law.dynamics],
            time_of(law),
            ranges["act"],
            muscle=muscle,
        )
        self._finish(scope, element, attributes, spec, law)

    def _note(self, scope: Scope, actuator: FileActuator) -> None:
        self.model.actuators.append(actuator)
        self._scopes.append(scope)

    def _name(self, scope: Scope, element: Element) -> str:
        name = scope.name(element)
        if name and self._suffix:
            return name + self._suffix
        if not name:
            return f"actuator{len(self.model.actuators)}_{scope.context.next_number()}"
        if name in self._elements:
            line = self._elements[name][0].line
            raise scope.context.error(element, f"the name {shown(name)} is taken already, on line {line}")
        self._elements[name] = (element, scope)
        return name

    def _is_off(self, scope: Scope, element: Element, attributes: Attributes) -> bool:
        """Whether an option switches it off."""
        group = int(scope.context.number(element, attributes, "group", 0.0))
        return not self.model.options.get("flag.actuation", True) or group in self.model.options.get(
            "actuatorgroupdisable", ()
        )

    def _bound_joints(self) -> None:
        """Bound the sum of forces of actuators of a joint by what it allows."""
        for it in self.model.actuators:
            if it.spec is not None and it.spec.joint:
                _, of_joint = self.names.joints[it.spec.joint]
                if of_joint.actuator_range != _UNBOUNDED:
                    it.spec = replace(it.spec, joint_range=of_joint.actuator_range)
        reported: set[int] = set()
        for it in self.model.actuators:
            for joint in self._pulled_joints(it.spec) if it.spec is not None else ():
                element = self.names.joints[joint][1].element
                if self.names.joints[joint][1].actuator_range == _UNBOUNDED or id(element) in reported:
                    continue
                reported.add(id(element))
                self.names.joints[joint][1].context.leave_out(
                    element,
                    f"its bound is without the force of actuator {shown(it.name)}",
                    "forces along tendons and at sites have no bound of their sum",
                    "actuatorfrcrange",
                )

    def _pulled_joints(self, spec: ActuatorSpec) -> list[str]:
        """The joints on which an actuator of a tendon or of sites acts."""
        if spec.joint or spec.link:
            return []
        bodies = [
            self.model.sites[name].body for name in (spec.site, spec.reference_site, spec.slider_site) if name
        ]
        if spec.tendon:
            parts = self.model.tendons[spec.tendon].parts
            of_joints = [
                part.on for part in parts if part.on in self.names.joints and part.kind == PathKind.JOINT
            ]
            if of_joints:
                return of_joints
            bodies = [part.on for part in parts if part.on]
        chains = [self._chain(body) for body in bodies]
        # What moves all ends alike changes no length between them.
        shared = set.intersection(*map(set, chains)) if len(chains) > 1 else set[str]()
        moving = {body for chain in chains for body in chain} - shared
        return [name for name, (body, _) in self.names.joints.items() if body.name in moving]

    def _chain(self, body: str) -> list[str]:
        """A body and all above it."""
        found: list[str] = []
        while body:
            found.append(body)
            body = self._above.get(body, "")
        return found


def _law(scope: Scope, element: Element) -> tuple[Attributes, Law]:
    """All attributes of an actuator, with defaults of all kinds, and its law."""
    context, laws = scope.context, Laws()
    name = element.attributes.get("class") or MAIN
    if name not in context.classes and name != MAIN:
        raise context.error(element, f"there is no default class {shown(name)}")

    def numbers(attribute: str, text: str, most: int) -> list[float]:
        return context.numbers(element, attribute, text, 1, most)

    whole: Attributes = {}
    for tag, defaults in context.classes.get(name, {}).items():
        if tag in KINDS:
            if isinstance(defaults, Recorded):
                defaults.note_use()
            laws.apply(tag, defaults, numbers)
            whole = context.over(whole, defaults)
    law = laws.apply(element.tag, element.attributes, numbers)
    if law.motor is not None and (problem := law.motor.problem()):
        raise context.error(element, problem)
    return context.over(whole, element.attributes), law
