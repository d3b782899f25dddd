"""Equilibria: poses and controls in which a robot stays, as set-points of regulators need them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.controllers.state_space import Controls
from carom.linearization.linearized_step import converging
from carom.linearization.quality import StepQuality
from carom.linearization.tangent import TangentSpace, body_label

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

# How much deeper than they were feet are tried: as found, then from this to that [m], so many.
_SHALLOW, _DEEP, _DEPTHS = 1e-6, 3e-2, 14
# Controls are scaled so that they have this many times the effect of any change of the pose: they do what
# they can, and the pose changes by what is left.
_EASE = 1e3
# Damping of the first step, relative to the squared size of the matrix, and bounds of it.
_DAMPING, _LEAST, _MOST = 1e-12, 1e-18, 1e3


@dataclass(frozen=True, eq=False, slots=True)
class Equilibrium:
    """A state in which a world stays under constant controls.

    Attributes:
        positions: As `World.position`; velocities are 0.
        controls: The controls, (nu,).
        names: Their names.
        residual: The greatest velocity after a step from there, divided by its duration [m/s² or rad/s²].
        iterations: How many steps were linearised.
    """

    positions: Array
    controls: Array
    names: tuple[str, ...]
    residual: float
    iterations: int

    def apply(self, world: World) -> None:
        """Put a world, or a copy of it, there at rest, and set the controls; torques act in one step."""
        with world.call_lock:
            world.position[:] = self.positions
            world.velocity[:] = 0.0
            world.arrays.state.numpy["actuator_activation"][:] = 0.0
            Controls(world, self.names).apply(world, self.controls)
            _follow(world)


def find_equilibrium(
    body: Body,
    keyframe: str | None = None,
    *,
    controls: Sequence[str] | None = None,
    tolerance: float = 1e-6,
    iterations: int = 60,
) -> Equilibrium:
    """The pose near a keyframe, and the controls, in which a body stays: a robot that stands, an arm at rest.

    A step of the world from the pose at rest is to end at rest. That is solved for small changes of the pose
    and for controls together, by Gauss-Newton steps with the derivatives of `World.linearize`, damped as
    Levenberg and Marquardt do, on a copy of the world: the world does not change. Before that the body is
    lowered, or raised, until contacts can carry it. Controls do what they can, so that
    the pose changes little.

    Args:
        body: The body; all others stay as they are, and are to be at rest.
        keyframe: Name of one of its keyframes to start from; None for its present pose.
        controls: Kinds or names, as in `World.linearize`; by default "actuators" if it has some, else
            "torques".
        tolerance: The residual that is enough [m/s² or rad/s²].
        iterations: At most so many.

    Returns:
        The equilibrium. Give it to a world by `apply`.

    Raises:
        KeyError: There is no such keyframe.
        ValueError: No equilibrium was found; the message has the residual and what still moves.
        NotImplementedError: Something in a step has no exact derivatives.
    """
    world = body.world.copy()
    own = world.bodies[body.id]
    if keyframe is not None:
        own.reset(keyframe)
    chosen = controls
    if chosen is None:
        chosen = ("actuators",) if own.spec.actuators else ("torques",)
    # An equilibrium on rigid contacts is at their switch: no warning on the way there.
    world.kept_linearization[StepQuality] = True
    with converging(world):
        return _Search(world, own, chosen).run(tolerance, iterations)


class _Search:
    """The pose of a body and controls of its world, changed until a step ends as it began."""

    def __init__(self, world: World, body: Body, controls: Sequence[str]) -> None:
        world.velocity[:] = 0.0
        self._world, self._space = world, TangentSpace(world)
        self._chosen = tuple(controls)
        ports = Controls(world, controls)
        prefix = f"{body_label(world, body)}."
        if not all(it.startswith(prefix) for it in ports.names):
            self._chosen = tuple(it for it in ports.names if it.startswith(prefix))
            ports = Controls(world, self._chosen)
        self.names = ports.names
        place = self._space.bodies.index(body)
        first, count = self._space.places[place]
        self._own = np.arange(first, first + count)
        self._height = None if body.fixed_base else first + 5
        self._rest = np.zeros(len(world.velocity))
        self._activations = np.zeros(len(self._space.activations))
        self._step_time = float(world.time_step)
        self.positions: Array = world.position.copy()
        self.controls: Array = ports.read(world)
        self._ports = ports
        self.count = 0

    def _derivatives(self, positions: Array, controls: Array) -> tuple[Array, Array]:
        """Derivatives of the body's velocities after a step by its pose, and by controls."""
        self.count += 1
        step = self._world.linearize(
            self._chosen,
            positions=positions,
            velocities=self._rest,
            activations=self._activations,
            control_values=controls,
        )
        rows = len(self._space) + self._own
        return step.A[np.ix_(rows, self._own)], step.B[rows]

    def _velocities(self, positions: Array, controls: Array) -> Array:
        """Velocities of the body after a step from rest."""
        after = self._world.copy()
        after.position[:] = positions
        after.velocity[:] = 0.0
        self._ports.apply(after, controls)
        after.step()
        return after.velocity[self._space.dofs[self._own]].copy()

    def run(self, tolerance: float, iterations: int) -> Equilibrium:
        if self._height is not None:
            self._lower()
        damping = _DAMPING
        moved = self._velocities(self.positions, self.controls)
        enough = tolerance * self._step_time
        while np.abs(moved).max(initial=0.0) > enough and self.count < iterations:
            by_pose, by_controls = self._derivatives(self.positions, self.controls)
            both = np.concatenate([by_pose, by_controls], axis=1)
            scale = np.ones(both.shape[1])
            effect = np.linalg.norm(by_controls, axis=0)
            largest = np.linalg.norm(by_pose, axis=0).max(initial=0.0) or 1.0
            scale[len(self._own) :] = np.where(effect == 0.0, 1.0, effect / (_EASE * largest))
            while True:
                change = _damped(both / scale, -moved, damping) / scale
                pose = np.zeros((1, len(self._space)))
                pose[0, self._own] = change[: len(self._own)]
                positions = self._space.moved(self.positions[None], pose)[0]
                controls = self.controls + change[len(self._own) :]
                found = self._velocities(positions, controls)
                if np.linalg.norm(found) < np.linalg.norm(moved):
                    self.positions, self.controls, moved = positions, controls, found
                    damping = max(0.1 * damping, _LEAST)
                    break
                damping = max(damping, _LEAST) * 10.0
                if damping > _MOST:
                    raise self._none(moved)
        if np.abs(moved).max(initial=0.0) > enough:
            raise self._none(moved)
        residual = float(np.abs(moved).max(initial=0.0)) / self._step_time
        return Equilibrium(self.positions, self.controls, self.names, residual, self.count)

    def _lower(self) -> None:
        """Move the base up or down to where controls come nearest to holding the body."""
        assert self._height is not None
        gap = self._gap()
        best = np.inf
        start = self.positions
        depths = [0.0, *np.geomspace(_SHALLOW, _DEEP, _DEPTHS).tolist()]
        for depth in depths:
            pose = np.zeros((1, len(self._space)))
            pose[0, self._height] = -(gap + depth)
            positions = self._space.moved(start[None], pose)[0]
            moved = self._velocities(positions, self.controls)
            _, by_controls = self._derivatives(positions, self.controls)
            change = np.linalg.lstsq(by_controls, -moved, rcond=None)[0]
            left = float(np.linalg.norm(moved + by_controls @ change))
            if left < best:
                best, self.positions = left, positions

    def _gap(self) -> float:
        """How far the base can go down until something touches [m]; 0 if nothing is below or it touches."""
        high, step = 0.0, 1e-3
        for _ in range(12):
            if self._touches(high + step):
                break
            high += step
            step *= 2.0
        else:
            return 0.0
        low = high + step
        if high == 0.0 and self._touches(0.0):
            # It begins in contact: back to where it no longer touches.
            while self._touches(high - step) and step < 1.0:
                step *= 2.0
            low, high = 0.0, -step
        while low - high > 1e-7:
            middle = 0.5 * (low + high)
            if self._touches(middle):
                low = middle
            else:
                high = middle
        return low

    def _touches(self, depth: float) -> bool:
        """Whether contacts push if the base is lower by a depth."""
        assert self._height is not None
        pose = np.zeros((1, len(self._space)))
        pose[0, self._height] = -depth
        after = self._world.copy()
        after.position[:] = self._space.moved(self.positions[None], pose)[0]
        after.velocity[:] = 0.0
        _follow(after)
        after.detect_collisions()
        return any(it.distance <= 0.0 for it in after.contacts())

    def _none(self, moved: Array) -> ValueError:
        worst = int(np.argmax(np.abs(moved)))
        label = " ".join(it for it in self._space.labels[self._own[worst]] if it)
        return ValueError(
            f"no equilibrium was found near this pose: {label} still accelerates by "
            f"{moved[worst] / self._step_time:.3g}; the controls may not be able to hold it"
        )


def _follow(world: World) -> None:
    """Give links the poses and velocities that follow from those of the joints."""
    for body in world.bodies.values():
        body.update_link_poses()
        body.update_link_velocities()


def _damped(matrix: Array, wanted: Array, damping: float) -> Array:
    """The least-squares solution of matrix x = wanted with squares of x damped."""
    count = matrix.shape[1]
    size = max(float(np.linalg.norm(matrix, 2)), 1e-300)
    rows = np.concatenate([matrix, np.sqrt(damping) * size * np.eye(count)])
    found = np.linalg.lstsq(rows, np.concatenate([wanted, np.zeros(count)]), rcond=None)[0]
    return np.asarray(found, dtype=float)
