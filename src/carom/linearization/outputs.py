"""Derivatives of outputs after steps: functions of the world, and sensors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.linearization.sensor_motion import SensorMotion, has_jacobian
from carom.linearization.tangent import body_label
from carom.scene.sensors.sensor import BodySensor

if TYPE_CHECKING:
    from carom.linearization.given_state import GivenState
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World

Outputs = Callable[["World"], ArrayLike] | Iterable[BodySensor]
_SIZE = 1e-6


class OutputDerivatives:
    """Finds derivatives of outputs after some steps.

    Args:
        world: The world.
        space: Its tangent space.
        controls: The controls.
        steps: Number of steps.
        start: What replaces the present state.
    """

    def __init__(
        self, world: World, space: TangentSpace, controls: Sequence[Input], steps: int, start: GivenState
    ) -> None:
        self._world, self._space, self._controls = world, space, controls
        self._steps, self._start = steps, start
        self._width = 2 * len(space) + len(space.activations)

    def of(
        self, outputs: Outputs, states: Sequence[np.ndarray], inputs: Sequence[np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
        """Derivatives by the state (ny, nx) and by controls (ny, nu), and names of the outputs of sensors.

        Args:
            outputs: A function of the world after the steps, or sensors.
            states: Derivatives of the states before and after the last step by the first, (2, nx, nx).
            inputs: Likewise by controls, (2, nx, nu).

        Raises:
            ValueError: A sensor is of another world.
            TypeError: Something is neither a function nor a sensor.
        """
        if callable(outputs):
            return *self._by_differences(outputs), ()
        sensors = [self._checked(sensor) for sensor in outputs]
        exact = [sensor for sensor in sensors if has_jacobian(sensor.body, sensor.spec)]
        others = [sensor for sensor in sensors if not has_jacobian(sensor.body, sensor.spec)]
        seen: dict[BodySensor, tuple[np.ndarray, np.ndarray]] = {}
        if exact:
            motion = self._motion()
            for sensor in exact:
                before, after = motion.derivatives(sensor.body.id, sensor.index)
                by_state, by_input = (before @ by[0] + after @ by[1] for by in (states, inputs))
                seen[sensor] = by_state, by_input
        if others:
            places = [(sensor.body.id, sensor.index) for sensor in others]
            found = self._by_differences(
                lambda after: np.concatenate([after.bodies[body].sensors[it].read() for body, it in places])
            )
            first = 0
            for sensor in others:
                own = slice(first, first + sensor.dim)
                seen[sensor] = found[0][own], found[1][own]
                first = own.stop
        of_states = [np.zeros((0, self._width)), *(seen[sensor][0] for sensor in sensors)]
        of_inputs = [np.zeros((0, len(self._controls))), *(seen[sensor][1] for sensor in sensors)]
        names = tuple(name for sensor in sensors for name in self._names(sensor))
        return np.concatenate(of_states), np.concatenate(of_inputs), names

    def _checked(self, sensor: BodySensor) -> BodySensor:
        if not isinstance(sensor, BodySensor):
            raise TypeError(f"outputs must be a function or sensors, and {sensor!r} is no sensor")
        if self._world.bodies.get(sensor.body.id) is not sensor.body:
            raise ValueError(f"{sensor!r} is of another world")
        return sensor

    def _names(self, sensor: BodySensor) -> list[str]:
        name = f"{body_label(self._world, sensor.body)}.{sensor.name}"
        return [name] if sensor.dim == 1 else [f"{name}.{number}" for number in range(sensor.dim)]

    def _stepped(self, scene: World, steps: int) -> None:
        """Perform steps with the forces that act now."""
        state = scene.arrays.state.numpy
        forces = [(name, state[name].copy()) for name in ("dof_torque", "link_wrench")]
        for _ in range(steps):
            for name, kept in forces:
                scene.arrays.state.numpy[name][:] = kept
            scene.step()
        # What acted in the last step acts in one that follows.
        for name, kept in forces:
            scene.arrays.state.numpy[name][:] = kept

    def _motion(self) -> SensorMotion:
        scene = self._world.copy()
        self._start.write(scene.arrays.state.numpy)
        self._stepped(scene, self._steps - 1)
        motion = SensorMotion(scene, self._space)
        self._stepped(scene, 1)
        motion.finish()
        return motion

    def _by_differences(self, outputs: Callable[[World], ArrayLike]) -> tuple[np.ndarray, np.ndarray]:
        """Central differences of outputs after the steps, by states and by controls."""
        space, controls, width = self._space, self._controls, self._width
        scene = self._world.copy()
        self._start.write(scene.arrays.state.numpy)
        start = scene.snapshot()
        columns: list[np.ndarray] = []
        for number in range(width + len(controls)):
            pair: list[np.ndarray] = []
            for change in (_SIZE, -_SIZE):
                scene.restore(start)
                state = scene.arrays.state.numpy
                if number < width:
                    _change_state(space, state, number, change)
                else:
                    given = controls[number - width]
                    state[given.field][(0, *given.place)] += given.scale * change
                self._stepped(scene, self._steps)
                pair.append(np.array(outputs(scene), dtype=float).ravel())
            columns.append((pair[0] - pair[1]) / (2.0 * _SIZE))
        found = np.stack(columns, axis=1)
        return found[:, :width], found[:, width:]


def _change_state(space: TangentSpace, state: dict[str, np.ndarray], number: int, change: float) -> None:
    """Add a change to an entry of the state of a world."""
    dofs = len(space)
    if number < dofs:
        changes = np.zeros((1, dofs))
        changes[0, number] = change
        state["position"][:] = space.moved(state["position"], changes)
    elif number < 2 * dofs:
        state["dof_velocity"][0, space.dofs[number - dofs]] += change
    else:
        state["actuator_activation"][0, space.activations[number - 2 * dofs]] += change
