"""One joint of a body; several at once are in `carom.scene.joints`."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, one_or_each, pair, vector
from carom.model.link_dynamics import enforced_limits
from carom.native.change import Change, first_change
from carom.native.gates import gated
from carom.native.products import length
from carom.scene.common.joint import CommonJoint
from carom.scene.handles import world_of
from carom.scene.joint_motor import Drives
from carom.scene.joint_terms.friction import friction_of, set_friction

if TYPE_CHECKING:
    from carom.model.body_spec import LinkSpec
    from carom.scene.body import Body
    from carom.scene.core.body_core import JointReset
    from carom.scene.link import Link


class Joint(CommonJoint[float, float, "Link"]):
    """One joint of a body. Positions are in rad or m, forces in N m or N, depending on its type.

    The scalar attributes and methods are for joints with one degree of freedom (revolute,
    continuous, prismatic) and raise `ValueError` on others; `coordinates` and `rates` work for all.

    Attributes:
        body: The body it belongs to.
        index: Its number in the body, and that of the link it moves.
    """

    __slots__ = ("body", "index")

    def __init__(self, body: Body, index: int) -> None:
        self.body: Body = body
        self.index: int = index

    def __repr__(self) -> str:
        return f"<Joint {self.index} {self.name!r} of {self.body.name!r}: {self.type.value}>"

    @property
    def spec(self) -> LinkSpec:
        """The specification of the joint and the link it moves, from the file."""
        return self.body.spec.links[self.index]

    @property
    def name(self) -> str:
        """Its name in the file."""
        return self.spec.joint_name

    @property
    def _has_quaternion(self) -> bool:
        return self.body.position_count[self.index] != self.body.velocity_count[self.index]

    @property
    def degrees_of_freedom(self) -> int:
        """0 for a fixed joint, 3 for a spherical or planar one, 1 for the others."""
        return self.body.velocity_count[self.index]

    @property
    def limits(self) -> tuple[float, float]:
        """Minimum and maximum position that are enforced now; -inf and inf without a limit; settable.

        Raises:
            ValueError: What is set is no pair of numbers, or the joint has not one degree of freedom.
        """
        return enforced_limits(self.spec, self.body.dynamics(self.index))

    @limits.setter
    def limits(self, value: tuple[float, float]) -> None:
        self._require_one_freedom()
        lower, upper = pair(value, "limits", "the least and the greatest position")
        self.body.change_dynamics(self.index, joint_lower_limit=lower, joint_upper_limit=upper)

    @property
    def spring_reference(self) -> float | tuple[float, ...]:
        """Position at which this spring is at rest; settable. Of a spherical joint it is a quaternion."""
        rest = self.body.dynamics(self.index).joint_spring_reference
        return rest[0] if len(rest) == 1 else rest

    @spring_reference.setter
    def spring_reference(self, value: ArrayLike) -> None:
        rest = vector(np.atleast_1d(value), self.body.position_count[self.index], "spring_reference")
        self._change(joint_spring_reference=tuple(rest.tolist()))

    @property
    def friction_loss(self) -> float:
        """Greatest force of dry friction [N m or N]; settable."""
        friction = friction_of(self.body, self.index)
        return 0.0 if friction is None else friction.upper

    @friction_loss.setter
    def friction_loss(self, value: float) -> None:
        world_of(self.body)  # raises an error if the body has been removed
        set_friction(self.body, self.index, float(value))

    def _link(self, number: int) -> Link:
        return self.body.links[number]

    def _term(self, name: str) -> float:
        return getattr(self.body.dynamics(self.index), name)

    def _change(self, **changes: float | tuple[float, ...]) -> None:
        """Change terms of the joint; raises `ValueError` for a fixed one, and numbers that are not finite."""
        world_of(self.body)
        for name, value in changes.items():
            finite(value, name.removeprefix("joint_"))
        self._require_terms()
        self.body.change_dynamics(self.index, **changes)

    # State

    @property
    @gated("body.world.call_lock")
    def position(self) -> float:
        """Present position; setting it puts the joint there, as `reset` does, and its velocity stays."""
        self._require_one_freedom()
        return float(world_of(self.body).position[self.body.position_index[self.index]])

    @position.setter
    def position(self, value: float) -> None:
        self._require_one_freedom()
        with self.body.world.call_lock:
            self.reset(value, self.velocity)

    @property
    @gated("body.world.call_lock")
    def velocity(self) -> float:
        """Present velocity; it can be set."""
        return float(world_of(self.body).velocity[self._dof])

    @velocity.setter
    def velocity(self, value: float) -> None:
        self._require_one_freedom()
        (rate,) = vector((value,), 1, "velocity").tolist()
        self.body.set_joint_state(self.index, None, (rate,))

    @property
    @gated("body.world.call_lock")
    def coordinates(self) -> Array:
        """All position coordinates, shape (0,), (1,), or (4,) for the quaternion of a spherical joint."""
        first, count = self.body.position_index[self.index], self.body.position_count[self.index]
        return world_of(self.body).position[first : first + count].copy()

    @property
    @gated("body.world.call_lock")
    def rates(self) -> Array:
        """All velocity coordinates, shape (0,), (1,), or (3,)."""
        return world_of(self.body).velocity[self._dofs].copy()

    @gated("body.world.call_lock", commits=True)
    def reset(self, position: ArrayLike, velocity: ArrayLike = 0.0) -> None:
        """Set the state of the joint without simulation; its motor keeps its target.

        Joints that are coupled to it, as by `<mimic>`, are placed where they follow it.

        Args:
            position: All position coordinates, as in `coordinates`; a quaternion is normalised.
            velocity: All velocity coordinates, as in `rates`, or one number for all.

        Raises:
            ValueError: A number is not finite, there are too many or too few, or a quaternion is 0.
        """
        change = first_change()
        world = world_of(self.body)
        states: list[JointReset] = [(self.index, *self._checked_state(position, velocity))]
        if len(world.user_constraints):
            from carom.scene.named_constraints.joint_coupling import follower_states

            states += follower_states(self.body, *states[0])
        self.body.note_joint_states(change, states)
        world.note_link_poses(change, self.body)
        change.commit()

    def _checked_state(
        self, position: ArrayLike, velocity: ArrayLike = 0.0
    ) -> tuple[list[float], list[float]]:
        """The coordinates of a state for `reset`, checked as it does."""
        world_of(self.body)  # raises an error if the body has been removed
        given = (position,) if isinstance(position, float) else np.atleast_1d(position)
        position = vector(given, self.body.position_count[self.index], "position")
        if self._has_quaternion and not position.any():
            raise ValueError("position must be a quaternion other than 0")
        if isinstance(velocity, float) and isfinite(velocity):
            return position.tolist(), [velocity] * self.degrees_of_freedom
        velocity = np.broadcast_to(finite(velocity, "velocity"), self.degrees_of_freedom)
        return position.tolist(), velocity.tolist()

    # Drive

    @gated("body.world.call_lock", commits=True)
    def set_position_target(
        self,
        target: float,
        *,
        gain: float = 0.1,
        velocity: float = 0.0,
        velocity_gain: float = 1.0,
        max_force: float | None = None,
        max_velocity: float = np.inf,
    ) -> None:
        """Position control: the motor moves the joint to a position and holds it there.

        In every substep it aims for a velocity that corrects the share `gain` of the position error and the
        share `velocity_gain` of the velocity error, with at most `max_force`.

        Args:
            target: Target position, clipped to the limits.
            gain: Position gain: share of the position error corrected per substep, usually 0 ... 1.
            velocity: Target velocity.
            velocity_gain: Velocity gain: share of the velocity error corrected per substep.
            max_force: Maximum force; `effort_limit` by default.
            max_velocity: Maximum velocity of the motor.
        """
        change = first_change()
        target = float(np.clip(one_or_each(target, 1, "target")[0], *self.limits))
        force = self._force(max_force)
        self._drives(self._one_dof, change).aim_at_position(
            target, velocity, gain, velocity_gain, force, max_velocity
        )

    @gated("body.world.call_lock", commits=True)
    def set_velocity_target(
        self, target: float, *, gain: float = 1.0, max_force: float | None = None
    ) -> None:
        """Velocity control: the motor keeps a velocity.

        Args:
            target: The velocity.
            gain: Share of the velocity error corrected per substep.
            max_force: Maximum force; `effort_limit` by default.
        """
        change = first_change()
        self._drives(self._one_dof, change).aim_at_velocity(target, gain, self._force(max_force))

    @gated("body.world.call_lock", commits=True)
    def set_spring(
        self,
        target: float,
        *,
        stiffness: float,
        damping: float,
        velocity: float = 0.0,
        max_force: float | None = None,
    ) -> None:
        """Add a spring and a damper (explicit PD control) to the joint; its motor stays on.

        Args:
            target: Rest position of the spring.
            stiffness: [N m/rad or N/m].
            damping: [N m s/rad or N s/m]. It is explicit: too large a value for the inertia is unstable.
            velocity: Velocity at which the damper exerts no force.
            max_force: Maximum force; `effort_limit` by default.
        """
        change = first_change()
        force = self._force(max_force)
        self._drives(self._one_dof, change).pull_like_a_spring(target, velocity, stiffness, damping, force)

    @gated("body.world.call_lock", commits=True)
    def set_orientation_target(
        self,
        target: ArrayLike,
        *,
        gain: float = 0.1,
        damping: float = 1.0,
        max_force: float | None = None,
    ) -> None:
        """Position control of a spherical joint: rotate the child link to an orientation in the parent link.

        Args:
            target: Quaternion (x, y, z, w); normalised here.
            gain: Share of the orientation error corrected per substep.
            damping: Share of the angular velocity removed per substep.
            max_force: Maximum torque about each axis; `effort_limit` by default.
        """
        if not self._has_quaternion:
            raise ValueError(f"joint {self.name!r} is {self.type.value}, not spherical")
        quaternion = vector(target, 4, "target")
        size = length(quaternion)
        if size == 0.0:
            raise ValueError("target must be a quaternion other than 0")
        change = first_change()
        force = self._force(max_force)
        self._drives(self._dofs, change).aim_at_orientation(quaternion / size, gain, damping, force)

    @gated("body.world.call_lock", commits=True)
    def set_torque(self, torque: ArrayLike) -> None:
        """Torque control: apply a force or torque in the next step, instead of one set before.

        The motor is not switched off; see `free`.
        """
        change = first_change()
        torque = one_or_each(finite(torque, "torque"), self.degrees_of_freedom, "torque")
        change.write(world_of(self.body).joint_torque[self._dofs], torque)
        change.commit()

    @gated("body.world.call_lock", commits=True)
    def servo(
        self,
        target: float,
        *,
        kp: float | None = None,
        kd: float | None = None,
        velocity: float = 0.0,
        max_force: float | None = None,
    ) -> None:
        """Pull the joint to a position: torque = kp (target - position) + kd (target velocity - velocity).

        Position and velocity are those at the end of a step, so that no gain is too large for it: the law of
        a position actuator of MuJoCo. It holds until the motor is told something else; `free` ends it.

        Args:
            target: [rad or m]; it is not clipped to the limits.
            kp: Stiffness [N m/rad or N/m]; that of its present servo if left out.
            kd: Damping [N m s/rad or N s/m], likewise.
            velocity: Target velocity.
            max_force: Greatest torque or force; `effort_limit` by default.

        Raises:
            ValueError: A gain is left out, and it has no servo yet; or a number is not finite.
        """
        change = first_change()
        force = self._force(max_force)
        drives = self._drives(self._one_dof, change)
        if kp is None or kd is None:
            (stiffness,), (damping,) = drives.servo_gains()
            kp, kd = float(stiffness) if kp is None else kp, float(damping) if kd is None else kd
        drives.serve(target, velocity, kp, kd, force)

    def velocity_servo(self, target: float, *, kd: float, max_force: float | None = None) -> None:
        """Push the joint to a velocity: torque = kd (target - velocity), of the velocity at a step's end."""
        self.servo(0.0, kp=0.0, kd=kd, velocity=target, max_force=max_force)

    def hold(self, *, max_force: float | None = None) -> None:
        """Hold the joint where it is now, as stiff as a step allows, with at most `max_force`."""
        with self.body.world.call_lock:
            self.set_position_target(self.position, max_force=max_force)

    @gated("body.world.call_lock", commits=True)
    def free(self) -> None:
        """Switch off the motor, which is on after loading a URDF file, servo and spring."""
        change = first_change()
        self._drives(self._dofs, change).switch_off()

    @property
    def torque(self) -> float:
        """Torque [N m] or force [N] of users in the next step; setting it is `set_torque`."""
        with self.body.world.call_lock:
            return float(world_of(self.body).joint_torque[self._dof])

    @torque.setter
    def torque(self, value: float) -> None:
        self._require_one_freedom()
        self.set_torque(value)

    @property
    @gated("body.world.call_lock")
    def motor_torque(self) -> float:
        """Force or torque of the motor in the last substep."""
        world = world_of(self.body)
        return float(world.motor_impulse[self._dof] / world.parameters.substep_time)

    # Force-torque sensor

    @gated("body.world.call_lock")
    def enable_sensor(self, enabled: bool = True) -> None:
        """Switch the force-torque sensor on or off; it reads 0 until the next step."""
        world_of(self.body)  # raises an error if the body has been removed
        self.body.set_sensor(self.index, enabled)

    @property
    @gated("body.world.call_lock")
    def reaction(self) -> Array:
        """Force [N] and torque [N m] measured by the sensor in the last substep, shape (6,).

        The wrench that the joint transmits from its parent link to its child link, due to weight and inertia
        of the links beyond it, applied forces, contacts, user constraints and soft bodies, but without the
        force of its own motor or limit. The torque is about the child link's centre of mass. Both are in the
        axes of its inertial frame, unless `EngineParameters.joint_feedback_mode` selects another frame.
        """
        return world_of(self.body).joint_reaction[self.body.first_link + 1 + self.index].copy()

    # Rows in the world's arrays

    @property
    def _dofs(self) -> slice:
        first, count = self.body.velocity_index[self.index], self.body.velocity_count[self.index]
        return slice(first, first + count) if count else slice(0, 0)

    @property
    def _one_dof(self) -> slice:
        self._require_one_freedom()
        return self._dofs

    @property
    def _dof(self) -> int:
        return self._one_dof.start

    def _drives(self, dofs: slice, change: Change) -> Drives:
        world = world_of(self.body)
        return Drives(world.motor, world.pd, dofs, world.parameters.substep_time, change)

    def _force(self, max_force: float | None) -> float:
        return self.effort_limit if max_force is None else max_force
