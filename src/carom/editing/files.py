"""Reading descriptions from files of any format."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from carom.description.sensor import SensorKind
from carom.editing.attached_keys import add_attached_keys
from carom.editing.description import Description
from carom.editing.flattening import flattened
from carom.editing.from_mounts import Fittings
from carom.editing.from_robots import Driven, description_of
from carom.editing.losses import Losses
from carom.editing.masses import state_masses
from carom.errors import DescriptionError
from carom.file_bodies import usd_bodies, written_sdf_bodies
from carom.files.boundary import reading
from carom.formats.kinds import FileKind, kind_of
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import Ignored, IgnoredList
from carom.formats.reading.written import Written
from carom.formats.robot.file import locate
from carom.formats.sdf.options import MAGNETIC_FIELD
from carom.formats.sdf.scene import SdfScene
from carom.formats.search import AssetSearch
from carom.formats.shipped import shipped_folder
from carom.geometry.hull import hull_triangles
from carom.model.assemble import assemble


def read(
    path: str | Path,
    *,
    package_paths: Sequence[str | Path] = (),
    fixed_base: bool = False,
    xacro_args: Mapping[str, object] | None = None,
) -> Description:
    """Read a robot or scene as a description, which can be changed before it is loaded or written.

    The format is found by the content of the file: URDF and xacro, SDF, MJCF or USD.

    Args:
        path: The file; one that comes with `pybullet_data` is found by its name.
        package_paths: Directories of ROS packages, or that contain them, for `package://` and `model://`.
        fixed_base: Fix the base of a URDF file in the world.
        xacro_args: Values of the arguments that a xacro file declares, by name.

    Returns:
        The description; `ignored` says what of the file it does not hold.

    Raises:
        carom.errors.DescriptionError: The file cannot be used.
        ValueError: An argument is not for this format.
    """
    search = AssetSearch(shipped_folder(), packages=tuple(Path(it).absolute() for it in package_paths))
    file = locate(Path(path), search)
    with reading(file):
        kind = kind_of(file)
        if kind is FileKind.SAVED_WORLD:
            raise DescriptionError("it is a saved world, and no robot file", file=file)
    if fixed_base and kind is not FileKind.URDF:
        raise ValueError(f"fixed_base is for URDF; in {kind.value} files, models state it themselves")
    if xacro_args and kind not in (FileKind.URDF, FileKind.SDF):
        raise ValueError("xacro_args is for URDF and SDF files")
    with reading(file):
        if kind is FileKind.MJCF:
            return _read_mjcf(file, search)
        given = tuple((name, _as_text(value)) for name, value in (xacro_args or {}).items())
        losses = Losses(file)
        found = _READERS[kind](file, search, Written(xacro_args=given), fixed_base)
        name, robots, actuators, stated, fittings = found
        root = description_of(robots, actuators, name, losses, fittings)
        return Description(root, file, IgnoredList.of([*stated, *losses.list()]), search)


def _read_mjcf(file: Path, search: AssetSearch) -> Description:
    from carom.formats.mjcf.compiled.reader import read_document

    cursor = Cursor(MJCF_RULES)
    context = read_document(file, search, hull_triangles, cursor)
    root = flattened(context)
    lost = add_attached_keys(root, context, search)
    state_masses(root, file, search)
    return Description(root, file, IgnoredList.of([*cursor.reported(), *lost]), search)


_Read = tuple[str, list[PlacedRobot], list[Driven], list[Ignored], Fittings]
_OPTIONS = {"gravity": "gravity", "timestep": "timestep", "magnetic_field": "magnetic"}


def _read_urdf(file: Path, search: AssetSearch, written: Written, fixed_base: bool) -> _Read:
    from carom.formats.urdf.reader import read_written_urdf

    robot, ignored = read_written_urdf(file, written, search=search)
    fixed = fixed_base or (robot.deformable is None and assemble(robot, as_written=True).fixed_base)
    return robot.name, [PlacedRobot(robot, fixed_base=fixed)], [], list(ignored), Fittings()


def _read_sdf(file: Path, search: AssetSearch, written: Written, fixed_base: bool) -> _Read:
    from carom.formats.sdf.rules import SDF_RULES

    cursor = Cursor(SDF_RULES)
    scene, _ = written_sdf_bodies(file, search, scale=1.0, cursor=cursor, xacro_args=written.xacro_args)
    actuators: list[Driven] = []
    fittings = Fittings()
    first = 0
    for model in scene.models:
        robots = list(enumerate(model.robots, start=first))
        first += len(model.robots)
        owners = {link.name: number for number, it in reversed(robots) for link in it.robot.links}
        owners |= {joint.name: number for number, it in reversed(robots) for joint in it.robot.joints}
        links = {link.name: number for number, it in reversed(robots) for link in it.robot.links}
        fittings.mounts += [(links[mount.link], mount) for mount in model.mounts]
        fittings.cameras += [(links[camera.link], camera) for camera in model.cameras]
        for owner, name, actuator in model.actuators:
            actuators.append((owners[owner], actuator.spec(name)))
    fittings.options = _options(scene)
    told = "it is not in the description", "a description of links and joints is made of SDF files"
    others = len(scene.options.keys() - _OPTIONS.keys())
    lost = [Ignored("world", file, 1, (), others, *told)] if others else []
    return file.stem, list(scene.robots), actuators, [*cursor.ignored(), *lost], fittings


def _options(scene: SdfScene) -> dict[str, Sequence[float]]:
    """Options of a scene of SDF under their names in MJCF."""
    found: dict[str, Sequence[float]] = {}
    if any(it.kind is SensorKind.MAGNETOMETER for model in scene.models for mount in model.mounts
           for it in mount.sensors):  # fmt: skip
        found["magnetic"] = MAGNETIC_FIELD
    for name, value in scene.options.items():
        if name in _OPTIONS:
            found[_OPTIONS[name]] = (value,) if isinstance(value, float) else value
    return found


def _read_usd(file: Path, search: AssetSearch, written: Written, fixed_base: bool) -> _Read:
    scene, ignored, _ = usd_bodies(file)
    actuators: list[Driven] = [
        (number, drive.actuator.spec(drive.name or drive.joint))
        for number, robot in enumerate(scene.robots)
        for drive in robot.drives
    ]
    told = "it is not in the description", "a description of bodies and joints is made of stages"
    counts = {
        "joint that closes a loop": sum(len(robot.loops) for robot in scene.robots),
        "filtered pair": len(scene.apart),
        "camera": len(scene.cameras),
        "joint state": sum(len(robot.positions) + len(robot.turns) for robot in scene.robots),
        "scene": len(scene.options),
        "drive/control": sum(bool(drive.control) for robot in scene.robots for drive in robot.drives),
        "drive for each unit of mass": sum(it.per_mass for robot in scene.robots for it in robot.drives),
    }
    lost = [Ignored(what, file, 1, (), count, *told) for what, count in counts.items() if count]
    return file.stem, [it.placed for it in scene.robots], actuators, [*ignored, *lost], Fittings()


_READERS: dict[FileKind, Callable[[Path, AssetSearch, Written, bool], _Read]] = {
    FileKind.URDF: _read_urdf,
    FileKind.SDF: _read_sdf,
    FileKind.USD: _read_usd,
}


def _as_text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
