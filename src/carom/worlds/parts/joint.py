"""One joint of a body in many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, OnDevice, pair
from carom.closed import Closed
from carom.model.body_spec import LinkSpec
from carom.scene.common.joint import CommonJoint
from carom.worlds.batch import Batch
from carom.worlds.chosen import Where

if TYPE_CHECKING:
    from carom.worlds.parts.joints import JointGroupBatch
    from carom.worlds.parts.links import LinkBatch


class JointBatch(CommonJoint[Array, "ArrayLike", "LinkBatch"], Closed):
    """One joint of a body in all worlds; get it from `worlds[body].joints`.

    Names are those of `Joint`, numbers have the world as their first axis: (count,). Setters take `where`: a
    mask (count,) of worlds, or their indices; None for all. Values are (n,) for the n worlds chosen, or one
    number for all.

    Attributes:
        index: Its number in the body, and that of the link it moves.
        name: Its name in the file.
    """

    def __init__(self, batch: Batch, group: JointGroupBatch) -> None:
        self._batch = batch
        self._group = group
        (joint,) = group._handles
        self.index: int = joint.index
        self.name: str = joint.name
        self._close()

    def __repr__(self) -> str:
        return f"<JointBatch {self.index} {self.name!r} in {self._batch._count} worlds: {self.type.value}>"

    @property
    def spec(self) -> LinkSpec:
        """The specification of the joint and the link it moves, from the file."""
        return self._batch._body.spec.links[self.index]

    def _link(self, number: int) -> LinkBatch:
        return self._batch._parts_of_it.link(self._batch, number)

    @property
    def degrees_of_freedom(self) -> int:
        """0 for a fixed joint, 3 for a spherical or planar one, 1 for the others."""
        return self._batch._body.velocity_count[self.index]

    @property
    def limits(self) -> tuple[Array, Array]:
        """Minimum and maximum position that are enforced in each world, (count,) each; settable.

        Raises:
            ValueError: What is set is no pair, or the joint had no limits when it was copied.
        """
        self._require_one_freedom()
        lower, upper = self._group.limits
        return lower[:, 0], upper[:, 0]

    @limits.setter
    def limits(self, value: tuple[ArrayLike, ArrayLike]) -> None:
        self._require_one_freedom()
        lower, upper = pair(value, "limits", "the least and the greatest position")
        self._change(joint_lower_limit=lower, joint_upper_limit=upper)

    @property
    def spring_reference(self) -> Array:
        """Position at which this spring is at rest; (count, 4) of a spherical joint."""
        return self._term("joint_spring_reference")

    @spring_reference.setter
    def spring_reference(self, value: ArrayLike) -> None:
        self._change(joint_spring_reference=value)

    @property
    def friction_loss(self) -> Array:
        """Greatest force of dry friction [N m or N]; settable if the joint had some when it was copied."""
        found = self._batch.dynamics(self.index).get("joint_friction")
        return np.zeros(self._batch._count) if found is None else found

    @friction_loss.setter
    def friction_loss(self, value: ArrayLike) -> None:
        self._change(joint_friction=value)

    def _term(self, name: str) -> Array:
        self._require_terms()
        return self._batch.dynamics(self.index)[name]

    def _change(self, **changes: ArrayLike) -> None:
        self._batch.change_dynamics(self.index, **changes)

    # State

    @property
    def position(self) -> Array:
        """Present positions, a view (count,); setting them leaves velocities as they are."""
        self._require_one_freedom()
        return self._group.positions[:, 0]

    @position.setter
    def position(self, value: ArrayLike) -> None:
        self._require_one_freedom()
        self._group.positions = self._column(value)

    @property
    def velocity(self) -> Array:
        """Present velocities, a view (count,); settable."""
        self._require_one_freedom()
        return self._group.velocities[:, 0]

    @velocity.setter
    def velocity(self, value: ArrayLike) -> None:
        self._require_one_freedom()
        self._group.velocities = self._column(value)

    @property
    def torque(self) -> Array:
        """Torque [N m] or force [N] to apply in the next step, a view (count,); settable."""
        self._require_one_freedom()
        return self._group.torques[:, 0]

    @torque.setter
    def torque(self, value: ArrayLike) -> None:
        self._require_one_freedom()
        self.set_torque(value)

    @property
    def coordinates(self) -> Array:
        """All position coordinates, a view (count, 0), (count, 1), or (count, 4) of a spherical joint."""
        return self._group.positions

    @property
    def rates(self) -> Array:
        """All velocity coordinates, a view (count, 0), (count, 1), or (count, 3)."""
        return self._group.velocities

    def reset(self, position: ArrayLike, velocity: ArrayLike = 0.0, *, where: Where | None = None) -> None:
        """Set the state of the joint without simulation; its motor keeps its target.

        Args:
            position: (n,) or one number; of a joint with several coordinates (n, coordinates).
            velocity: Likewise.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        self._group.reset(self._column(position), self._column(velocity), where=where)

    # Drive

    def servo(
        self,
        target: ArrayLike,
        *,
        kp: ArrayLike | None = None,
        kd: ArrayLike | None = None,
        velocity: ArrayLike = 0.0,
        max_force: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.servo` in all worlds, or in some; each argument (n,) or one number."""
        column = self._column
        self._group.servo(
            column(target),
            kp=None if kp is None else column(kp),
            kd=None if kd is None else column(kd),
            velocities=column(velocity),
            max_forces=None if max_force is None else column(max_force),
            where=where,
        )

    def velocity_servo(
        self,
        target: ArrayLike,
        *,
        kd: ArrayLike,
        max_force: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.velocity_servo` in all worlds, or in some."""
        self.servo(0.0, kp=0.0, kd=kd, velocity=target, max_force=max_force, where=where)

    def hold(self, *, max_force: ArrayLike | None = None, where: Where | None = None) -> None:
        """Hold the joint where it is now, as `Joint.hold`."""
        self._group.hold(max_forces=None if max_force is None else self._column(max_force), where=where)

    def free(self, *, where: Where | None = None) -> None:
        """Switch off motor, servo and spring."""
        self._group.free(where=where)

    def set_position_target(
        self,
        target: ArrayLike,
        *,
        gain: ArrayLike = 0.1,
        velocity: ArrayLike = 0.0,
        velocity_gain: ArrayLike = 1.0,
        max_force: ArrayLike | None = None,
        max_velocity: ArrayLike = np.inf,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_position_target` in all worlds, or in some."""
        column = self._column
        self._group.set_position_targets(
            column(target),
            gains=column(gain),
            velocities=column(velocity),
            velocity_gains=column(velocity_gain),
            max_forces=None if max_force is None else column(max_force),
            max_velocities=column(max_velocity),
            where=where,
        )

    def set_velocity_target(
        self,
        target: ArrayLike,
        *,
        gain: ArrayLike = 1.0,
        max_force: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_velocity_target` in all worlds, or in some."""
        self._group.set_velocity_targets(
            self._column(target),
            gains=self._column(gain),
            max_forces=None if max_force is None else self._column(max_force),
            where=where,
        )

    def set_spring(
        self,
        target: ArrayLike,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        velocity: ArrayLike = 0.0,
        max_force: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_spring` in all worlds, or in some."""
        column = self._column
        self._group.set_springs(
            column(target),
            stiffness=column(stiffness),
            damping=column(damping),
            velocities=column(velocity),
            max_forces=None if max_force is None else column(max_force),
            where=where,
        )

    def set_torque(self, torque: ArrayLike, *, where: Where | None = None) -> None:
        """`Joint.set_torque` in all worlds, or in some."""
        self._group.set_torques(self._column(torque), where=where)

    @property
    def motor_torque(self) -> Array:
        """Force or torque of the motor in the last substep, a copy (count,)."""
        self._require_one_freedom()
        return self._group.motor_torques[:, 0]

    # Force-torque sensor

    def enable_sensor(self, enabled: bool = True) -> None:
        """Switch the force-torque sensor on or off in all worlds."""
        self._group.enable_sensors(enabled)

    @property
    def reaction(self) -> Array:
        """Force [N] and torque [N m] measured by the sensor in the last substep, a view (count, 6)."""
        return self._group.reactions[:, 0]

    def _column(self, value: ArrayLike) -> ArrayLike:
        """Numbers of worlds as values of a group of one joint."""
        if self.degrees_of_freedom != 1 or np.ndim(value) != 1:
            return value
        taken: Any = self._batch._take(value)
        is_elsewhere = isinstance(taken, OnDevice)
        column: Any = taken if is_elsewhere else np.asarray(taken)
        return column.reshape(len(column), 1)
