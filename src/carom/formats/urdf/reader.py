"""Reading a URDF file into a `Robot`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from carom.description import Joint, Link, Robot, Visual
from carom.files.boundary import reading
from carom.files.bounded import FileCache, read_bounded
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.robot.context import FileContext
from carom.formats.robot.file import check_scale, locate, warn_of_assumed_masses
from carom.formats.robot.link import read_link
from carom.formats.robot.tree import find_root
from carom.formats.search import AssetSearch
from carom.formats.urdf.geometry import read_urdf_geometry
from carom.formats.urdf.joint import read_joint
from carom.formats.urdf.material import read_global_materials, read_visual_material

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.formats.reading.ignored import IgnoredList
    from carom.formats.reading.written import Written
    from carom.formats.xacro.document import Expanded

Part = TypeVar("Part", Link, Joint)

# The elements that make a robot a soft body, in order of precedence.
_SOFT = ("reduced_deformable", "deformable")


def read_urdf(path: Path, *, scale: float = 1.0, search: AssetSearch | None = None) -> Robot:
    """Reads and checks a URDF file, looked up with `AssetSearch.find`; links and joints are in file order.

    Unchanged files are served from a cache; changed files are read again. `scale` is a factor on every length
    (positions, shapes, limits of prismatic joints); masses and inertia tensors stay as they are.

    Raises:
        DescriptionError: The file is missing, broken, or does not describe one tree of links.
        ValueError: `scale` is not a positive number of sensible size.
    """
    return _read(path, scale, search or AssetSearch(), None)[0]


def read_written_urdf(
    path: Path, written: Written, *, scale: float = 1.0, search: AssetSearch | None = None
) -> tuple[Robot, IgnoredList]:
    """As `read_urdf`, but as the author of the file meant it; and what of it is not simulated.

    Links without `<inertial>` have no mass, products of inertia count singly, and an axis has no length. A
    joint that moves nothing with mass is reported, see `carom.formats.urdf.moving_mass`.
    """
    robot, ignored = _read(path, scale, search or AssetSearch(), written)
    assert ignored is not None
    return robot, ignored


def _read(
    path: Path, scale: float, search: AssetSearch, written: Written | None
) -> tuple[Robot, IgnoredList | None]:
    check_scale(scale)
    file = path
    # The search begins at an absolute path itself, so an unchanged file there is the one it would find.
    cached = _cache.get((file, scale, search, written), file) if path.is_absolute() else None
    if cached is None:
        file = locate(path, search)
        cached = _cache.get((file, scale, search, written), file)
    if cached is not None:
        robot, references, ignored, expanded = cached
        is_valid = expanded is None or expanded.is_still_valid(search)
        if is_valid and [search.find_referenced(name, file) for name in references] == list(
            references.values()
        ):
            return robot, ignored
    with reading(file):
        data, stamp = read_bounded(file, "document_bytes")
        context, expanded = _context(data, file, scale, search, written)
        robot, references = _parse(context)
    ignored = None if context.cursor is None else context.cursor.ignored()
    _cache.put((file, scale, search, written), stamp, (robot, references, ignored, expanded))
    return robot, ignored


def parse_urdf(
    data: bytes, file: Path, *, scale: float, search: AssetSearch
) -> tuple[Robot, dict[str, Path | None]]:
    """A robot from the content of a file, and the path that each file name in it was resolved to."""
    return _parse(_context(data, file, scale, search, None)[0])


def _context(
    data: bytes, file: Path, scale: float, search: AssetSearch, written: Written | None
) -> tuple[FileContext, Expanded | None]:
    element = parse_root(data, file, "robot")
    if written is None:
        return FileContext(file, element, scale, search), None
    # Imported only here: PyBullet's reading needs none of it.
    from carom.formats.reading.cursor import Cursor
    from carom.formats.urdf.extensions import read_extensions
    from carom.formats.urdf.rules import URDF_RULES

    expanded = None
    if b"xacro" in data or file.suffix.lower() == ".xacro" or written.xacro_args:
        # Imported only here: few files need it.
        from carom.formats.xacro.document import expanded_if_xacro

        expanded = expanded_if_xacro(element, file, search, written.xacro_args)
    cursor = Cursor(URDF_RULES)
    context = FileContext(
        file, cursor.trace(element if expanded is None else expanded.root, file), scale, search
    )
    context.parts = [] if expanded is None else list(expanded.files)
    context.written, context.cursor = written, cursor
    read_extensions(context)
    return context, expanded


def _parse(context: FileContext) -> tuple[Robot, dict[str, Path | None]]:
    element = context.root
    name = context.required(element, "name")
    for tag in _SOFT:
        soft = element.first(tag)
        if soft is not None:
            return _soft_robot(context, name, soft), context.references
    read_global_materials(context)
    links = _read_all(
        context, "link", lambda it: read_link(context, it, read_urdf_geometry, read_visual_material)
    )
    if not links:
        raise context.error(element, "there are no links")
    link_indices = {link.name: index for index, link in enumerate(links)}
    joints = _read_all(context, "joint", lambda it: read_joint(context, it, link_indices))
    warn_of_assumed_masses(context)
    root = find_root(context, links, joints, list(element.all("joint")))
    actuators: tuple[ActuatorSpec, ...] = ()
    if context.written is not None:
        from carom.formats.urdf.floating import with_free_root
        from carom.formats.urdf.transmission import read_transmissions

        actuators = read_transmissions(context, joints)
        from carom.formats.urdf.following import checked_followers
        from carom.formats.urdf.moving_mass import report_motion_without_mass

        report_motion_without_mass(context, links, joints)
        joints = checked_followers(context, joints)
        links, joints, root = with_free_root(context, links, joints, root)
    robot = Robot(
        name,
        tuple(_with_late_materials(context, link) for link in links),
        tuple(joints),
        root=root,
        materials=tuple(context.materials.values()),
        source=context.file,
        user_data=context.user_data(element),
        actuators=actuators,
    )
    return robot, context.references


def _soft_robot(context: FileContext, name: str, element: Element) -> Robot:
    """A robot that is a soft body; as in PyBullet its links and joints are ignored."""
    from carom.formats.urdf.deformable import read_deformable

    deformable = read_deformable(context, element)
    return Robot(
        name,
        (Link(context.required(element, "name")),),
        (),
        source=context.file,
        user_data=context.user_data(context.root),
        deformable=deformable,
    )


def _read_all(context: FileContext, tag: str, read: Callable[[Element], Part]) -> list[Part]:
    """The links or joints of a robot, all with different names."""
    parts: list[Part] = []
    lines: dict[str, int] = {}
    for element in context.root.all(tag):
        part = read(element)
        context.refuse_duplicate(element, part.name, lines)
        parts.append(part)
    return parts


def _with_late_materials(context: FileContext, link: Link) -> Link:
    """The link with its materials, including those that were referred to before their definition."""
    visuals = tuple([_with_late_material(context, visual) for visual in link.visuals])
    return link if visuals == link.visuals else replace(link, visuals=visuals)


def _with_late_material(context: FileContext, visual: Visual) -> Visual:
    material = visual.material
    if material is None or material.rgba or material.specular or material.texture:
        return visual
    return replace(visual, material=context.materials.get(material.name, material))


_cache: FileCache[
    tuple[Path, float, AssetSearch, Written | None],
    tuple[Robot, dict[str, Path | None], IgnoredList | None, Expanded | None],
] = FileCache(64)
