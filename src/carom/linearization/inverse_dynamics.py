"""Inverse dynamics with contacts: the forces that a motion of a world needs."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, vector
from carom.engine.parameters import COMPLIANT, CONVERGED
from carom.engine.program import inverse_program
from carom.errors import SimulationError
from carom.layouts.codes import MOTOR_MAX_IMPULSE
from carom.layouts.status import STATUS, WELL
from carom.linearization.given_state import Start
from carom.linearization.integrators.frame_motions import FrameMotions
from carom.linearization.stepping import Copies, greatest, made_for
from carom.linearization.tangent import TangentSpace

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore


class InverseDynamics(NamedTuple):
    """The forces of a motion, in the order of `World.state.velocity`, 0 for fixed bases.

    Those of a free base are torque, then force, about its centre of mass and in world axes.

    Attributes:
        forces: What motors, actuators and `set_torques` together have to give, (n,) [N m or N].
        constraint_forces: What contacts, limits, friction of joints, equalities and tendons give, (n,)
            [N m or N].
    """

    forces: Array
    constraint_forces: Array


def inverse_dynamics(world: WorldCore, accelerations: ArrayLike, start: Start) -> InverseDynamics:
    """The forces that give accelerations in the next substep; see `World.inverse_dynamics`."""
    if world.parameters.contact not in CONVERGED:
        raise ValueError(
            f"with contact={world.parameters.contact!r} forces of contacts do not follow from a motion; set "
            "world.contact = 'compliant' (MuJoCo's law, for MJCF files) or 'rigid'"
        )
    if world.parameters.noslip_iterations and world.parameters.contact == COMPLIANT:
        raise NotImplementedError(
            "with noslip_iterations forces of friction do not follow from a motion: inverse dynamics needs "
            "world.change_parameters(noslip_iterations=0)"
        )
    if world.contact_arrays.soft.bodies:
        raise NotImplementedError(
            "what soft bodies push does not follow from a motion of the others: inverse dynamics needs a "
            "world without soft bodies"
        )
    if not world.bodies:
        return InverseDynamics(np.zeros(0), np.zeros(0))
    space = TangentSpace(world)
    count, length = space.rates
    given = np.asarray(accelerations, dtype=float)
    changes = vector(given, length if given.shape == (length,) else count, "accelerations")[:count]
    copies = _copy_of(world)
    state = copies.engine.arrays.state.numpy
    start.checked(space, []).write(state)
    # Motors, actuators and torques are what is asked for.
    state["dof_torque"][:] = 0.0
    state["dof_motor"][..., MOTOR_MAX_IMPULSE] = 0.0
    for bound in ("actuator_force_lower", "actuator_force_upper"):
        copies.model[bound][:] = 0.0
    h = world.parameters.substep_time
    wanted = np.zeros(count)
    wanted[space.dofs] = state["dof_velocity"][0, space.dofs] + h * changes[space.dofs]
    engine = copies.engine
    frames = FrameMotions(space, engine.arrays)
    if frames.follow(world.parameters):
        frames.undo_end(wanted, state["position"][0], h)
    engine.prepare()
    work = engine.workspace.newton_work.numpy
    work["dof_wanted"][0, :count] = wanted
    for name in ("dof_asked", "dof_pushed"):
        work[name][:] = 0.0
    engine.step([1])
    if greatest(engine.status[:, STATUS]) > WELL:
        raise SimulationError("the motion has no forces: a number is not finite")
    work = engine.workspace.newton_work.numpy
    asked, pushed = (work[name][0, :count] / h for name in ("dof_asked", "dof_pushed"))
    if np.isnan(asked).any():
        raise ValueError("bodies rebound in this step: their forces do not follow from accelerations")
    return InverseDynamics(asked, pushed)


def _copy_of(world: WorldCore) -> Copies:
    """One copy of a world, which moves as it is told; it is kept for the next call."""
    world.prepare()
    now = made_for(world)
    kept: tuple[tuple[object, ...], Copies] | None = world.kept_linearization.get(InverseDynamics)
    if kept is not None and kept[0] == now and kept[1].follow(world.engine, world.unspent_time):
        return kept[1]
    copies = Copies(world, 1)
    copies.engine.step_by(inverse_program)
    world.kept_linearization[InverseDynamics] = made_for(world), copies
    return copies
