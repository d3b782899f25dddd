"""Exact derivatives of what sensors show, by the motion of links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.link_motions import link_motion_derivatives
from carom.description.sensor import OF_STEPS, SUBTREE_KINDS, UNBOUNDED, SensorKind, SensorSpec
from carom.layouts.codes import BASE_POSITIONS
from carom.linearization.turns import cross, cross_matrix, matrix_of, multiplied
from carom.scene.sensors.accelerations import acceleration
from carom.scene.sensors.frames import motion, object_frame
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.measure import measured
from carom.scene.sensors.reading import reading
from carom.scene.sensors.source import Source

if TYPE_CHECKING:
    from carom.checks import Array
    from carom.engine.engine import Engine
    from carom.engine.parameters import EngineParameters
    from carom.engine.queries.nearest_pair import Nearest
    from carom.linearization.tangent import TangentSpace
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# Numbers with this imaginary part times their derivative have the derivative of a smooth function in the
# imaginary part of its value, to rounding (W. Squire, G. Trapp, Using Complex Variables to Estimate
# Derivatives of Real Functions, SIAM Review 40, 1998): it is so small that its square vanishes.
_SMALL = 1e-40
_EXACT = {
    *(SensorKind.ACCELEROMETER, SensorKind.VELOCIMETER, SensorKind.GYRO, SensorKind.MAGNETOMETER),
    *(SensorKind.JOINT_POSITION, SensorKind.JOINT_VELOCITY, SensorKind.JOINT_LIMIT_POSITION),
    *(SensorKind.JOINT_LIMIT_VELOCITY, SensorKind.BALL_QUATERNION, SensorKind.BALL_ANGULAR_VELOCITY),
    *(SensorKind.FRAME_POSITION, SensorKind.FRAME_QUATERNION, SensorKind.FRAME_X_AXIS),
    *(SensorKind.FRAME_Y_AXIS, SensorKind.FRAME_Z_AXIS, SensorKind.FRAME_LINEAR_VELOCITY),
    *(SensorKind.FRAME_ANGULAR_VELOCITY, SensorKind.FRAME_LINEAR_ACCELERATION),
    *(SensorKind.FRAME_ANGULAR_ACCELERATION, SensorKind.CLOCK, *SUBTREE_KINDS),
}
_OF_ACTUATORS = (SensorKind.ACTUATOR_POSITION, SensorKind.ACTUATOR_VELOCITY)


def has_jacobian(body: BodyCore, spec: SensorSpec) -> bool:
    """Whether a sensor has exact derivatives: it follows from positions, velocities, and those before a step.

    Forces and torques, distances of shapes and along rays, and tendons have none, nor what is held or late.
    """
    if spec.delay > 0.0 or spec.period > 0.0:
        return False
    if spec.kind in _OF_ACTUATORS:
        return any(it.name == spec.object and it.joint for it in body.spec.actuators)
    return spec.kind in _EXACT


class SensorMotion:
    """The motion of a scene before and after a step, for the derivatives of its sensors.

    Args:
        scene: A world before the step.
        space: The tangent space, of this world or of one that it is a copy of.
    """

    def __init__(self, scene: WorldCore, space: TangentSpace) -> None:
        self._scene, self._space = scene, space
        self._before = _Changes(scene, space, 0)
        self._after: _Changes | None = None

    def finish(self) -> None:
        """Take the motion after the step, which the scene has performed."""
        self._after = _Changes(self._scene, self._space, 1)

    def derivatives(self, body_id: int, sensor: int) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of what a sensor shows by the states before and after the step, (dim, nx) each."""
        return self.shown(body_id, sensor)[1:]

    def shown(self, body_id: int, sensor: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What a sensor shows without noise and bounds (dim,), and its derivatives as `derivatives`."""
        body, after = self._scene.bodies[body_id], self._after
        spec = body.spec.sensors[sensor]
        if after is None:
            raise RuntimeError("the step has not been performed")
        if spec.kind in OF_STEPS:
            values = acceleration(after, body, spec, motion(self._before, object_frame(body, spec)))
        else:
            values = measured(after, body, spec)
        found = np.imag(values).T / _SMALL
        if spec.cutoff > 0.0 and spec.kind not in UNBOUNDED:
            shown = reading(LoneSource(self._scene), body, sensor)[0]
            found[np.abs(shown) >= spec.cutoff] = 0.0
        width = found.shape[1] // 2
        return np.real(values)[0].copy(), found[:, :width], found[:, width:]


class _Changes(Source):
    """The present state of a scene in many worlds, each with a change of one number as imaginary part.

    The first half of the worlds is for changes of the state before a step, the other one for those of the
    state after it.

    Args:
        scene: The scene.
        space: The tangent space.
        half: 0 for the state before a step, 1 for that after it.
    """

    def __init__(self, scene: WorldCore, space: TangentSpace, half: int) -> None:
        super().__init__(scene.bodies)
        self._scene = scene
        self._lone = LoneSource(scene)
        width = 2 * len(space) + len(space.activations)
        dofs = len(space)
        self._count = 2 * width
        self._of_positions = slice(half * width, half * width + dofs)
        self._of_velocities = slice(half * width + dofs, half * width + 2 * dofs)
        for body in scene.bodies.values():
            scene.update_link_poses(body)
            scene.update_link_velocities(body)
        state = scene.arrays.state.numpy
        self._fields: dict[str, np.ndarray] = {
            name: np.repeat(state[name][:1].astype(complex), self._count, axis=0)
            for name in ("position", "dof_velocity", "link_pose", "link_twist")
        }
        self._position, self._velocity = state["position"][0].copy(), state["dof_velocity"][0].copy()
        size = len(self._position)
        coordinates = np.repeat(self._position[None], size, axis=0)
        self._change("position")[self._of_positions] = space.of_changes(coordinates, np.eye(size)).T
        self._change("dof_velocity")[self._of_velocities] = np.eye(len(self._velocity))[space.dofs]
        for own, (first, count) in zip(space.bodies, space.places, strict=True):
            self._change_links(scene.bodies[own.id], first, count, self._velocity[space.dofs])
        for changed in self._fields.values():
            np.imag(changed)[:] *= _SMALL

    @property
    def engine(self) -> Engine:
        """See `Source`."""
        return self._lone.engine

    @property
    def parameters(self) -> EngineParameters:
        """See `Source`."""
        return self._lone.parameters

    @property
    def times(self) -> Array:
        """See `Source`."""
        return np.repeat(self._lone.times, self._count)

    @property
    def seeds(self) -> np.ndarray:
        """See `Source`."""
        return np.repeat(self._lone.seeds, self._count)

    @property
    def count(self) -> int:
        """Twice the length of the state."""
        return self._count

    def poses(self, body: BodyCore) -> Array:
        """See `Source`."""
        return self._fields["link_pose"]

    def velocities(self, body: BodyCore) -> Array:
        """See `Source`."""
        return self._fields["link_twist"]

    def hits(self, starts: Array, ends: Array, number: int) -> tuple[Array, np.ndarray, np.ndarray, Array]:
        """Rays have no derivatives."""
        raise NotImplementedError("distances along rays have no exact derivatives")

    def nearest(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """Neither have nearest points."""
        raise NotImplementedError("distances of shapes have no exact derivatives")

    def state(self, name: str) -> Array:
        """See `Source`; only what is known with its changes."""
        return self._fields[name]

    def _change(self, name: str) -> np.ndarray:
        """The changes of a field."""
        return np.imag(self._fields[name])

    def _change_links(self, body: BodyCore, first: int, count: int, rates: np.ndarray) -> None:
        """Write how the links of a body move with its dofs."""
        own = slice(first, first + count)
        of_positions = np.arange(self._count)[self._of_positions][own]
        of_velocities = np.arange(self._count)[self._of_velocities][own]
        poses, twists = self._change("link_pose"), self._change("link_twist")
        to_base = np.eye(count)
        # The change of velocities along the axes of a base, as it turns under them.
        turning = np.zeros((count, count))
        at = self._position[body.first_position : body.first_position + BASE_POSITIONS]
        given, positions = rates[own].copy(), self._position[body.first_position + BASE_POSITIONS :]
        positions = positions[: sum(body.position_count)]
        if not body.fixed_base:
            turn = matrix_of(at[3:]).T
            to_base[:3, :3] = to_base[3:6, 3:6] = turn
            given = to_base @ given
            turning[:3, :3], turning[3:6, :3] = cross_matrix(given[:3]), cross_matrix(given[3:6])
            positions = np.concatenate([at, positions])
        for link in range(-1, body.joint_count):
            row = body.first_link + 1 + link
            found = link_motion_derivatives(body, link, positions, given, np.zeros(count))
            by_velocity = found.dv_dv @ to_base
            by_position = (found.dv_dq + found.dv_dv @ turning) @ to_base
            pose, twist = (np.real(self._fields[name][0, row]) for name in ("link_pose", "link_twist"))
            # From the origin of the link frame to the centre of mass.
            frame = body.link_inertial_frame(link)
            local = multiplied(pose[3:], np.array([*frame.orientation]) * np.array([-1.0, -1.0, -1.0, 1.0]))
            arm = matrix_of(local) @ np.array(frame.position)
            turned, spin = by_velocity[3:].T, by_velocity[3:].T
            poses[of_positions, row, :3] = by_velocity[:3].T + cross(turned, arm)
            pure = np.concatenate([turned, np.zeros((count, 1))], axis=1)
            poses[of_positions, row, 3:] = 0.5 * multiplied(pure, pose[3:])
            twists[of_velocities, row, :3] = by_velocity[:3].T + cross(spin, arm)
            twists[of_velocities, row, 3:] = spin
            bent = by_position[3:].T
            moved = by_position[:3].T + cross(bent, arm) + cross(twist[3:], cross(turned, arm))
            twists[of_positions, row, :3] = moved
            twists[of_positions, row, 3:] = bent
