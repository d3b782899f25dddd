"""What an MJCF file means for the bodies made from it: positions, pairs that do not collide, names."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np

from carom.description.place import Place
from carom.description.pose import Pose
from carom.description.sensor import SensorObject
from carom.description.skin import NO_NODE, Bone, Skin
from carom.description.stage import StageCamera
from carom.description.transform import compose, rotate
from carom.model.body_spec import BASE
from carom.render.appearance import appearance_of
from carom.scene.core.soft_core import SoftCore
from carom.scene.following import Following, Point
from carom.scene.joint_terms.implicit import rest_base_spring
from carom.scene.sensors.changes import add_site, put_sensor
from carom.scene.tendons.making import tendons_of
from carom.world.file_actuators import find_numbers
from carom.world.file_keyframes import give_keyframes

if TYPE_CHECKING:
    from carom.checks import Array
    from carom.formats.mjcf.compiled.deformables.file_skin import FileSkin
    from carom.formats.mjcf.compiled.model import CompiledModel
    from carom.scene.core.body_core import BodyCore
    from carom.scene.link import Link
    from carom.world.scene import Scene

_FIXED, _WORLD = "fixed", "world"
_AIMED = ("targetbody", "targetbodycom")
# Width and height of the images of cameras that state none.
_STANDARD = (4.0, 3.0)


def finish(bodies: Sequence[BodyCore], model: CompiledModel) -> None:
    """Put joints where the file has them, and let links collide or not as in MuJoCo."""
    for body in bodies:
        if body.spec.base.stiffness:
            rest_base_spring(body)
        for index, link in enumerate(body.spec.links):
            start = model.starts.get(link.joint_name)
            if start is not None:
                body.set_joint_state(index, [start], None)
    if not bodies:
        return
    filters = bodies[0].world.contact_arrays.shapes.filters
    for a, b in sorted({rows for rows, _ in _rows_of(bodies, model.excluded)}):
        filters.set(a, b, enabled=False)
    for (a, b), names in _rows_of(bodies, list(model.paired)):
        filters.set(a, b, enabled=True, contact=model.paired[names])


def equip(bodies: Sequence[BodyCore], model: CompiledModel) -> None:
    """Give bodies the sites, sensors and keyframes of their file, and actuators what they move.

    The constraints of the file have been made.
    """
    places = {
        body.spec.link(index).name: (body, index)
        for body in reversed(bodies)
        for index in range(BASE, len(body.spec.links))
    }
    _hold_flexes(bodies, places, model)
    _give_sites(places, model)
    find_numbers(bodies, {it.name: it.damping_ratio for it in model.actuators if it.damping_ratio})
    _give_sensors(bodies, places, model)
    give_keyframes(bodies, model)


def describe(scene: Scene, model: CompiledModel) -> None:
    """Give a scene, which has just been loaded, the sites, cameras, actuators and options of its file."""
    scene.sites = dict(model.sites)
    scene.cameras = dict(model.cameras)
    if any(it.mode != _FIXED for it in model.cameras.values()):
        scene.followings = _followings(scene)
    scene.options = dict(model.options)
    of_bodies = {it.name: it for body in scene.bodies for it in body.actuators}
    scene.actuators = {it.name: of_bodies[it.name] for it in model.actuators if it.spec is not None}


def put_on_stage(scene: Scene, model: CompiledModel, place: Pose) -> None:
    """Give the world of a scene, just loaded at a place, the lights, sky and cameras of its file.

    If there are some already, those of the file are added.
    """
    links = {
        link.name: Place(body.id, link.index)
        for body in reversed(scene.bodies)
        for link in [*body.links][::-1]
    }

    def found(name: str, pose: Pose) -> tuple[Place, Pose]:
        """The link of a body of the file, and a pose in its frame; what does not move is in the world."""
        if name in links and name != _WORLD:
            return links[name], pose
        return Place(), compose(place, compose(model.still.get(name, Pose()), pose))

    lights = []
    for it in model.lights:
        at, pose = found(it.body, Pose(it.light.position))
        target = links.get(it.target) if it.mode in _AIMED else None
        direction = rotate(pose.orientation, it.light.direction)
        lights.append(replace(it.light, place=at, position=pose.position, direction=direction, target=target))
    cameras = []
    for camera in model.cameras.values():
        if camera.is_orthographic:
            # Windows have perspective only.
            continue
        at, pose = found(camera.body, camera.frame)
        width, height = camera.resolution if min(camera.resolution) > 1 else _STANDARD
        target = links.get(camera.target) if camera.mode in _AIMED else None
        cameras.append(StageCamera(camera.name, at, pose, camera.field_of_view, width / height, target))
    stage = replace(
        model.stage,
        skins=tuple(_skin(scene, model, skin, found) for skin in model.skins),
        lights=tuple(lights),
        cameras=tuple(cameras),
        shows_tendons=any(it.robot and it.look is not None for it in model.tendons.values()),
    )
    appearance = appearance_of(scene.world)
    appearance.set_stage(stage if appearance.stage is None else appearance.stage + stage)


def _skin(
    scene: Scene, model: CompiledModel, skin: FileSkin, found: Callable[[str, Pose], tuple[Place, Pose]]
) -> Skin:
    """A skin of a file on the links of a scene; `found` says where a pose of a body is."""
    nodes = {
        name: (flex.name, node, flex.turns.get(node, Pose()))
        for flex in model.flexes
        for name, node in flex.body_names().items()
    }
    bodies = {body.name: body.id for body in scene.bodies}
    bones: list[Bone] = []
    for bone in skin.bones:
        node = NO_NODE
        if bone.body in nodes:
            flex, node, frame = nodes[bone.body]
            place, frame = Place(bodies[flex]), Pose(orientation=frame.orientation)
        else:
            place, frame = found(bone.body, Pose())
        bones.append(Bone(place, frame, bone.vertices, bone.points, bone.weights, node))
    return Skin(
        *(skin.name, skin.vertices, skin.triangles, skin.uvs, tuple(bones)),
        inflation=skin.inflation,
        material=skin.material,
        group=skin.group,
    )


def _followings(scene: Scene) -> dict[str, Following]:
    """How the cameras of a scene follow bodies, which are where the file has them; of those that do."""
    found: dict[str, Following] = {}
    links = {link.name: link for body in reversed(scene.bodies) for link in [*body.links][::-1]}
    for name, camera in scene.cameras.items():
        is_centre = camera.mode in ("trackcom", "targetbodycom")
        if camera.mode in ("track", "trackcom"):
            pose, link = camera.image_frame, links.get(camera.body)
            if link is not None:
                pose = compose(_frame_of(link), pose)
            point = _point(scene, links.get(camera.body), is_centre=is_centre)
            offset = np.subtract(pose.position, _place_of(point)).tolist()
            found[name] = Following(point, tuple(offset), pose.orientation)
        elif camera.target:
            found[name] = Following(looks_at=_point(scene, links.get(camera.target), is_centre=is_centre))
    return found


def _frame_of(link: Link) -> Pose:
    (x, y, z), (i, j, k, w) = (part.tolist() for part in link.pose)
    return Pose((x, y, z), (i, j, k, w))


def _place_of(point: Point) -> Array:
    """Where a point is for the present coordinates, as `Point.position`, of many links at once."""
    links = cast("Sequence[Link]", point.links)
    rows = [link.body.first_link + 1 + link.index for link in links]
    if not rows:
        return np.array(point.of_world)
    world = links[0].body.world
    masses = world.arrays.model.numpy["link_mass"][0][rows]
    if not point.is_centre or not masses.any():
        return np.array(_frame_of(links[0]).position)
    total = (masses[:, None] * world.arrays.state.numpy["link_pose"][0][rows, :3]).cumsum(axis=0)[-1]
    return total / masses.cumsum()[-1]


def _point(scene: Scene, link: Link | None, *, is_centre: bool) -> Point:
    """The origin of a body of the file, or the centre of mass of it and all bodies in it."""
    if link is None:
        return Point(())
    links = [link]
    if is_centre and link.name == _WORLD:
        links += [each for body in scene.bodies for each in body.links]
    elif is_centre:
        inside = {link.index}
        for index, each in enumerate(link.body.spec.links):
            if each.parent in inside and index not in inside:
                inside.add(index)
                links.append(link.body.links[index])
    return Point(tuple(links), is_centre)


def _hold_flexes(
    bodies: Sequence[BodyCore], places: Mapping[str, tuple[BodyCore, int]], model: CompiledModel
) -> None:
    """Anchor nodes that are pinned to links, or to the world where there is none of that name.

    `places` has the body and index of each link by name. Called while bodies are added.
    """
    soft = {body.spec.name: body for body in bodies if isinstance(body, SoftCore)}
    for flex in model.flexes:
        if not flex.collides:
            row = soft[flex.name].first_link
            soft[flex.name].world.contact_arrays.shapes.set_group_and_mask(row, 0, 0)
        for node, name in flex.pins.items():
            body, link = places.get(name, (None, -1))
            if body is not None and isinstance(body, SoftCore):
                body = None
            soft[flex.name].anchor(node, body, link)


def _give_sites(places: Mapping[str, tuple[BodyCore, int]], model: CompiledModel) -> None:
    """Add the sites of the file to the bodies with their links; those of the world stay with the scene."""
    for site in model.sites.values():
        if site.body in places:
            body, link = places[site.body]
            add_site(body, site.name, link, site.frame, site.kind, site.size, site.rgba, site.group)


def _give_sensors(
    bodies: Sequence[BodyCore], places: Mapping[str, tuple[BodyCore, int]], model: CompiledModel
) -> None:
    """Add the sensors of the file to the bodies that have what they measure."""
    owners = {
        **{(SensorObject.JOINT, link.joint_name): body for body in bodies for link in body.spec.links},
        **{(SensorObject.ACTUATOR, it.name): body for body in bodies for it in body.spec.actuators},
        **{(SensorObject.TENDON, it.name): body for body in bodies for it in tendons_of(body)},
        **{(SensorObject.SITE, site.name): body for body in bodies for site in body.spec.sites},
        **{
            (kind, name): body
            for name, (body, _) in places.items()
            for kind in (SensorObject.LINK, SensorObject.INERTIAL_FRAME, SensorObject.SUBTREE)
        },
        **{
            (SensorObject.SHAPE, shape.name): body
            for body in bodies
            for link in (body.spec.base, *body.spec.links)
            for shape in link.collisions
        },
    }
    for spec in model.sensors:
        body = owners[spec.object_type, spec.object] if spec.object else bodies[0]
        if spec.reference:
            other = owners[spec.reference_type, spec.reference]
            spec = spec if other is body else replace(spec, reference_body=other.name)
        put_sensor(body, spec)


def _rows_of(
    bodies: Sequence[BodyCore], pairs: Sequence[tuple[str, str]]
) -> Iterator[tuple[tuple[int, int], tuple[str, str]]]:
    """Rows of pairs of links with shapes, in order, by the names of bodies, and these names."""
    rows: dict[str, int] = {}
    for body in bodies:
        for index in range(BASE, len(body.spec.links)):
            link = body.spec.link(index)
            if link.collisions:
                rows[link.name] = body.first_link + 1 + index
    for first, second in pairs:
        if first in rows and second in rows and first != second:
            a, b = rows[first], rows[second]
            yield (min(a, b), max(a, b)), (first, second)
