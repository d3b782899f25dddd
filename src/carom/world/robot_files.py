"""Robot files, read as their authors meant them: bodies, constraints, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.joint import JOINT_CODE, SLIDES
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose
from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.formats.kinds import FileKind, kind_of
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import IgnoredList
from carom.formats.reading.written import Written
from carom.formats.robot.file import check_scale, locate
from carom.formats.search import AssetSearch
from carom.formats.shipped import shipped_folder
from carom.layouts.codes import POSITION_COUNT
from carom.logger import Logger
from carom.model.body_spec import BASE, BodySpec
from carom.native.uninterrupted import Quiet

if TYPE_CHECKING:
    from carom.editing.description import Description
    from carom.formats.mjcf.compiled import CompiledModel
    from carom.formats.sdf.scene import SdfScene
    from carom.formats.urdf.semantics import Semantics
    from carom.formats.usd.scene import UsdScene
    from carom.scene.core.body_core import BodyCore
    from carom.scene.named_constraints.joint_coupling import JointCoupling

_log = Logger("carom.world")
MISSING_MESHES = ("error", "warn")


@dataclass(slots=True)
class Choices:
    """How a robot file is loaded; see `World.load`."""

    fixed_base: bool = False
    scale: float = 1.0
    flags: int = 0
    strict: bool = False
    package_paths: Sequence[str | Path] = ()
    missing_meshes: str = "error"
    default_mass: float | None = None
    xacro_args: Mapping[str, object] | None = None
    srdf: str | Path | None = None

    def written(self) -> Written:
        """The choices of a reading; raises `ValueError` if one is not known."""
        if self.missing_meshes not in MISSING_MESHES:
            raise ValueError(f"missing_meshes is {self.missing_meshes!r}; expected one of {MISSING_MESHES}")
        if self.default_mass is not None and not 0.0 < self.default_mass < float("inf"):
            raise ValueError(f"default_mass is {self.default_mass}; expected a positive number or None")
        given = tuple((name, _as_text(value)) for name, value in (self.xacro_args or {}).items())
        return Written(self.missing_meshes == "warn", self.default_mass, given)

    def search(self) -> AssetSearch:
        """The search for the file and its meshes."""
        packages = tuple(Path(path).absolute() for path in self.package_paths)
        return AssetSearch(shipped_folder(), packages=packages)


@dataclass(eq=False, slots=True)
class RobotFile:
    """What a file describes, before it is in a world.

    Attributes:
        path: The file.
        kind: Its format.
        bodies: Bodies, and world poses of the link frames of their bases.
        ignored: What it says and the simulation lacks.
        model: All of an MJCF file; None for other formats.
        sdf: All of an SDF file; None for other formats.
        usd: All of a USD stage; None for other formats.
        semantics: What an SRDF file says; None without one.
    """

    path: Path
    kind: FileKind
    bodies: list[tuple[BodySpec, Pose]] = field(default_factory=list)
    ignored: IgnoredList = field(default_factory=IgnoredList)
    model: CompiledModel | None = None
    sdf: SdfScene | None = None
    usd: UsdScene | None = None
    semantics: Semantics | None = None


def read_robot_file(path: Path, choices: Choices, kind: FileKind | None = None) -> RobotFile:
    """Read a robot file; without `kind`, its format is found by its content.

    Raises:
        DescriptionError: The file cannot be used, or, if the choice is strict, something in it would be left
            out.
        ValueError: A choice is not known, or not for this format.
    """
    written, search = choices.written(), choices.search()
    file = locate(path, search)
    with reading(file):
        kind = kind or kind_of(file)
    if kind is FileKind.SAVED_WORLD:
        raise DescriptionError("it is a saved world, and no robot file", file=file)
    if kind is not FileKind.URDF and choices.fixed_base:
        raise ValueError(f"fixed_base is for URDF; in {kind.value} files, models state it themselves")
    if kind in (FileKind.MJCF, FileKind.USD) and choices.scale != 1.0:
        raise ValueError("scale is for URDF and SDF files")
    if kind in (FileKind.MJCF, FileKind.USD) and choices.xacro_args:
        raise ValueError("xacro_args is for URDF and SDF files")
    if kind is not FileKind.URDF and choices.srdf is not None:
        raise ValueError("srdf is for URDF files")
    check_scale(choices.scale)
    result = RobotFile(file, kind)
    with reading(file), Quiet():
        _read(result, choices, written, search)
    return result


def compiled_description(description: Description, choices: Choices) -> RobotFile:
    """What a description is as MuJoCo compiles it; errors name the files that its parts were read from.

    Raises:
        DescriptionError: Something in it is wrong.
        ValueError: A choice is not known, or not for descriptions.
    """
    from carom.editing.elements import copied
    from carom.file_bodies import compiled_mjcf_bodies
    from carom.formats.mjcf.rules import MJCF_RULES

    written = choices.written()
    if choices.fixed_base or choices.scale != 1.0 or choices.xacro_args or choices.package_paths:
        raise ValueError(
            "fixed_base, xacro_args and package_paths are for carom.read, and Description.scale scales"
        )
    if choices.srdf is not None:
        raise ValueError("srdf is for URDF files")
    result, cursor = RobotFile(description.source, FileKind.MJCF), Cursor(MJCF_RULES)
    with reading(description.source):
        result.model, result.bodies = compiled_mjcf_bodies(
            description.source,
            description.search,
            flags=choices.flags,
            cursor=cursor,
            missing_meshes=written.missing_meshes,
            root=copied(description.root),
        )
        result.bodies += _soft(result.model, description.source)
        result.ignored = IgnoredList.of([*description.ignored, *cursor.ignored()])
    return result


def _read(result: RobotFile, choices: Choices, written: Written, search: AssetSearch) -> None:
    """Read the file of a result into it."""
    file, kind = result.path, result.kind
    if kind is FileKind.URDF:
        from carom.soft.from_urdf import written_urdf_body

        spec, result.ignored = written_urdf_body(
            file, search, written, scale=choices.scale, flags=choices.flags, fixed_base=choices.fixed_base
        )
        result.bodies = [(spec, IDENTITY)]
        if choices.srdf is not None:
            _read_srdf(result, spec, Path(choices.srdf), choices, written, search)
    elif kind is FileKind.SDF:
        from carom.file_bodies import written_sdf_bodies
        from carom.formats.sdf.rules import SDF_RULES

        cursor = Cursor(SDF_RULES)
        result.sdf, result.bodies = written_sdf_bodies(
            file,
            search,
            scale=choices.scale,
            cursor=cursor,
            xacro_args=written.xacro_args,
            missing_meshes=written.missing_meshes,
        )
        result.ignored = cursor.ignored()
    elif kind is FileKind.USD:
        from carom.file_bodies import usd_bodies

        result.usd, result.ignored, result.bodies = usd_bodies(file)
    else:
        from carom.file_bodies import compiled_mjcf_bodies
        from carom.formats.mjcf.rules import MJCF_RULES

        cursor = Cursor(MJCF_RULES)
        result.model, result.bodies = compiled_mjcf_bodies(
            file, search, flags=choices.flags, cursor=cursor, missing_meshes=written.missing_meshes
        )
        result.bodies += _soft(result.model, file)
        result.ignored = cursor.ignored()


def _soft(model: CompiledModel, file: Path) -> list[tuple[BodySpec, Pose]]:
    """The soft bodies of an MJCF file."""
    if not model.flexes:
        return []
    from carom.soft.from_flexes import flex_bodies

    return flex_bodies(model, file)


def _read_srdf(
    result: RobotFile, spec: BodySpec, path: Path, choices: Choices, written: Written, search: AssetSearch
) -> None:
    """Read what an SRDF file says of the robot of a result into it."""
    from carom.formats.urdf.semantics import JointPlace, read_srdf

    joints = [
        JointPlace(
            link.joint_name,
            link.name,
            spec.link(link.parent).name,
            POSITION_COUNT[JOINT_CODE[link.joint_type]],
            link.joint_type in SLIDES,
        )
        for link in spec.links
    ]
    result.semantics = read_srdf(
        path, search, spec.base.name, joints, scale=choices.scale, xacro_args=written.xacro_args
    )
    result.ignored = IgnoredList.of([*result.ignored, *result.semantics.ignored])


def give_semantics(body: BodyCore, semantics: Semantics) -> None:
    """Keep links of a body apart and give it keyframes, as an SRDF file says; called while it is added."""
    from carom.description.keyframe import BodyKeyframe
    from carom.formats.urdf.semantics import with_followers
    from carom.scene.keyframes.changes import add_keyframe

    names = [body.spec.link(index).name for index in range(BASE, len(body.spec.links))]
    rows = {name: row for row, name in enumerate(names, start=body.first_link)}
    filters = body.world.contact_arrays.shapes.filters
    for first, second in semantics.apart:
        filters.set(rows[first], rows[second], enabled=False)
    mimics = {
        link.joint_name: (link.mimic.joint, link.mimic.multiplier, link.mimic.offset)
        for link in body.spec.links
        if link.mimic is not None and not body.spec.is_held
    }
    for name, stated in semantics.states.items():
        positions = with_followers(stated, mimics)
        whole: list[float] = []
        for link, count in zip(body.spec.links, body.position_count, strict=True):
            if count == 1:
                whole.append(positions.get(link.joint_name, 0.0))
            elif count:
                whole += [0.0] * (count - 1) + [1.0]
        add_keyframe(body, BodyKeyframe(name, positions=tuple(whole)))


def _as_text(value: object) -> str:
    """The text of an argument, as it would be given on a command line."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def report(source: RobotFile, *, strict: bool) -> None:
    """One warning that says how much of a file is left out, if anything is; an error if that is strict.

    Raises:
        DescriptionError: It is strict, and something is left out; the message has the table.
    """
    lost = source.ignored.that_matter
    if not lost:
        return
    if strict:
        raise DescriptionError(f"{lost.total} things in it are not simulated:\n{lost}", file=source.path)
    _log.warning(
        "%s: %d things in it are not simulated (%s); print(scene.ignored) of World.load, or "
        "`python -m carom check`, lists them",
        source.path,
        lost.total,
        lost.summary(),
    )


