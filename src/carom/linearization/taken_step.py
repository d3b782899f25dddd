"""A step that has been performed: what it started from, what it led to, and its derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.engine.parameters import OF_STEPS
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.linearization.fields import Fields
from carom.linearization.stepping import Copies
from carom.linearization.turns import rotation_of

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.quality import Qualities
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.body_core import BodyCore

_GRAVITY = 3


class TakenStep:
    """State before a step, and results of it.

    Attributes:
        time_step: Duration [s].
        gravity: Gravity [m/s²], (3,).
        parameters: Parameters of the engine.
        model: Fields of the model, without an axis of worlds.
        position: Positions of all coordinates before it.
        velocity: Velocities of the dofs before it, (n,).
        activation: Activations of all actuators before it.
        link_pose: Poses of links before it.
        link_wrench: Forces and torques applied to them.
        angular, linear: Motion subspaces, (n, 3), linear ones at the centre of mass of the base.
        control: Controls of all actuators.
        state: Fields of the state after it, without an axis of worlds.
        after: Velocities of the dofs after it, (n,).
        ends: Velocities after free motion, and those of the solver, (2, n).
        is_explicit: Whether all forces are those of the state before it.
    """

    def __init__(
        self,
        parameters: EngineParameters,
        space: TangentSpace,
        copies: Copies,
        wrench: np.ndarray,
        velocities: np.ndarray,
        world: int = 0,
    ) -> None:
        """Read the step that one of the worlds of `copies` has performed.

        Args:
            parameters: Parameters of the engine.
            space: The tangent space.
            copies: The worlds.
            wrench: Forces and torques applied to links, (worlds, links, 6).
            velocities: Velocities before the step, after free motion, and of the solver, (3, n).
            world: Which of the worlds.
        """
        arrays = copies.engine.arrays
        self.time_step: float = parameters.substep_time
        self.parameters: EngineParameters = parameters
        self.is_explicit: bool = parameters.integrator not in OF_STEPS
        self.model = Fields(arrays.model, world)
        self.state = Fields(arrays.state, world)
        self.after: np.ndarray = self.state["dof_velocity"][space.dofs]
        self.gravity: np.ndarray = self.model["gravity_vector"][0]
        scratch = copies.scratch(world)
        self.position: np.ndarray = scratch["position_start"]
        self.velocity: np.ndarray = velocities[0]
        self.activation: np.ndarray = scratch["actuator_start"]
        # What a step does not change.
        self.control: np.ndarray = self.state["actuator_control"]
        self.link_wrench: np.ndarray = wrench[world]
        self.ends: np.ndarray = velocities[1:]
        self.angular: np.ndarray = scratch["dof_angular"][space.dofs]
        self.linear: np.ndarray = scratch["dof_linear"][space.dofs]
        self.link_pose: np.ndarray = self.state["link_pose"]


@dataclass(frozen=True, eq=False, slots=True)
class StepDerivatives:
    """Derivatives of the step of some worlds.

    Attributes:
        by_state: Of the state after the step by that before it, (m, nx, nx).
        by_input: By inputs, (m, nx, inputs).
        rows: Of each world, names and status of all rows; none where they were not asked for.
        qualities: Of each world, how far they can be trusted; only residuals, likewise.
    """

    by_state: np.ndarray
    by_input: np.ndarray
    rows: list[tuple[tuple[str, str], ...]]
    qualities: Qualities

    def pulled_back(self, cotangents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Cotangents of the states after the step (m, nx), as those before it, and of inputs (m, inputs)."""
        given = cotangents[:, None]
        return (given @ self.by_state)[:, 0], (given @ self.by_input)[:, 0]


def motion_questions(
    body: BodyCore,
    taken: TakenStep,
    own: slice,
    accelerations: np.ndarray,
    velocities: np.ndarray | None = None,
) -> np.ndarray:
    """Questions (k, numbers) about the motion of a body before a step with some accelerations.

    Args:
        body: The body.
        taken: The step.
        own: Its dofs in the tangent space.
        accelerations: (k, dofs), those of a free base in world axes.
        velocities: Likewise; None for those before the step.
    """
    first, count = body.first_position, BASE_POSITIONS + sum(body.position_count)
    size = own.stop - own.start
    behind = _GRAVITY + count + size
    found = np.empty((len(accelerations), behind + size))
    found[:, :_GRAVITY] = taken.gravity
    found[:, _GRAVITY : _GRAVITY + count] = taken.position[first : first + count]
    found[:, _GRAVITY + count : behind] = taken.velocity[own] if velocities is None else velocities
    found[:, behind:] = accelerations
    if not body.fixed_base:
        turn = rotation_of(taken.position[first + 3 : first + BASE_POSITIONS])
        # Two vectors each, angular and linear, of velocity and acceleration.
        for start in (_GRAVITY + count, behind):
            both = found[:, start : start + BASE_VELOCITIES]
            both[:] = (both.reshape(-1, 2, 3) @ turn).reshape(-1, BASE_VELOCITIES)
    return found
