"""Loading bodies and their poses from files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import Pose
from carom.files.boundary import reading
from carom.formats.robot.file import check_scale
from carom.formats.search import AssetSearch
from carom.geometry.hull import hull_triangles
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble
from carom.model.body_spec import BodySpec
from carom.model.shape_pieces import shape_pieces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.files.xml_element import Element
    from carom.formats.mjcf.compiled import CompiledModel
    from carom.formats.placed import PlacedRobot
    from carom.formats.reading.cursor import Cursor
    from carom.formats.reading.ignored import IgnoredList
    from carom.formats.sdf.scene import SdfScene
    from carom.formats.usd.scene import UsdScene
    from carom.formats.usd.stage import Solids

# Flags that PyBullet ignores for MJCF files, and those that it always sets.
_NOT_FOR_MJCF = (
    LoadFlags.MERGE_FIXED_LINKS | LoadFlags.IGNORE_VISUAL_SHAPES | LoadFlags.IGNORE_COLLISION_SHAPES
)
_ALWAYS_FOR_MJCF = LoadFlags.USE_IMPLICIT_CYLINDER

PlacedBody = tuple[BodySpec, Pose]
"""A body, and the world pose of the link frame of its base."""


def sdf_bodies(
    path: Path, search: AssetSearch, *, scale: float, words_are_true: bool = True
) -> list[PlacedBody]:
    """The bodies of an SDF file as PyBullet reads it, in its order; raises `DescriptionError`.

    With `words_are_true`, `<static>true</static>` makes a model static; in PyBullet it does not.
    """
    from carom.formats.sdf import read_sdf

    check_scale(scale)
    with reading(path):
        robots = read_sdf(path, scale=scale, words_are_true=words_are_true, search=search)
        return [(assemble(placed.robot, fixed_base=placed.fixed_base), placed.pose) for placed in robots]


def written_sdf_bodies(
    path: Path,
    search: AssetSearch,
    *,
    scale: float,
    cursor: Cursor,
    xacro_args: Sequence[tuple[str, str]] = (),
    missing_meshes: bool = False,
) -> tuple[SdfScene, list[PlacedBody]]:
    """All of an SDF file as its author means it, and its bodies in order; raises `DescriptionError`.

    The `cursor` records what is taken of the file. Macros of xacro are expanded, with these arguments; with
    `missing_meshes`, shapes whose mesh is missing are left out.
    """
    from carom.formats.sdf.document import Document

    with reading(path):
        scene = Document(scale, search, cursor, missing_meshes=missing_meshes).read(path, xacro_args)
        bodies: list[PlacedBody] = []
        for placed in scene.robots:
            spec = assemble(placed.robot, fixed_base=placed.fixed_base, as_written=True)
            bodies.append((spec, placed.pose))
        return scene, bodies


def usd_bodies(path: Path) -> tuple[UsdScene, IgnoredList, list[PlacedBody]]:
    """All of a USD stage, what of it is left out, and its bodies in order; raises `DescriptionError`."""
    from carom.formats.usd.reader import read_usd

    with reading(path):
        scene, ignored = read_usd(path, usd_solids())
        bodies: list[PlacedBody] = []
        both = LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_INCLUDE_PARENT
        for robot in scene.robots:
            it, flags = robot.placed, both if robot.touches_itself else LoadFlags.NONE
            spec = assemble(
                it.robot, flags=flags, fixed_base=it.fixed_base, compound_margin=0.0, as_written=True
            )
            bodies.append((spec, it.pose))
        return scene, ignored, bodies


def usd_solids() -> Solids:
    """The geometry that the reader of USD needs."""
    from carom.formats.usd.stage import Solids
    from carom.geometry.decomposition import DecompositionOptions, decompose

    def pieces(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> list[NDArray[np.float64]]:
        return [vertices for vertices, _ in decompose(points, triangles, DecompositionOptions())]

    return Solids(hull_triangles, pieces)


def mjcf_bodies(
    path: Path,
    search: AssetSearch,
    *,
    flags: int,
    as_mujoco: bool = True,
    cursor: Cursor | None = None,
) -> list[PlacedBody]:
    """The bodies of an MJCF file, in the order of the file; raises `DescriptionError`.

    `flags` are `carom.layouts.flags.LoadFlags`. With `as_mujoco`, `axisangle` turns bodies, and named classes
    limit joints; in PyBullet they do not. A `cursor` records what is taken of the file.
    """
    from carom.formats.mjcf import read_mjcf

    with reading(path):
        robots = read_mjcf(
            path,
            colours=bool(flags & LoadFlags.MJCF_COLORS_FROM_FILE),
            implicit=bool(flags & LoadFlags.USE_IMPLICIT_CYLINDER),
            as_mujoco=as_mujoco,
            search=search,
            cursor=cursor,
        )
        return _assembled(robots, LoadFlags(flags & ~_NOT_FOR_MJCF | _ALWAYS_FOR_MJCF))


def _assembled(robots: Sequence[PlacedRobot], loading: LoadFlags) -> list[PlacedBody]:
    """The bodies of robots that were read as PyBullet reads MJCF."""
    bodies = []
    for placed in robots:
        spec = assemble(placed.robot, flags=loading, compound_margin=0.0)
        for link in (spec.base, *spec.links):
            link.default_margins = True
        from carom.model.mjcf_inertia import set_mjcf_inertias

        set_mjcf_inertias(spec)
        bodies.append((spec, placed.pose))
    return bodies


def compiled_mjcf_bodies(
    path: Path,
    search: AssetSearch,
    *,
    flags: int,
    cursor: Cursor | None = None,
    missing_meshes: bool = False,
    root: Element | None = None,
) -> tuple[CompiledModel, list[PlacedBody]]:
    """All of an MJCF file as MuJoCo understands it, and its bodies in the order of the file.

    Links of a body collide with each other; see `carom.formats.mjcf.compiled.reader.compile_mjcf` for what is
    read. Raises `DescriptionError`.
    """
    from carom.formats.mjcf.compiled import compile_mjcf

    with reading(path):
        model = compile_mjcf(
            path,
            hull=hull_triangles,
            search=search,
            cursor=cursor,
            missing_meshes=missing_meshes,
            root=root,
        )
        return model, _compiled(model, flags)


def _compiled(model: CompiledModel, flags: int) -> list[PlacedBody]:
    """The bodies of a compiled file."""
    loading = LoadFlags(flags | _ALWAYS_FOR_MJCF)
    if not flags & LoadFlags.ANY_SELF_COLLISION:
        loading |= LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_INCLUDE_PARENT
    bodies = []
    for placed in model.robots:
        spec = assemble(
            placed.robot, flags=loading, fixed_base=placed.fixed_base, compound_margin=0.0, as_written=True
        )
        # A base that is fixed keeps the mass of its body, which has no effect until it is freed.
        spec.base.mass = placed.robot.links[placed.robot.root].inertial.mass
        for link in (spec.base, *spec.links):
            link.exact_edges = True
        bodies.append((spec, placed.pose))
    return bodies


def make_shapes(bodies: Sequence[PlacedBody]) -> None:
    """Prepare all shapes for collision detection, so that `DescriptionError` is raised early."""
    for spec, _ in bodies:
        if spec.pattern is not None:
            continue
        if spec.source is None:
            _make_shapes(spec)
            continue
        with reading(spec.source):
            _make_shapes(spec)


def _make_shapes(spec: BodySpec) -> None:
    implicit = bool(spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    for link in (spec.base, *spec.links):
        for collision in link.collisions:
            shape_pieces(collision.geometry, implicit_cylinder=implicit)
