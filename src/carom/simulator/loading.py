"""Loading the files of the simulator into a world: robots, scenes, saved worlds and meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.formats.kinds import FileKind, is_robot_file, kind_of
from carom.formats.reading.ignored import IgnoredList
from carom.formats.robot.file import locate
from carom.formats.robot.geometry import WRITTEN_MESH_SUFFIXES
from carom.world.robot_files import Choices

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled import CompiledModel
    from carom.scene.body import Body
    from carom.world.world import World

_XML_SUFFIXES = (".urdf", ".sdf", ".world", ".xml", ".mjcf", ".xacro")


@dataclass(eq=False, slots=True)
class LoadedFile:
    """A file in a world.

    Attributes:
        path: The file.
        format: `URDF`, `SDF`, `MJCF`, `USD`, `saved world` or `mesh`.
        bodies: The bodies that it describes.
        ignored: What it says and the simulation lacks.
        stated: What it states besides bodies, by name.
        arguments: The arguments of a xacro file, by name, with their values.
        model: All of an MJCF file; None for others.
    """

    path: Path
    format: str
    bodies: list[Body] = field(default_factory=list)
    ignored: IgnoredList = field(default_factory=IgnoredList)
    stated: Mapping[str, Any] = field(default_factory=dict)
    arguments: Mapping[str, str] = field(default_factory=dict)
    model: CompiledModel | None = None


def located(path: Path, choices: Choices) -> Path:
    """The file of a path, which may be the name of one of `pybullet_data`.

    Raises:
        DescriptionError: There is none.
    """
    return locate(path, choices.search())


def load_files(world: World, paths: Sequence[Path], choices: Choices) -> list[LoadedFile]:
    """Add what files describe to a world without bodies; gravity and options are those of the first of them.

    A mesh becomes a fixed body whose triangles collide. Of `choices`, `fixed_base` is for the URDF files, and
    each argument of `xacro_args` for the xacro files that declare it.

    Raises:
        DescriptionError: A file cannot be used, or there is nothing in any of them.
        ValueError: No file has an argument of a name that is given.
    """
    found = [_load(world, located(path, choices), choices) for path in paths]
    if not any(it.bodies for it in found):
        raise DescriptionError("it holds no robot", file=found[0].path)
    declared = {name for it in found for name in it.arguments}
    if unknown := sorted(set(choices.xacro_args or ()) - declared):
        known = ", ".join(sorted(declared)) or "none"
        raise ValueError(f"no file has the argument {unknown[0]!r}; their arguments: {known}")
    return found


def _load(world: World, file: Path, choices: Choices) -> LoadedFile:
    if file.suffix.lower() in WRITTEN_MESH_SUFFIXES:
        with reading(file):
            return LoadedFile(file, "mesh", [world.add_mesh(file, mass=0.0, concave=True)])
    if not is_robot_file(file):
        scene = world.load(file)
        return LoadedFile(file, scene.format, scene.bodies, scene.ignored, scene.options)
    with reading(file):
        kind = kind_of(file)
    arguments = xacro_arguments(file, choices) if kind in (FileKind.URDF, FileKind.SDF) else {}
    given = {name: value for name, value in (choices.xacro_args or {}).items() if name in arguments}
    own = replace(choices, xacro_args=given or None, fixed_base=choices.fixed_base and kind is FileKind.URDF)
    scene = world.load(
        file,
        fixed_base=own.fixed_base,
        package_paths=own.package_paths,
        missing_meshes=own.missing_meshes,
        xacro_args=own.xacro_args,
    )
    loaded = LoadedFile(file, scene.format, scene.bodies, scene.ignored, scene.options, arguments)
    if kind is FileKind.MJCF:
        from carom.world.robot_files import read_robot_file

        loaded.model = read_robot_file(file, replace(own, fixed_base=False), kind).model
    return loaded


def xacro_arguments(file: Path, choices: Choices) -> dict[str, str]:
    """The arguments that a xacro file declares, those of included files among them, and their values.

    Where it cannot be expanded, which loading it then says, they are those of the file itself. Other files
    have none.
    """
    from carom.files.xml_tree import parse_root
    from carom.formats.xacro.document import expand, is_xacro

    if file.suffix.lower() not in _XML_SUFFIXES:
        return {}
    with reading(file):
        data, _ = read_bounded(file, "document_bytes")
        root = parse_root(data, file, "robot", "sdf", "gazebo")
        if not is_xacro(root, file):
            return {}
        own = {
            it.attributes["name"]: it.attributes.get("default", "")
            for it in root.children
            if it.tag == "xacro:arg" and "name" in it.attributes
        }
        given = {name: str(value) for name, value in (choices.xacro_args or {}).items()}
        try:
            declared = expand(root, file, choices.search(), {}).arguments
        except (DescriptionError, ValueError):
            declared = own
    return {name: given.get(name, value) for name, value in declared.items()}


def main_file(files: Sequence[Path]) -> Path | None:
    """Which of several files is to be shown: the outermost robot file, saved world or, without one, mesh.

    Others are its meshes, textures and included files. Of robot files at the same depth it is one that no
    other names, the first by name.
    """
    robots = [it for it in files if _is_robot(it)]
    meshes = [it for it in files if it.suffix.lower() in WRITTEN_MESH_SUFFIXES]
    saved = [it for it in files if it not in robots and it not in meshes and _is_saved(it)]
    for candidates in (robots, saved, meshes):
        if candidates:
            texts = {it: _text(it) for it in candidates} if candidates is robots else {}
            named = {
                it for it in candidates for other, text in texts.items() if other != it and it.name in text
            }
            return min(candidates, key=lambda it: (it in named, len(it.parts), str(it)))
    return None


def _is_robot(file: Path) -> bool:
    if not is_robot_file(file):
        return False
    try:
        with reading(file):
            return kind_of(file) is not FileKind.SAVED_WORLD
    except DescriptionError:
        return False


def _is_saved(file: Path) -> bool:
    try:
        with reading(file):
            return kind_of(file) is FileKind.SAVED_WORLD
    except DescriptionError:
        return False


def _text(file: Path) -> str:
    try:
        return read_bounded(file, "document_bytes")[0].decode("utf-8", errors="replace")
    except DescriptionError:
        return ""
