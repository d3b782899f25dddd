"""What a USD stage means for its bodies: pairs that collide, drives, loops, where joints are, velocities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose, rotate
from carom.model.actuator_rows import write_actuator
from carom.model.body_spec import BASE
from carom.scene.actuators.changes import add_actuator
from carom.scene.handles import world_of
from carom.scene.named_constraints.connect import Connect, Weld, new_connection
from carom.world.reference_masses import ReferenceMasses

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.formats.usd.scene import UsdRobot, UsdScene
    from carom.scene.body import Body
    from carom.world.compiled_constraints import NamedConstraint

_LEAST = 1e-15


def equip_usd(bodies: Sequence[Body], file: UsdScene, place: Pose) -> None:
    """Keep links apart, put joints where the stage has them, and add drives.

    `place` is the pose of the file in the world.
    """
    for body, robot in zip(bodies, file.robots, strict=True):
        for name, position in robot.positions.items():
            body.joints[name].reset(position)
        for name, turn in robot.turns.items():
            body.joints[name].reset(turn)
    _filter(bodies, file)
    for body, robot in zip(bodies, file.robots, strict=True):
        _drive(body, robot)
        _push(body, robot, place)


def close_loops(bodies: Sequence[Body], file: UsdScene, place: Pose) -> list[NamedConstraint]:
    """Close the loops of robots; gives the constraints: of a joint `NAME`, of a hinge also `NAME@2`."""
    made: list[NamedConstraint] = []
    for body, robot in zip(bodies, file.robots, strict=True):
        numbers = {body.spec.link(index).name: index for index in range(BASE, len(body.spec.links))}
        for loop in robot.loops:
            for count, point in enumerate(loop.points or (0.0,)):
                x, y, z = (point * component for component in loop.axis)
                ends = [compose(frame, Pose((x, y, z))) for frame in loop.frames]
                links = list(loop.links)
                if not links[0]:
                    ends.reverse()
                    links.reverse()
                second = (body, numbers[links[1]], ends[1]) if links[1] else None
                fixed = compose(place, ends[1]) if second is None else ends[1]
                name = loop.name if count == 0 else f"{loop.name}@{count + 1}"
                first = (body, numbers[links[0]], ends[0])
                constraint = new_connection(name, first, second, fixed, is_weld=not loop.points)
                body.world.add_constraint(constraint)
                made.append(Connect(constraint) if loop.points else Weld(constraint))
    return made


def _filter(bodies: Sequence[Body], file: UsdScene) -> None:
    rows = {
        (number, body.spec.link(index).name): body.first_link + 1 + index
        for number, body in enumerate(bodies)
        for index in range(BASE, len(body.spec.links))
    }
    for first, second in file.apart:
        if first in rows and second in rows:
            a, b = rows[first], rows[second]
            bodies[0].world.contact_arrays.shapes.filters.set(min(a, b), max(a, b), enabled=False)


def _drive(body: Body, robot: UsdRobot) -> None:
    for drive in robot.drives:
        add_actuator(body, drive.name or drive.joint, drive.actuator)
    if any(drive.per_mass for drive in robot.drives):
        masses = ReferenceMasses(body)
        for number, drive in enumerate(robot.drives):
            if drive.per_mass:
                _weigh(body, number, masses.of(number).inverse_mass)
    for drive in robot.drives:
        if drive.control:
            body.actuators[drive.name or drive.joint].control = drive.control


def _weigh(body: Body, number: int, inverse_mass: float) -> None:
    """Multiply the gains of an actuator by the mass that it moves."""
    spec = body.spec.actuators[number]
    mass = 1.0 / inverse_mass if inverse_mass > _LEAST else 0.0
    gain: Vector3 = (mass * spec.gain[0], mass * spec.gain[1], mass * spec.gain[2])
    bias: Vector3 = (mass * spec.bias[0], mass * spec.bias[1], mass * spec.bias[2])
    found = replace(spec, gain=gain, bias=bias)
    others = [found if it is spec else it for it in body.spec.actuators]
    body.spec = replace(body.spec, actuators=tuple(others))
    write_actuator(world_of(body).arrays.model.numpy, body.rows.first["actuator"] + number, found)


def _push(body: Body, robot: UsdRobot, place: Pose) -> None:
    """Give a free base the velocity of the stage, which is that of its origin."""
    if not any(robot.velocity) and not any(robot.angular_velocity):
        return
    linear, angular = (rotate(place.orientation, it) for it in (robot.velocity, robot.angular_velocity))
    at = compose(place, robot.placed.pose).orientation
    turn = rotate(at, body.spec.base.inertial_frame.position)
    (wx, wy, wz), (x, y, z), (vx, vy, vz) = angular, turn, linear
    centre = (vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x)
    body.set_base_velocity(centre, angular)
