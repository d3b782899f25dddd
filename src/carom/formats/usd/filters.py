"""Which links of a stage collide: joints, `FilteredPairsAPI`, `CollisionGroup` and articulations decide."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from carom.formats.usd.bodies import Part, Parts
from carom.formats.usd.joints import UsdJoint
from carom.formats.usd.scene import LinkPair, UsdScene
from carom.formats.usd.stage import Stage
from carom.formats.usd.tree import Tree

Pair = frozenset[str]


def set_pairs(
    stage: Stage, parts: Parts, trees: Sequence[Tree], joints: Sequence[UsdJoint], scene: UsdScene
) -> None:
    """Write into a scene which robots touch themselves, and which pairs of links do not collide."""
    places: dict[str, tuple[int, str]] = {}
    for number, tree in enumerate(trees):
        places |= {part.path: (number, tree.names[part.path]) for part in tree.parts}
    places |= {part.path: (len(trees) + k, part.link.name) for k, part in enumerate(parts.still)}
    apart = _stated(stage, parts) | _to_still(parts, joints) | _by_groups(stage, parts)
    for tree in trees:
        tree.robot.touches_itself = _collides_with_itself(stage, tree)
        apart |= tree.joined
    for pair in sorted(apart, key=sorted):
        if len(pair) == 2 and all(path in places for path in pair):
            scene.apart.append(_named(places, pair))


def _named(places: dict[str, tuple[int, str]], pair: Pair) -> LinkPair:
    first, second = sorted(places[path] for path in pair)
    return first, second


def _collides_with_itself(stage: Stage, tree: Tree) -> bool:
    """Whether links of a robot collide, which articulations can switch off."""
    names = ("physxArticulation:enabledSelfCollisions", "newton:selfCollisionEnabled")
    seen: set[str] = set()
    for part in tree.parts:
        for it in stage.above(part.prim):
            if str(it.GetPath()) in seen:
                break
            seen.add(str(it.GetPath()))
            if it.HasAPI(stage.pxr.UsdPhysics.ArticulationRootAPI) and not all(
                stage.value(it, name, True) for name in names
            ):
                return False
    return True


def _stated(stage: Stage, parts: Parts) -> set[Pair]:
    """The pairs of `FilteredPairsAPI`."""
    found: set[Pair] = set()
    for prim in stage.prims():
        if not prim.HasAPI(stage.pxr.UsdPhysics.FilteredPairsAPI):
            continue
        own = parts.named(prim)
        for target in stage.targets(prim, "physics:filteredPairs"):
            others = parts.named(target)
            for end, named in ((prim, own), (target, others)):
                if end.HasAPI(stage.pxr.UsdPhysics.CollisionAPI) and any(
                    len(it.colliders) > 1 for it in named
                ):
                    stage.leave_out(
                        prim, "none of the colliders of that body collides", "pairs are of links",
                        "physics:filteredPairs",
                    )  # fmt: skip
            found |= {frozenset((a.path, b.path)) for a in own for b in others}
    return found


def _to_still(parts: Parts, joints: Sequence[UsdJoint]) -> set[Pair]:
    """Bodies and the colliders that do not move to which a joint holds them."""
    found: set[Pair] = set()
    for joint in joints:
        for end, other in (joint.ends, joint.ends[::-1]):
            if end.part is None and end.target is not None and other.part is not None and not joint.collide:
                still = [it for it in parts.named(end.target) if not it.moves]
                found |= {frozenset((it.path, other.part.path)) for it in still}
    return found


def _by_groups(stage: Stage, parts: Parts) -> set[Pair]:
    """Pairs of links whose collision groups do not collide."""
    kind = stage.pxr.UsdPhysics.CollisionGroup
    groups = [prim for prim in stage.prims() if prim.IsA(kind)]
    if not groups:
        return set()
    table = kind.ComputeCollisionGroupTable(stage.stage)
    queries: list[tuple[Any, Any]] = []
    for prim in groups:
        for name in (
            "collection:colliders:includes",
            "collection:colliders:excludes",
            "physics:filteredGroups",
        ):
            stage.targets(prim, name)
        for name in ("collection:colliders:expansionRule", "collection:colliders:includeRoot",
                     "physics:mergeGroup", "physics:invertFilteredGroups"):  # fmt: skip
            stage.note(prim, name)
        queries.append((prim.GetPath(), kind(prim).GetCollidersCollectionAPI().ComputeMembershipQuery()))

    def groups_of(part: Part) -> list[tuple[Any, ...]]:
        return [
            tuple(path for path, query in queries if query.IsPathIncluded(it.GetPath()))
            for it in part.colliders
        ]

    def collide(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
        return all(table.IsCollisionEnabled(a, b) for a in one for b in other)

    members = [(part, groups_of(part)) for part in (*parts.moving, *parts.still) if part.colliders]
    found: set[Pair] = set()
    for (first, own), (second, others) in combinations(members, 2):
        answers = {collide(a, b) for a in set(own) for b in set(others)}
        if True not in answers:
            found.add(frozenset((first.path, second.path)))
        elif False in answers:
            stage.leave_out(first.prim, "its colliders all collide", "groups are of links", "CollisionGroup")
    return found
