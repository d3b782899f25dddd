"""Rows of contacts, linearised: normals and lateral friction.

How a contact moves is known exactly where a ball, the end of a capsule, or a corner touches a plane or a
face, and where two balls touch.
"""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.layouts.codes import BASE_VELOCITIES, SPHERE, ShapeKind
from carom.layouts.contacts import THERE
from carom.linearization.contact_compliance import Compliance, compliance_of, pair_of_links
from carom.linearization.contact_features import touches_with_face, touching_radius
from carom.linearization.pair_rows import Places, Point
from carom.linearization.rows import HOLDS, LOWER, Rows, status_of
from carom.linearization.turns import cross, cross_matrix

if TYPE_CHECKING:
    from carom.linearization.free_motion import FreeMotion
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace

SLIDES = "slides"
_NONE = np.zeros(3)
_STICKS = 1.0 - 1e-7
_MAX_FRICTION = 10.0
_HALF_ROOT = float(np.sqrt(0.5))
_DEFAULT_DAMPING = 0.1


class _Contact(NamedTuple):
    """A contact, its points, its normal, and how that turns by a change of each dof, (3, n)."""

    number: int
    name: str
    a: Point
    b: Point
    normal: np.ndarray
    turned: np.ndarray


class _Sideways(NamedTuple):
    """How both rows of lateral friction of a contact yield.

    Attributes:
        softness: Velocity per impulse.
        softens: Its derivatives by positions and inputs, (n + inputs,).
        targets: Velocities of both at impulses of 0, (2,).
        by_velocity: Derivatives of these by velocities before the step, (2, n).
        sides: Derivatives of targets, less softness times impulse, by positions and inputs, (2, n + inputs).
    """

    softness: float
    softens: np.ndarray
    targets: np.ndarray
    by_velocity: np.ndarray
    sides: np.ndarray


