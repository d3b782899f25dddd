"""The tree of bounds in which Bullet finds the overlaps of a body.

Bullet's broad phase is a binary tree of bounds. A new leaf is inserted beside the leaf at which a descent
from the root ends that takes the nearer child each time, by the distance of centres along the three axes; it
is the second child of a new node. Bodies are inserted when they are created; in a step each is taken out, and
inserted again with its widened bounds. Then a traversal, second children first, finds what it overlaps.

So the order depends on everything that has been in the tree. In a new scene it follows from the present
bounds, and from those with which bodies are created (`search_order`); later it does not, and `overlap_turns`
has a simple rule in its place.
"""

import warp as wp

from carom.kernels.maths.min_max import lower_corner, upper_corner
from carom.kernels.structs import Pairs
from carom.kernels.types import Index4, Int32, func, real

_NONE = wp.constant(-1)


@func
def distance(pairs: Pairs, world: Int32, node: Int32, other: Int32) -> real:
    """Twice the distance between the centres of two nodes, summed over the axes."""
    apart = wp.abs(
        (pairs.twig_lower[world, node] + pairs.twig_upper[world, node])
        - (pairs.twig_lower[world, other] + pairs.twig_upper[world, other])
    )
    return apart[0] + apart[1] + apart[2]


@func
def set_parent(pairs: Pairs, world: Int32, node: Int32, parent: Int32):
    """Set the parent of a node."""
    links = pairs.twig_links[world, node]
    pairs.twig_links[world, node] = Index4(parent, links[1], links[2], 0)


@func
def set_child(pairs: Pairs, world: Int32, parent: Int32, child: Int32, other: Int32):
    """Put another node in the place of a child."""
    links = pairs.twig_links[world, parent]
    if links[1] == child:
        pairs.twig_links[world, parent] = Index4(links[0], other, links[2], 0)
    else:
        pairs.twig_links[world, parent] = Index4(links[0], links[1], other, 0)
    set_parent(pairs, world, other, parent)


@func
def enclose(pairs: Pairs, world: Int32, node: Int32) -> bool:
    """Set the bounds of a node to those around its children; returns whether they have changed."""
    links = pairs.twig_links[world, node]
    lower = lower_corner(pairs.twig_lower[world, links[1]], pairs.twig_lower[world, links[2]])
    upper = upper_corner(pairs.twig_upper[world, links[1]], pairs.twig_upper[world, links[2]])
    same = lower == pairs.twig_lower[world, node] and upper == pairs.twig_upper[world, node]
    pairs.twig_lower[world, node] = lower
    pairs.twig_upper[world, node] = upper
    return not same


@func
def enclose_from(pairs: Pairs, world: Int32, node: Int32):
    """Bring the bounds of a node and of those above it up to date."""
    above = node + 0
    while above >= 0:
        changed = enclose(pairs, world, above)
        above = wp.where(changed, pairs.twig_links[world, above][0], Int32(_NONE))


@func
def insert_leaf(pairs: Pairs, world: Int32, root: Int32, leaf: Int32, node: Int32) -> Int32:
    """Insert a leaf, with `node` as the new node above it; returns the root."""
    pairs.twig_links[world, leaf] = Index4(_NONE, _NONE, _NONE, 0)
    if root < 0:
        return leaf
    beside = root + 0
    while pairs.twig_links[world, beside][1] >= 0:
        links = pairs.twig_links[world, beside]
        if distance(pairs, world, leaf, links[1]) < distance(pairs, world, leaf, links[2]):
            beside = links[1]
        else:
            beside = links[2]
    parent = pairs.twig_links[world, beside][0]
    pairs.twig_links[world, node] = Index4(_NONE, beside, leaf, 0)
    if parent >= 0:
        set_child(pairs, world, parent, beside, node)
    set_parent(pairs, world, beside, node)
    set_parent(pairs, world, leaf, node)
    enclose(pairs, world, node)
    enclose_from(pairs, world, parent)
    return wp.where(parent >= 0, root, node)


@func
def remove_leaf(pairs: Pairs, world: Int32, root: Int32, leaf: Int32):
    """Take out a leaf; returns the root, and the node that was above the leaf; -1 where there is none."""
    parent = pairs.twig_links[world, leaf][0]
    if parent < 0:
        return Int32(_NONE), Int32(_NONE)
    links = pairs.twig_links[world, parent]
    sibling = wp.where(links[1] == leaf, links[2], links[1])
    if links[0] < 0:
        set_parent(pairs, world, sibling, _NONE)
        return sibling, parent
    set_child(pairs, world, links[0], parent, sibling)
    enclose_from(pairs, world, links[0])
    return root, parent
