"""What sensors of forces at sites measure: those that a joint transmits, and those of contacts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.joints import link_axes
from carom.checks import Array
from carom.description.sensor import SensorKind, SensorSpec
from carom.errors import DescriptionError
from carom.layouts.contacts import THERE
from carom.scene.sensors.frames import Frame, object_frame, placement
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import cross, turned_back
from carom.scene.sensors.volumes import is_touched

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def loaded_frame(body: BodyCore, spec: SensorSpec) -> Frame:
    """The site of a force or torque sensor.

    Raises:
        DescriptionError: There is no such site, or it is on a fixed base, whose load is not computed.
    """
    frame = object_frame(body, spec)
    if frame.link < 0 and body.fixed_base:
        raise DescriptionError(
            f"sensor {spec.name!r}: site {spec.object!r} is on the fixed base of {body.name!r}, and the "
            "force that holds a base is not computed; give the base a link on a fixed joint, with the site"
        )
    return frame


def _wrench(source: Source, frame: Frame) -> tuple[Array, Array]:
    """Force and torque of the parent on a link about its centre of mass, in axes of its inertial frame."""
    zero = np.zeros((source.count, 3))
    if frame.link < 0:
        # Nothing holds a free base.
        return zero, zero
    body, row = frame.body, frame.row
    load = source.loads(body)[:, row]
    force, torque = load[:, :3], load[:, 3:]
    # The load leaves out what motors, limits and actuators of the joint itself exert along its axes.
    first, count = body.velocity_index[frame.link], body.velocity_count[frame.link]
    along = source.state("dof_joint_impulse")[:, first : first + count] / source.parameters.substep_time
    for number, (angular, linear) in enumerate(link_axes(body, frame.link)):
        # What drives a screw turns it; that its thread pushes the link along is in the load already.
        if angular.any():
            torque = torque + along[:, number : number + 1] * angular
        else:
            force = force + along[:, number : number + 1] * linear
    return force, torque


def _force(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame = loaded_frame(body, spec)
    return turned_back(np.array([frame.pose.orientation]), _wrench(source, frame)[0])


def _torque(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame = loaded_frame(body, spec)
    force, torque = _wrench(source, frame)
    about_site = torque - cross(np.array([frame.pose.position]), force)
    return turned_back(np.array([frame.pose.orientation]), about_site)


def _touch(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame = object_frame(body, spec)
    site = next(site for site in body.spec.sites if site.name == spec.object)
    number = source.contacts("count_contacts")[:, THERE]
    most = int(number.max(initial=0))
    links = source.contacts("contact_shapes")[:, :most, 2:]
    push = source.contacts("contact_impulse")[:, :most, 0]
    there = (np.arange(most)[None] < number[:, None]) & (push > 0.0) & (links == frame.row).any(axis=2)
    worlds, rows = np.nonzero(there)
    points = [source.contacts(f"contact_point_{side}")[worlds, rows] for side in "ab"]
    normals = source.contacts("contact_normal")[worlds, rows]
    # Normals point from b to a; outward of the link is away from the other one.
    outward = np.where((links[worlds, rows, 0] == frame.row)[:, None], -normals, normals)
    place = placement(source, frame)
    turn = place.orientation[worlds]
    middle = turned_back(turn, (points[0] + points[1]) * 0.5 - place.position[worlds])
    within = is_touched(site, middle, turned_back(turn, outward))
    impulse = np.bincount(worlds, weights=np.where(within, push[worlds, rows], 0.0), minlength=source.count)
    return impulse / source.parameters.substep_time


OF_LOADS: dict[SensorKind, Callable[[Source, BodyCore, SensorSpec], Array]] = {
    SensorKind.FORCE: _force,
    SensorKind.TORQUE: _torque,
    SensorKind.TOUCH: _touch,
}