class ContactRows:
    """Adds the rows of the contacts of a world in a step to `rows`."""

    def __init__(
        self, space: TangentSpace, taken: TakenStep, places: Places, motion: FreeMotion, rows: Rows
    ) -> None:
        self._space = space
        self._taken = taken
        self._places = places
        self._motion = motion
        self._rows = rows

    def add_all(self) -> None:
        """Add those of all contacts that push."""
        contacts = self._taken.contacts
        for number in range(int(contacts["count_contacts"][THERE])):
            if contacts["contact_impulse"][number, 0] > 0.0:
                self._add(self._contact(number))

    def _contact(self, number: int) -> _Contact:
        """A contact with its geometry; `NotImplementedError` if that has no exact derivatives."""
        taken = self._taken
        contacts, shapes = taken.contacts, taken.shapes
        shape_a, shape_b, link_a, link_b = contacts["contact_shapes"][number].tolist()
        kinds = shapes["shape_kind"][shape_a], shapes["shape_kind"][shape_b]
        described = " and ".join(ShapeKind(int(kind)).name.lower() for kind in kinds)
        name = f"contact {number} of {described}"
        self._check_at_rest(name, (shape_a, shape_b))
        normal = contacts["contact_normal"][number]
        points = contacts["contact_point_a"][number], contacts["contact_point_b"][number]
        turned = np.zeros((3, len(self._space)))
        if kinds[0] == SPHERE and kinds[1] == SPHERE:
            radii = [float(shapes["shape_size"][shape][0]) for shape in (shape_a, shape_b)]
            centres = points[0] + radii[0] * normal, points[1] - radii[1] * normal
            a, b = (self._places.point(*it) for it in zip((link_a, link_b), centres, strict=True))
            apart = a.position - b.position
            across = np.eye(3) - np.outer(normal, normal)
            turned = across @ (a.moving - b.moving) / np.sqrt(apart @ apart)
            moving = a.moving - radii[0] * turned, b.moving + radii[1] * turned
            ends = (
                a._replace(position=points[0], moving=moving[0]),
                b._replace(position=points[1], moving=moving[1]),
            )
            return _Contact(number, name, *ends, normal, turned)
        for side in (0, 1):
            shape, other = (shape_a, shape_b)[side], (shape_b, shape_a)[side]
            outward = normal if side == 0 else -normal
            radius = touching_radius(taken, shape, points[side], outward)
            if radius is None or not touches_with_face(taken, other, outward):
                continue
            core = self._places.point((link_a, link_b)[side], points[side] + radius * outward)
            face = self._places.point((link_b, link_a)[side], points[1 - side])
            turned = cross(face.turning.T, normal).T
            sign = 1.0 if side == 0 else -1.0
            moving = core.moving - sign * radius * turned
            # The point on the face is the projection of the other one.
            gap = points[0] - points[1]
            parting = normal @ (core.moving - face.moving)
            beside = moving - sign * (np.outer(normal, sign * parting) + (gap @ normal) * turned)
            own = core._replace(position=points[side], moving=moving)
            on_face = face._replace(moving=beside)
            ends = (own, on_face) if side == 0 else (on_face, own)
            return _Contact(number, name, *ends, normal, turned)
        raise NotImplementedError(f'a {name} has no exact derivatives: use method="differences"')

    def _check_at_rest(self, name: str, shapes: tuple[int, int]) -> None:
        """Raise `NotImplementedError` if a fixed base at a contact has been given a velocity."""
        taken = self._taken
        for tree in taken.shapes["shape_tree"][list(shapes)].tolist():
            first = int(taken.model["tree_first_velocity"][tree])
            moves = taken.state["dof_velocity"][first : first + BASE_VELOCITIES].any()
            if taken.model["tree_fixed"][tree] and moves:
                raise NotImplementedError(
                    f"{name} with a fixed base that has a velocity has no exact derivatives: "
                    'use method="differences"'
                )

    def _add(self, contact: _Contact) -> None:
        taken, rows = self._taken, self._rows
        link_a, link_b = taken.contacts["contact_shapes"][contact.number, 2:].tolist()
        friction, rolling, spinning = self._friction(contact, link_a, link_b)
        softness, erp = self._stiffness(link_a, link_b)
        distance = float(taken.contacts["contact_distance"][contact.number])
        yields = compliance_of(taken, (link_a, link_b), (friction, rolling, spinning), distance)
        gap = distance + taken.parameters.contact_slop
        gain = (1.0 if gap > 0.0 else erp) / taken.time_step
        impulses = taken.contacts["contact_impulse"][contact.number]
        normal_turns = np.stack([contact.turned, np.zeros_like(contact.turned)])
        jacobian, hessian = self._places.row(contact.a, contact.b, contact.normal, _NONE, normal_turns)
        self._check_restitution(contact, jacobian, link_a, link_b)
        softness = yields.softness if yields is not None else softness
        normal = rows.add(contact.name, HOLDS, jacobian, float(impulses[0]), 1.0, softness)
        rows.set_hessian(normal, hessian)
        parting = contact.normal @ (contact.a.moving - contact.b.moving)
        if yields is None:
            rows.by_position[normal] = -gain * parting
        else:
            h, push = taken.time_step, float(impulses[0])
            kept = 1.0 - h * yields.damping
            rows.by_velocity[normal] = kept * jacobian
            rows.by_position[normal] = kept * (taken.velocity @ hessian)
            rows.by_position[normal] -= (h * yields.pull_slope + push * yields.softness_slope) * parting
            self._set_friction(normal, -push * yields.by_friction, contact, "friction")
        directions, turns = self._directions(contact)
        lateral = [self._row_of(contact, *it) for it in zip(directions, turns, strict=True)]
        along = impulses[1:].tolist()
        sideways = None if yields is None else self._sideways(yields, contact, lateral, along, parting)
        self._add_pair(contact, "friction", normal, friction, lateral, along, sideways)
        if rolling > 0.0 or spinning > 0.0:
            self._add_torsion(contact, normal, rolling, spinning, (directions, turns))

    def _stiffness(self, a: int, b: int) -> tuple[float, float]:
        """Softness and error reduction of a normal row."""
        taken, shapes, h = self._taken, self._taken.shapes, self._taken.time_step
        springs = [float(shapes["link_stiffness"][link]) for link in (a, b)]
        if max(springs) < 0.0:
            return taken.parameters.global_cfm / h, taken.parameters.contact_erp
        compliance = sum(1.0 / spring for spring in springs if spring > 0.0)
        dampers = [float(shapes["link_contact_damping"][link]) for link in (a, b)]
        damping = sum(
            damper if spring > 0.0 and damper >= 0.0 else _DEFAULT_DAMPING
            for spring, damper in zip(springs, dampers, strict=True)
        )
        stiffness = 1.0 / max(compliance, np.finfo(float).eps)
        denominator = h * stiffness + damping
        return 1.0 / (denominator * h), h * stiffness / denominator

    def _friction(self, contact: _Contact, a: int, b: int) -> tuple[float, float, float]:
        """The coefficients of lateral, rolling and spinning friction."""
        shapes = self._taken.shapes
        pair = pair_of_links(self._taken, a, b)
        own = [float(shapes["link_lateral_friction"][link]) for link in (a, b)]
        ranks = [int(shapes["link_friction_rank"][link]) for link in (a, b)]
        if any((shapes["link_anisotropy"][link] != 1.0).any() for link in (a, b)):
            raise NotImplementedError(f"{contact.name}: anisotropic friction has no exact derivatives")
        if any(shapes["link_friction_anchor"][link] for link in (a, b)):
            raise NotImplementedError(f"{contact.name}: friction anchors have no exact derivatives")
        if pair is not None:
            lateral, rolling, spinning = shapes["filter_friction"][pair].tolist()
            return lateral, rolling, spinning
        found: list[float] = []
        for what in ("lateral", "rolling", "spinning"):
            x, y = (float(shapes[f"link_{what}_friction"][link]) for link in (a, b))
            if min(ranks) > 0:
                combined = max(x, y) if ranks[0] == ranks[1] else (x, y)[int(ranks[1] > ranks[0])]
            else:
                combined = x * y if what == "lateral" else x * own[1] + y * own[0]
            found.append(min(max(combined, -_MAX_FRICTION), _MAX_FRICTION))
        lateral, rolling, spinning = found
        return lateral, rolling, spinning

    def _check_restitution(self, contact: _Contact, jacobian: np.ndarray, a: int, b: int) -> None:
        shapes, taken = self._taken.shapes, self._taken
        restitution = shapes["link_restitution"][a] * shapes["link_restitution"][b]
        approach = -float(jacobian @ taken.free_velocity)
        if restitution > 0.0 and approach >= taken.parameters.restitution_velocity_threshold:
            raise NotImplementedError(f"{contact.name}: a bounce has no exact derivatives")

    def _row_of(
        self, contact: _Contact, direction: np.ndarray, turned: np.ndarray, *, angular: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Jacobian and its derivatives of a row along a direction, or about it, which turns by `turned`."""
        changes = np.zeros((2, 3, len(self._space)))
        changes[int(angular)] = turned
        linear, about = (_NONE, direction) if angular else (direction, _NONE)
        return self._places.row(contact.a, contact.b, linear, about, changes)

    def _add_torsion(
        self,
        contact: _Contact,
        normal: int,
        rolling: float,
        spinning: float,
        along: tuple[np.ndarray, np.ndarray],
    ) -> None:
        """Add rows of rolling and of spinning friction."""
        found = self._taken.torsion_impulses(contact.number)
        if found is None:
            raise NotImplementedError(
                f"{contact.name}: rolling and spinning friction have no exact derivatives where bodies "
                'are solved in several groups: use method="differences"'
            )
        if rolling > 0.0:
            jacobians = [self._row_of(contact, *it, angular=True) for it in zip(*along, strict=True)]
            self._add_pair(contact, "rolling friction", normal, rolling, jacobians, found[:2])
        if spinning > 0.0:
            own = self._row_of(contact, contact.normal, contact.turned, angular=True)
            self._add_pair(contact, "spinning friction", normal, spinning, [own], found[2:])

    def _add_pair(
        self,
        contact: _Contact,
        what: str,
        normal: int,
        friction: float,
        parts: list[tuple[np.ndarray, np.ndarray]],
        along: list[float],
        yields: _Sideways | None = None,
    ) -> None:
        """Add two rows of friction, or one, that the impulse of a normal row bounds.

        Args:
            contact: The contact.
            what: Name of the rows.
            normal: The normal row.
            friction: Coefficient of friction.
            parts: Jacobian and its derivatives of each row.
            along: Their impulses.
            yields: How they yield; None if they do not.
        """
        taken, rows = self._taken, self._rows
        push = rows.impulses[normal]
        bound = friction * push
        first = len(rows)
        for (jacobian, hessian), impulse in zip(parts, along, strict=True):
            row = rows.add(f"{what} of {contact.name}", HOLDS, jacobian, impulse, 0.0, 0.0)
            rows.set_hessian(row, hessian)
        cone = taken.parameters.cone_friction or taken.parameters.isotropic_friction
        # A row along which nothing moves is off, and its impulse 0.
        moves = [bool(jacobian.any()) for jacobian, _ in parts]
        if len(parts) == 1 or not cone or not all(moves):
            for row, impulse in enumerate(along, first):
                if not moves[row - first]:
                    rows.beta.append((row, row, 1.0))
                    continue
                status = status_of(impulse, -bound * _STICKS, bound * _STICKS)
                rows.names[row] = (rows.names[row][0], status)
                if status == HOLDS:
                    rows.alpha.append((row, row, 1.0))
                    if yields is not None:
                        self._let_yield(row, row - first, yields)
                    continue
                sign = -1.0 if status == LOWER else 1.0
                rows.beta += [(row, row, 1.0), (row, normal, -sign * friction)]
                self._set_friction(row, sign * push, contact, what)
            return
        second = first + 1
        size = hypot(*along)
        if size < bound * _STICKS:
            rows.alpha += [(first, first, 1.0), (second, second, 1.0)]
            if yields is not None:
                self._let_yield(first, 0, yields)
                self._let_yield(second, 1, yields)
            return
        for row in (first, second):
            rows.names[row] = (rows.names[row][0], SLIDES)
        x, y = along
        if size == 0.0:
            rows.beta += [(first, first, 1.0), (second, second, 1.0)]
            return
        # The impulse is as great as the bound, ...
        rows.beta += [(first, first, x / size), (first, second, y / size), (first, normal, -friction)]
        self._set_friction(first, push, contact, what)
        # ... and opposite to the change of the impulses that the rows still ask for.
        jacobians = [jacobian for jacobian, _ in parts]
        rates = np.array([jacobian @ taken.solved for jacobian in jacobians])
        if yields is not None:
            rates -= yields.targets
        softness = 0.0 if yields is None else yields.softness
        masses, changes = self._masses(jacobians, [hessian for _, hessian in parts], yields)
        asked = rates + softness * np.array([x, y])
        rows.alpha += [(second, first, masses[0] * y), (second, second, -masses[1] * x)]
        rows.beta += [
            (second, second, masses[0] * asked[0] - masses[1] * softness * x),
            (second, first, masses[0] * softness * y - masses[1] * asked[1]),
        ]
        changed = x * asked[1] * changes[1] - y * asked[0] * changes[0]
        if yields is not None:
            changed += masses[0] * y * yields.sides[0] - masses[1] * x * yields.sides[1]
            rows.by_velocity[second] = masses[0] * y * yields.by_velocity[0]
            rows.by_velocity[second] -= masses[1] * x * yields.by_velocity[1]
        rows.by_position[second] = changed[: len(self._space)]
        rows.by_input[second] = changed[len(self._space) :]

    def _sideways(
        self,
        yields: Compliance,
        contact: _Contact,
        parts: list[tuple[np.ndarray, np.ndarray]],
        along: list[float],
        parting: np.ndarray,
    ) -> _Sideways:
        """How two rows of lateral friction yield, where the distance of a contact changes by `parting`."""
        taken = self._taken
        kept = 1.0 - taken.time_step * yields.lateral_damping
        softens = np.concatenate([yields.lateral_slope * parting, self._by_friction(contact, "friction")])
        softens[len(self._space) :] *= yields.lateral_by_friction
        sides = -np.outer(along, softens)
        for side, (_, hessian) in zip(sides, parts, strict=True):
            side[: len(self._space)] += kept * (taken.velocity @ hessian)
        by_velocity = kept * np.stack([jacobian for jacobian, _ in parts])
        return _Sideways(yields.lateral_softness, softens, by_velocity @ taken.velocity, by_velocity, sides)

    def _let_yield(self, row: int, number: int, yields: _Sideways) -> None:
        """Let a row of friction that sticks yield, one of two."""
        rows, count = self._rows, len(self._space)
        rows.beta.append((row, row, yields.softness))
        rows.by_velocity[row] = yields.by_velocity[number]
        rows.by_position[row] = yields.sides[number, :count]
        rows.by_input[row] = yields.sides[number, count:]

    def _by_friction(self, contact: _Contact, what: str) -> np.ndarray:
        """Derivatives of a coefficient of friction of a contact by inputs, (inputs,)."""
        found = np.zeros(len(self._rows.all_inputs))
        for place, share in self._shares_of_links(contact, what):
            for column, given in enumerate(self._rows.all_inputs):
                if given.field == "link_lateral_friction" and given.place == place:
                    found[column] += share * given.scale
        return found

    def _set_friction(self, row: int, derivative: float, contact: _Contact, what: str) -> None:
        """Set the derivatives of a row's right side by the lateral friction of both links."""
        for place, share in self._shares_of_links(contact, what):
            self._rows.set_input(row, "link_lateral_friction", place, derivative * share)

    def _shares_of_links(self, contact: _Contact, what: str) -> list[tuple[tuple[int], float]]:
        """Both links, and the derivatives of a coefficient by their lateral friction."""
        shapes = self._taken.shapes
        links = self._taken.contacts["contact_shapes"][contact.number, 2:].tolist()
        if pair_of_links(self._taken, *links) is not None:
            return []
        # Rolling and spinning coefficients are multiplied by the lateral one of the other link.
        kind = {"friction": "lateral", "rolling friction": "rolling", "spinning friction": "spinning"}[what]
        ranks = [int(shapes["link_friction_rank"][link]) for link in links]
        own = [float(shapes[f"link_{kind}_friction"][link]) for link in links]
        found: list[tuple[tuple[int], float]] = []
        for k in (0, 1):
            share = own[1 - k]
            if min(ranks) > 0:
                greater = ranks[k] > ranks[1 - k] or (ranks[0] == ranks[1] and own[k] >= own[1 - k])
                share = float(greater and kind == "lateral")
            found.append(((links[k],), share))
        return found

    def _masses(
        self, jacobians: list[np.ndarray], hessians: list[np.ndarray], yields: _Sideways | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Effective masses of two rows, and their derivatives by positions and inputs, (2, n + inputs).

        With isotropic friction both take the same steps, so only their ratio counts, which is 1.
        """
        inputs = self._rows.all_inputs
        masses, changes = np.ones(2), np.zeros((2, len(self._space) + len(inputs)))
        if self._taken.parameters.isotropic_friction:
            return masses, changes
        for k, (jacobian, hessian) in enumerate(zip(jacobians, hessians, strict=True)):
            response = self._motion.inverse @ jacobian
            inverse = float(jacobian @ response)
            turned = 2.0 * response @ hessian - response @ self._motion.mass_derivatives(response)
            driven = -response @ self._motion.mass_input_derivatives(response, inputs)
            turned = np.concatenate([turned, driven])
            if yields is not None:
                inverse, turned = inverse + yields.softness, turned + yields.softens
            masses[k], changes[k] = 1.0 / inverse, -turned / inverse**2
        return masses, changes

    def _directions(self, contact: _Contact) -> tuple[np.ndarray, np.ndarray]:
        """Both directions of friction (2, 3), and how they turn by a change of each dof, (2, 3, n)."""
        contacts = self._taken.contacts
        directions = np.stack([contacts[f"contact_direction{k}"][contact.number] for k in (1, 2)])
        turns = np.zeros((2, 3, len(self._space)))
        if contact.turned.any():
            n = contact.normal
            # The first is perpendicular to the normal and to an axis, so it turns about that axis.
            axis = np.array([1.0, 0.0, 0.0]) if abs(n[2]) > _HALF_ROOT else np.array([0.0, 0.0, 1.0])
            across = cross(axis, n)
            length = float(np.sqrt(across @ across))
            sign = float(np.sign(directions[0] @ across))
            rate = sign * cross_matrix(axis) / length
            turns[0] = rate @ contact.turned
            turns[0] -= np.outer(directions[0], directions[0] @ turns[0])
            second = float(np.sign(cross(n, directions[0]) @ directions[1]))
            turns[1] = second * (cross(contact.turned.T, directions[0]).T + cross(n, turns[0].T).T)
        return directions, turns
