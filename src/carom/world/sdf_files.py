"""What an SDF file means for the bodies made from it: pairs that collide, sensors, actuators, cameras."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

from carom.description.sensor import SensorKind
from carom.description.site import SiteShape
from carom.formats.mjcf.compiled.model import FileCamera, Site
from carom.model.body_spec import BASE
from carom.scene.actuators.changes import add_actuator
from carom.scene.sensors.changes import add_site, put_sensor

if TYPE_CHECKING:
    from carom.formats.sdf.scene import SdfModel, SdfScene
    from carom.scene.core.body_core import BodyCore


def equip_sdf(bodies: Sequence[BodyCore], file: SdfScene) -> None:
    """Let links collide or not as the file says, and give bodies its sites, actuators and sensors."""
    for model, own in _models(bodies, file):
        _filter(own, model)
        places = {
            body.spec.link(index).name: (body, index)
            for body in reversed(own)
            for index in range(BASE, len(body.spec.links))
        }
        joints = {link.joint_name: body for body in reversed(own) for link in body.spec.links}
        for mount in model.mounts:
            body, index = places[mount.link]
            size = (mount.reach, mount.reach, mount.reach)
            add_site(body, mount.name, index, mount.frame, SiteShape.SPHERE, size)
        for owner, name, actuator in model.actuators:
            body = joints[owner] if owner in joints else places[owner][0]
            add_actuator(body, name, actuator)
        for mount in model.mounts:
            for spec in mount.sensors:
                if spec.kind is SensorKind.MAGNETOMETER and "magnetic_field" in file.options:
                    spec = replace(spec, magnetic_field=file.options["magnetic_field"])
                put_sensor(places[mount.link][0], spec)


def sites_and_cameras(file: SdfScene) -> tuple[dict[str, Site], dict[str, FileCamera]]:
    """The places of sensors and the cameras of a file, by name; of equal names the first."""
    sites, cameras = dict[str, Site](), dict[str, FileCamera]()
    for model in file.models:
        for mount in model.mounts:
            size = (mount.reach, mount.reach, mount.reach)
            sites.setdefault(mount.name, Site(mount.name, mount.link, mount.frame, "sphere", size))
        for camera in model.cameras:
            terms = camera.field_of_view, camera.resolution, "fixed"
            cameras.setdefault(camera.name, FileCamera(camera.name, camera.link, camera.seen, *terms))
    return sites, cameras


def _models(bodies: Sequence[BodyCore], file: SdfScene) -> Iterator[tuple[SdfModel, Sequence[BodyCore]]]:
    """The models of a file with their bodies."""
    first = 0
    for model in file.models:
        yield model, bodies[first : first + len(model.robots)]
        first += len(model.robots)


def _filter(bodies: Sequence[BodyCore], model: SdfModel) -> None:
    """Links of one model collide if one of them says so, and no joint connects them."""
    rows: list[tuple[int, str, BodyCore, int]] = []
    for body in bodies:
        for index in range(BASE, len(body.spec.links)):
            link = body.spec.link(index)
            if link.collisions:
                rows.append((body.first_link + 1 + index, link.name, body, index))
    if not rows or (len(bodies) == 1 and not model.collide):
        return
    filters = bodies[0].world.contact_arrays.shapes.filters
    for (a, first, body, one), (b, second, other, two) in combinations(rows, 2):
        collides = first in model.collide or second in model.collide
        if body is other:
            if collides and not _are_joined(body, one, two):
                filters.set(min(a, b), max(a, b), enabled=True)
        elif not collides:
            filters.set(min(a, b), max(a, b), enabled=False)


def _are_joined(body: BodyCore, one: int, two: int) -> bool:
    """Whether a joint connects two links, with nothing but massless links in between."""
    for lower, upper in ((one, two), (two, one)):
        at = lower
        while at != BASE:
            at = body.spec.links[at].parent
            if at == upper:
                return True
            link = body.spec.link(at)
            if link.collisions or link.mass:
                break
    return False
