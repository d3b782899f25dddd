"""What is fitted: parameters of a world by name, their bounds, and how far they are from the start."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.algorithms.regressor import inertial_parameters
from carom.checks import Array
from carom.identification.link_inertia import set_link_inertia
from carom.identification.pseudo_inertia import PARAMETERS as TEN
from carom.identification.pseudo_inertia import PseudoInertia, centre_and_inertia
from carom.identification.writing import read_value, with_friction, write_value
from carom.linearization.inputs import INERTIAL, PARAMETERS, Input, chosen_inputs
from carom.linearization.tangent import TangentSpace, body_label

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

DELAYS = "delays"
_DELAY = ".delay"
SMALL_FRICTION = 1e-9
# Scales of parameters that are 0 at the start: only the steps of the solver depend on them.
_MIN_SCALE = 0.01
_ANY_SIGN = ("actuator_gains", "actuator_biases", "motor_position_gains", "motor_velocity_gains")


class _Link(NamedTuple):
    link: int
    place: int
    inertia: PseudoInertia


class Unknowns:
    """The parameters that are fitted.

    Their values are p. Inertial parameters of links have to stay physical; others have lower bounds.

    Args:
        world: A copy of the world, which changes: joints get the friction that is asked for.
        body: The body there.
        chosen: Kinds of parameters or full names, as in `carom.identify`.
        controls: Names of the controls in the log.

    Attributes:
        names: Of p.
        inputs: For each of p, of what kind it is in the linearisation; None for delays.
        delays: Places in p of the delays, by control.
        start: Values at the start.
        scale: Sizes by which they are compared.
        lower: Lower bounds.

    Raises:
        ValueError: There is no such parameter, one is chosen twice, or an inertia is not physical.
    """

    def __init__(self, world: World, body: Body, chosen: Sequence[str], controls: Sequence[str]) -> None:
        self.body = body
        names = [chosen] if isinstance(chosen, str) else list(chosen)
        if any(name == "joint_friction" or name.endswith(".joint_friction") for name in names):
            with_friction(body, SMALL_FRICTION)
        world.prepare()
        self.space = TangentSpace(world)
        links, others = self._links_among(world, names)
        wanted = [name for name in others if name != DELAYS and not name.endswith(_DELAY)]
        found = chosen_inputs(world, self.space, PARAMETERS, wanted, "parameter")
        given = [it for it in found if not self._is_foreign(world, it)]
        inertial = chosen_inputs(world, self.space, PARAMETERS, [INERTIAL], "parameter") if links else []
        self.inputs: list[Input | None] = []
        self._links: list[_Link] = []
        start: list[float] = []
        scale: list[float] = []
        values = inertial_parameters(body) if links else np.zeros((0, 10))
        for link in links:
            own = [it for it in inertial if it.row == body.first_link + 1 + link]
            try:
                pseudo = PseudoInertia(values[1 + link])
            except ValueError as reason:
                raise ValueError(f"link {body.link_spec(link).name!r}: {reason}") from None
            self._links.append(_Link(link, len(start), pseudo))
            self.inputs += own
            start += values[1 + link].tolist()
            scale += pseudo.scale.tolist()
        self.lower: Array = np.full(len(start), -np.inf)
        for it in given:
            value = read_value(world, it)
            self.inputs.append(it)
            start.append(value)
            scale.append(max(abs(value), _MIN_SCALE))
        of_delays = self._delayed(others, controls)
        self.delays: dict[str, int] = {name: len(start) + k for k, name in enumerate(of_delays)}
        self.names: tuple[str, ...] = (
            *(it.name for it in self.inputs if it is not None),
            *(name + _DELAY for name in of_delays),
        )
        self.inputs += [None] * len(of_delays)
        signs = [-np.inf if it.kind in _ANY_SIGN else 0.0 for it in given]
        self.lower = np.concatenate([self.lower, signs, np.zeros(len(of_delays))])
        self.start: Array = np.array([*start, *([0.0] * len(of_delays))])
        self.scale: Array = np.array([*scale, *([_MIN_SCALE] * len(of_delays))])
        if not len(self.start):
            raise ValueError("there is nothing to fit")

    def _links_among(self, world: World, names: list[str]) -> tuple[list[int], list[str]]:
        """Links whose inertial parameters are fitted, and the other names."""
        body, label = self.body, body_label(world, self.body)
        first = 0 if body.fixed_base else -1
        heavy = [link for link in range(first, body.joint_count) if body.dynamics(link).mass > 0.0]
        parts = {link: "base" if link < 0 else body.spec.links[link].name for link in heavy}
        of_names = {f"{label}.{part}.inertial": link for link, part in parts.items()}
        links: list[int] = []
        others: list[str] = []
        for name in names:
            if name == INERTIAL:
                links += self._movable(heavy)
            elif name in of_names:
                links.append(of_names[name])
            else:
                others.append(name)
        if len(set(links)) < len(links):
            raise ValueError("the inertial parameters of a link are chosen twice")
        return links, others

    def _movable(self, links: list[int]) -> list[int]:
        """Those links that some joint moves, or a base that is free."""
        spec, counts = self.body.spec, self.body.velocity_count
        if not self.body.fixed_base:
            return links

        def moves(link: int) -> bool:
            return link >= 0 and (counts[link] > 0 or moves(spec.links[link].parent))

        return [link for link in links if moves(link)]

    def _is_foreign(self, world: World, given: Input) -> bool:
        """Whether an input is another body's, as kinds choose those of all bodies."""
        return not given.name.startswith(f"{body_label(world, self.body)}.") and given.kind != "friction"

    def _delayed(self, names: Sequence[str], controls: Sequence[str]) -> list[str]:
        found: list[str] = []
        for name in names:
            if name == DELAYS:
                found += controls
            elif name.endswith(_DELAY):
                found.append(name.removesuffix(_DELAY))
        for name in found:
            if name not in controls:
                raise ValueError(f"the log has no control {name!r} that could have a delay")
        if len(set(found)) < len(found):
            raise ValueError("a delay is chosen twice")
        return found

    def distance(self, p: Array) -> tuple[float, Array, Array]:
        """How far inertia is from the start, with the gradient (n,) and second derivatives (n, n)."""
        value, gradient, matrix = 0.0, np.zeros(len(p)), np.zeros((len(p), len(p)))
        for link in self._links:
            own = slice(link.place, link.place + TEN)
            far, gradient[own], matrix[own, own] = link.inertia.distance(p[own])
            value += far
        return value, gradient, matrix

    def room(self, p: Array, change: Array) -> float:
        """The multiple of a change of p after which some inertia is not physical any more."""
        parts = [slice(link.place, link.place + TEN) for link in self._links]
        return min([np.inf, *(PseudoInertia.room(p[own], change[own]) for own in parts)])

    def write(self, world: World, body: Body, p: Array) -> None:
        """Set the parameters of a world, but delays, which a world does not have.

        Raises:
            NotImplementedError: Inertial frames of the body cannot be changed.
        """
        space = TangentSpace(world)
        for link in self._links:
            own = p[link.place : link.place + TEN]
            set_link_inertia(body, link.link, *centre_and_inertia(own))
        for value, given in zip(p.tolist(), self.inputs, strict=True):
            if given is not None and given.kind == "joint_friction":
                write_value(world, space, given, value)
        for value, given in zip(p.tolist(), self.inputs, strict=True):
            if given is not None and given.kind not in (INERTIAL, "joint_friction"):
                write_value(world, space, given, value)
