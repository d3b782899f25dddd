"""The collision shapes of a link in pieces, placed in its inertial frame."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

from carom.description import Collision, Mesh, SignedDistanceField
from carom.description.pose import IDENTITY
from carom.description.shapes.bounds import Bounds
from carom.description.transform import compose, inverse, quaternion_from_matrix
from carom.logger import Logger
from carom.model.body_spec import LinkSpec
from carom.model.bounds import placed_bounds
from carom.model.inertia import is_in_place, placement, shape_margin
from carom.model.shape_pieces import ShapePiece, shape_pieces
from carom.model.swept_spheres import FIRST_MARGIN, as_given

_log = Logger(__name__)

AXES: tuple[str, ...] = ("shape", "vertex", "face", "corner", "node")
"""The axes of `Shapes` on which a piece has rows of its own."""
_LEVELS = 30
"""Levels of a tree that a path has; parts below them come as they were inserted."""
MOST_PATHS: int = 1 << _LEVELS
"""Paths as numbers are less."""

Path = tuple[int, ...]
"""Which child leads to a part, from the root on: 0 or 1 for each level."""


class PlacedPiece(NamedTuple):
    """A piece and its pose.

    Attributes:
        piece: The piece.
        pose: Its frame in the inertial frame of its link: (x, y, z, qx, qy, qz, qw).
        link: Index of the link in its body; the base is 0.
        depth: In so many compounds, one in the other, Bullet has the piece.
        path: Where it is in the trees of these compounds, see `tree_paths`.
        collision: Which collision shape of its link it is, or is a part of.
    """

    piece: ShapePiece
    pose: tuple[float, ...]
    link: int
    depth: int
    path: int = 0
    collision: int = 0


def made_poses(links: Sequence[LinkSpec]) -> list[tuple[float, ...]]:
    """Where Bullet has the shapes of links when it creates them, see `Shapes.link_made_pose`.

    Args:
        links: The base and the links of a body.

    Returns:
        For each link its own frame at joint positions 0, in the inertial frame of the base:
        (x, y, z, qx, qy, qz, qw).
    """
    base = links[0].inertial_frame
    frames = [IDENTITY if base == IDENTITY else inverse(base)]
    for link in links[1:]:
        frames.append(compose(frames[link.parent + 1], link.joint_frame))
    return [(*frame.position, *frame.orientation) for frame in frames]


def placed_pieces(link: LinkSpec, index: int, implicit_cylinder: bool) -> list[PlacedPiece]:
    """The pieces of all collision shapes of a link with this index in its body; the base is 0."""
    placed: list[PlacedPiece] = []
    counts: list[int] = []
    for number, collision in enumerate(link.collisions):
        rotation, position = placement(link.inertial_frame, collision.frame)
        pose = (*position, *quaternion_from_matrix(rotation))
        if isinstance(collision.geometry, SignedDistanceField):
            _log.warning("link %r: nothing collides with a signed distance field", link.name)
        pieces = shape_pieces(collision.geometry, implicit_cylinder=implicit_cylinder)
        if collision.swept:
            pieces = [piece._replace(size=(*piece.size[:2], FIRST_MARGIN)) for piece in pieces]
        margin = shape_margin(link, collision)
        if margin is not None:
            pieces = [piece._replace(margin=margin) for piece in pieces]
        depth = int(_is_moved(link, collision)) + _is_compound(collision)
        placed.extend(PlacedPiece(piece, pose, index, depth, collision=number) for piece in pieces)
        counts.append(len(pieces))
    return _with_paths(link, placed, counts, implicit_cylinder) if len(placed) > 1 else placed


def _with_paths(
    link: LinkSpec, placed: Sequence[PlacedPiece], counts: Sequence[int], implicit_cylinder: bool
) -> list[PlacedPiece]:
    """The pieces of a link with several ones, with their paths; `counts` are those of its collisions."""
    bounds = []
    for collision in link.collisions:
        place = placement(link.inertial_frame, collision.frame)
        bounds.append(placed_bounds(collision.geometry, *place, implicit_cylinder=implicit_cylinder))
    found = []
    first = 0
    for count, path in zip(counts, tree_paths(bounds), strict=True):
        own = placed[first : first + count]
        boxes = [Bounds(one.piece.center, one.piece.size) for one in own]
        inner = tree_paths(boxes) if count > 1 else [()]
        found += [one._replace(path=as_number(path + rest)) for one, rest in zip(own, inner, strict=False)]
        first += count
    return found


def _is_moved(link: LinkSpec, collision: Collision) -> bool:
    """Whether Bullet puts a shape into a compound of its link: it is one of several, or has its own place."""
    return not is_in_place([as_given(collision)], link.inertial_frame) or len(link.collisions) > 1


def _is_compound(collision: Collision) -> bool:
    """Whether the shape itself is a compound in Bullet.

    That of an OBJ file is one, also of one part, and any that is given by its ends and is not swept.
    Shapes that scripts make are none: of these the parts are put directly into the compound of the link.
    """
    if collision.ends_frame is not None:
        return not collision.swept
    geometry = collision.geometry
    return isinstance(geometry, Mesh) and geometry.is_compound()


def row_counts(pieces: Sequence[ShapePiece]) -> dict[str, int]:
    """Number of rows that pieces need on each axis of shapes."""
    solids = [piece.polyhedron for piece in pieces if piece.polyhedron is not None]
    graphs = [piece.graph for piece in pieces if piece.graph is not None]
    hierarchies = [piece.hierarchy for piece in pieces if piece.hierarchy is not None]
    return {
        "shape": len(pieces),
        "vertex": sum(len(each) for each in (*graphs, *(solid.vertices for solid in solids))),
        "face": sum(len(solid.planes) for solid in solids),
        "corner": sum(len(solid.corners) for solid in solids),
        "node": sum(len(hierarchy.lower) for hierarchy in hierarchies),
    }


def reach(bounds: Bounds) -> float:
    """Radius of the bounds' enclosing sphere, plus the distance of their centre from the origin [m]."""
    return sqrt(sum(half * half for half in bounds.half)) + sqrt(sum(c * c for c in bounds.center))


