"""Reading an MJCF file into robots and their world poses."""

from __future__ import annotations

from pathlib import Path

from carom.formats.files import read_bounded
from carom.formats.mjcf.body import ModelReader, world_elements
from carom.formats.mjcf.context import MjcfContext
from carom.formats.mjcf.defaults import read_defaults
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor, TracedElement
from carom.formats.robot.context import shown
from carom.formats.robot.file import MAX_FILE_BYTES, Includes, locate
from carom.formats.search import AssetSearch
from carom.formats.xml_element import MAX_ELEMENTS, Element
from carom.formats.xml_tree import parse_root
from carom.logger import Logger

_log = Logger(__name__)

_ROOTS = ("mujoco", "mujocoinclude")
_READ = ("compiler", "default", "asset", "worldbody", "body")
_SILENT = ("option", "size", "visual", "statistic")


def read_mjcf(
    path: Path,
    *,
    colours: bool = False,
    implicit: bool = False,
    as_mujoco: bool = True,
    search: AssetSearch | None = None,
    cursor: Cursor | None = None,
) -> list[PlacedRobot]:
    """Reads and checks an MJCF file, looked up with `AssetSearch.find`: bodies and geoms in its order.

    Features that PyBullet supports are read as PyBullet reads them: numbers in single precision, 1000 kg/m³
    for every geom, massless links for joints. Others have MuJoCo's meaning: classes of defaults for all
    attributes, ball joints, ellipsoids, all kinds of orientations, `<frame>`, `<include>`, global
    coordinates. Actuators, sensors, tendons, damping, armature and the like are ignored. The flags are those
    of `MjcfContext`. A `cursor` records what is taken.

    Raises:
        DescriptionError: The file is missing or broken.
    """
    search = search or AssetSearch()
    file = locate(path, search)
    root = _read_root(file, cursor)
    context = MjcfContext(file, root, search)
    context.colours = colours
    context.implicit = implicit
    context.as_mujoco = as_mujoco
    _Inclusion(context, cursor).expand(root, file, (file,))
    for element in root.all("default"):
        read_defaults(context, element)
    for element in root.all("compiler"):
        _read_compiler(context, element)
    for element in root.all("asset"):
        _read_assets(context, element)
    ignored = sorted({child.tag for child in root.children} - {*_READ, *_SILENT})
    if ignored:
        _log.info("%s: <%s> left out", file, ">, <".join(ignored))
    name = root.attributes.get("model", "")
    robots: list[PlacedRobot] = []
    for world in (*root.all("body"), *root.all("worldbody")):
        for element, scope in world_elements(context, world):
            reader = ModelReader(context, len(robots), name)
            if element.tag == "body":
                robots.append(reader.read_body(element, scope))
            elif element.tag == "geom":
                robots.append(reader.read_world_geom(element, scope))
    return robots


def _read_root(file: Path, cursor: Cursor | None) -> Element:
    data, _ = read_bounded(file, MAX_FILE_BYTES)
    root = parse_root(data, file, *_ROOTS)
    return root if cursor is None else cursor.trace(root, file)


class _Inclusion:
    """Replaces `<include>` elements by the content of the files they include."""

    def __init__(self, context: MjcfContext, cursor: Cursor | None) -> None:
        self.context = context
        self.cursor = cursor
        self.includes = Includes()
        self.elements = 0

    def expand(self, parent: Element, file: Path, including: tuple[Path, ...]) -> None:
        """Replaces every `<include>` below an element; `including` are its file and those around that."""
        children: list[Element] = []
        for child in parent.children:
            if child.tag != "include":
                self.expand(child, file, including)
                children.append(child)
                continue
            other = self._file(child, file, including)
            root = _read_root(other, self.cursor)
            self.expand(root, other, (*including, other))
            for element in root.children:
                self.context.origins.setdefault(id(element), other)
            self.elements += _count(root)
            if self.elements > MAX_ELEMENTS:
                raise self.context.error(child, f"all includes have more than {MAX_ELEMENTS} elements")
            children += root.children
            if isinstance(root, TracedElement):
                # From now on they are reported below the element that includes them.
                root.children = []
        parent.children = children

    def _file(self, element: Element, file: Path, including: tuple[Path, ...]) -> Path:
        name = self.context.required(element, "file")
        found = self.context.search.find_referenced(name, file)
        return self.includes.admit(self.context, element, name, found, including)


def _count(element: Element) -> int:
    return 1 + sum(_count(child) for child in element.children)


def _read_compiler(context: MjcfContext, element: Element) -> None:
    options, attributes = context.compiler, element.attributes
    angle = attributes.get("angle", "degree")
    if angle not in ("degree", "radian"):
        raise context.error(element, f"angle={shown(angle)} is neither degree nor radian")
    options.degrees = angle == "degree"
    coordinate = attributes.get("coordinate", "local")
    if coordinate not in ("local", "global"):
        raise context.error(element, f"coordinate={shown(coordinate)} is neither local nor global")
    options.global_frames = coordinate == "global"
    sequence = attributes.get("eulerseq", options.euler_sequence)
    if len(sequence) != 3 or set(sequence.lower()) - set("xyz"):
        raise context.error(element, f"eulerseq={shown(sequence)} needs three of x, y, z, X, Y and Z")
    options.euler_sequence = sequence
    options.mesh_directory = attributes.get("meshdir", attributes.get("assetdir", options.mesh_directory))
    options.auto_limits = attributes.get("autolimits") == "true"
    if attributes.get("inertiafromgeom", "").startswith("f"):
        options.inertia_from_geoms = False


def _read_assets(context: MjcfContext, element: Element) -> None:
    for child in element.children:
        if child.tag == "mesh":
            name = child.attributes.get("name") or Path(child.attributes.get("file", "")).stem
            context.assets.meshes[name] = child
        elif child.tag == "material":
            context.assets.materials[child.attributes.get("name", "")] = child
