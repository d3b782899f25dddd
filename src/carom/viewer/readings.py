"""Data in a frame besides poses: contacts, joints, velocities of links and so on, in columns of numbers.

`page/view/readings.js` has the same columns.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import nan
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from carom.errors import StateError
from carom.layouts.codes import (
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
    PathKind,
)
from carom.model.body_spec import BASE
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.shown import shown
from carom.scene.tendons.making import tendons_of
from carom.scene.tendons.measure import forces_of_tendon, measured, pieces
from carom.scene.tendons.slack import is_slack

if TYPE_CHECKING:
    from carom.description.tendon import TendonLook
    from carom.scene.core.world_core import WorldCore

Columns = NDArray[np.float32]

CONTACT_COLUMNS, JOINT_COLUMNS, LINK_COLUMNS = 16, 8, 14
ACTUATOR_COLUMNS, SENSOR_COLUMNS, TENDON_COLUMNS, TENDON_LOOK_COLUMNS = 5, 4, 9, 7
COLUMNS = {
    "contacts": CONTACT_COLUMNS,
    "joints": JOINT_COLUMNS,
    "links": LINK_COLUMNS,
    "actuators": ACTUATOR_COLUMNS,
    "sensors": SENSOR_COLUMNS,
    "tendons": TENDON_COLUMNS,
    "tendonLooks": TENDON_LOOK_COLUMNS,
}
"""Numbers of columns, by the names of the arrays."""
# Maximum number of contacts shown.
_MAX_CONTACTS = 5000
_MAX_FRICTION = 10.0


def contacts(world: WorldCore) -> Columns:
    """The contacts of the last step.

    Returns:
        (contacts, 16): body a, link a (0: the base), body b, link b, point on b (3) [m], normal on b
        towards a (3), force along it on a [N], friction on a (3) [N], friction coefficient, distance [m].
    """
    table = world.contact_arrays.contacts.numpy
    count = min(world.contact_arrays.contact_count, _MAX_CONTACTS)
    if count == 0:
        return np.zeros((0, CONTACT_COLUMNS), dtype=np.float32)
    links = table["contact_shapes"][0, :count, 2:4].copy()
    places = np.array(world.link_places, dtype=np.float32).reshape(-1, 2)
    places[:, 1] += 1.0
    if links.max() >= len(places) or links.min() < 0:
        return np.zeros((0, CONTACT_COLUMNS), dtype=np.float32)
    forces = table["contact_impulse"][0, :count] / world.parameters.substep_time
    lateral = world.contact_arrays.shapes.table.numpy["shape_lateral_friction"][0]
    shapes = table["contact_shapes"][0, :count, :2]
    coefficient = np.minimum(lateral[shapes[:, 0]] * lateral[shapes[:, 1]], _MAX_FRICTION)
    directions = (table["contact_direction1"][0, :count], table["contact_direction2"][0, :count])
    friction = sum(forces[:, 1 + i, None] * directions[i] for i in range(2))
    return np.column_stack(
        (
            places[links[:, 0]],
            places[links[:, 1]],
            table["contact_point_b"][0, :count],
            table["contact_normal"][0, :count],
            forces[:, 0],
            friction,
            coefficient,
            table["contact_distance"][0, :count],
        )
    ).astype(np.float32)


def links(world: WorldCore, wanted: Iterable[tuple[int, int]]) -> Columns:
    """Velocities of links, and readings of their joints' force-torque sensors.

    Returns:
        (links, 14): body, link, velocity of the centre of mass (3) [m/s], angular velocity (3) [rad/s],
        force (3) [N] and moment (3) [N m] of the sensor. Links that do not exist are left out.
    """
    rows = []
    fresh: set[int] = set()
    for number, link in wanted:
        body = world.bodies.get(number)
        if body is None or not BASE <= link < body.joint_count:
            continue
        if number not in fresh:
            world.update_link_velocities(body)
            fresh.add(number)
        row = body.first_link + 1 + link
        rows.append((number, link, *world.link_velocity[row], *world.joint_reaction[row]))
    return np.array(rows, dtype=np.float32).reshape(-1, LINK_COLUMNS)


def actuators(world: WorldCore, wanted: frozenset[int] | Literal["all"]) -> Columns:
    """Controls and forces of the actuators of some bodies.

    Returns:
        (actuators, 5): body, actuator, control, force in the last step, activation; NaN without one.
    """
    state = world.arrays.state.numpy
    parts = []
    for number, body in list(world.bodies.items()):
        count = len(body.spec.actuators)
        if count and (wanted == "all" or number in wanted):
            first = body.rows.first["actuator"]
            rows = slice(first, first + count)
            moves = np.array([bool(it.dynamics) for it in body.spec.actuators])
            activation = np.where(moves, state["actuator_activation"][0, rows], np.nan)
            values = (state["actuator_control"][0, rows], state["actuator_force"][0, rows], activation)
            parts.append(np.column_stack((np.full(count, number), np.arange(count), *values)))
    return np.vstack(parts).astype(np.float32) if parts else np.zeros((0, ACTUATOR_COLUMNS), np.float32)


def sensors(world: WorldCore, wanted: Iterable[int]) -> Columns:
    """What the sensors of some bodies show.

    Returns:
        (numbers, 4): body, sensor, place of the number among those of the sensor, the number. Sensors that
        show nothing yet, as they are delayed, are left out.
    """
    rows: list[tuple[float, ...]] = []
    for number in sorted(wanted):
        body = world.bodies.get(number)
        if body is None:
            continue
        for sensor in range(len(body.spec.sensors)):
            try:
                values = np.ravel(shown(body, sensor)).tolist()
            except StateError:
                continue
            rows += [(number, sensor, place, value) for place, value in enumerate(values)]
    return np.array(rows, dtype=np.float32).reshape(-1, SENSOR_COLUMNS)


def tendons(world: WorldCore) -> tuple[Columns, Columns]:
    """The straight pieces of all tendons that go through sites, and how each is drawn.

    Returns:
        (pieces, 9): body, start (3) [m], end (3), force of the tendon [N], and 1 if it is at its limit.
        (pieces, 7): 1 if the tendon is slack, its radius [m], its colour (4), and the number of its group;
        NaN for a radius and a colour that no file states.
    """
    rows: list[tuple[float, ...]] = []
    looks: list[tuple[float, ...]] = []
    source = LoneSource(world)
    for number, body in list(world.bodies.items()):
        for tendon in tendons_of(body):
            if tendon.path[0].kind is PathKind.SITE:
                force, limit = forces_of_tendon(tendon)
                values = (force, float(limit > 0.0))
                found = pieces(source, body, tendon.path)
                rows += [(number, *start, *end, *values) for start, end in found]
                length = float(measured(source, body, tendon.path)[0][0])
                looks += [(float(is_slack(tendon, length)), *_look(tendon.look))] * len(found)
    return (
        np.array(rows, dtype=np.float32).reshape(-1, TENDON_COLUMNS),
        np.array(looks, dtype=np.float32).reshape(-1, TENDON_LOOK_COLUMNS),
    )


def _look(look: TendonLook | None) -> tuple[float, ...]:
    return (*(nan,) * 5, 0.0) if look is None else (look.width, *look.rgba, look.group)


class JointReadings:
    """States and targets of joints; one of `World.observers` while torques of scripts are watched."""

    def __init__(self, world: WorldCore) -> None:
        self._world = world
        # Torques that scripts have applied for the last step, which has cleared them; none if not watched.
        self._applied = np.zeros(0)
        self._placed_bodies: list[tuple[int, tuple[int, ...], tuple[int, ...], tuple[int, ...]]] = []
        self._known_places: NDArray[np.int64] = np.zeros((0, 4), dtype=np.int64)

    def watch(self, *, on: bool) -> None:
        """Reads the torques that scripts apply, or no longer. The world must not be stepped meanwhile.

        Steps take longer while it does.
        """
        observers = self._world.observers
        if on and self not in observers:
            observers.append(self)
        elif not on and self in observers:
            observers.remove(self)
            self._applied = np.zeros(0)

    def before_step(self) -> None:
        """Keeps the torques that scripts have applied for the step."""
        self._applied = self._world.joint_torque.copy()

    def after_step(self) -> None:
        """Does nothing: joints are read when a frame is made."""

    def rows(self, wanted: frozenset[int] | Literal["all"]) -> Columns:
        """Present states of the joints of some bodies that have one dof.

        Returns:
            (joints, 8): body, joint, position [rad or m], velocity, torque or force of the motor and, while
            these are watched, the script together, and the targets of position, velocity and torque; NaN
            without a target.
        """
        world = self._world
        places = self._places(wanted)
        if not len(places):
            return np.zeros((0, JOINT_COLUMNS), dtype=np.float32)
        position, velocity = places[:, 2], places[:, 3]
        motor = world.motor[velocity]
        active = motor[:, MOTOR_MAX_IMPULSE] > 0.0
        rows = np.empty((len(places), JOINT_COLUMNS), dtype=np.float32)
        rows[:, :2] = places[:, :2]
        rows[:, 2] = world.position[position]
        rows[:, 3] = world.velocity[velocity]
        rows[:, 7] = np.nan
        rows[:, 5] = np.where(active & (motor[:, MOTOR_KP] != 0.0), motor[:, MOTOR_POSITION], np.nan)
        rows[:, 6] = np.where(active & (motor[:, MOTOR_KD] != 0.0), motor[:, MOTOR_VELOCITY], np.nan)
        torque = world.motor_impulse[velocity] / world.parameters.substep_time
        if velocity.max() < len(self._applied):
            applied = self._applied[velocity]
            torque += applied
            rows[:, 7] = np.where(applied != 0.0, applied, np.nan)
        rows[:, 4] = torque
        return rows

    def _places(self, wanted: frozenset[int] | Literal["all"]) -> NDArray[np.int64]:
        """(joints, 4): body, joint, rows of its position and velocity; found anew if bodies change."""
        bodies = [
            (body.id, body.position_index, body.velocity_index, body.velocity_count)
            for number, body in list(self._world.bodies.items())
            if wanted == "all" or number in wanted
        ]
        if bodies != self._placed_bodies:
            self._placed_bodies = bodies
            places = [
                (number, joint, positions[joint], velocities[joint])
                for number, positions, velocities, counts in bodies
                for joint, count in enumerate(counts)
                if count == 1
            ]
            self._known_places = np.array(places, dtype=np.int64).reshape(-1, 4)
        return self._known_places
