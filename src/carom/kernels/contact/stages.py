"""The stages of collision detection, one kernel each."""

import warp as wp

from carom.kernels.contact.broad_phase import find_pairs
from carom.kernels.contact.collide import find_contacts
from carom.kernels.structs import Contacts, Model, Pairs, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, kernel


@kernel
def broad_phase_kernel(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    pairs: Pairs,
    first_world: Int32,
):
    """Find the pairs of shapes whose bounding boxes meet."""
    find_pairs(shapes, model, state, scratch, settings, contacts, pairs, first_world + wp.tid())


@kernel
def narrow_phase_kernel(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    first_world: Int32,
):
    """Find the contacts of these pairs; contacts that persist keep their impulses."""
    find_contacts(settings, shapes, model, state, contacts, pairs, first_world + wp.tid())
