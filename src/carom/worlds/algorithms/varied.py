"""Masses, inertias and armature of a body in each world, as the nodes of its mechanism have them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.algorithms.nodes import End, node_inertias
from carom.engine.engine import Engine
from carom.layouts.codes import BASE_VELOCITIES
from carom.model.body_spec import BASE
from carom.scene.core.body_core import BodyCore


@dataclass(frozen=True, eq=False, slots=True)
class NodeParameters:
    """What can differ between worlds.

    Attributes:
        mass: As in `Node`, (worlds, nodes).
        moment: (worlds, nodes, 3).
        inertia: (worlds, nodes, 3, 3).
        armature: Of all dofs, those of a free base first, (worlds, dofs).
    """

    mass: np.ndarray
    moment: np.ndarray
    inertia: np.ndarray
    armature: np.ndarray


class VariedParameters:
    """The parameters of the nodes of a body in the worlds of an engine, kept as long as they are the same."""

    def __init__(self, engine: Engine, body: BodyCore, ends: list[End]) -> None:
        self._engine, self._body, self._ends = engine, body, ends
        self._known: list[np.ndarray] = []
        self._found: NodeParameters | None = None

    def __call__(self) -> NodeParameters | None:
        """The parameters in all worlds; None if they are those of the original body."""
        body = self._body
        links = slice(body.first_link, body.first_link + 1 + body.joint_count)
        first = body.first_velocity + (BASE_VELOCITIES if body.fixed_base else 0)
        dofs = slice(first, self._last_dof())
        fields = (("link_mass", links), ("link_inertia", links), ("dof_armature", dofs))
        model = self._engine.arrays.model.numpy
        if all(len(model[name]) == 1 for name, _ in fields):
            return None
        now = [self._engine.parameter("model", name, rows) for name, rows in fields]
        if self._found is None or not all(map(np.array_equal, now, self._known)):
            self._known = now
            self._found = self._find(*now)
        return self._found

    def _last_dof(self) -> int:
        return self._body.first_velocity + BASE_VELOCITIES + sum(self._body.velocity_count)

    def _find(self, masses: np.ndarray, inertias: np.ndarray, armature: np.ndarray) -> NodeParameters:
        body = self._body
        if body.fixed_base:
            # The engine has none for a base that cannot move.
            base = body.dynamics(BASE)
            masses, inertias = masses.copy(), inertias.copy()
            masses[:, 0], inertias[:, 0] = base.mass, base.inertia
        return NodeParameters(*node_inertias(body, self._ends, masses, inertias), armature)
