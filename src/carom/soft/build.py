"""Checking meshes and parameters, and making the specifications of soft bodies from them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.description import ContactParameters, Material, TriangleMesh, Visual
from carom.description.pose import Pose
from carom.errors import DescriptionError
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.soft_spec import SHORT, Skin, SoftSpec
from carom.native.products import determinants
from carom.soft.materials import NeoHookean, Springs
from carom.soft.shapes import oriented
from carom.soft.skin import bind
from carom.soft.texture_mapping import TextureMapping, checkered
from carom.soft.topology import bending_pairs, edges_of, surface_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

MAX_NODES = 1_000_000
"""Maximum number of nodes of a soft body."""
MIN_MASS = 1.0e-30
"""Minimum mass of a soft body [kg]; smaller masses would overflow."""
FARTHEST = 1.0e6
"""Largest coordinate of a node [m]."""
# Tetrahedra count as flat if six times their volume is less than this share of their size cubed.
_FLAT = 1.0e-9
_WHITE = (1.0, 1.0, 1.0, 1.0)


def soft_body(
    name: str,
    nodes: Floats,
    cells: Ints,
    *,
    mass: float,
    springs: Springs | None = None,
    solid: NeoHookean | None = None,
    margin: float = 0.02,
    friction: float = 0.0,
    self_collision: bool = False,
    seen: tuple[Floats, Ints] | None = None,
    textured: TextureMapping | None = None,
    source: Path | None = None,
) -> BodySpec:
    """A soft body of nodes of equal mass.

    Args:
        name: Its name.
        nodes: (n, 3) positions at rest [m].
        cells: Its (m, 2) edges, (m, 3) triangles or (m, 4) tetrahedra. Triangles that name a node twice are
            springs, but no faces, as in PyBullet.
        mass: Total mass of all nodes [kg].
        springs: Springs along the edges of the cells; None for no springs.
        solid: Material of tetrahedra; None if they do not resist deformation.
        margin: Distance at which nodes rest on other surfaces [m].
        friction: Coulomb coefficient, multiplied by that of the other surface.
        self_collision: Its nodes collide with its own faces.
        seen: (v, 3) vertices and (t, 3) triangles that are drawn instead of its surface.
        textured: Texture mapping of what is drawn; None for checkered solids and plain cloth.
        source: The file it comes from, for error messages.

    Raises:
        DescriptionError: A node is not finite or too far away; a cell refers to a node that does not exist,
            or has no volume; no face refers to three nodes; all nodes are in one place; or a parameter is
            invalid.
    """
    _check_parameters(mass, springs, solid, margin, friction, source)
    nodes = np.array(nodes, dtype=np.float64).reshape(-1, 3)
    cells = np.asarray(cells, dtype=np.int32)
    _check_nodes(nodes, cells, source)
    center = nodes.mean(axis=0)
    places = nodes - center
    tetras = np.empty((0, 4), dtype=np.int32)
    faces = drawn = cells if cells.shape[1] == 3 else np.empty((0, 3), dtype=np.int32)
    if cells.shape[1] == 4:
        tetras = cells = oriented(places, cells)
        _check_volumes(places, tetras, source)
        faces = drawn = surface_of(tetras)
    elif cells.shape[1] == 3:
        faces = _with_three_nodes(cells, source)
    pairs, terms = _springs(places, cells, springs, source)
    elastic = solid or NeoHookean(0.0, 0.0)
    soft = SoftSpec(
        nodes=places,
        masses=np.full(len(nodes), mass / len(nodes)),
        faces=np.ascontiguousarray(faces, dtype=np.int32),
        springs=pairs,
        spring_terms=terms,
        tetras=tetras if solid is not None else np.empty((0, 4), dtype=np.int32),
        mu=elastic.mu,
        lam=elastic.lam,
        damping=elastic.damping,
        damps_all_directions=springs is not None and springs.damps_all_directions,
        margin=margin,
        self_collision=self_collision,
    )
    vertices, triangles = (nodes, np.ascontiguousarray(drawn)) if seen is None else seen
    if seen is not None:
        soft.skin = Skin(*bind(vertices, nodes, faces if cells.shape[1] == 3 else cells), triangles)
    elif len(triangles) != len(faces):
        every = np.arange(len(nodes), dtype=np.int32)[:, None]
        soft.skin = Skin(every, np.ones(every.shape), triangles)
    if seen is None and textured is None and cells.shape[1] == 4:
        textured = checkered(vertices, triangles)
    soft.checkered = textured is not None and textured.checkered
    x, y, z = center.tolist()
    base = LinkSpec(
        name,
        inertial_frame=Pose((x, y, z)),
        contact=ContactParameters(lateral_friction=friction),
        visuals=(_visual(vertices, triangles, textured),) if len(triangles) else (),
    )
    return BodySpec(name, base, fixed_base=True, source=source, soft=soft)


def _visual(vertices: Floats, triangles: Ints, textured: TextureMapping | None) -> Visual:
    if textured is None:
        return Visual(TriangleMesh(vertices, triangles))
    # A vertex may have another texture coordinate in each of its triangles.
    corners = vertices[triangles.reshape(-1)]
    apart = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
    material = Material(rgba=_WHITE, texture=textured.texture)
    return Visual(TriangleMesh(corners, apart, uvs=textured.uvs), material=material)


def _check_parameters(
    mass: float,
    springs: Springs | None,
    solid: NeoHookean | None,
    margin: float,
    friction: float,
    source: Path | None,
) -> None:
    positive = {"mass": mass, "the collision margin": margin}
    others = {"friction": friction}
    if springs is not None:
        others |= {
            "the stiffness of springs": springs.stiffness,
            "the damping of springs": springs.damping,
            "the stiffness against bending": springs.bending,
        }
    if solid is not None:
        others |= {"mu": solid.mu, "lambda": solid.lam, "the damping of the solid": solid.damping}
    if 0.0 < mass < MIN_MASS:
        raise DescriptionError(f"mass is {mass}; {MIN_MASS:g} kg is the minimum", file=source)
    for name, value in {**positive, **others}.items():
        if not np.isfinite(value) or value < 0.0 or (value == 0.0 and name in positive):
            least = "greater than 0" if name in positive else "0 or more"
            raise DescriptionError(f"{name} is {value}; it has to be finite and {least}", file=source)


def _check_nodes(nodes: Floats, cells: Ints, source: Path | None) -> None:
    if not len(nodes) or not len(cells):
        raise DescriptionError("there are no nodes or no cells to simulate", file=source)
    if len(nodes) > MAX_NODES:
        raise DescriptionError(f"{len(nodes)} nodes are more than the {MAX_NODES} accepted", file=source)
    if not (np.abs(nodes) <= FARTHEST).all():
        node = int(np.argmin((np.abs(nodes) <= FARTHEST).all(axis=1)))
        raise DescriptionError(f"node {node} is not finite, or farther than {FARTHEST:g} m away", file=source)
    if cells.min() < 0 or cells.max() >= len(nodes):
        raise DescriptionError(f"a cell names a node outside 0..{len(nodes) - 1}", file=source)


def _check_volumes(nodes: Floats, tetras: Ints, source: Path | None) -> None:
    corners = nodes[tetras]
    edges = corners[:, 1:] - corners[:, :1]
    size = np.abs(edges).max(axis=(1, 2))
    flat = determinants(edges) <= _FLAT * size**3
    if flat.any():
        raise DescriptionError(
            f"tetrahedron {int(flat.argmax())} has no volume; repair the mesh, or remove it", file=source
        )


def _with_three_nodes(triangles: Ints, source: Path | None) -> Ints:
    """The triangles without those that name a node twice; raises `DescriptionError` if none is left."""
    a, b, c = triangles.T
    kept = triangles[(a != b) & (b != c) & (c != a)]
    if not len(kept):
        raise DescriptionError("each of its faces names a node twice", file=source)
    return kept


def _springs(nodes: Floats, cells: Ints, springs: Springs | None, source: Path | None) -> tuple[Ints, Floats]:
    """Pairs of nodes (s, 2), and the length, stiffness and damping of the springs between them (s, 3)."""
    edges = edges_of(cells)
    # A triangle that names a node twice has one edge of two nodes; PyBullet puts a spring there as well.
    edges = edges[edges[:, 0] != edges[:, 1]]
    # Springs of zero length are allowed: they hold nodes in the same place together, as in seams of garments.
    size = float(np.ptp(nodes, axis=0).max())
    if not (np.linalg.norm(nodes[edges[:, 1]] - nodes[edges[:, 0]], axis=1) > SHORT * size).any():
        raise DescriptionError("all corners of its cells are in one place", file=source)
    if springs is None:
        return np.empty((0, 2), dtype=np.int32), np.empty((0, 3))
    pairs, stiffness = [edges], [np.full(len(edges), springs.stiffness)]
    if springs.bending > 0.0:
        across = bending_pairs(edges, len(nodes))
        pairs.append(across)
        stiffness.append(np.full(len(across), springs.bending))
    found = np.concatenate(pairs)
    length = np.linalg.norm(nodes[found[:, 1]] - nodes[found[:, 0]], axis=1)
    return found, np.stack([length, np.concatenate(stiffness), np.full(len(found), springs.damping)], axis=1)
