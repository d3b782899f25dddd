"""A body in many worlds as its parts know it: its rows, writing to them, and parameters of its links."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.closed import Closed
from carom.engine.engine import Engine
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.native.gates import gated
from carom.scene.body import Body
from carom.world.world import World
from carom.worlds.chosen import Chosen, Where, choose
from carom.worlds.dynamics import change_dynamics, dynamics_of
from carom.worlds.poses import PoseFinder
from carom.worlds.writing import assign


class HasIndex(Protocol):
    """A link, in one world or in many."""

    index: int


AnyLink = HasIndex | int | str
"""A link by its handle, in the original world or in all, by its index (-1 is the base), or by its name."""


class Kinds(NamedTuple):
    """Classes of parts of a body in many worlds, each made with a `Batch`.

    Attributes:
        joint: One joint, with the group of it alone.
        joints: All joints.
        link: One link, with its number.
    """

    joint: Callable[..., Any]
    joints: Callable[..., Any]
    link: Callable[..., Any]


class Batch(Closed):
    """Base class of `BodyBatch`, of which joints and links have one of their own.

    They refer to no `BodyBatch`, so that none is in a cycle.
    """

    def __init__(self, body: Body, scene: World, engine: Engine, threads: int) -> None:
        self._body = body
        self._scene = scene
        self._engine = engine
        self._threads = threads
        self._state = engine.arrays.state.numpy
        self._take = engine.take
        self._count = engine.arrays.world_count
        self._poses = PoseFinder(engine, body.rows.tree)
        self._body_rows = body.rows
        self.name: str = body.name
        self._joint_names: list[str] = [link.joint_name for link in body.spec.links]
        self._link_names: list[str] = [link.name for link in body.spec.links]
        self._base_name = body.spec.base.name
        self._dofs = _following(body.first_velocity + BASE_VELOCITIES, sum(body.velocity_count))
        self._coordinates = _following(body.first_position + BASE_POSITIONS, sum(body.position_count))
        self._links = _following(body.first_link + 1, body.joint_count)
        self._nodes = _following(body.rows.first["node"], body.rows.count["node"])
        self._actuators = _following(body.rows.first["actuator"], body.rows.count["actuator"])
        # Classes of parts that lead to each other; set by the body that has them.
        self._kinds: Kinds | None = None
        self._close()

    def _link_rows(self, link: AnyLink | None) -> np.ndarray:
        """Rows of a link in the arrays of the engine; None stands for the base and all links."""
        first = self._body.first_link
        if link is None:
            return np.arange(first, self._links.stop)
        return np.array([first + 1 + self._link_index(link)])

    def _link_index(self, link: AnyLink) -> int:
        """The index of a link by index (-1 is the base), name or handle, in the original world or in all.

        Raises:
            IndexError, KeyError: There is no such link.
        """
        if not isinstance(link, int | str):
            # An integer of NumPy has none.
            handle: Any = link
            link = int(getattr(handle, "index", handle))
        if link in (-1, self._base_name):
            return -1
        return choose("link", self._link_names, link)

    @gated("_scene.call_lock", section=True)
    def change_dynamics(self, link: AnyLink, *, where: Where | None = None, **changes: ArrayLike) -> None:
        """Change inertia, contact or joint parameters of a link, or damping of the whole body, in each world.

        Args:
            link: The link, its index (-1 is the base) or name.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            **changes: As for `Body.change_dynamics`, each one value for all, or one for each of the n worlds
                chosen (n,): `mass`, `inertia` (n, 3), `lateral_friction`, `rolling_friction`,
                `spinning_friction`, `restitution`, `contact_stiffness`, `contact_damping`, `linear_damping`,
                `angular_damping`, `max_joint_velocity`, `joint_damping`, `joint_armature`, `joint_stiffness`,
                `joint_spring_reference` (n, 4 for a spherical joint), `joint_friction` of a joint that has
                some, `joint_lower_limit`, `joint_upper_limit`. A `mass` without `inertia` scales the inertia
                that the link has in the original world in proportion, as if its density changed. Where a
                lower limit is greater than the upper one, the joint has no limits.

        Raises:
            ValueError: A number is out of range, there are not as many values as worlds chosen, or limits are
                set for a joint without limits.
            TypeError: There is no such parameter, or it cannot differ between worlds.
        """
        change_dynamics(self._engine, self._body, self._link_index(link), self._chosen(where), changes)

    @gated("_scene.call_lock")
    def dynamics(self, link: AnyLink) -> dict[str, Array]:
        """What `change_dynamics` changes of a link, as it is now in each world.

        Args:
            link: The link, its index (-1 is the base) or name.

        Returns:
            A copy of each parameter by name, (count,); `inertia` is (count, 3). Those that the link does not
                have are missing: mass and inertia of a fixed base, damping and limits without a joint that
                has some.
        """
        return dynamics_of(self._engine, self._body, self._link_index(link))

    @property
    def _parts_of_it(self) -> Kinds:
        assert self._kinds is not None, "only a body makes parts"
        return self._kinds

    def _chosen(self, where: Where | None = None) -> Chosen:
        return Chosen(self._take(where), self._count)

    @contextmanager
    def _rows_of_dofs(self, worlds: Chosen, *fields: str) -> Iterator[list[Any]]:
        """The rows of the joints in fields of the state, in some worlds, to write to.

        Whatever is written becomes the state at the end, unless there is an error.
        """
        place = worlds.rows, self._dofs
        parts = [self._state[field][place].copy() for field in fields]
        yield parts
        assign(*((self._state[field], place, part) for field, part in zip(fields, parts, strict=True)))


def _following(first: int, count: int) -> slice:
    return slice(first, first + count)
