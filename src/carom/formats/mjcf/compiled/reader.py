"""Reading an MJCF file as MuJoCo compiles it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from carom.description.actuator import ActuatorSpec
from carom.files.boundary import reading
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.reader import ActuatorReader
from carom.formats.mjcf.compiled.actuation.tendon_inertia import weigh_with_tendons
from carom.formats.mjcf.compiled.actuation.ties import Ties
from carom.formats.mjcf.compiled.body import WORLD, BodyReader
from carom.formats.mjcf.compiled.collision_groups import set_collision_groups
from carom.formats.mjcf.compiled.compiler import read_compiler
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.deformables.flexes import FlexSection
from carom.formats.mjcf.compiled.deformables.skins import read_skins
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.equality import EqualityReader
from carom.formats.mjcf.compiled.families import connected_pairs
from carom.formats.mjcf.compiled.flags import switch_off
from carom.formats.mjcf.compiled.inertia import scaled_to_total
from carom.formats.mjcf.compiled.keyframes.attached import add_attached_keyframes
from carom.formats.mjcf.compiled.keyframes.keyframe import read_keyframes, reference_of
from carom.formats.mjcf.compiled.looks.stage import read_stage
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel, world_poses
from carom.formats.mjcf.compiled.names import Names
from carom.formats.mjcf.compiled.option import DEFAULTS, read_option
from carom.formats.mjcf.compiled.pairs import paired_geoms, read_excluded, read_pairs
from carom.formats.mjcf.compiled.robots import let_held_bodies_move_by_frames, robot_of_body, robot_of_world
from carom.formats.mjcf.compiled.sensors import SensorReader
from carom.formats.mjcf.compiled.shapes.mesh_mass import Hull
from carom.formats.mjcf.compiled.softness import weigh
from carom.formats.mjcf.compiled.tendons import TendonReader
from carom.formats.mjcf.defaults import read_defaults
from carom.formats.mjcf.document import Inclusion, merge_sections, read_root
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor
from carom.formats.robot.context import shown
from carom.formats.robot.file import locate
from carom.formats.search import AssetSearch

_FILTER_PARENT = "flag.filterparent"
# What is in them is reported one by one.
_BY_CHILDREN = ("actuator", "sensor", "tendon", "equality", "deformable")
_MAX_MODELS = 64
_ASSETS = ("mesh", "material", "texture", "hfield")
_MODEL = "MuJoCo Model"
"""Name of a model whose file states none, as in MuJoCo."""


def compile_mjcf(
    path: Path,
    *,
    hull: Hull,
    search: AssetSearch | None = None,
    cursor: Cursor | None = None,
    missing_meshes: bool = False,
    root: Element | None = None,
) -> CompiledModel:
    """Reads and checks an MJCF file as MuJoCo understands it, in double precision.

    Inertia comes from geoms and meshes by the rules of `<compiler>`; bodies without joints are fixed to what
    is around them; the geoms of the world are one robot, `world`. Soft bodies are not read.

    Args:
        path: The file, looked up with `AssetSearch.find`.
        hull: Makes convex hulls.
        search: The search for files.
        cursor: Records what is taken.
        missing_meshes: Geoms whose mesh is missing are left out and reported; otherwise they are errors.
        root: The document, which is changed; then the file is not read, but errors name it.

    Raises:
        DescriptionError: The file is missing, broken, or something in it is.
    """
    search = search or AssetSearch()
    file = locate(path, search) if root is None else path
    with reading(file):
        return _compile(file, search, hull, cursor, missing_meshes=missing_meshes, root=root)


def _compile(
    file: Path,
    search: AssetSearch,
    hull: Hull,
    cursor: Cursor | None,
    *,
    missing_meshes: bool,
    root: Element | None = None,
) -> CompiledModel:
    context = read_document(file, search, hull, cursor, root=root)
    model = CompiledModel(context.root.attributes.get("model", ""), options=dict(DEFAULTS))
    for element in context.root.all("option"):
        read_option(context, element, model.options)
    reader = BodyReader(model, missing_meshes=missing_meshes)
    reader.paired = paired_geoms(context)
    scope, whole = Scope(context), CompiledBody(WORLD, context.root)
    world = context.root.first("worldbody")
    if world is not None:
        whole = reader.read_world(world, scope)
        flexes = FlexSection(reader, whole)
        flexes.read(scope)
        if set_collision_groups(whole, reader.bodies):
            context.leave_out(
                world,
                "all geoms of a body collide with what one of them collides with",
                "a body has one group",
            )
        if context.compiler.total_mass is not None:
            inertias = [body.inertia for body in (*reader.bodies, *flexes.nodes)]
            scaled_to_total(inertias, context.compiler.total_mass)
        flexes.weigh()
        weigh(model, whole)
        if model.options.get(_FILTER_PARENT, True):
            model.excluded += connected_pairs(whole)
        static = robot_of_world(whole)
        model.robots += [] if static is None else [static]
        model.robots += [robot_of_body(body) for body in whole.children]
        poses = world_poses(whole)
        for flex in model.flexes:
            flex.pose = poses[flex.body]
    model.stage = read_stage(context)
    names = Names(reader.bodies, reader.elements, model.flexes)
    for of, element, target in reader.aims:
        if target not in names.bodies and target != WORLD:
            raise of.context.error(element, f"there is no body {shown(target)}")
    for each in (scope, *reader.elements.attached):
        for tag in _BY_CHILDREN:
            for element in each.context.root.all(tag):
                element.note()
    model.skins = list(read_skins(scope, names))
    ties = Ties(whole)
    tendons = TendonReader(model, names, reader, whole, ties)
    tendons.read(scope)
    weigh_with_tendons(model, whole, names)
    tendons.add_ball_limits()
    model.still = tendons.still
    ActuatorReader(model, names, tendons.moving, ties).read(scope)
    ties.apply(model, context)
    model.robots = _driven(model)
    EqualityReader(model, names, whole).read(scope)
    let_held_bodies_move_by_frames(model, whole.children)
    SensorReader(model, names, reader.geom_bodies, reader.geom_frames).read(scope)
    read_pairs(model, names, scope, reader.geom_bodies, whole)
    switch_off(model)
    read_excluded(model, names, scope)
    model.reference = reference_of(model, names.bodies)
    for element in context.root.all("keyframe"):
        read_keyframes(context, element, model)
    own = {id(other) for other in context.attached.values()}
    add_attached_keyframes(
        model,
        [each for each in reader.elements.attached if id(each.context) in own],
        lambda other: _compile(other.file, search, hull, None, missing_meshes=missing_meshes),
    )
    return model


def _driven(model: CompiledModel) -> list[PlacedRobot]:
    """The robots with the actuators of their joints, tendons and sites, in the order of the file."""
    joints = {it.name: placed.robot.name for placed in model.robots for it in placed.robot.joints}
    links = {it.name: placed.robot.name for placed in model.robots for it in placed.robot.links}
    links.pop(WORLD, None)
    own: dict[str, list[ActuatorSpec]] = {placed.robot.name: [] for placed in model.robots}
    for spec in (it.spec for it in model.actuators if it.spec is not None):
        if spec.tendon:
            owner = model.tendons[spec.tendon].robot
        elif spec.site:
            bodies = (model.sites[name].body for name in (spec.site, spec.slider_site) if name)
            owner = next((links[body] for body in bodies if body in links), "")
        elif spec.link:
            owner = links.get(spec.link, "")
        else:
            owner = joints.get(spec.joint, "")
        if owner in own:
            own[owner].append(spec)
    return [
        replace(placed, robot=replace(placed.robot, actuators=tuple(own[placed.robot.name])))
        for placed in model.robots
    ]


def read_document(
    file: Path,
    search: AssetSearch,
    hull: Hull,
    cursor: Cursor | None,
    around: tuple[Path, ...] = (),
    root: Element | None = None,
) -> CompiledContext:
    """A file with all that it includes, its options, defaults, assets and the models that it attaches.

    The files `around` it attach it. If its `root` is given, that is changed and the file is not read.
    """
    if root is None:
        root = read_root(file, cursor)
    elif cursor is not None:
        root = cursor.trace(root, file)
    context = CompiledContext(file, root, search, hull)
    context.cursor = cursor
    Inclusion(context, cursor).expand(root, file, (file,))
    merge_sections(context)
    for element in root.all("compiler"):
        read_compiler(context, element)
    for element in root.all("default"):
        read_defaults(context, element, once=True)
    for assets in root.all("asset"):
        for child in assets.children:
            if child.tag in _ASSETS:
                _add_asset(context, child)
    models = [child for assets in root.all("asset") for child in assets.children if child.tag == "model"]
    for element in models:
        element.note()
        other = context.asset_file(element, context.required(element, "file"), "")
        if other is None:
            raise context.not_found(element, element.attributes["file"])
        charge("includes", file=context.file, line=element.line, element="<model>")
        if other in (*around, file) or len(around) > _MAX_MODELS:
            raise context.error(element, f"{shown(str(other))} attaches itself")
        read = read_document(other.absolute(), search, hull, cursor, (*around, file))
        name = element.attributes.get("name") or read.root.attributes.get("model", _MODEL)
        if name in context.attached:
            raise context.error(element, f"the model name {shown(name)} is taken already")
        context.attached[name] = read
    return context


def _add_asset(context: CompiledContext, element: Element) -> None:
    named = getattr(context.named, element.tag)
    attributes = element.attributes
    name = attributes.get("name") or Path(attributes.get("file", "")).stem
    if not name and element.tag == "texture":
        return
    if not name:
        raise context.error(element, "it needs a name")
    if name in named:
        raise context.error(element, f"the name {shown(name)} is taken already, on line {named[name].line}")
    named[name] = element