def placed(
    bodies: Sequence[tuple[BodySpec, Pose]], position: Sequence[float], orientation: Sequence[float]
) -> list[tuple[BodySpec, Pose]]:
    """The bodies with the frame of the file at a pose of the world."""
    px, py, pz = position
    qx, qy, qz, qw = orientation
    pose = Pose((px, py, pz), (qx, qy, qz, qw))
    if pose == IDENTITY:
        return list(bodies)
    return [(spec, pose if own == IDENTITY else compose(pose, own)) for spec, own in bodies]


def has_mimics(spec: BodySpec) -> bool:
    """Whether joints of a body may mimic others."""
    return not spec.is_held and any(link.mimic is not None for link in spec.links)


def couple(bodies: Sequence[BodyCore]) -> list[JointCoupling]:
    """Couple the joints that mimic others, and place them; called while bodies are added."""
    from carom.scene.named_constraints.joint_coupling import JointCoupling, new_coupling, place_followers

    made = []
    for body in bodies:
        places = {link.joint_name: place for place, link in enumerate(body.spec.links)}
        for follower, link in enumerate(body.spec.links):
            mimic = link.mimic
            if mimic is None or body.spec.is_held or mimic.joint not in places:
                continue
            leader: int | None = places[mimic.joint]
            factor = mimic.multiplier
            if body.velocity_count[places[mimic.joint]] == 0:
                # The leader cannot move, so the follower is held where it wants it.
                leader, factor = None, 0.0
            coefficients = (mimic.offset, factor, 0.0, 0.0, 0.0)
            constraint = new_coupling(body, follower, leader, coefficients, link.joint_name)
            body.world.add_constraint(constraint)
            made.append(JointCoupling(constraint))
    for coupling in made:
        # From the first leaders on: a follower may lead others.
        if coupling.leader is None or not any(other.follower is coupling.leader for other in made):
            coupling.place()
        place_followers(coupling.follower)
    return made
