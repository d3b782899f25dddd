"""What a world is linearised by: its tangent space and the inputs that were chosen, kept between calls."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.linearization.inputs import CONTROLS, INERTIAL, PARAMETERS, Input, chosen_inputs
from carom.linearization.stepping import made_for
from carom.linearization.tangent import TangentSpace

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

_MAX_KEPT = 16
_EXAMPLES = {"controls": "['torques']", "parameters": "['masses']"}


@dataclass(frozen=True, eq=False, slots=True)
class Chosen:
    """A tangent space, and the inputs that were chosen.

    Attributes:
        space: The tangent space.
        inputs: Controls, then parameters.
        control_count: How many of them are controls.
        states, controls, parameters: Names, as in `LinearizedStep`.
    """

    space: TangentSpace
    inputs: list[Input]
    control_count: int
    states: tuple[str, ...]
    controls: tuple[str, ...]
    parameters: tuple[str, ...]

    def refuse_inertial(self, model: dict[str, np.ndarray], method: str) -> None:
        """Refuse inertial parameters where they have no derivatives, in any world of a model."""
        if all(it.kind != INERTIAL for it in self.inputs[self.control_count :]):
            return
        if method != "exact":
            raise NotImplementedError("inertial parameters have exact derivatives only")
        for body in self.space.bodies:
            tree, links = body.rows.tree, slice(body.first_link, body.first_link + 1 + body.joint_count)
            drags = (model[f"tree_{kind}_damping"][:, tree].any() for kind in ("linear", "angular"))
            if any(drags) or model["link_gravity_compensation"][:, links].any():
                raise NotImplementedError(
                    f"inertial parameters of {body.name!r} have no derivatives with air damping or gravity "
                    "compensation"
                )


def chosen_parts(world: WorldCore, controls: Sequence[str], parameters: Sequence[str]) -> Chosen:
    """The parts of a world that calls have chosen.

    Raises:
        TypeError: Something else than names is given, such as a body.
        ValueError: There is no such control or parameter, or one is chosen twice.
    """
    for given, what in ((controls, "controls"), (parameters, "parameters")):
        if not isinstance(given, Iterable):
            raise TypeError(
                f"{what} must be a list of kinds or full names, such as {_EXAMPLES[what]}, not {given!r}; "
                "derivatives are those of all bodies of the world"
            )
    world.prepare()
    bodies = [(body, body.name, body.spec, body.fixed_base) for body in world.bodies.values()]
    key = made_for(world), world.parameters.substep_time, bodies
    known: tuple[Any, dict[Any, Chosen]] | None = world.kept_linearization.get(Chosen)
    if known is None or known[0] != key or len(known[1]) >= _MAX_KEPT:
        known = world.kept_linearization[Chosen] = key, {}
    choice = tuple((it,) if isinstance(it, str) else tuple(it) for it in (controls, parameters))
    found = known[1].get(choice)
    if found is None:
        found = known[1][choice] = _choose(world, *choice)
    return found


def _choose(world: WorldCore, controls: Sequence[str], parameters: Sequence[str]) -> Chosen:
    space = TangentSpace(world)
    given = chosen_inputs(world, space, CONTROLS, controls, "control")
    count = len(given)
    given += chosen_inputs(world, space, PARAMETERS, parameters, "parameter")
    names = tuple(it.name for it in given)
    return Chosen(space, given, count, _state_names(space), names[:count], names[count:])


def _state_names(space: TangentSpace) -> tuple[str, ...]:
    dofs = [f"{label}.{end}" if end else label for label, end in space.labels]
    of_positions, of_velocities = ([f"{dof}.{what}" for dof in dofs] for what in ("position", "velocity"))
    return (*of_positions, *of_velocities, *(f"{name}.activation" for name in space.actuators))
