"""A step that has been performed: what it started from, and what it led to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.linearization.fields import Fields
from carom.linearization.stepping import Copies

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.tangent import TangentSpace


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
        motor: Settings of motors, (n, 8).
        link_pose: Poses of links before it.
        link_wrench: Forces and torques applied to them.
        angular, linear: Motion subspaces, (n, 3), linear ones at the centre of mass of the base.
        activation: Activations of all actuators before it.
        control: Controls of all actuators.
        state: Fields of the state after it, without an axis of worlds.
        ends: Velocities after free motion, and those of the solver, (2, n).
        user_count: Number of user constraints in the engine.
        constraint_count: Number of joint constraints.
        users, shapes, contacts: Fields of these tables after it, likewise.
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
        arrays, contact_arrays = copies.engine.arrays, copies.engine.contact_arrays
        self.time_step: float = parameters.substep_time
        self.parameters: EngineParameters = parameters
        self.model = Fields(arrays.model, world)
        self.state = Fields(arrays.state, world)
        self.users = Fields(contact_arrays.users, world)
        self.shapes = Fields(contact_arrays.shapes.table, world)
        self.contacts = Fields(contact_arrays.contacts, world)
        self.user_count: int = contact_arrays.user_count
        self.constraint_count: int = arrays.used["constraint"]
        self.gravity: np.ndarray = self.model["gravity_vector"][0]
        scratch = copies.scratch(world)
        self.position: np.ndarray = scratch["position_start"]
        self.velocity: np.ndarray = velocities[0]
        self.joint_position: np.ndarray = space.scalars(self.position)
        # What a step does not change.
        self.motor: np.ndarray = self.state["dof_motor"][space.dofs]
        self.control: np.ndarray = self.state["actuator_control"]
        self.activation: np.ndarray = scratch["actuator_start"]
        self.link_wrench: np.ndarray = wrench[world]
        self.free_velocity: np.ndarray = velocities[1]
        self.solved: np.ndarray = velocities[2]
        self.ends: np.ndarray = velocities[1:]
        self.angular: np.ndarray = scratch["dof_angular"][space.dofs]
        self.linear: np.ndarray = scratch["dof_linear"][space.dofs]
        self.link_pose: np.ndarray = self.state["link_pose"]
