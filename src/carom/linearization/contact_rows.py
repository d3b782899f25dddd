"""Rows of contacts, linearised: normals and lateral friction.

How a contact moves is known exactly where a ball, capsule, box or polyhedron touches a plane that does not move,
and where two balls touch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.layouts.codes import BOX, CAPSULE, HULL, PLANE, SPHERE, ShapeKind
from carom.layouts.contacts import THERE
from carom.linearization.pair_rows import Places, Point
from carom.linearization.rows import HOLDS, LOWER, Rows, status_of
from carom.linearization.turns import cross_matrix

if TYPE_CHECKING:
    from carom.linearization.free_motion import FreeMotion
    from carom.linearization.tangent import TangentSpace
    from carom.linearization.taken_step import TakenStep

SLIDES = "slides"
_NONE = np.zeros(3)
_STICKS = 1.0 - 1e-7
_MAX_FRICTION = 10.0
_HALF_ROOT = float(np.sqrt(0.5))
_DEFAULT_DAMPING = 0.1
_ON_PLANES = (SPHERE, CAPSULE, BOX, HULL)


class _Contact(NamedTuple):
    """A contact, its points, its normal, and how that turns by a change of each dof, (3, n)."""

    number: int
    name: str
    a: Point
    b: Point
    normal: np.ndarray
    turned: np.ndarray


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
        contacts, shapes = self._taken.contacts, self._taken.shapes
        shape_a, shape_b, link_a, link_b = contacts["contact_shapes"][number].tolist()
        kinds = shapes["shape_kind"][shape_a], shapes["shape_kind"][shape_b]
        described = " and ".join(ShapeKind(int(kind)).name.lower() for kind in kinds)
        name = f"contact {number} of {described}"
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
            ends = (a._replace(position=points[0], moving=moving[0]), b._replace(position=points[1], moving=moving[1]))
            return _Contact(number, name, *ends, normal, turned)
        if PLANE not in kinds or (kinds[0] if kinds[1] == PLANE else kinds[1]) not in _ON_PLANES:
            raise NotImplementedError(f'a {name} has no exact derivatives: use method="differences"')
        side = 0 if kinds[1] == PLANE else 1
        fixed = self._places.point((link_b, link_a)[side], points[1 - side])
        if fixed.moving.any():
            raise NotImplementedError(f'a {name}, a plane that moves, has no exact derivatives')
        shape = (shape_a, shape_b)[side]
        radius = 0.0
        if kinds[side] in (SPHERE, CAPSULE):
            radius = float(shapes["shape_size"][shape][0])
        elif kinds[side] == HULL:
            radius = float(shapes["shape_margin"][shape])
        outward = normal if side == 0 else -normal
        core = self._places.point((link_a, link_b)[side], points[side] + radius * outward)
        touching = core._replace(position=points[side])
        ends = (touching, fixed) if side == 0 else (fixed, touching)
        return _Contact(number, name, *ends, normal, turned)

    def _add(self, contact: _Contact) -> None:
        taken, rows = self._taken, self._rows
        link_a, link_b = taken.contacts["contact_shapes"][contact.number, 2:].tolist()
        friction = self._friction(contact, link_a, link_b)
        softness, erp = self._stiffness(link_a, link_b)
        gap = float(taken.contacts["contact_distance"][contact.number]) + taken.parameters.contact_slop
        gain = (1.0 if gap > 0.0 else erp) / taken.time_step
        impulses = taken.contacts["contact_impulse"][contact.number]
        normal_turns = np.stack([contact.turned, np.zeros_like(contact.turned)])
        jacobian, hessian = self._places.row(contact.a, contact.b, contact.normal, _NONE, normal_turns)
        self._check_restitution(contact, jacobian, link_a, link_b)
        normal = rows.add(contact.name, HOLDS, jacobian, float(impulses[0]), 1.0, softness)
        rows.set_hessian(normal, hessian)
        rows.by_position[normal] = -gain * (contact.normal @ (contact.a.moving - contact.b.moving))
        self._add_friction(contact, normal, friction, (link_a, link_b))

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

    def _friction(self, contact: _Contact, a: int, b: int) -> float:
        """The coefficient of lateral friction."""
        shapes = self._taken.shapes
        own = [float(shapes["link_lateral_friction"][link]) for link in (a, b)]
        ranks = [int(shapes["link_friction_rank"][link]) for link in (a, b)]
        for what in ("rolling", "spinning"):
            if any(shapes[f"link_{what}_friction"][link] > 0.0 for link in (a, b)):
                raise NotImplementedError(f'{what} friction has no exact derivatives: use method="differences"')
        if any((shapes["link_anisotropy"][link] != 1.0).any() for link in (a, b)):
            raise NotImplementedError(f"{contact.name}: anisotropic friction has no exact derivatives")
        if any(shapes["link_friction_anchor"][link] for link in (a, b)):
            raise NotImplementedError(f"{contact.name}: friction anchors have no exact derivatives")
        if min(ranks) > 0:
            return max(own) if ranks[0] == ranks[1] else own[int(ranks[1] > ranks[0])]
        return min(max(own[0] * own[1], -_MAX_FRICTION), _MAX_FRICTION)

    def _check_restitution(self, contact: _Contact, jacobian: np.ndarray, a: int, b: int) -> None:
        shapes, taken = self._taken.shapes, self._taken
        restitution = shapes["link_restitution"][a] * shapes["link_restitution"][b]
        approach = -float(jacobian @ taken.free_velocity)
        if restitution > 0.0 and approach >= taken.parameters.restitution_velocity_threshold:
            raise NotImplementedError(f"{contact.name}: a bounce has no exact derivatives")

    def _add_friction(self, contact: _Contact, normal: int, friction: float, links: tuple[int, int]) -> None:
        taken, rows = self._taken, self._rows
        _, *along = taken.contacts["contact_impulse"][contact.number].tolist()
        push = rows.impulses[normal]
        bound = friction * push
        directions, turns = self._directions(contact)
        first = len(rows)
        jacobians: list[np.ndarray] = []
        for direction, turned, impulse in zip(directions, turns, along, strict=True):
            changes = np.stack([turned, np.zeros_like(turned)])
            jacobian, hessian = self._places.row(contact.a, contact.b, direction, _NONE, changes)
            rows.set_hessian(rows.add(f"friction of {contact.name}", HOLDS, jacobian, impulse, 0.0, 0.0), hessian)
            jacobians.append(jacobian)
        cone = taken.parameters.cone_friction or taken.parameters.isotropic_friction
        if not cone:
            for row, impulse in zip((first, first + 1), along, strict=True):
                status = status_of(impulse, -bound * _STICKS, bound * _STICKS)
                rows.names[row] = (rows.names[row][0], status)
                if status == HOLDS:
                    rows.alpha.append((row, row, 1.0))
                    continue
                sign = -1.0 if status == LOWER else 1.0
                rows.beta += [(row, row, 1.0), (row, normal, -sign * friction)]
                self._set_friction(row, sign * push, links)
            return
        size = float(np.hypot(*along))
        if size < bound * _STICKS:
            rows.alpha += [(first, first, 1.0), (first + 1, first + 1, 1.0)]
            return
        for row in (first, first + 1):
            rows.names[row] = (rows.names[row][0], SLIDES)
        # The impulse is as great as the bound, ...
        x, y = along
        if size == 0.0:
            rows.beta += [(first, first, 1.0), (first + 1, first + 1, 1.0)]
            return
        rows.beta += [(first, first, x / size), (first, first + 1, y / size), (first, normal, -friction)]
        self._set_friction(first, push, links)
        # ... and opposite to the change of the impulses that the rows still ask for.
        rates = np.array([jacobian @ taken.after for jacobian in jacobians])
        masses, changes = self._masses(jacobians, [rows.hessians[first], rows.hessians[first + 1]])
        second = first + 1
        rows.alpha += [(second, first, masses[0] * y), (second, second, -masses[1] * x)]
        rows.beta += [(second, second, masses[0] * rates[0]), (second, first, -masses[1] * rates[1])]
        rows.by_position[second] = x * rates[1] * changes[1] - y * rates[0] * changes[0]

    def _set_friction(self, row: int, derivative: float, links: tuple[int, int]) -> None:
        shapes = self._taken.shapes
        for link, other in (links, links[::-1]):
            share = float(shapes["link_lateral_friction"][other])
            if shapes["link_friction_rank"][link] > 0 and shapes["link_friction_rank"][other] > 0:
                own = float(shapes["link_lateral_friction"][link])
                ranks = [int(shapes["link_friction_rank"][it]) for it in (link, other)]
                share = float(ranks[0] > ranks[1] or (ranks[0] == ranks[1] and own >= share))
            self._rows.set_input(row, "link_lateral_friction", (link,), derivative * share)

    def _masses(self, jacobians: list[np.ndarray], hessians: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Effective masses of two rows, and their derivatives by positions, (2, n).

        With isotropic friction both take the same steps, so only their ratio counts, which is 1.
        """
        count = len(self._space)
        if self._taken.parameters.isotropic_friction:
            return np.ones(2), np.zeros((2, count))
        masses, changes = np.zeros(2), np.zeros((2, count))
        for k, (jacobian, hessian) in enumerate(zip(jacobians, hessians, strict=True)):
            response = self._motion.inverse @ jacobian
            inverse = float(jacobian @ response)
            turned = 2.0 * response @ hessian - response @ self._motion.mass_derivatives(response)
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
            across = np.cross(axis, n)
            length = float(np.sqrt(across @ across))
            sign = float(np.sign(directions[0] @ across))
            rate = sign * cross_matrix(axis) / length
            turns[0] = rate @ contact.turned
            turns[0] -= np.outer(directions[0], directions[0] @ turns[0])
            second = float(np.sign(np.cross(n, directions[0]) @ directions[1]))
            turns[1] = second * (
                np.cross(contact.turned.T, directions[0]).T + np.cross(n, turns[0].T).T
            )
        return directions, turns

