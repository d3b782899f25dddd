"""A step that has been performed: what it started from, and what it led to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.codes import PD_MAX_FORCE
from carom.layouts.contacts import Shapes, UserConstraints
from carom.layouts.model import Model
from carom.linearization.stepping import Copies

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World


def _of_first_world(struct: Any, arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Fields of a table with parameters, without the axis of worlds that some have."""
    return {
        name: array[0] if getattr(struct.fields.get(name), "ndim", 1) == 2 else array
        for name, array in arrays.items()
    }


class TakenStep:
    """State before a step, and results of it.

    Attributes:
        time_step: Duration [s].
        gravity: Gravity [m/s²], (3,).
        parameters: Parameters of the engine.
        model: Fields of the model, without an axis of worlds.
        position: Positions of all coordinates before it.
        joint_position: Positions of the dofs of joints with one, (n,); 0 for others.
        velocity: Velocities of the dofs before it, (n,).
        free_velocity: Those after free motion.
        solved: Those of the solver, before they are limited to the greatest velocity.
        after: Those after it.
        motor: Settings of motors, (n, 8).
        drive: Settings of explicit PD control, (n, 8); None if there is none.
        link_pose: Poses of links before it.
        link_wrench: Forces and torques applied to them.
        angular, linear: Motion subspaces, (n, 3), linear ones at the centre of mass of the base.
        activation: Activations of all actuators before it.
        control: Controls of all actuators.
        state: Fields of the state after it, without an axis of worlds.
        user_count: Number of user constraints in the engine.
        users, shapes, contacts: Fields of these tables after it, likewise.
    """

    def __init__(self, world: World, space: TangentSpace, copies: Copies) -> None:
        copies.apply_forces()
        before = copies.engine.arrays.state.numpy
        parameters = world.parameters
        self.time_step: float = parameters.substep_time
        self.gravity: np.ndarray = np.array(parameters.gravity)
        self.parameters: EngineParameters = parameters
        self.model: dict[str, np.ndarray] = _of_first_world(Model, copies.engine.arrays.model.numpy)
        self.position: np.ndarray = before["position"][0].copy()
        self.velocity: np.ndarray = before["dof_velocity"][0, space.dofs]
        self.joint_position: np.ndarray = space.scalars(self.position)
        self.motor: np.ndarray = before["dof_motor"][0, space.dofs]
        drive = before["dof_pd"][0, space.dofs]
        self.drive: np.ndarray | None = drive if (drive[:, PD_MAX_FORCE] > 0.0).any() else None
        self.activation: np.ndarray = before["actuator_activation"][0].copy()
        self.control: np.ndarray = before["actuator_control"][0].copy()
        self.link_wrench: np.ndarray = before["link_wrench"][0].copy()
        copies.step()
        self.state: dict[str, np.ndarray] = {
            name: array[0] for name, array in copies.engine.arrays.state.numpy.items()
        }
        contact_arrays = copies.engine.contact_arrays
        self.user_count: int = contact_arrays.user_count
        self.users: dict[str, np.ndarray] = _of_first_world(UserConstraints, contact_arrays.users.numpy)
        self.shapes: dict[str, np.ndarray] = _of_first_world(Shapes, contact_arrays.shapes.table.numpy)
        self.contacts: dict[str, np.ndarray] = {
            name: array[0] for name, array in contact_arrays.contacts.numpy.items()
        }
        self._pair_rows = copies.engine.workspace.pair_rows.numpy
        scratch = copies.engine.workspace.scratch.numpy
        self.after: np.ndarray = self.state["dof_velocity"][space.dofs]
        self.free_velocity: np.ndarray = self.velocity + self.time_step * scratch["dof_force"][0, space.dofs]
        deltas = np.concatenate(
            [
                4 * int(self.model["tree_first_delta"][body.rows.tree]) + np.arange(size)
                for body, (_, size) in zip(space.bodies, space.places, strict=True)
            ]
            or [np.zeros(0, dtype=np.int64)]
        )
        self.solved: np.ndarray = self.free_velocity + scratch["delta_velocity"][0].ravel()[deltas]
        self.angular: np.ndarray = scratch["dof_angular"][0, space.dofs]
        self.linear: np.ndarray = scratch["dof_linear"][0, space.dofs]
        self.link_pose: np.ndarray = self.state["link_pose"].copy()

    def torsion_impulses(self, contact: int) -> list[float] | None:
        """Impulses of rolling friction, two, and of spinning friction, in the solver's rows of a contact.

        None if the rows of other bodies have taken their place: bodies that do not touch are solved one after
        the other in the same memory.
        """
        expected = tuple(self.contacts["contact_impulse"][contact])
        # Contacts of rigid bodies have rows of fixed size, in two places that follow each other.
        of_singles = self._pair_rows["single_impulse"][0]
        for place in np.flatnonzero(self._pair_rows["single_contact"][0, :-1] == contact).tolist():
            after = place + 1
            if self._pair_rows["single_contact"][0, after] != contact:
                continue
            if tuple(of_singles[place, :3]) == expected:
                spun, *rolled = of_singles[after, :3].tolist()
                return [*rolled, spun]
        impulses = self._pair_rows["row_terms_impulse"][0]
        normal, lateral, rolling, spinning = self._pair_rows["contact_rows"][0, contact].tolist()
        known = impulses[normal], impulses[lateral], impulses[lateral + 1]
        if known != expected:
            return None
        rolled = impulses[rolling : rolling + 2].tolist() if rolling >= 0 else [0.0, 0.0]
        return [*rolled, float(impulses[spinning]) if spinning >= 0 else 0.0]
