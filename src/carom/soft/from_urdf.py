"""Bodies from URDF files, rigid or soft."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from carom.description import Robot
from carom.errors import DescriptionError
from carom.formats.search import AssetSearch
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble
from carom.model.body_spec import BodySpec

if TYPE_CHECKING:
    from carom.description.deformable import Deformable
    from carom.soft.materials import NeoHookean, Springs


def urdf_body(
    path: Path, search: AssetSearch, *, scale: float, flags: int, fixed_base: bool, older: bool = False
) -> BodySpec:
    """The body of a URDF file, rigid or soft.

    Args:
        path: The file.
        search: Folders to search for it and for the files that it refers to.
        scale: Factor on all lengths.
        flags: Loading flags, see `carom.layouts.flags.LoadFlags`.
        fixed_base: Fix the base of a rigid body in the world.
        older: Make soft bodies as in PyBullet without a deformable world.

    Raises:
        DescriptionError: The file cannot be used.
    """
    from carom.formats.urdf import read_urdf

    robot = read_urdf(path, scale=scale, search=search)
    return robot_body(robot, scale=scale, flags=flags, fixed_base=fixed_base, older=older)


def robot_body(
    robot: Robot, *, scale: float = 1.0, flags: int = 0, fixed_base: bool = False, older: bool = False
) -> BodySpec:
    """The body of a description; the arguments are those of `urdf_body`.

    Raises:
        DescriptionError: A mesh of a soft body cannot be used.
    """
    if robot.deformable is None:
        return assemble(robot, flags=LoadFlags(flags), fixed_base=fixed_base)
    collides = bool(flags & LoadFlags.USE_SELF_COLLISION)
    spec = _deformable_body(robot.deformable, scale=scale, self_collision=collides, older=older)
    # As in PyBullet, the body has the name of its root link, and its base has no name.
    spec.name, spec.base.name, spec.user_data = robot.links[robot.root].name, "", dict(robot.user_data)
    spec.source = robot.source
    return spec


def _deformable_body(soft: Deformable, *, scale: float, self_collision: bool, older: bool) -> BodySpec:
    from carom.soft.files import soft_body_from_file
    from carom.soft.older import older_cloth_from_file

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
