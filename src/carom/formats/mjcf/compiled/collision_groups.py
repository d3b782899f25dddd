"""Collision groups for MJCF's bits, where the type of either geom has to meet the affinity of the other."""

from __future__ import annotations

from dataclasses import replace

from carom.formats.mjcf.compiled.model import CompiledBody

Kind = tuple[int, int]
_ORDINARY: Kind = (1, 1)
_MAX_KINDS = 31


def set_collision_groups(bodies: list[CompiledBody]) -> int:
    """Replace `contype` and `conaffinity` of all shapes by groups and masks that mean the same.

    Carom lets two links collide if the group of each meets the mask of the other. So every kind of bits gets
    a group of its own, and a mask of the groups that it collides with. Ordinary geoms, with 1 and 1, have
    group 1, which other bodies have as well.

    Returns:
        The number of bodies with several kinds of shapes, which then have all their groups and masks.
    """
    kinds: list[Kind] = [_ORDINARY]
    for body in bodies:
        for shape in body.collisions:
            kind = (shape.group or 0, shape.mask or 0)
            if kind not in kinds:
                kinds.append(kind)
    bits = {kind: 1 << min(place, _MAX_KINDS - 1) for place, kind in enumerate(kinds)}
    mixed = 0
    for body in bodies:
        own = {(shape.group or 0, shape.mask or 0) for shape in body.collisions}
        mixed += len(own) > 1
        group = mask = 0
        for kind in own:
            group |= bits[kind]
            for other in kinds:
                if kind[0] & other[1] or other[0] & kind[1]:
                    mask |= bits[other]
        body.collisions = [replace(shape, group=group, mask=mask) for shape in body.collisions]
    return mixed
