"""How contacts move whose features have no closed form: by central differences of collision detection.

A copy of the worlds finds their contacts as the step has, from the contacts before it, at positions that are
a little off. Where points jump on the way there are no derivatives.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.contacts import NONE_KEPT, START_CONTACTS, THERE
from carom.linearization.stepping import Copies

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.tangent import TangentSpace

# Size of the changes of positions [rad or m].
_SIZE = 1e-6
# Contacts that are found again are where they were [m], but for rounding of searches.
_SAME = 1e-9
# Differences to both sides of a contact that moves smoothly are the same, but for this part.
_SMOOTH = 0.02
# What a contact is: two points, and the normal.
_PLACES = ("contact_point_a", "contact_point_b", "contact_normal")
_KEPT = (
    *("shapes", "normal", "direction1", "direction2", "distance", "local_a", "local_b", "point_a", "point_b"),
    *("anchor_a", "anchor_b", "impulse", "warm_start"),
)


class ContactMotions:
    """Measures how contacts of the worlds of `copies` move, after these have taken a step.

    Args:
        space: The tangent space.
        copies: The worlds.
    """

    def __init__(self, space: TangentSpace, copies: Copies) -> None:
        self._space, self._copies = space, copies
        self._probe: Copies | None = None

    def follow(self, parameters: EngineParameters) -> None:
        """Take the present state and parameters of the worlds."""
        engine = self._copies.engine
        if self._probe is None or not self._probe.follow(engine, 0.0):
            self._probe = Copies.of_engine(engine, parameters, 1)

    def measure(
        self, world: int, velocity: np.ndarray, contacts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """How contacts of a world move with each dof; `follow` comes before.

        Args:
            world: Number of the world.
            velocity: Velocities of the dofs before the step, (n,).
            contacts: Numbers of the contacts, (k,).

        Returns:
            Derivatives of both points and of the normal, (k, n, 3, 3), and whether each is known, (k,).
        """
        space, probe = self._space, self._probe
        assert probe is not None
        taken = self._copies.engine.contact_arrays.contacts.numpy
        pairs, points = taken["contact_shapes"][world], taken["contact_point_a"][world, contacts]
        start = self._start(world, velocity)
        first = self._copies.scratch(world)["position_start"][None]
        moving = self._dofs_of(pairs[contacts])
        # Changes with each sign of each dof, then none.
        changes = np.zeros((2 * len(moving) + 1, len(space)))
        changes[np.arange(len(moving)), moving] = _SIZE
        changes[len(moving) + np.arange(len(moving)), moving] = -_SIZE
        positions = space.moved(np.repeat(first, len(changes), axis=0), changes)
        places = np.full((len(changes), len(contacts), 3, 3), np.nan)
        for number, position in enumerate(positions):
            self._detect(world, start, position)
            found = probe.engine.contact_arrays.contacts.numpy
            there, same = _found_again(found, world, contacts, pairs[contacts], points)
            for part, name in enumerate(_PLACES):
                places[number, same, part] = found[name][world, there[same]]
        return self._differences(world, contacts, moving, places)

    def _differences(
        self, world: int, contacts: np.ndarray, moving: np.ndarray, places: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        stepped = self._copies.engine.contact_arrays.contacts.numpy
        taken = np.stack([stepped[name][world, contacts] for name in _PLACES], axis=1)
        ahead, behind, there = places[: len(moving)], places[len(moving) : -1], places[-1]
        motions = np.zeros((len(contacts), len(self._space), 3, 3))
        motions[:, moving] = np.moveaxis((ahead - behind) / (2.0 * _SIZE), 0, 1)
        bent = np.abs(ahead + behind - 2.0 * there).max(axis=(0, 2, 3), initial=0.0)
        # What is not a number is not less.
        known = (bent < _SMOOTH * _SIZE) & (np.abs(there - taken).max(axis=(1, 2), initial=0.0) < _SAME)
        return motions, known

    def _dofs_of(self, shapes: np.ndarray) -> np.ndarray:
        """The dofs of the trees of contacts."""
        trees = self._copies.engine.contact_arrays.shapes.table.numpy["shape_tree"][shapes[:, :2]]
        return np.flatnonzero(np.isin(self._space.trees, trees))

    def _start(self, world: int, velocity: np.ndarray) -> dict[str, np.ndarray]:
        """The contacts of a world before the step, with its overlaps, which the probe has from now on."""
        assert self._probe is not None
        self._probe.state["dof_velocity"][world, self._space.dofs] = velocity
        kept = self._copies.engine.workspace.pairs.numpy
        row = world if len(kept["count_pairs"]) > 1 else 0
        contacts = self._probe.engine.contact_arrays.contacts.numpy
        count = int(kept["count_pairs"][row, START_CONTACTS])
        if count != NONE_KEPT:
            for name in _KEPT:
                contacts[f"contact_{name}"][world, :count] = kept[f"previous_{name}"][row, :count]
            contacts["count_contacts"][world, THERE] = count
        return {name: array[world].copy() for name, array in contacts.items()}

    def _detect(self, world: int, start: dict[str, np.ndarray], position: np.ndarray) -> None:
        """Find the contacts of a world at a position, from those before the step."""
        assert self._probe is not None
        engine = self._probe.engine
        contacts = engine.contact_arrays.contacts.numpy
        for name, values in start.items():
            contacts[name][world, : len(values)] = values
        engine.contact_arrays.forget_order()
        own = self._probe.state["position"][world]
        # There may be spare rows.
        own[:] = position[: len(own)]
        engine.detect(np.array([world]))


def _found_again(
    found: dict[str, np.ndarray], world: int, contacts: np.ndarray, pairs: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Which of the contacts that were found are some others (k,), and whether each is there.

    Those of two shapes may come in another order, so they are known by their points (k, 3).
    """
    own = found["contact_shapes"][world, : found["count_contacts"][world, THERE]]
    again, there = contacts.copy(), np.zeros(len(contacts), dtype=bool)
    for place, (pair, point) in enumerate(zip(pairs, points, strict=True)):
        same = np.flatnonzero((own == pair).all(axis=1))
        if len(same):
            off = found["contact_point_a"][world, same] - point
            again[place], there[place] = same[np.argmin((off * off).sum(axis=1))], True
    return again, there
