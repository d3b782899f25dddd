"""Bodies from URDF files, rigid or soft."""

from __future__ import annotations

from collections import OrderedDict
from operator import is_
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description import Mesh, Robot, SignedDistanceField
from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.formats.search import AssetSearch
from carom.layouts.contacts import MARGIN
from carom.layouts.flags import LoadFlags
from carom.logger import Logger
from carom.meshes import MeshPart, read_mesh
from carom.model.assemble import assemble
from carom.model.body_spec import BodySpec

if TYPE_CHECKING:
    from carom.description.deformable import Deformable
    from carom.formats.reading.ignored import IgnoredList
    from carom.formats.reading.written import Written
    from carom.soft.materials import NeoHookean, Springs

Meshes = dict[Path, list[MeshPart]]
_CACHED = 64


def urdf_body(
    path: Path, search: AssetSearch, *, scale: float, flags: int, fixed_base: bool, older: bool = False
) -> BodySpec:
    """The body of a URDF file, rigid or soft; `scale` is a factor on all lengths.

    `flags` are `carom.layouts.flags.LoadFlags`. `fixed_base` fixes the base of a rigid body in the world, and
    `older` makes soft bodies as in PyBullet without a deformable world.

    Raises:
        DescriptionError: The file cannot be used.
    """
    from carom.formats.urdf import read_urdf

    robot = read_urdf(path, scale=scale, search=search)
    if robot.deformable is not None:
        with reading(robot.source):
            return robot_body(robot, scale=scale, flags=flags, fixed_base=fixed_base, older=older)
    return _bodies.of(robot, flags, fixed_base)


def written_urdf_body(
    path: Path, search: AssetSearch, written: Written, *, scale: float, flags: int, fixed_base: bool
) -> tuple[BodySpec, IgnoredList]:
    """As `urdf_body`, but as the author of the file meant it; and what of it is not simulated."""
    from carom.formats.urdf.reader import read_written_urdf

    robot, ignored = read_written_urdf(path, written, scale=scale, search=search)
    if robot.deformable is not None:
        with reading(robot.source):
            return robot_body(robot, scale=scale, flags=flags, fixed_base=fixed_base), ignored
    return _bodies.of(robot, flags, fixed_base, as_written=True), ignored


def rigid_body(robot: Robot, *, flags: int, compound_margin: float) -> BodySpec:
    """The rigid body of a description, once made for the same object; raises `DescriptionError`."""
    return _bodies.of(robot, flags, False, compound_margin)


class _Bodies:
    """A cache of rigid bodies by the robots they were made from, valid while their meshes are unchanged.

    For an unchanged file, `read_urdf` returns the same robot.
    """

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[object, ...], tuple[Robot, Meshes, BodySpec]] = OrderedDict()

    def of(
        self,
        robot: Robot,
        flags: int,
        fixed_base: bool,
        compound_margin: float = MARGIN,
        *,
        as_written: bool = False,
    ) -> BodySpec:
        """The body of a robot."""
        key = id(robot), flags, fixed_base, compound_margin, as_written
        # Taken out meanwhile: another thread may do the same.
        kept = self._kept.pop(key, None)
        if kept is not None and kept[0] is robot and _are_unchanged(kept[1]):
            self._kept[key] = kept
            kept[2].is_reused = True
            return kept[2]
        # Read first: a mesh that changes while the body is made is then found to have changed.
        meshes = _meshes(robot, flags)
        said = Logger.count
        with reading(robot.source):
            spec = assemble(
                robot,
                flags=LoadFlags(flags),
                fixed_base=fixed_base,
                compound_margin=compound_margin,
                as_written=as_written,
            )
        # What the log was told must be told again for the next body.
        if meshes is not None and Logger.count == said and not flags & LoadFlags.PRINT_URDF_INFO:
            self._kept[key] = robot, meshes, spec
            while len(self._kept) > _CACHED:
                self._kept.popitem(last=False)
        return spec


