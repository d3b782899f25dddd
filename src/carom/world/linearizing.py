"""Linearisation of a world's steps, and their inverse."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, cast

from carom.native.gates import alone

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.checks import Array
    from carom.linearization import LinearizedStep
    from carom.linearization.inverse_dynamics import InverseDynamics
    from carom.scene.sensors.sensor import BodySensor
    from carom.world.world import World


class Linearizing:
    """Linearisation of a world's steps."""

    @alone("call_lock")
    def linearize(
        self,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        steps: int = 1,
        method: str = "auto",
        smoothing: float = 0.0,
        outputs: Callable[[World], ArrayLike] | Iterable[BodySensor] | None = None,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        activations: ArrayLike | None = None,
        control_values: ArrayLike | None = None,
        tight: bool = False,
    ) -> LinearizedStep:
        """What the next steps would do to small changes of state, controls and parameters.

        The world does not change. Its present state and controls count, unless others are given:
        `linearize(positions=q, velocities=v, control_values=u)` linearises at the state (q, v) and controls
        u. The derivatives are those of what a step computes, by the implicit function theorem over the rows
        of the solver (motors, limits, friction of joints, actuators) that hold at its end, as if its sweeps
        had converged: docs/architecture/derivatives.md says more. Applied forces and torques, which a world
        forgets after a step, act in all of these steps; so do changes of controls.

        Args:
            controls: Kinds of controls, or full names of some: "torques" (of all dofs of joints),
                "target_positions" and "target_velocities" (of motors), "actuators".
            parameters: Likewise: "masses" (centres and moments of inertia stay), "inertias" (principal
                moments), "inertial_parameters" (ten of each link), "offsets" (of joints' frames in those of
                their parent links, along its axes), "friction" (lateral, of links), "joint_friction",
                "stiffness", "damping", "armature", "motor_position_gains", "motor_velocity_gains",
                "motor_forces", "actuator_gains", "actuator_biases".
            steps: Number of steps.
            method: "exact" derivatives; "differences", central differences of the steps themselves, of all
                that can be in a world; or "auto", the exact ones, and differences where a part of these steps
                has none. `LinearizedStep.method` says which they are, and a warning is logged, once for a
                world, where differences take the place of exact ones.
            smoothing: Softness of rows that hold, relative to their own inverse mass: 0.1 lets them yield by
                a tenth. Only with exact derivatives.
            outputs: What `C` and `D` are of: sensors, such as `robot.sensors`, or a function that returns
                numbers of a world after the steps. Those of sensors are exact where what they show follows
                from positions and velocities (joints, frames, gyroscopes, subtrees of links...) and from
                their changes (accelerometers); central differences for forces, torques, touch, distances
                along rays, tendons, and sensors with delay or period, and for functions.
            positions: Positions to linearise at, as `state.position`; None for the present ones. Contacts
                start from the impulses that they have now.
            velocities: Velocities, as `state.velocity`, likewise.
            activations: Activations of actuators, in the order of `LinearizedStep.states`, (a,), likewise.
            control_values: Values of the controls, in their order; None for the present ones.
            tight: Whether to let the sweeps of these steps converge, which takes more time: then step and
                derivatives agree, also where the world's own steps stop early.

        Returns:
            The matrices, what their rows and columns are, and how far they can be trusted: `residual`,
            `redundant`, `distances`, `at_switch`, and `measured`, contacts whose motion is that of central
            differences inside the exact rest. A warning is logged, once for a world, where that is not far.

        Raises:
            ValueError: An argument has a value that it cannot have; there is no such control or parameter.
            NotImplementedError: With "exact", or with smoothing: something in these steps has no exact
                derivatives; it is named.
            carom.errors.SimulationError: A velocity is not finite.
        """
        from carom.linearization.given_state import Start
        from carom.linearization.linearized_step import linearize

        world = cast("World", self)
        return linearize(
            *(world, controls, parameters, steps, method, smoothing, outputs),
            Start(positions, velocities, activations, control_values),
            tight,
        )

    @alone("call_lock")
    def step_vjp(
        self,
        cotangent: ArrayLike,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        steps: int = 1,
        smoothing: float = 0.0,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        activations: ArrayLike | None = None,
        control_values: ArrayLike | None = None,
    ) -> tuple[Array, Array, Array]:
        """The vector-Jacobian product of the next steps, for reverse differentiation.

        It takes the gradient of a number by the state after the steps back to what the steps start from:
        products with the matrices of each step, from the last one to the first, which are not multiplied
        with each other.

        Args:
            cotangent: The gradient by the state after the steps, (nx,), in the order of
                `LinearizedStep.states`.
            controls: As in `linearize`, like all that follow.
            parameters: Likewise.
            steps: Number of steps.
            smoothing: Softness of rows that hold.
            positions: Positions to start from.
            velocities: Velocities to start from.
            activations: Activations to start from.
            control_values: Values of the controls.

        Returns:
            cotangent A (nx,), cotangent B (nu,) and cotangent E (np,).

        Raises:
            ValueError, NotImplementedError, carom.errors.SimulationError: As `linearize`.
        """
        from carom.linearization.given_state import Start
        from carom.linearization.linearized_step import step_vjp

        world = cast("World", self)
        return step_vjp(
            *(world, cotangent, controls, parameters, steps, smoothing),
            Start(positions, velocities, activations, control_values),
        )

    @alone("call_lock")
    def inverse_dynamics(
        self,
        accelerations: ArrayLike,
        *,
        positions: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
    ) -> InverseDynamics:
        """The forces that a motion needs where contacts, limits and friction act, as MuJoCo's `mj_inverse`.

        The world does not change. Accelerations are changes of velocities in the next substep, over its
        duration: that is MuJoCo's inverse dynamics in discrete time (its flag `invdiscrete`). Of each row of
        the solver, of contacts, limits, friction, equalities and tendons, the force follows from them; so the
        answer is unique, and needs no search. Gravity, damping, springs, fluids and forces that have been
        applied to links act as in a step; motors, actuators and torques that have been set do not: what they
        have to give together is the answer.

        Args:
            accelerations: Changes of `state.velocity` per time, in its order, [rad/s² or m/s²]; entries of
                fixed bases do not count.
            positions: Positions to ask about, as `state.position`; None for the present ones.
            velocities: Velocities, as `state.velocity`, likewise.

        Returns:
            The forces, and what contacts and other constraints give. Forces of joints are what
            `joints.set_torques` takes.

        Raises:
            ValueError: The contacts of the world are PyBullet's (`contact="bullet"`), whose forces do not
                follow from a motion; bodies rebound; a length is wrong, or a number is not finite.
            carom.errors.SimulationError: A number overflows.

        Example:
            >>> world = World(contact="compliant")
            >>> robot = world.load("walker.xml")[0]
            >>> needed = world.inverse_dynamics(0.0 * world.state.velocity).forces
        """
        from carom.linearization.given_state import Start
        from carom.linearization.inverse_dynamics import inverse_dynamics

        return inverse_dynamics(cast("World", self), accelerations, Start(positions, velocities))
