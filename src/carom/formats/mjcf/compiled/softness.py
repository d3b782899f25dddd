"""`solref` and `solimp`: how constraints yield; and the inverse masses for which they do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from carom.description import ContactParameters
from carom.description.compliance import Compliance
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.inverse_masses import InverseMasses, TendonInertia
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel, FileFriction
from carom.formats.mjcf.defaults import Attributes

_LEAST = 1e-15


def read_compliance(scope: Scope, element: Element, attributes: Attributes, of: str = "") -> Compliance:
    """What `solref` and `solimp`, or those of a limit or friction, say, with MuJoCo's defaults."""
    stated = Compliance()
    numbers = [*stated.reference[:2], *stated.impedance[:3], *stated.reference[2:]]
    for name, first, most in ((f"solref{of}", 0, 2), (f"solimp{of}", 2, 5)):
        given = scope.context.numbers(element, name, attributes.get(name, ""), 0, most)
        numbers[first : first + len(given)] = given
    return Compliance(*numbers)


def weigh(model: CompiledModel, world: CompiledBody) -> None:
    """Find the inverse masses of all bodies and joints, and what follows from them."""
    for root in world.children:
        weigh_tree(model, root)


def weigh_tree(model: CompiledModel, root: CompiledBody, tendons: Sequence[TendonInertia] = ()) -> None:
    """The same for a body of the world and all in it, also again, with tendons that add to its inertia."""
    weights = InverseMasses(root, tendons)
    model.free_weights[root.name], model.weight_along[root.name] = weights.free, weights.along
    model.body_weights |= weights.bodies
    model.joint_weights |= weights.joints
    if root.free_compliance is not None:
        mass, inertia = weights.free
        yielding = replace(root.free_compliance, inverse_mass=mass, inverse_inertia=inertia)
        model.frictions = [it for it in model.frictions if it.body != root.name]
        model.frictions.append(FileFriction(root.name, root.free_friction, yielding))
    pending = [root]
    while pending:
        body = pending.pop()
        pending += body.children
        _weigh_body(model, body)


def _weighed(contact: ContactParameters, inverse_mass: float) -> ContactParameters:
    """Contact parameters with the inverse mass of the body [1/kg]."""
    if (yielding := contact.compliance) is None:
        return contact
    compliance = replace(yielding.compliance, inverse_mass=inverse_mass)
    return replace(contact, compliance=replace(yielding, compliance=compliance))


def _weigh_body(model: CompiledModel, body: CompiledBody) -> None:
    inverse_mass, _ = model.body_weights[body.name]
    if not inverse_mass and not body.joints:
        # As nothing else has been said of them.
        return
    body.contact = _weighed(body.contact, inverse_mass)
    body.collisions = [
        it if it.contact is None else replace(it, contact=_weighed(it.contact, inverse_mass))
        for it in body.collisions
    ]
    for each in body.joints:
        joint, weight = each.joint, model.joint_weights[each.joint.name]
        if joint.limit_compliance is not None:
            joint = replace(joint, limit_compliance=replace(joint.limit_compliance, inverse_mass=weight))
        if joint.friction_compliance is not None:
            friction = replace(joint.friction_compliance, inverse_mass=weight)
            joint = replace(joint, friction_compliance=friction)
        time_constant, ratio = each.spring_damper
        if time_constant > 0.0 and ratio > 0.0:
            inertia = 1.0 / max(weight, _LEAST)
            joint = replace(
                joint,
                stiffness=inertia / (time_constant * ratio) ** 2,
                damping=2.0 * inertia / time_constant,
            )
        each.joint = joint
