"""Adding sites and sensors to bodies, and what sensors need switched on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.link import Rgba
from carom.description.pose import Pose
from carom.description.sensor import DISTANCE_KINDS, OF_STEPS, SensorKind, SensorSpec
from carom.description.sensors import Sensor
from carom.description.site import SiteShape, SiteSpec
from carom.errors import DescriptionError
from carom.native.change import Change
from carom.native.gates import gated
from carom.scene.handles import world_of
from carom.scene.sensors.contacts import sides
from carom.scene.sensors.distances import check_distance
from carom.scene.sensors.frames import object_frame, reference_frame
from carom.scene.sensors.joints import actuator_of, joint_of
from carom.scene.sensors.loads import loaded_frame
from carom.scene.sensors.observer import SensorObserver
from carom.scene.tendons.making import tendon_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

_OF_LOADS = (SensorKind.FORCE, SensorKind.TORQUE)
_OF_JOINTS = "joint", "ball"


@gated("world.call_lock")
def add_site(
    body: BodyCore,
    name: str,
    link: int,
    pose: Pose,
    shape: SiteShape | str,
    size: Sequence[float],
    rgba: Rgba | None = None,
    group: int = 0,
) -> None:
    """Add a site to a body, as `Body.add_site` does; with a colour it is drawn, while its group is shown."""
    x, y, z = (*map(float, size), 0.0, 0.0)[:3]
    try:
        volume = SiteShape(shape)
    except ValueError:
        known = ", ".join(it.value for it in SiteShape)
        raise DescriptionError(f"site {name!r}: its shape {shape!r} is none of {known}") from None
    site = SiteSpec(name, link, pose, volume, (x, y, z), rgba, group)
    site.check()
    if not site.name or any(other.name == site.name for other in body.spec.sites):
        raise DescriptionError(f"site {site.name!r}: each one of a body needs a name of its own")
    world_of(body)
    change = Change()
    change.set(body, "spec", replace(body.spec, sites=(*body.spec.sites, site)))
    change.drop(body.__dict__, "sites")
    change.commit()


def add_sensor(body: BodyCore, name: str, sensor: Sensor) -> None:
    """Add a sensor to a body, as `Body.add_sensor` does."""
    put_sensor(body, sensor.spec(name))


@gated("world.call_lock")
def put_sensor(body: BodyCore, spec: SensorSpec) -> None:
    """Add a sensor, given as data, to a body; raises as `Body.add_sensor` does."""
    world = world_of(body)
    check_sensor(world, body, spec)
    if not spec.name or any(other.name == spec.name for other in body.spec.sensors):
        raise DescriptionError(f"sensor {spec.name!r}: each one of a body needs a name of its own")
    change = Change(world.change_scene)
    if spec.memory:
        others = [other.rows for other in world.bodies.values()]
        world.arrays.insert(change, body.rows, others, "sensor", spec.memory)
    if measure_load(change, body, spec):
        note_watch(change, world)
    change.set(body, "spec", replace(body.spec, sensors=(*body.spec.sensors, spec)))
    change.drop(body.__dict__, "sensors")
    world.change_scene(change)
    change.commit()


def check_sensor(world: WorldCore, body: BodyCore, spec: SensorSpec) -> None:
    """Raise `DescriptionError` unless a sensor fits its body and its world."""
    spec.check()
    kind = spec.kind.value
    if kind.startswith(_OF_JOINTS):
        joint_of(body, spec)
    elif kind.startswith("actuator"):
        actuator_of(body, spec)
    elif kind.startswith("tendon"):
        tendon_of(body, spec.object)
    elif spec.kind in _OF_LOADS:
        loaded_frame(body, spec)
    elif spec.kind is SensorKind.CONTACT:
        sides(world.bodies, body, spec)
    elif spec.kind in DISTANCE_KINDS:
        check_distance(world.bodies, body, spec)
    elif spec.object:
        object_frame(body, spec)
        reference_frame(world.bodies, body, spec)


def switch_on(world: WorldCore, bodies: Sequence[BodyCore]) -> None:
    """Switch on what the sensors of bodies need: measurements of joints' forces, and of every step."""
    change = Change()
    if measure_loads(change, bodies):
        note_watch(change, world)
    world.change_scene(change)
    change.commit()


def note_watch(change: Change, world: WorldCore) -> None:
    """Measure at every step of a world after a change."""
    if not any(isinstance(it, SensorObserver) for it in world.observers):
        change.extend(world.observers, [SensorObserver(world)])


def measure_loads(change: Change, bodies: Sequence[BodyCore]) -> bool:
    """Measure the forces of joints that sensors need; whether one needs measurements at every step."""
    return True in [measure_load(change, body, spec) for body in bodies for spec in body.spec.sensors]


def measure_load(change: Change, body: BodyCore, spec: SensorSpec) -> bool:
    """Let steps keep what a sensor needs, such as the force of a joint; whether it is measured at each."""
    if spec.kind in _OF_LOADS:
        link = object_frame(body, spec).link
        if link >= 0:
            body.measure_load(change, link)
    elif spec.kind is SensorKind.JOINT_LIMIT_FORCE:
        body.measure_limit(change, joint_of(body, spec))
    if spec.kind in (*OF_STEPS, *_OF_LOADS):
        body.follow(change)
    return spec.is_clocked
