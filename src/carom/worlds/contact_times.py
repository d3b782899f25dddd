"""For how long links of a body have touched something, or nothing, in each of many worlds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.worlds.chosen import Where, world_numbers
from carom.worlds.contact_queries import AnyBody
from carom.worlds.worlds import Worlds


class ContactTimes:
    """Air times and contact times of links, such as feet.

    Contacts are looked at by `update` only: call it after each step, of the simulation or of an environment,
    as fine as the times shall be. Call `forget` for worlds that are reset. It is part of the checkpoints of
    an environment that has it as an attribute.

    Attributes:
        touching: Whether each link touched something at the last update, (count, links).
        air_times: Time since the last update at which the link touched something [s], (count, links); 0 if
            it touches.
        contact_times: Time since the last update at which it touched nothing [s], likewise.
        last_air_times: Time in the air before the latest contact [s]; 0 before the first one.
        last_contact_times: Time in contact before the link left last [s]; 0 before the first time.
        landed: Which links touched at the last update and did not at that before.

    Args:
        worlds: The worlds.
        body: The body.
        links: Its links by index (-1 is the base) or name; None for all but the base.
        other: The other body; None for any.
        least_force: A contact counts if its force is greater than this [N].
    """

    def __init__(
        self,
        worlds: Worlds,
        body: AnyBody,
        links: Sequence[int | str] | None = None,
        *,
        other: AnyBody | None = None,
        least_force: float = 0.0,
    ) -> None:
        self._worlds = worlds
        self._asked = body, links, other
        self._least_force = least_force
        number = len(worlds[body]._link_names) if links is None else len(links)
        shape = (worlds.count, number)
        self.touching: NDArray[np.bool_] = np.zeros(shape, dtype=bool)
        self.landed: NDArray[np.bool_] = np.zeros(shape, dtype=bool)
        self.last_air_times: Array = np.zeros(shape)
        self.last_contact_times: Array = np.zeros(shape)
        self._begun: NDArray[np.bool_] = np.zeros(worlds.count, dtype=bool)
        self._touched_at = np.zeros(shape)
        self._apart_at = np.zeros(shape)
        self._seen_at = np.zeros(worlds.count)
        self.forget()

    @property
    def air_times(self) -> Array:
        """Time since the last update at which each link touched something [s], (count, links)."""
        return self._seen_at[:, None] - self._touched_at

    @property
    def contact_times(self) -> Array:
        """Time since the last update at which each link touched nothing [s], (count, links)."""
        return self._seen_at[:, None] - self._apart_at

    def update(self) -> None:
        """Look at the contacts of the last step, at the present times of the worlds."""
        body, links, other = self._asked
        forces = self._worlds.contact_forces(body, links, other)
        touching = np.square(forces).sum(axis=2) > self._least_force**2
        now = np.broadcast_to(self._worlds.time[:, None], touching.shape)
        changed = self._begun[:, None] & (touching != self.touching)
        self.landed[:] = changed & touching
        left = changed & ~touching
        self.last_air_times[self.landed] = (now - self._touched_at)[self.landed]
        self.last_contact_times[left] = (now - self._apart_at)[left]
        self._touched_at[touching] = now[touching]
        self._apart_at[~touching] = now[~touching]
        self.touching[:] = touching
        self._seen_at[:] = self._worlds.time
        self._begun[:] = True

    def forget(self, where: Where | None = None) -> None:
        """Begin anew in worlds that are reset, at their present times.

        Args:
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        chosen = world_numbers(where, self._worlds.count)
        now = self._worlds.time[chosen]
        self._seen_at[chosen] = now
        self._touched_at[chosen] = self._apart_at[chosen] = now[:, None]
        self._begun[chosen] = False
        for array in (self.touching, self.landed, self.last_air_times, self.last_contact_times):
            array[chosen] = 0

    def checkpoint(self) -> dict[str, Any]:
        """What `resume` needs, as arrays by name."""
        return {name: value.copy() for name, value in vars(self).items() if isinstance(value, np.ndarray)}

    def resume(self, saved: Mapping[str, Any]) -> None:
        """Continue from what `checkpoint` returned."""
        for name, value in saved.items():
            getattr(self, name)[...] = value
