"""`Worlds`: many copies of a scene, stepped together."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.engine.engine import MOST_STEPS
from carom.errors import SimulationWarning
from carom.layouts.status import STATUS, WELL
from carom.scene.body import Body
from carom.scene.user_constraints import UserConstraint
from carom.world.world import World
from carom.worlds.body import BodyBatch
from carom.worlds.checks import Mask, broadcast, world_numbers
from carom.worlds.contacts import ContactFinder, ContactSummary
from carom.worlds.devices import CPU, make_engine
from carom.worlds.images import Images, take_images
from carom.worlds.lone import copy_coordinates, lone_world
from carom.worlds.rays import RayCaster, RayHits
from carom.worlds.saved import SavedWorlds

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.gpu.device import Device

_MOST_NAMED = 8
"""Worlds that are named when many halt at once."""


class Worlds:
    """Many worlds with the same bodies, each with a state of its own.

    Each goes on bit for bit as that world would alone, whatever the others do and however many threads share
    them. What may differ between them besides their state: gravity, masses and inertias, how links touch,
    damping, joint limits, and which user constraints hold. Arrays have the worlds in front: (count, ...).

    Attributes:
        count: How many there are.
        device: Where they are.
        time_step: Duration of a step [s].
        times: Simulated time of each world [s], shape (count,).
        halted: Which worlds stand still because a velocity in them came out as NaN or infinite, (count,).
            They are as they were before that step; `restore` sets them going again.

    Args:
        world: What each of them is like. It is copied, and stays as it is.
        count: How many there are to be.
        device: Where they are kept and stepped: "cpu", "cuda" or a GPU by number such as "cuda:1". On a GPU
            what is a view here is an array there, `carom.gpu.array.DeviceArray`; docs/gpu.md has more.
            ("warp-cpu" tries on the processor what a GPU would be asked for.)
        threads: How many threads share them on the processor; None for as many as the process may use.

    Raises:
        ValueError: A number is less than 1, or there is no such device.
        ImportError: For a GPU Warp has to be installed.
        MemoryError: There is no room for so many.
    """

    def __init__(
        self, world: World, count: int, *, device: str | Device = CPU, threads: int | None = None
    ) -> None:
        if count < 1:
            raise ValueError(f"count must be at least 1, not {count}")
        if threads is not None and threads < 1:
            raise ValueError(f"threads must be at least 1, not {threads}")
        self.count: int = count
        self._scene = world.copy()
        self._scene.prepare()
        self._engine = make_engine(self._scene, count, device, threads)
        self.device: str = device if isinstance(device, str) else device.name
        self._engine.update_settings(self._scene.parameters)
        self.time_step: float = world.parameters.time_step
        self.times: Array = np.full(count, world.time)
        self._unspent_times = np.full(count, world.unspent_time)
        self.halted: Mask = np.zeros(count, dtype=bool)
        self._bodies = {
            number: BodyBatch(body, self._scene, self._engine) for number, body in self._scene.bodies.items()
        }

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, body: Body | int) -> BodyBatch:
        """A body in all worlds.

        Args:
            body: The body in the world they are copies of, or its number.

        Raises:
            KeyError: That world had no such body.
        """
        number = body if isinstance(body, int) else body.id
        if number not in self._bodies:
            raise KeyError(f"there is no body {number}; there are {', '.join(map(str, self._bodies))}")
        return self._bodies[number]

    def __iter__(self) -> Iterator[BodyBatch]:
        """The bodies, in the order they were added."""
        return iter(self._bodies.values())

    # Time

    def step(self, count: int = 1, where: ArrayLike | None = None) -> None:
        """Advance the worlds that are not halted by `count` time steps.

        A world whose velocities come out as NaN or infinite is halted; a `SimulationWarning` names it.

        Args:
            count: How many steps.
            where: Which worlds: a mask (count,) or their numbers; None for all.
        """
        chosen = None if where is None else np.unique(world_numbers(self._engine.take(where), self.count))
        while count > 0:
            steps = min(count, MOST_STEPS)
            self._step(steps, chosen)
            count -= steps

    def _step(self, steps: int, chosen: np.ndarray | None) -> None:
        running = np.flatnonzero(~self.halted) if chosen is None else chosen[~self.halted[chosen]]
        if not len(running):
            return
        parameters = self._scene.parameters
        if parameters.substeps <= 1:
            self._engine.step([1] * steps, None if len(running) == self.count else running)
        else:
            # Worlds whose clocks differ get their substeps at different steps.
            for unspent in np.unique(self._unspent_times[running]):
                worlds = running[self._unspent_times[running] == unspent]
                due, left = [], float(unspent)
                for _ in range(steps):
                    substeps, left = parameters.substeps_due(left)
                    due.append(substeps)
                self._engine.step(due, worlds)
                self._unspent_times[worlds] = left
        # One after the other, as a world alone adds them.
        for _ in range(steps):
            self.times[running] += self.time_step
        status = self._engine.status[running, STATUS]
        if status.any():
            self._halt(running[status > WELL], steps)

    def _halt(self, worlds: np.ndarray, steps: int) -> None:
        """Clear all other results of the failed step than the coordinates, as in a single world, and warn."""
        state = self._engine.arrays.state.numpy
        self.halted[worlds] = True
        state["link_reaction"][worlds] = 0.0
        state["dof_motor_impulse"][worlds] = 0.0
        self._engine.contact_arrays.contacts.numpy["count_contacts"][worlds] = 0
        self.times[worlds] -= self.time_step * (steps - self._engine.steps_done(worlds))
        names = {batch.rows.tree: batch.name for batch in self}
        for world in worlds[:_MOST_NAMED].tolist():
            name = names[int(self._engine.status[world, STATUS]) - 1]
            warnings.warn(
                f"world {world} is halted: its body {name!r} came to a velocity that is not finite",
                SimulationWarning,
                stacklevel=4,
            )
        if len(worlds) > _MOST_NAMED:
            warnings.warn(f"{len(worlds)} worlds are halted", SimulationWarning, stacklevel=4)

    def detect_collisions(self) -> None:
        """Find the contacts of all worlds for their present coordinates, without a step."""
        if self._engine.can_collide:
            self._engine.detect()

    # States

    def save(self, where: ArrayLike | None = None) -> SavedWorlds:
        """The present states, for `restore`.

        Args:
            where: Which worlds: a mask (count,) or their numbers; None for all.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        return SavedWorlds.take(self._engine, worlds, self.times[worlds], self._unspent_times[worlds])

    def restore(self, start: SavedWorlds, where: ArrayLike | None = None) -> None:
        """Put worlds back to states of `save`; what follows is then the same as it was, bit for bit.

        Args:
            start: States of all worlds: each of those chosen gets its own; or the state of one world,
                which all get; or as many states as there are worlds chosen.
            where: Which worlds: a mask (count,) or their numbers; None for all.

        Raises:
            ValueError: The states are of other bodies, or there are not as many as are needed.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        rows = start.rows_for(worlds, self.count)
        start.put_back(self._engine, worlds, rows)
        self.times[worlds], self._unspent_times[worlds] = start.times[rows], start.unspent_times[rows]
        self.halted[worlds] = False

    def extract(self, world: int) -> World:
        """A `World` that goes on exactly as one of these would.

        Raises:
            IndexError: There is no such world.
        """
        (number,) = world_numbers([world], self.count)
        return lone_world(
            self._scene,
            self._engine,
            int(number),
            float(self.times[number]),
            float(self._unspent_times[number]),
        )

    def copy_coordinates(self, number: int, world: World) -> None:
        """Put the bodies of a `World` where they are in one of these, to ask it what these cannot be asked.

        Args:
            number: The one of these.
            world: A world with the same bodies, such as that which these are copies of. Its velocities stay.

        Raises:
            IndexError: There is no such world.
            ValueError: It has other bodies.
        """
        (row,) = world_numbers([number], self.count)
        if world.arrays.used["position"] != self._engine.arrays.used["position"]:
            raise ValueError("that world has other bodies")
        copy_coordinates(self._engine, int(row), world)

    # Parameters

    @property
    def gravity(self) -> Array:
        """Gravity of each world in world axes [m/s²], shape (count, 3)."""
        return np.broadcast_to(
            self._engine.arrays.model.numpy["gravity_vector"][:, 0], (self.count, 3)
        ).copy()

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        gravity = broadcast(np.asarray(self._engine.take(value)), (self.count, 3), "gravity")
        self._engine.set_parameter("model", "gravity_vector", 0, gravity)

    def enable_constraint(self, constraint: UserConstraint | int, enabled: ArrayLike) -> None:
        """Switch a user constraint on or off, world by world.

        Args:
            constraint: The constraint in the world they are copies of, or its number.
            enabled: Whether it holds: one value, or one for each world.

        Raises:
            KeyError: That world had no such constraint.
            ValueError: There are not as many values as worlds.
        """
        number = constraint if isinstance(constraint, int) else constraint.id
        if self._scene.user_constraints.get(number) is None:
            raise KeyError(f"there is no constraint {number}")
        holds = broadcast(np.asarray(self._engine.take(enabled), dtype=bool), (self.count,), "enabled") != 0.0
        row = self._scene.user_constraints.rows[number]
        self._engine.set_parameter("users", "user_enabled", row, holds)

    # Questions

    def contacts(
        self,
        body: Body | int,
        other: Body | int | None = None,
        *,
        link: int | str | None = None,
        other_link: int | str | None = None,
    ) -> ContactSummary:
        """How a body touches another one, or anything, in each world, as the last step found it.

        Args:
            body: The body.
            other: The other body; None for any.
            link: Link of the body by index (-1 is the base) or name; None for any.
            other_link: Link of the other body likewise.
        """
        first, second = self[body], None if other is None else self[other]
        if second is None and other_link is not None:
            raise ValueError("other_link needs other")
        return self._contact_finder.summary(
            first.link_rows(link),
            None if second is None else second.link_rows(other_link),
            self._scene.parameters.substep_time,
        )

    def links_in_contact(
        self, body: Body | int, other: Body | int, other_link: int | str | None = None
    ) -> Mask:
        """Which links of a body have a contact point with another body, as the last step found it.

        Points count that are still apart, as `ContactSummary.number` counts them.

        Args:
            body: The body.
            other: The other body.
            other_link: Link of the other body by index (-1 is the base) or name; None for any.

        Returns:
            (count, links + 1) booleans, the base first.
        """
        return self._contact_finder.links(self[body].link_rows(None), self[other].link_rows(other_link))

    @cached_property
    def _contact_finder(self) -> ContactFinder:
        return ContactFinder(self._engine)

    def rays(self, starts: ArrayLike, ends: ArrayLike, *, mask: int = -1) -> RayHits:
        """What rays hit in each world.

        Args:
            starts: Where they start in world axes [m], shape (n, 3) for the same rays in all worlds, or
                (count, n, 3).
            ends: Where they end, likewise.
            mask: Collision groups that are hit.
        """
        return self._ray_caster(starts, ends, mask)

    @cached_property
    def _ray_caster(self) -> RayCaster:
        return RayCaster(self._engine, self._scene.link_places)

    def images(self, camera: Camera, where: ArrayLike | None = None) -> Images:
        """What a camera sees in each world.

        Args:
            camera: A `Camera`, mounted on a link of the world they are copies of or fixed in the world.
            where: Which worlds: a mask (count,) or their numbers; None for all.
        """
        return take_images(
            self._scene, self._engine, camera, world_numbers(self._engine.take(where), self.count)
        )
