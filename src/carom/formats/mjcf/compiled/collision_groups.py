"""Collision groups for MJCF's bits, where the type of either geom has to meet the affinity of the other."""

from __future__ import annotations

from dataclasses import replace

from carom.description.collision_groups import FIXED_GROUP, MOVING_GROUP
from carom.formats.mjcf.compiled.model import CompiledBody

Kind = tuple[int, int, bool]
"""Type, affinity, and whether its bodies are fixed in the world."""
_ORDINARY: Kind = (1, 1, False)
_SCENERY: Kind = (1, 1, True)
_GROUPS = [1 << bit for bit in range(31) if 1 << bit not in (MOVING_GROUP, FIXED_GROUP)]
"""Groups for other kinds of bits than the ordinary ones."""


def set_collision_groups(world: CompiledBody, bodies: list[CompiledBody]) -> int:
    """Replace `contype` and `conaffinity` of all shapes by groups and masks that mean the same.

    Carom lets two links collide if the group of either meets the mask of the other. So every kind of bits
    gets a group of its own, and a mask of the groups that it collides with; what collides with nothing is
    in no group. Bodies from elsewhere, whose masks have all groups of files, collide with all the others.
    What is fixed in the world does not collide with what is, too, as in MuJoCo.

    Args:
        world: The body of the world, with what hangs on it.
        bodies: All others.

    Returns:
        The number of bodies with several kinds of shapes, which then have all their groups and masks.
    """
    fixed = _fixed(world)
    kinds_of = {id(body): _kinds(body, id(body) in fixed) for body in (world, *bodies)}
    kinds = list(dict.fromkeys([_ORDINARY, _SCENERY, *(kind for own in kinds_of.values() for kind in own)]))
    bits = {kind: _GROUPS[min(place, len(_GROUPS) - 1)] for place, kind in enumerate(kinds[2:])}
    bits |= {_ORDINARY: MOVING_GROUP, _SCENERY: FIXED_GROUP}
    mixed = 0
    for body in (world, *bodies):
        own = kinds_of[id(body)]
        mixed += len(own) > 1
        group = mask = 0
        for kind in own:
            met = [bits[other] for other in kinds if _meet(kind, other)]
            group |= bits[kind] if met else 0
            mask |= sum(set(met))
        body.collisions = [replace(shape, group=group, mask=mask) for shape in body.collisions]
    return mixed


def _fixed(world: CompiledBody) -> set[int]:
    """Identities of the world and of the bodies on it without joints between; those that users move, too."""
    found, left = set[int](), [world]
    while left:
        body = left.pop()
        found.add(id(body))
        left += [child for child in body.children if not child.joints and not child.is_free]
    return found


def _kinds(body: CompiledBody, is_fixed: bool) -> list[Kind]:
    """The kinds of the shapes of a body, each once."""
    return list(dict.fromkeys((shape.group or 0, shape.mask or 0, is_fixed) for shape in body.collisions))


def _meet(kind: Kind, other: Kind) -> bool:
    """Whether shapes of two kinds collide."""
    return bool(kind[0] & other[1] or other[0] & kind[1]) and not (kind[2] and other[2])
