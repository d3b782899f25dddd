"""Contacts that yield and do not push, but would after the smallest change: they are at a switch."""

import warp as wp

from carom.kernels.dynamics.contact_compliance import contact_law, yields_without_bounce
from carom.kernels.dynamics.yielding import spring_and_damper
from carom.kernels.linearization.contact_rows import touching_links
from carom.kernels.linearization.yielding_rows import surfaces_of
from carom.kernels.newton.linear_contacts import motion_between
from carom.kernels.structs import Contacts, Model, Settings, Shapes, StepBatch, StepSpace
from carom.kernels.types import Int32, called_func, real
from carom.layouts.contacts import THERE
from carom.layouts.linearization import NEAR_MARGIN

_NEAR = wp.constant(real(NEAR_MARGIN))


@called_func
def note_open_contacts(
    model: Model,
    settings: Settings,
    shapes: Shapes,
    contacts: Contacts,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Note in `steps.near` contacts at their margin that would push if they were within it.

    Within it a contact of MuJoCo's law pushes as soon as its sides approach, or slide fast enough: what it
    asks for does not begin at 0 where the gap does.
    """
    for contact in range(contacts.count_contacts[world, THERE]):
        pair = contacts.contact_shapes[world, contact]
        if contacts.contact_impulse[world, contact][0] <= 0.0 and yields_without_bounce(
            shapes, world, pair[0], pair[1]
        ):
            reference, impedance, lateral, margin, _mass, _row = contact_law(
                settings, shapes, world, pair[0], pair[1]
            )
            if wp.abs(contacts.contact_distance[world, contact] - margin) <= _NEAR:
                touch = touching_links(model, shapes, contacts, space, steps, place, world, contact)
                touch = surfaces_of(settings, shapes, contacts, world, touch)
                before, before_about = motion_between(space, steps, place, touch, 0)
                after, about = motion_between(space, steps, place, touch, 2)
                _stiffness, damping = spring_and_damper(settings, reference, impedance)
                _stiffness, lateral_damping = spring_and_damper(settings, lateral, impedance)
                kept = 1.0 - settings.time_step * damping
                kept_across = 1.0 - settings.time_step * lateral_damping
                approach = -wp.dot(touch.normal, after - kept * before)
                slip = after - kept_across * before
                across = wp.length(slip - wp.dot(slip, touch.normal) * touch.normal)
                turn = wp.length(about - kept_across * before_about)
                # An edge of a pyramid also pushes where only its sides slide.
                held = touch.friction[0] * across + (touch.friction[1] + touch.friction[2]) * turn
                if approach + held > 0.0:
                    steps.near[place * space.most_contacts + contact] = touch.known_as