class _Node:
    """A leaf, which is a part, or a node with two children and the bounds around them."""

    def __init__(self, bounds: Bounds, part: int) -> None:
        self.bounds = bounds
        self.part = part
        self.children: tuple[_Node, _Node] | None = None


def _insert(root: _Node, leaf: _Node) -> None:
    node = root
    while node.children is not None:
        node.bounds = node.bounds.joined(leaf.bounds)
        first, second = node.children
        is_nearer = _apart(leaf.bounds, first.bounds) < _apart(leaf.bounds, second.bounds)
        node = first if is_nearer else second
    node.children = (_Node(node.bounds, node.part), leaf)
    node.bounds = node.bounds.joined(leaf.bounds)


def _apart(a: Bounds, b: Bounds) -> float:
    return sum(abs(x - y) for x, y in zip(a.center, b.center, strict=True))


def tree_paths(bounds: Sequence[Bounds]) -> list[Path]:
    """Where Bullet has parts with these bounds in the tree that it searches them by.

    One after the other is inserted beside the leaf at which a descent from the root ends that takes the
    nearer child each time, by the distance of centres along the three axes. It is the second child of a new
    node.
    """
    root = _Node(bounds[0], 0)
    for part, box in enumerate(bounds[1:], start=1):
        _insert(root, _Node(box, part))
    found: dict[int, Path] = {}
    waiting: list[tuple[_Node, Path]] = [(root, ())]
    while waiting:
        node, path = waiting.pop()
        if node.children is None:
            found[node.part] = path
        else:
            waiting += [(child, (*path, place)) for place, child in enumerate(node.children)]
    return [found[part] for part in range(len(bounds))]


def as_number(path: Path) -> int:
    """A path as a number that is greater for parts which a search reaches earlier: the root's level first."""
    return sum(child << (_LEVELS - 1 - level) for level, child in enumerate(path[:_LEVELS]))
