"""Reading an MJCF file into robots and their world poses."""

from __future__ import annotations

from pathlib import Path

from carom.files.boundary import reading
from carom.files.xml_element import Element
from carom.formats.mjcf.body import ModelReader, world_elements
from carom.formats.mjcf.context import MjcfContext
from carom.formats.mjcf.defaults import read_defaults
from carom.formats.mjcf.document import Inclusion, read_root
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor
from carom.formats.robot.context import shown
from carom.formats.robot.file import locate
from carom.formats.search import AssetSearch
from carom.logger import Logger

_log = Logger(__name__)

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
    with reading(file):
        return _read(file, search, cursor, colours=colours, implicit=implicit, as_mujoco=as_mujoco)


def _read(
    file: Path,
    search: AssetSearch,
    cursor: Cursor | None,
    *,
    colours: bool,
    implicit: bool,
    as_mujoco: bool,
) -> list[PlacedRobot]:
    root = read_root(file, cursor)
    context = MjcfContext(file, root, search)
    context.colours = colours
    context.implicit = implicit
    context.as_mujoco = as_mujoco
    Inclusion(context, cursor).expand(root, file, (file,))
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
