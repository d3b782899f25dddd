"""Collision filters: which pairs of shapes may collide."""

import warp as wp

from carom.kernels.structs import Model, Settings, Shapes
from carom.kernels.types import Int32, func
from carom.layouts.flags import LoadFlags

SELF_COLLISION = wp.constant(int(LoadFlags.USE_SELF_COLLISION))
EXCLUDE_ALL_PARENTS = wp.constant(int(LoadFlags.USE_SELF_COLLISION_EXCLUDE_ALL_PARENTS))
INCLUDE_PARENT = wp.constant(int(LoadFlags.USE_SELF_COLLISION_INCLUDE_PARENT))


@func
def rigid_root(model: Model, link: Int32) -> Int32:
    """First link, from `link` towards the base, that can move relative to its parent; else the base."""
    root = link
    while model.link[root].parent >= 0 and model.link[root].dof_count == 0:
        root = model.link[root].parent
    return root


@func
def is_below(model: Model, link: Int32, ancestor: Int32) -> bool:
    """Whether `ancestor` is on the path from `link` (excluded) to its base (included)."""
    above = model.link[link].parent
    while above >= 0 and above != ancestor:
        above = model.link[above].parent
    return above == ancestor


@func
def touches_itself(shapes: Shapes, model: Model, a: Int32, b: Int32) -> bool:
    """Whether two links of one body may collide; they are not the same link, nor rigidly joined."""
    flags = shapes.link_self_collision[a]
    if flags & SELF_COLLISION == 0:
        return False
    if flags & EXCLUDE_ALL_PARENTS != 0:
        return not is_below(model, a, b) and not is_below(model, b, a)
    if flags & INCLUDE_PARENT != 0:
        return True
    return model.link[a].parent != b and model.link[b].parent != a


@func
def pair_row(shapes: Shapes, settings: Settings, a: Int32, b: Int32) -> Int32:
    """The row of two links among the pairs with a rule of their own, or -1."""
    low, high = wp.min(a, b), wp.max(a, b)
    first = Int32(0)
    last = settings.filter_count
    while first < last:
        middle = (first + last) // 2
        link_a = shapes.filter_link_a[middle]
        link_b = shapes.filter_link_b[middle]
        if link_a == low and link_b == high:
            return middle
        if link_a < low or (link_a == low and link_b < high):
            first = middle + 1
        else:
            last = middle
    return -1


@func
def pair_filter(shapes: Shapes, settings: Settings, a: Int32, b: Int32) -> Int32:
    """The user's filter for two links: 1 collide, 0 do not collide, -1 not set."""
    row = pair_row(shapes, settings, a, b)
    if row < 0:
        return Int32(-1)
    return shapes.filter_enabled[row]


@func
def pair_with_contacts(shapes: Shapes, settings: Settings, a: Int32, b: Int32) -> Int32:
    """The row of two links whose contacts are as a pair states them, not as both links do, or -1."""
    if settings.has_pair_contacts == 0:
        return Int32(-1)
    row = pair_row(shapes, settings, a, b)
    if row >= 0 and shapes.filter_impedance[row][1] > 0.0:
        return row
    return Int32(-1)


@func
def masks_match(shapes: Shapes, settings: Settings, a: Int32, b: Int32) -> bool:
    """Whether collision groups and masks let two links collide."""
    a_passes = shapes.link_group[a] & shapes.link_mask[b] != 0
    b_passes = shapes.link_group[b] & shapes.link_mask[a] != 0
    if settings.filter_both == 1:
        return a_passes and b_passes
    return a_passes or b_passes


@func
def links_may_collide(shapes: Shapes, settings: Settings, a: Int32, b: Int32) -> bool:
    """Whether two links of different bodies may collide, by user filters, groups and masks."""
    wanted = pair_filter(shapes, settings, a, b)
    if wanted >= 0:
        return wanted == 1
    return masks_match(shapes, settings, a, b)


@func
def may_collide(shapes: Shapes, model: Model, settings: Settings, shape_a: Int32, shape_b: Int32) -> bool:
    """Whether two shapes may collide, by self-collision flags, user filters, groups and masks."""
    a = shapes.shape_link[shape_a]
    b = shapes.shape_link[shape_b]
    if a == b:
        return False
    root_a, root_b = rigid_root(model, a), rigid_root(model, b)
    if root_a == root_b:
        return False
    if shapes.shape_tree[shape_a] == shapes.shape_tree[shape_b] and not touches_itself(shapes, model, a, b):
        return False
    return links_may_collide(shapes, settings, a, b)
