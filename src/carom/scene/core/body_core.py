"""A body as everything below it knows it: its world, rows, specification, state and parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import sqrt
from typing import TYPE_CHECKING, Any

from carom.closed import Closed
from carom.description.joint import JOINT_CODE
from carom.description.pose import Pose
from carom.layouts.codes import (
    BASE_POSITIONS,
    BASE_VELOCITIES,
    DOF_COUNT,
    LIMITED,
    LOADED,
    POSITION_COUNT,
    SENSED,
    Activity,
)
from carom.layouts.magnitudes import UNIT_ROUNDING
from carom.model.body_rows import TreeRows
from carom.model.body_spec import BASE, BodySpec, LinkSpec
from carom.model.link_dynamics import LinkDynamics
from carom.native.change import Change, first_change
from carom.native.gates import gated
from carom.scene.core.state_writer import StateWriter
from carom.scene.dynamics.changes import set_dynamics, set_present
from carom.scene.handles import world_of

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

_NO_REACTION = (0.0,) * BASE_VELOCITIES
_QUATERNION = 4

JointReset = tuple[int, Sequence[float] | None, Sequence[float] | None]
"""A joint, its position coordinates, and its velocity coordinates; None keeps them."""


class Outline:
    """What bodies take over from their specification: attributes of `Body`, and parameters of each link."""

    def __init__(self, spec: BodySpec) -> None:
        codes = [JOINT_CODE[link.joint_type] for link in spec.links]
        self.joint_types: tuple[int, ...] = tuple([int(code) for code in codes])
        self.position_count: tuple[int, ...] = tuple([POSITION_COUNT[code] for code in codes])
        self.velocity_count: tuple[int, ...] = tuple([DOF_COUNT[code] for code in codes])
        self.dynamics = [LinkDynamics.of(link) for link in (spec.base, *spec.links)]
        if spec.fixed_base:
            self.dynamics[0].mass = 0.0


COMPUTED_HANDLES = ("joints", "links", "shapes", "actuators", "sites", "sensors")
"""Attributes that a body computes on demand, and that refer to it."""


class BodyCore(Closed):
    """What a body is without the handles of its parts; `Body` describes the attributes.

    Functions that work on bodies and are used by methods of `Body` or `World` take this class.
    """

    # For the other packages of Carom:
    # derived: Data that algorithms cache until masses or inertias change, or the base is fixed or freed.
    # links_before: Number of links that the world had loaded before this body.
    id: int
    world: WorldCore
    spec: BodySpec
    rows: TreeRows
    joint_count: int
    joint_types: tuple[int, ...]
    position_count: tuple[int, ...]
    velocity_count: tuple[int, ...]
    first_link: int
    first_position: int
    first_velocity: int
    position_index: tuple[int, ...]
    velocity_index: tuple[int, ...]
    fixed_base: bool
    links_before: int
    derived: dict[Any, Any]
    _encoded_names: tuple[bytes, bytes] | None
    _dynamics: list[LinkDynamics]

    def __init__(
        self, world: WorldCore, body_id: int, spec: BodySpec, rows: TreeRows, outline: Outline | None = None
    ) -> None:
        mine = outline or Outline(spec)
        position, velocity = rows.first["position"], rows.first["dof"]
        # All at once, as `Closed` makes it slow to set one after the other.
        vars(self).update(
            id=body_id,
            world=world,
            spec=spec,
            rows=rows,
            joint_count=len(spec.links),
            joint_types=mine.joint_types,
            position_count=mine.position_count,
            velocity_count=mine.velocity_count,
            first_link=rows.first["link"],
            first_position=position,
            first_velocity=velocity,
            position_index=_first_rows(position + BASE_POSITIONS, mine.position_count),
            velocity_index=_first_rows(velocity + BASE_VELOCITIES, mine.velocity_count),
            fixed_base=spec.fixed_base,
            links_before=0,
            derived={},
            _encoded_names=None,
            _dynamics=mine.dynamics if outline is None else [it.copy() for it in mine.dynamics],
        )

    def forget_handles(self) -> None:
        """Drop what refers to the body, which is computed anew on demand: it has left its world, or will."""
        for name in COMPUTED_HANDLES:
            vars(self).pop(name, None)
        self.derived.clear()

    def relocate(self, change: Change, first: Mapping[str, int]) -> None:
        """Update the rows of the body in the flat arrays with a change of them; they begin at `first`."""
        position, velocity = first["position"], first["dof"]
        change.set_all(
            self,
            first_link=first["link"],
            first_position=position,
            first_velocity=velocity,
            position_index=_first_rows(position + BASE_POSITIONS, self.position_count),
            velocity_index=_first_rows(velocity + BASE_VELOCITIES, self.velocity_count),
        )

    def __repr__(self) -> str:
        base = "fixed base" if self.fixed_base else "free base"
        joints = "1 joint" if self.joint_count == 1 else f"{self.joint_count} joints"
        return f"<{type(self).__name__} {self.id} {self.name!r}: {joints}, {base}>"

    @property
    def name(self) -> str:
        """Name of the robot."""
        return self.spec.name

    def encoded_names(self) -> tuple[bytes, bytes]:
        """Names of the base link and of the robot: always the same tuple."""
        if self._encoded_names is None:
            self._encoded_names = self.spec.base.name.encode(), self.spec.name.encode()
        return self._encoded_names

    def link_spec(self, link: int) -> LinkSpec:
        """The specification of link `link`; -1 is the base."""
        return self.spec.link(link)

    def link_number(self, link: int | str) -> int:
        """The number of a link by its number (-1 is the base) or name.

        Raises:
            IndexError, KeyError: There is no such link.
        """
        if isinstance(link, str):
            names = [self.spec.base.name, *(spec.name for spec in self.spec.links)]
            if link not in names:
                raise KeyError(f"no link is called {link!r}; there are {', '.join(names)}")
            return names.index(link) - 1
        if not BASE <= link < self.joint_count:
            raise IndexError(f"link {link} is out of range: indices are {BASE} to {self.joint_count - 1}")
        return link

    def link_inertial_frame(self, link: int) -> Pose:
        """Inertial frame of a link in its link frame; -1 is the base."""
        return self.link_spec(link).inertial_frame

    def set_inertial_pose(self, position: Sequence[float], orientation: Sequence[float]) -> None:
        """Set the pose of the base's inertial frame; its velocity does not change. See `Body.set_pose`.

        Args:
            position: [m], world axes.
            orientation: Quaternion (x, y, z, w); normalised here.
        """
        (x, y, z), (i, j, k, w) = position, orientation
        squared = i * i + j * j + k * k + w * w
        # A pose that was read and is written back must not change in the last digit.
        scale = 1.0 if abs(squared - 1.0) < UNIT_ROUNDING else 1.0 / sqrt(squared)
        StateWriter.write(
            self, self.world, self.id, None, (x, y, z, i * scale, j * scale, k * scale, w * scale), None
        )

    def set_base_velocity(self, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Set the velocity of the base's centre of mass [m/s] and its angular velocity [rad/s].

        A fixed base moves with it, and as in Bullet the velocity turns with the base.
        """
        (x, y, z), (i, j, k) = linear, angular
        StateWriter.write(self, self.world, self.id, None, None, (i, j, k, x, y, z))

    def set_joint_state(
        self, joint: int, position: Sequence[float] | None, velocity: Sequence[float] | None
    ) -> None:
        """Set the state of a joint without simulation; its motor keeps its target.

        Args:
            joint: Index of the joint; nothing happens for a fixed one.
            position: All coordinates of the joint (of a spherical joint: quaternion xyzw, normalised here);
                None keeps them.
            velocity: All velocity coordinates of the joint; None keeps them.

        Raises:
            ValueError: There are too many or too few numbers.
        """
        if position is not None:
            position = _state_of(position, self.position_count[joint])
        if velocity is not None:
            velocity = _state_of(velocity, self.velocity_count[joint])
        StateWriter.write(self, self.world, self.id, joint, position, velocity)

    @gated("world.call_lock", commits=True)
    def set_joint_states(self, states: Iterable[JointReset]) -> None:
        """Set the states of joints, in turn, all at once."""
        change = first_change()
        world = world_of(self)
        self.note_joint_states(change, states)
        world.note_link_poses(change, self)
        change.commit()

    def note_joint_states(self, change: Change, states: Iterable[JointReset]) -> list[bool]:
        """Set the states of joints, in turn, with a change, as `set_joint_state`; poses of links stay.

        Returns:
            Of each whether its coordinates change.
        """
        first, first_rate, moved = self.first_position, self.first_velocity, list[bool]()
        place = self.world.position_memory[first : first + self.rows.count["position"]]
        motion = self.world.velocity_memory[first_rate : first_rate + self.rows.count["dof"]]
        coordinates, rates = list(place), list(motion)
        for joint, position, velocity in states:
            moves = False
            if position is not None and (count := self.position_count[joint]):
                start, wanted = self.position_index[joint] - first, _state_of(position, count)
                moves = coordinates[start : start + count] != wanted
                coordinates[start : start + count] = wanted
            if velocity is not None and (count := self.velocity_count[joint]):
                start = self.velocity_index[joint] - first_rate
                rates[start : start + count] = _state_of(velocity, count)
            moved.append(moves)
        change.write_numbers(place, coordinates)
        change.write_numbers(motion, rates)
        return moved

    @gated("world.call_lock")
    def coordinates(self) -> list[float]:
        """All position coordinates: those of the base, then those of the joints."""
        first, count = self.rows.first["position"], self.rows.count["position"]
        return self.world.position[first : first + count].tolist()

    def note_reset(self, *, moved: bool) -> None:
        """Note that PyBullet would look for what the body overlaps now; see `ContactArrays.note_resets`."""
        change = Change()
        self.world.contact_arrays.note_resets(change, self.rows.tree, moved)
        change.commit()

    @gated("world.call_lock")
    def update_link_poses(self) -> None:
        """Update the body's rows of `World.link_pose` from its coordinates."""
        self.world.update_link_poses(self)

    @gated("world.call_lock")
    def update_link_velocities(self) -> None:
        """Update the body's rows of `World.link_velocity` from its coordinates."""
        self.world.update_link_velocities(self)

    def dynamics(self, link: int) -> LinkDynamics:
        """Present inertia, surface and joint limits of a link; -1 is the base."""
        return self._dynamics[link + 1]

    @property
    def all_dynamics(self) -> list[LinkDynamics]:
        """`dynamics` of the base and of all links, in this order: always the same list."""
        return self._dynamics

    @property
    def asleep(self) -> bool:
        """Whether the body slept in the last step, because it and all bodies near it had been at rest."""
        return bool(self.world.arrays.state.numpy["tree_activity"][0, self.rows.tree] == Activity.ASLEEP)

    @property
    def present(self) -> bool:
        """Whether the body is present; it may be set.

        While it is absent, it does not move, nothing touches or sees it, and constraints on it do nothing;
        the others move bit for bit as in a world made without it. Its coordinates and velocities stay as they
        are and can be set; forces on it are lost. Sleeping bodies wake when it comes or goes. Setting it
        raises `ValueError` for a soft body, and for a body that a soft body is anchored to.
        """
        return bool(self.world.arrays.state.numpy["tree_activity"][0, self.rows.tree] != Activity.ABSENT)

    @present.setter
    def present(self, value: bool) -> None:
        set_present(self, bool(value))

    @gated("world.call_lock")
    def set_dynamics(self, link: int, dynamics: LinkDynamics) -> None:
        """Set all parameters of a link at once, except the limits of its joint; -1 is the base."""
        set_dynamics(self, link, dynamics)

    def has_sensor(self, joint: int) -> bool:
        """Whether the force-torque sensor of a joint is on."""
        return bool(self.measured_joints[joint] & SENSED)

    @property
    def measured_joints(self) -> list[int]:
        """What is measured of each joint: bits `SENSED`, `LOADED` and `LIMITED`."""
        first = self.first_link + 1
        return self.world.arrays.model.numpy["link_sensor"][first : first + self.joint_count].tolist()

    @gated("world.call_lock", commits=True)
    def set_sensor(self, joint: int, enabled: bool) -> None:
        """Switch the force-torque sensor of a joint on or off."""
        change = first_change()
        world_of(self)  # raises an error if the body has been removed
        self.note_sensor(change, joint, enabled=enabled)
        change.commit()

    def note_sensor(self, change: Change, joint: int, *, enabled: bool) -> None:
        """The same with a change."""
        self._note_sensor(change, joint, SENSED, on=enabled)
        if not enabled:
            change.write_numbers(self.world.joint_reaction[self.first_link + 1 + joint], _NO_REACTION)

    def measure_load(self, change: Change, joint: int) -> None:
        """Measure what a joint transmits after a change, for sensors of sites."""
        self._note_sensor(change, joint, LOADED, on=True)

    def measure_limit(self, change: Change, joint: int) -> None:
        """Measure the impulses of a joint's limit after a change, for sensors of it."""
        self._note_sensor(change, joint, LIMITED, on=True)

    def follow(self, change: Change) -> None:
        """Let steps keep the motion of the body after a change, for sensors of accelerations and forces."""
        change.arrays(self.world.arrays.model.numpy)["tree_is_followed"][self.rows.tree] = 1

    def _note_sensor(self, change: Change, joint: int, kind: int, *, on: bool) -> None:
        model = change.arrays(self.world.arrays.model.numpy)
        sensors = model["link_sensor"][self.first_link : self.first_link + 1 + self.joint_count]
        sensors[1 + joint] = sensors[1 + joint] | kind if on else sensors[1 + joint] & ~kind
        model["tree_sensor_count"][self.rows.tree] = len(sensors) - sensors.tolist().count(0)
        model["tree_sensed_count"][self.rows.tree] = (sensors & SENSED != 0).sum()


def _state_of(numbers: Sequence[float], count: int) -> list[float]:
    """The coordinates of a joint, `count` numbers; four are a quaternion, which is normalised.

    A fixed joint has none, whatever is given.
    """
    if not count:
        return []
    coordinates = [*numbers]
    if len(coordinates) != count:
        raise ValueError(f"a joint with {count} coordinates has got {len(coordinates)} numbers")
    if count == _QUATERNION:
        size = sum([component * component for component in coordinates]) ** 0.5
        return [component / size for component in coordinates]
    return coordinates


def _first_rows(start: int, counts: Sequence[int]) -> tuple[int, ...]:
    rows = []
    for count in counts:
        rows.append(start if count else -1)
        start += count
    return tuple(rows)
