"""Collision detection in finer launches than `collide`, for devices with thousands of threads.

Shapes are placed side by side. Neighbouring threads have the same shape in neighbouring worlds.
"""

import warp as wp

from carom.collision.bounds import look_ahead, place_shape
from carom.collision.broad_phase import find_pairs_of_placed
from carom.collision.collide import find_contacts
from carom.model.contact_structs import Contacts, Pairs, Shapes
from carom.model.real import kernel
from carom.model.status import STATUS, WELL
from carom.model.structs import Model, Scratch, Settings, State


@kernel
def place_shapes_kernel(
    settings: Settings, shapes: Shapes, model: Model, state: State, scratch: Scratch, pairs: Pairs
):
    """Poses and bounds of each shape, and how far ahead continuous detection looks for it."""
    shape, world = wp.tid()
    pairs.shape_motion[world, shape] = look_ahead(shapes, model, settings, state, scratch, world, shape)
    place_shape(shapes, state, pairs, world, shape)


@kernel
def world_pairs_kernel(settings: Settings, shapes: Shapes, model: Model, pairs: Pairs):
    """Pairs of shapes whose bounds meet, in each world."""
    find_pairs_of_placed(shapes, model, settings, pairs, wp.tid())


@kernel
def world_contacts_kernel(shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs):
    """Contacts of these pairs."""
    world = wp.tid()
    if state.status_entry[world, STATUS] == WELL:
        find_contacts(shapes, model, state, contacts, pairs, world)
