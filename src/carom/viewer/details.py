"""Data for pages besides poses."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from time import monotonic
from typing import TYPE_CHECKING, Any, Literal

from carom.model.body_spec import BASE
from carom.viewer import readings
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page
from carom.viewer.rays import Rays

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# How long a frame waits for a step to end before it repeats the last details [s].
_PATIENCE = 0.005
# Interval at which masses and constraints are read [s].
_PERIOD = 0.25
_MAX_LINKS = 64
# Readings are always recorded, so that their past can be plotted, unless there are more of them than this.
_ALWAYS_JOINTS, _ALWAYS_LINKS, _ALWAYS_CONTACTS = 128, 64, 64


@dataclass(frozen=True, slots=True)
class DetailRequest:
    """The data that one page, or all pages together, need.

    `joints` are the ids of the bodies whose joints are read, or all; `links` are bodies and links whose
    velocities are read; `dynamics` are masses and inertias; `sensors` are the ids of
    the bodies whose sensors are read. Actuators are read with joints.
    """

    collisions: bool = False
    contacts: bool = False
    joints: frozenset[int] | Literal["all"] = frozenset()
    links: frozenset[tuple[int, int]] = frozenset()
    dynamics: bool = False
    constraints: bool = False
    rays: bool = False
    sensors: frozenset[int] = frozenset()
    tendons: bool = False

    @classmethod
    def from_message(cls, message: dict[str, Any]) -> DetailRequest:
        """The wish in a message from a page."""
        joints = message.get("joints", [])
        return cls(
            joints="all" if joints == "all" else frozenset(int(body) for body in joints),
            links=frozenset((int(body), int(link)) for body, link in message.get("links", [])[:_MAX_LINKS]),
            sensors=frozenset(int(body) for body in message.get("sensors", [])),
            **{
                name: bool(message.get(name, False))
                for name in ("collisions", "contacts", "dynamics", "constraints", "rays", "tendons")
            },
        )

    def __or__(self, other: DetailRequest) -> DetailRequest:
        return DetailRequest(
            self.collisions or other.collisions,
            self.contacts or other.contacts,
            "all" if self.joints == "all" or other.joints == "all" else self.joints | other.joints,
            self.links | other.links,
            self.dynamics or other.dynamics,
            self.constraints or other.constraints,
            self.rays or other.rays,
            self.sensors | other.sensors,
            self.tendons or other.tendons,
        )


NOTHING = DetailRequest()


class Details:
    """Reads the data that all pages together need; the lock is that of steps. For use by one thread.

    With `always`, the readings that pages may plot later are read as well, if there are not too many.

    Attributes:
        wish: The present wish of all pages together.
        rays: The rays that scripts cast.
    """

    def __init__(self, world: WorldCore, lock: Any, latest: LatestMessages, *, always: bool = False) -> None:
        self._always = always
        self._links: list[tuple[int, int]] = []
        self._joint_total = 0
        self._bodies: list[BodyCore] = []
        self._world = world
        self._world_lock = lock
        self._latest = latest
        self.wish: DetailRequest = NOTHING
        self.rays: Rays = Rays(latest)
        self._wishes: dict[int, DetailRequest] = {}
        self._joints = readings.JointReadings(world)
        self._last: list[tuple[str, readings.Columns]] = []
        self._due = 0.0
        self._dynamics: dict[int, dict[str, Any]] = {}
        self._constraints: list[dict[str, Any]] = []

    def want(self, page: int, wish: DetailRequest) -> None:
        """Sets the wish of a page."""
        if wish == NOTHING:
            self._wishes.pop(page, None)
        else:
            self._wishes[page] = wish
        wanted = NOTHING
        for each in self._wishes.values():
            wanted |= each
        if wanted.joints != self.wish.joints:
            # The world must not be stepped while its observers change.
            with self._world_lock:
                self._joints.watch(on=bool(wanted.joints))
        self.wish = wanted
        self.rays.wanted = wanted.rays
        self._due = 0.0

    def blocks(self) -> list[tuple[str, readings.Columns]]:
        """Arrays that follow the poses in a frame, by name."""
        wish = self.wish
        if wish.rays:
            self.rays.show()
        wanted = wish.contacts or wish.joints or wish.links or wish.dynamics or wish.constraints
        wanted = wanted or wish.sensors or wish.tendons
        if not (self._always or wanted):
            return []
        if not self._world_lock.acquire(timeout=_PATIENCE):
            return self._last
        try:
            due = monotonic() >= self._due
            bodies = list(self._world.bodies.values())
            # The past of a new body begins with its first frame.
            if self._always and (due or bodies != self._bodies):
                self._find_readings(bodies)
            self._bodies = bodies
            if due:
                self._due = monotonic() + _PERIOD
                self._show_dynamics(wish.dynamics)
                self._show_constraints(wish.constraints)
            self._last = self._read(wish)
        finally:
            self._world_lock.release()
        return self._last

    def _read(self, wish: DetailRequest) -> list[tuple[str, readings.Columns]]:
        blocks = []
        world = self._world
        contacts = wish.contacts
        joints = wish.joints
        links = wish.links
        if self._always:
            contacts |= 0 < world.contact_arrays.contact_count <= _ALWAYS_CONTACTS
            links = links.union(self._links)
            if 0 < self._joint_total <= _ALWAYS_JOINTS:
                joints = "all"
        if contacts:
            blocks.append(("contacts", readings.contacts(world)))
        if joints:
            blocks.append(("joints", self._joints.rows(joints)))
            blocks.append(("actuators", readings.actuators(world, joints)))
        if links:
            blocks.append(("links", readings.links(world, sorted(links))))
        if wish.sensors:
            blocks.append(("sensors", readings.sensors(world, wish.sensors)))
        if wish.tendons:
            blocks += zip(("tendons", "tendonLooks"), readings.tendons(world), strict=True)
        return [(name, rows) for name, rows in blocks if len(rows)]

    def _find_readings(self, bodies: list[BodyCore]) -> None:
        """Finds the links whose readings are always recorded: bases that move, and joints with sensors."""
        self._links = []
        self._joint_total = 0
        for body in bodies:
            self._joint_total += body.velocity_count.count(1)
            if len(self._links) <= _ALWAYS_LINKS:
                self._links += [] if body.fixed_base else [(body.id, BASE)]
                self._links += [
                    (body.id, joint) for joint in range(body.joint_count) if body.has_sensor(joint)
                ]
        if len(self._links) > _ALWAYS_LINKS:
            self._links = []

    def _show_dynamics(self, wanted: bool) -> None:
        facts = {body.id: _dynamics(body) for body in self._bodies} if wanted else {}
        for number in self._dynamics.keys() - facts.keys():
            self._latest.remove(("dynamics", number), to_page.NO_DYNAMICS(dynamics=number))
        for number, known in facts.items():
            if self._dynamics.get(number) != known:
                self._latest.put(("dynamics", number), known)
        self._dynamics = facts

    def _show_constraints(self, wanted: bool) -> None:
        constraints = _constraints(self._world) if wanted else []
        if constraints != self._constraints:
            self._constraints = constraints
            self._latest.put("constraints", to_page.CONSTRAINTS(constraints=constraints))


def _dynamics(body: BodyCore) -> dict[str, Any]:
    links = []
    for link in range(BASE, body.joint_count):
        dynamics = body.dynamics(link)
        inertia = [value if isfinite(value) else 0.0 for value in dynamics.inertia]
        links.append({"mass": dynamics.mass, "inertia": inertia})
    return to_page.DYNAMICS(dynamics=body.id, body=body.id, links=links)


def _constraints(world: WorldCore) -> list[dict[str, Any]]:
    return [
        {
            "constraint": constraint.id,
            "kind": constraint.kind.name.lower(),
            "parent": {
                "body": constraint.parent.id,
                "link": constraint.parent_link + 1,
                "position": constraint.parent_frame.position,
            },
            "child": {
                "body": -1 if constraint.child is None else constraint.child.id,
                "link": constraint.child_link + 1,
                "position": constraint.child_frame.position,
            },
        }
        for constraint in world.user_constraints.all
    ]