_bodies = _Bodies()


def _meshes(robot: Robot, flags: int) -> Meshes | None:
    """The files that collision shapes are made from, and their parts; None if others count as well."""
    meshes: dict[Path, list[MeshPart]] = {}
    for link in () if flags & LoadFlags.IGNORE_COLLISION_SHAPES else robot.links:
        for collision in link.collisions:
            match collision.geometry:
                case Mesh(path):
                    try:
                        meshes[path] = read_mesh(path)
                    except DescriptionError:
                        return None
                case SignedDistanceField():
                    return None
    return meshes


def _are_unchanged(meshes: Meshes) -> bool:
    """Whether files have the parts they had: `read_mesh` returns the same ones for an unchanged file."""
    try:
        return all(all(map(is_, read_mesh(path), parts)) for path, parts in meshes.items())
    except DescriptionError:
        return False


def robot_body(
    robot: Robot, *, scale: float = 1.0, flags: int = 0, fixed_base: bool = False, older: bool = False
) -> BodySpec:
    """The body of a description, with the arguments of `urdf_body`; raises `DescriptionError`."""
    if robot.deformable is None:
        return assemble(robot, flags=LoadFlags(flags), fixed_base=fixed_base)
    collides = bool(flags & LoadFlags.USE_SELF_COLLISION)
    spec = _deformable_body(robot.deformable, scale=scale, self_collision=collides, older=older)
    # As in PyBullet, the body has the name of its root link, and its base has no name.
    spec.name, spec.base.name, spec.user_data = robot.links[robot.root].name, "", dict(robot.user_data)
    spec.source = robot.source
    return spec


def _deformable_body(soft: Deformable, *, scale: float, self_collision: bool, older: bool) -> BodySpec:
    from carom.soft.files import older_cloth_from_file, soft_body_from_file

    if older:
        if soft.stiffness_scale is not None:
            raise DescriptionError("reduced deformable bodies need a deformable world", file=soft.visual)
        path = soft.simulated or soft.visual
        return older_cloth_from_file(path, scale=scale, mass=soft.mass, margin=soft.margin)
    spec = soft_body_from_file(
        soft.visual,
        scale=scale,
        mass=soft.mass,
        springs=_springs(soft),
        solid=_solid(soft),
        margin=soft.margin,
        friction=soft.friction,
        self_collision=self_collision,
        simulated=soft.simulated,
    )
    assert spec.soft is not None
    spec.soft.gravity_factor = soft.gravity_factor
    return spec


def _springs(soft: Deformable) -> Springs | None:
    from carom.soft.materials import Springs

    if soft.springs is None or soft.springs.elastic <= 0.0:
        return None
    return Springs(soft.springs.elastic, soft.springs.damping, soft.springs.bending)


def _solid(soft: Deformable) -> NeoHookean | None:
    """Material of the tetrahedra: the sum of all material elements in the file."""
    from carom.soft.materials import NeoHookean
    from carom.soft.reduced import solid_of_modes

    if soft.stiffness_scale is not None:
        return solid_of_modes(soft)
    kinds: list[NeoHookean] = []
    if soft.neo_hookean is not None:
        kinds.append(NeoHookean(soft.neo_hookean.mu, soft.neo_hookean.lam, soft.neo_hookean.damping))
    if soft.corotated is not None:
        # The parameters of corotated materials are Lamé's.
        kinds.append(NeoHookean.of_lame(soft.corotated.mu, soft.corotated.lam, soft.corotated.damping))
    mu, lam = sum(kind.mu for kind in kinds), sum(kind.lam for kind in kinds)
    if mu == lam == 0.0:
        return None
    viscosity = sum(kind.damping * (kind.mu + kind.lam) for kind in kinds)
    return NeoHookean(mu, lam, viscosity / (mu + lam) if mu + lam > 0.0 else 0.0)
