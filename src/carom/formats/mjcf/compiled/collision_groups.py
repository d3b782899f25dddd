"""Collision groups for MJCF's bits, where the type of either geom has to meet the affinity of the other."""

from __future__ import annotations

from dataclasses import replace

from carom.description.collision_groups import FIXED_GROUP, MOVING_GROUP
from carom.formats.mjcf.compiled.model import CompiledBody

Kind = tuple[int, int]
_ORDINARY: Kind = (1, 1)
_GROUPS = [1 << bit for bit in range(31) if 1 << bit not in (MOVING_GROUP, FIXED_GROUP)]
"""Groups for other kinds of bits than the ordinary one."""


def set_collision_groups(bodies: list[CompiledBody]) -> int:
    """Replace `contype` and `conaffinity` of all shapes by groups and masks that mean the same.

    Carom lets two links collide if the group of either meets the mask of the other. So every kind of bits
    gets a group of its own, and a mask of the groups that it collides with; what collides with nothing is
    in no group. Bodies from elsewhere, whose masks have all groups of files, collide with all the others.

    Returns:
        The number of bodies with several kinds of shapes, which then have all their groups and masks.
    """
    shapes = [shape for body in bodies for shape in body.collisions]
    kinds = list(dict.fromkeys([_ORDINARY, *((shape.group or 0, shape.mask or 0) for shape in shapes)]))
    bits = {kind: _GROUPS[min(place, len(_GROUPS) - 1)] for place, kind in enumerate(kinds[1:])}
    bits[_ORDINARY] = MOVING_GROUP
    mixed = 0
    for body in bodies:
        own = {(shape.group or 0, shape.mask or 0) for shape in body.collisions}
        mixed += len(own) > 1
        group = mask = 0
        for kind in own:
            met = [bits[other] for other in kinds if kind[0] & other[1] or other[0] & kind[1]]
            group |= bits[kind] if met else 0
            mask |= sum(set(met))
        body.collisions = [replace(shape, group=group, mask=mask) for shape in body.collisions]
    return mixed
