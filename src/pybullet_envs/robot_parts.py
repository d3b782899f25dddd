"""Named links and joints of robots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import pybullet

Vector = Sequence[float] | np.ndarray


class Pose_Helper:
    """Present pose of a link."""

    def __init__(self, body_part: BodyPart) -> None:
        self.body_part = body_part

    def xyz(self) -> np.ndarray:
        """Position [m] of the centre of mass."""
        return self.body_part.current_position()

    def rpy(self) -> tuple[float, float, float]:
        """Roll, pitch and yaw [rad]."""
        return pybullet.getEulerFromQuaternion(self.body_part.current_orientation().tolist())

    def orientation(self) -> np.ndarray:
        """Orientation (x, y, z, w)."""
        return self.body_part.current_orientation()


class BodyPart:
    """A link.

    Attributes:
        bodies: Ids of several bodies, one of which contains the link.
        bodyIndex: Index of that body in `bodies`.
        bodyPartIndex: Index of the link, -1 for the base.
        initialPosition: Position when the object was made [m].
        initialOrientation: Orientation when the object was made (x, y, z, w).
    """

    def __init__(
        self, bullet_client: Any, body_name: str, bodies: Sequence[int], bodyIndex: int, bodyPartIndex: int
    ) -> None:
        self._p = bullet_client
        self.body_name = body_name
        self.bodies = bodies
        self.bodyIndex = bodyIndex
        self.bodyPartIndex = bodyPartIndex
        self.initialPosition = self.current_position()
        self.initialOrientation = self.current_orientation()

    @property
    def body(self) -> int:
        """Id of the body that contains the link."""
        return self.bodies[self.bodyIndex]

    def state_fields_of_pose_of(self, body_id: int, link_id: int = -1) -> np.ndarray:
        """Position [m] and orientation (x, y, z, w) of the centre of mass of any link."""
        if link_id == -1:
            position, orientation = self._p.getBasePositionAndOrientation(body_id)
        else:
            position, orientation = self._p.getLinkState(body_id, link_id)[:2]
        return np.array((*position, *orientation))

    def get_pose(self) -> np.ndarray:
        """Position [m] and orientation (x, y, z, w)."""
        return self.state_fields_of_pose_of(self.body, self.bodyPartIndex)

    def current_position(self) -> np.ndarray:
        """Position [m] of the centre of mass."""
        return self.get_pose()[:3]

    def current_orientation(self) -> np.ndarray:
        """Orientation (x, y, z, w)."""
        return self.get_pose()[3:]

    get_position = current_position
    get_orientation = current_orientation

    def speed(self) -> np.ndarray:
        """Velocity [m/s] of the centre of mass."""
        if self.bodyPartIndex == -1:
            return np.array(self._p.getBaseVelocity(self.body)[0])
        return np.array(self._p.getLinkState(self.body, self.bodyPartIndex, computeLinkVelocity=1)[6])

    def reset_position(self, position: Vector) -> None:
        """Moves the base of the body, at rest, to a position [m] and the orientation of this link."""
        self.reset_pose(position, self.current_orientation())

    def reset_orientation(self, orientation: Vector) -> None:
        """Moves the base of the body, at rest, to an orientation (x, y, z, w) and this link's position."""
        self.reset_pose(self.current_position(), orientation)

    def reset_velocity(self, linearVelocity: Vector = (0, 0, 0), angularVelocity: Vector = (0, 0, 0)) -> None:
        """Sets the velocity of the base [m/s, rad/s]."""
        self._p.resetBaseVelocity(self.body, list(linearVelocity), list(angularVelocity))

    def reset_pose(self, position: Vector, orientation: Vector) -> None:
        """Moves the base of the body, at rest, to a position [m] and an orientation (x, y, z, w)."""
        self._p.resetBasePositionAndOrientation(self.body, list(position), list(orientation))

    def pose(self) -> Pose_Helper:
        """The pose of the link."""
        return self.bp_pose

    @property
    def bp_pose(self) -> Pose_Helper:
        """The pose of the link; made anew, because it refers to the link."""
        return Pose_Helper(self)

    def contact_list(self) -> Any:
        """The contacts of the link, see `getContactPoints`."""
        return self._p.getContactPoints(self.body, -1, self.bodyPartIndex, -1)


class Joint:
    """A joint, usually driven by torques.

    Attributes:
        joint_name: Name of the joint.
        lowerLimit: Lower position limit [rad or m].
        upperLimit: Upper position limit [rad or m].
        power_coef: Torque [N m] for an action of 1; robots multiply it by their own power.
    """

    def __init__(
        self, bullet_client: Any, joint_name: str, bodies: Sequence[int], bodyIndex: int, jointIndex: int
    ) -> None:
        self._p = bullet_client
        self.joint_name = joint_name
        self.bodies = bodies
        self.bodyIndex = bodyIndex
        self.jointIndex = jointIndex
        self.lowerLimit, self.upperLimit = bullet_client.getJointInfo(self.body, jointIndex)[8:10]
        self.power_coef = 0.0

    @property
    def body(self) -> int:
        """Id of the body that contains the joint."""
        return self.bodies[self.bodyIndex]

    def get_state(self) -> tuple[float, float]:
        """Position [rad or m] and velocity [rad/s or m/s]."""
        return self._p.getJointState(self.body, self.jointIndex)[:2]

    current_position = get_state

    def current_relative_position(self) -> tuple[float, float]:
        """Position from -1 at the lower limit to 1 at the upper one, and a tenth of the velocity."""
        position, velocity = self.get_state()
        middle = 0.5 * (self.lowerLimit + self.upperLimit)
        return 2.0 * (position - middle) / (self.upperLimit - self.lowerLimit), 0.1 * velocity

    def get_position(self) -> float:
        """Position [rad or m]."""
        return self.get_state()[0]

    def get_velocity(self) -> float:
        """Velocity [rad/s or m/s]."""
        return self.get_state()[1]

    get_orientation = get_velocity
    """PyBullet's other name of it."""

    def set_state(self, x: float, vx: float) -> None:
        """Sets position and velocity; the motor keeps its settings."""
        self._p.resetJointState(self.body, self.jointIndex, x, vx)

    def reset_position(self, position: float, velocity: float) -> None:
        """Sets position and velocity, and switches the motor off."""
        self.set_state(position, velocity)
        self.disable_motor()

    reset_current_position = reset_position

    def set_position(self, position: float) -> None:
        """Sets a position target for the motor."""
        self._control(pybullet.POSITION_CONTROL, targetPosition=position)

    def set_velocity(self, velocity: float) -> None:
        """Sets a velocity target for the motor."""
        self._control(pybullet.VELOCITY_CONTROL, targetVelocity=velocity)

    def set_torque(self, torque: float) -> None:
        """Applies a torque [N m] or force [N] in the next step."""
        self._control(pybullet.TORQUE_CONTROL, force=torque)

    set_motor_torque = set_torque

    def disable_motor(self) -> None:
        """Switches off the motor that joints have when they are loaded."""
        self._control(pybullet.POSITION_CONTROL, positionGain=0.1, velocityGain=0.1, force=0)

    def _control(self, mode: int, **settings: float) -> None:
        self._p.setJointMotorControl2(self.body, self.jointIndex, mode, **settings)
