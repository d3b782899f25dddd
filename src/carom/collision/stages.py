"""The stages of collision detection as kernels of their own, so that each can be timed."""

import warp as wp

from carom.collision.broad_phase import find_pairs
from carom.collision.collide import find_contacts
from carom.model.contact_structs import Contacts, Pairs, Shapes
from carom.model.real import Int32, kernel
from carom.model.structs import Model, Scratch, Settings, State


@kernel
def broad_phase_kernel(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    first_world: Int32,
):
    """Pairs of shapes whose bounds meet."""
    find_pairs(shapes, model, state, scratch, settings, pairs, first_world + wp.tid())


@kernel
def narrow_phase_kernel(
    shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs, first_world: Int32
):
    """Contacts of these pairs."""
    find_contacts(shapes, model, state, contacts, pairs, first_world + wp.tid())
