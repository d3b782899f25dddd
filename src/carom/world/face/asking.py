"""Questions to a world: rays, nearest points, overlaps, images, and derivatives of its steps."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from carom.checks import Array, finite, vector
from carom.engine.queries.ray_hits import RayHits
from carom.native.gates import gated
from carom.scene.populated import Populated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.camera import Camera
    from carom.linearization import LinearizedStep
    from carom.linearization.inverse_dynamics import InverseDynamics
    from carom.render.camera_image import CameraImage
    from carom.scene.body import Body
    from carom.scene.link import Link
    from carom.scene.sensors.sensor import BodySensor
    from carom.world.world import World


class RayHit(NamedTuple):
    """What a ray has hit.

    Attributes:
        link: The link.
        position: The point in world axes [m], shape (3,).
        normal: Unit normal of the surface there, shape (3,).
        distance: From the start of the ray [m].
    """

    link: Link
    position: Array
    normal: Array
    distance: float

    @property
    def body(self) -> Body:
        """The body that the link belongs to."""
        return self.link.body


class Nearness(NamedTuple):
    """The nearest points of two shapes.

    Attributes:
        a: A link of what was asked for first.
        b: A link of what was asked for second.
        point_on_a: In world axes [m], shape (3,).
        point_on_b: Likewise.
        normal: Unit normal on `b` towards `a`.
        distance: [m]; negative where they overlap.
    """

    a: Link
    b: Link
    point_on_a: Array
    point_on_b: Array
    normal: Array
    distance: float


class Asking(Populated):
    """Questions about where the bodies of a world are now, and about its next steps; nothing moves."""

    @gated("call_lock")
    def ray(self, start: ArrayLike, end: ArrayLike, *, mask: int = -1) -> RayHit | None:
        """The first thing that a ray hits, None if it hits nothing.

        Args:
            start: In world axes [m], shape (3,).
            end: Likewise.
            mask: Mask of the collision groups that it can hit.
        """
        first, last = vector(start, 3, "start"), vector(end, 3, "end")
        (sx, sy, sz), (ex, ey, ez) = first.tolist(), last.tolist()
        body, link, fraction, position, normal = self.queries().ray_tuple(
            (sx, sy, sz), (ex, ey, ez), mask=mask
        )
        if body < 0:
            return None
        distance = fraction * float(np.sqrt(np.square(last - first).sum()))
        return RayHit(self.bodies[body].links[link], np.array(position), np.array(normal), distance)

    @gated("call_lock")
    def rays(self, starts: ArrayLike, ends: ArrayLike, *, mask: int = -1) -> RayHits:
        """What n rays hit first, as arrays.

        Args:
            starts: In world axes [m], (n, 3), or (3,) for all.
            ends: Likewise.
            mask: Mask of the collision groups that they can hit.

        Raises:
            ValueError: The shapes do not fit, or a number is not finite.
        """
        first, last = finite(starts, "starts"), finite(ends, "ends")
        if not (first.shape[-1:] == last.shape[-1:] == (3,) and max(first.ndim, last.ndim) == 2):
            raise ValueError(f"starts and ends must be (n, 3), not {first.shape} and {last.shape}")
        first, last = np.broadcast_arrays(first, last)
        found = self.queries().ray_tuples(first.tolist(), last.tolist(), mask=mask)
        bodies, links, fractions, positions, normals = zip(*found, strict=True) if found else ((),) * 5
        return RayHits(
            np.array(bodies, dtype=np.int32),
            np.array(links, dtype=np.int32),
            np.array(fractions, dtype=np.float64),
            np.array(positions, dtype=np.float64).reshape(-1, 3),
            np.array(normals, dtype=np.float64).reshape(-1, 3),
        )

    @gated("call_lock")
    def nearest(
        self, a: Body | Link | int | str, b: Body | Link | int | str, max_distance: float = np.inf
    ) -> list[Nearness]:
        """The nearest points of all pairs of shapes of two bodies or links, the nearest pair first.

        Args:
            a: A body, its name or number, or a link.
            b: Likewise.
            max_distance: Pairs that are further apart are left out [m].

        Raises:
            KeyError: There is no such body.
        """
        found = self.queries().nearest(self._rows_of(a), self._rows_of(b), max_distance)
        places = self.link_places
        answers = [
            Nearness(
                self.bodies[places[first][0]].links[places[first][1]],
                self.bodies[places[second][0]].links[places[second][1]],
                np.array(on_first),
                np.array(on_second),
                np.array(normal),
                distance,
            )
            for first, second, on_first, on_second, normal, distance in found
        ]
        return sorted(answers, key=lambda nearness: nearness.distance)

    @gated("call_lock")
    def overlapping(self, lower: ArrayLike, upper: ArrayLike) -> list[Link]:
        """The links whose bounds overlap a box.

        Args:
            lower: Least corner in world axes [m], shape (3,).
            upper: Greatest corner.
        """
        (a, b, c), (d, e, f) = vector(lower, 3, "lower").tolist(), vector(upper, 3, "upper").tolist()
        places = [self.link_places[row] for row in self.queries().overlapping((a, b, c), (d, e, f))]
        return [self.bodies[body].links[link] for body, link in places]

    def image(self, camera: Camera) -> CameraImage:
        """An image of the world by a camera, as `camera.capture(world)`."""
        return camera.capture(cast("World", self))

    def _rows_of(self, it: Body | Link | int | str) -> tuple[int, ...]:
        """Rows of a link, or of all links of a body, in the world's arrays."""
        from carom.scene.link import Link

        if isinstance(it, Link):
            return (self[it.body].first_link + 1 + it.index,)
        body = self[it]
        return tuple(range(body.first_link, body.first_link + 1 + body.joint_count))

    @gated("call_lock")
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

        return linearize(
            *(cast("World", self), controls, parameters, steps, method, smoothing, outputs),
            Start(positions, velocities, activations, control_values),
            tight,
        )

    @gated("call_lock")
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

        return step_vjp(
            *(cast("World", self), cotangent, controls, parameters, steps, smoothing),
            Start(positions, velocities, activations, control_values),
        )

    @gated("call_lock")
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
