"""The stages of collision detection as kernels of their own, so that each can be timed."""

import warp as wp

from carom.collision.broad_phase import find_pairs
from carom.collision.collide import find_contacts
from carom.model.contact_structs import Contacts, Pairs, Shapes
from carom.model.real import kernel
from carom.model.structs import Model, Settings, State


@kernel
def broad_phase_kernel(settings: Settings, shapes: Shapes, model: Model, state: State, pairs: Pairs):
    """Pairs of shapes whose bounds meet."""
    find_pairs(shapes, model, state, settings, pairs, wp.tid())


@kernel
def narrow_phase_kernel(shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs):
    """Contacts of these pairs."""
    find_contacts(shapes, model, state, contacts, pairs, wp.tid())
