"""Base classes of the robots of environments: loaded from files, with links and joints by name."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

import pybullet
import pybullet_data
from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.robot_parts import BodyPart, Joint, Pose_Helper

__all__ = ["BodyPart", "Joint", "MJCFBasedRobot", "Pose_Helper", "URDFBasedRobot", "XmlBasedRobot"]

_POWER = 100.0
Found = tuple[dict[str, BodyPart], dict[str, Joint], list[Joint], BodyPart | None]


class XmlBasedRobot:
    """A robot with named parts.

    Subclasses define `robot_specific_reset`, `apply_action` and `calc_state`.

    Attributes:
        parts: Links by name, in order.
        jdict: Joints by name, in order, except free ones: names that begin with `ignore` or `jointfix`.
        ordered_joints: The same joints.
        robot_body: The link that represents the robot.
        robot_name: Name of this link.
        self_collision: Whether the links collide with each other.
        np_random: Random number generator of the environment.
        scene: The scene.
    """

    self_collision = True
    np_random: Any
    scene: Any

    def __init__(self, robot_name: str, action_dim: int, obs_dim: int, self_collision: bool) -> None:
        """Makes the spaces of actions and observations.

        Args:
            robot_name: Name of the link that represents the robot.
            action_dim: Size of an action, each of whose numbers is from -1 to 1.
            obs_dim: Size of an observation.
            self_collision: Whether the links collide with each other.
        """
        ones, endless = np.ones(action_dim, np.float32), np.full(obs_dim, np.inf, np.float32)
        self.action_space = gymnasium.spaces.Box(-ones, ones, dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-endless, endless, dtype=np.float32)
        self.robot_name = robot_name
        self.self_collision = self_collision
        self.forget()

    def forget(self) -> None:
        """Drops links and joints of a world that no longer exists."""
        self.objects: Sequence[int] = ()
        self.parts: dict[str, BodyPart] = {}
        self.jdict: dict[str, Joint] = {}
        self.ordered_joints: list[Joint] = []
        self.robot_body: Any = None

    def addToScene(self, bullet_client: Any, bodies: int | Sequence[int]) -> Found:
        """Adds the links and joints of bodies, and switches their motors off.

        Args:
            bullet_client: The world.
            bodies: Id of one body, or ids of several.

        Returns:
            `parts`, `jdict`, `ordered_joints` and `robot_body`, with those added earlier.
        """
        self._p = bullet_client
        bodies = [bodies] if isinstance(bodies, int) else list(bodies)
        for index, body in enumerate(bodies):
            infos = [bullet_client.getJointInfo(body, j) for j in range(bullet_client.getNumJoints(body))]
            base_name = bullet_client.getBodyInfo(body)[0].decode()
            if not infos:
                self._add_part(base_name, bodies, index, -1)
            elif index == 0 and self.robot_body is None and infos[0][12].decode() != self.robot_name:
                self._add_part(self.robot_name, bodies, index, -1)
            for info in infos:
                self._add_part(info[12].decode(), bodies, index, info[0])
                self._add_joint(info[1].decode(), bodies, index, info[0])
        return self.parts, self.jdict, self.ordered_joints, self.robot_body

    def _add_part(self, name: str, bodies: Sequence[int], index: int, link: int) -> None:
        self.parts[name] = BodyPart(self._p, name, bodies, index, link)
        if name == self.robot_name:
            self.robot_body = self.parts[name]

    def _add_joint(self, name: str, bodies: Sequence[int], index: int, number: int) -> None:
        joint = Joint(self._p, name, bodies, index, number)
        joint.disable_motor()
        if not name.startswith(("ignore", "jointfix")):
            joint.power_coef = _POWER
            self.jdict[name] = joint
            self.ordered_joints.append(joint)

    def reset_pose(self, position: Sequence[float], orientation: Sequence[float]) -> None:
        """Moves the base of the body that contains `robot_body`."""
        self.parts[self.robot_name].reset_pose(position, orientation)

    def middle(self) -> np.ndarray:
        """The mean position of all parts [m]."""
        links: dict[int, list[int]] = {}
        for part in self.parts.values():
            links.setdefault(part.body, []).append(part.bodyPartIndex)
        places: list[Any] = []
        for body, numbers in links.items():
            inner = [number for number in numbers if number >= 0]
            bases = len(numbers) - len(inner)
            places += [self._p.getBasePositionAndOrientation(body)[0]] * bases
            places += [state[0] for state in self._p.getLinkStates(body, inner)] if inner else []
        return np.array(places).mean(axis=0)

    def relative_joint_states(self) -> np.ndarray:
        """The `Joint.current_relative_position` of each of `ordered_joints`, (joints, 2)."""
        states = np.empty((len(self.ordered_joints), 2))
        for body, places in self._places_by_body(self.ordered_joints).items():
            joints = [self.ordered_joints[place] for place in places]
            found = self._p.getJointStates(body, [joint.jointIndex for joint in joints])
            states[places] = [state[:2] for state in found]
        lower = np.array([joint.lowerLimit for joint in self.ordered_joints])
        upper = np.array([joint.upperLimit for joint in self.ordered_joints])
        relative = (2.0 * states[:, 0] - lower - upper) / (upper - lower)
        return np.column_stack((relative, 0.1 * states[:, 1]))

    def set_motor_torques(self, joints: Sequence[Joint], torques: np.ndarray) -> None:
        """Applies torques [N m] or forces [N] to several joints in the next step."""
        for body, places in self._places_by_body(joints).items():
            numbers = [joints[place].jointIndex for place in places]
            forces = [float(torques[place]) for place in places]
            self._p.setJointMotorControlArray(body, numbers, pybullet.TORQUE_CONTROL, forces=forces)

    @staticmethod
    def _places_by_body(joints: Sequence[Joint]) -> dict[int, list[int]]:
        """Indices, in a list of joints, of the joints of each body."""
        places: dict[int, list[int]] = {}
        for place, joint in enumerate(joints):
            places.setdefault(joint.body, []).append(place)
        return places

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Moves the robot to the start of an episode."""
        raise NotImplementedError(f"{type(self).__name__} has no robot_specific_reset")

    def apply_action(self, a: np.ndarray) -> None:
        """Drives the joints in the next step."""
        raise NotImplementedError(f"{type(self).__name__} has no apply_action")

    def calc_state(self) -> np.ndarray:
        """The present observation."""
        raise NotImplementedError(f"{type(self).__name__} has no calc_state")

    def calc_potential(self) -> float:
        """Potential of the present state; its increase in a step may be part of the reward."""
        return 0.0

    def _flags(self) -> int:
        collision = pybullet.URDF_USE_SELF_COLLISION if self.self_collision else 0
        return collision | pybullet.URDF_GOOGLEY_UNDEFINED_COLORS


class MJCFBasedRobot(XmlBasedRobot):
    """A robot in an MJCF file, which is loaded when the first episode begins.

    Attributes:
        model_xml: The file, from the folder `mjcf` of `pybullet_data` if it is not absolute.
        doneLoading: Whether the file is loaded.
        objects: Ids of the bodies in the file.
    """

    def __init__(
        self, model_xml: str, robot_name: str, action_dim: int, obs_dim: int, self_collision: bool = True
    ) -> None:
        """Sets the file; see `XmlBasedRobot`."""
        super().__init__(robot_name, action_dim, obs_dim, self_collision)
        self.model_xml = model_xml

    def forget(self) -> None:
        """Drops links and joints, so that the next `reset` loads them again."""
        super().forget()
        self.doneLoading = 0

    def reset(self, bullet_client: Any) -> np.ndarray:
        """Begins an episode; returns the first observation."""
        self._p = bullet_client
        if not self.doneLoading:
            self.doneLoading = 1
            file = os.path.join(pybullet_data.getDataPath(), "mjcf", self.model_xml)
            flags = self._flags()
            if self.self_collision:
                flags |= pybullet.URDF_USE_SELF_COLLISION_EXCLUDE_ALL_PARENTS
            self.objects = bullet_client.loadMJCF(file, flags=flags)
            self.addToScene(bullet_client, self.objects)
        self.robot_specific_reset(bullet_client)
        return self.calc_state()


class URDFBasedRobot(XmlBasedRobot):
    """A robot in a URDF file, which is loaded again for each episode: its scene has to be empty then.

    Attributes:
        model_urdf: The file, from the folder of `pybullet_data` if it is not absolute.
    """

    def __init__(
        self,
        model_urdf: str,
        robot_name: str,
        action_dim: int,
        obs_dim: int,
        basePosition: Sequence[float] = (0, 0, 0),
        baseOrientation: Sequence[float] = (0, 0, 0, 1),
        fixed_base: bool = False,
        self_collision: bool = False,
    ) -> None:
        """Sets the file; see `XmlBasedRobot`.

        Args:
            model_urdf: The file.
            robot_name: Name of the link that represents the robot.
            action_dim: Size of an action.
            obs_dim: Size of an observation.
            basePosition: Initial position of the base [m].
            baseOrientation: Initial orientation of the base (x, y, z, w).
            fixed_base: Whether the base is fixed.
            self_collision: Whether the links collide with each other.
        """
        super().__init__(robot_name, action_dim, obs_dim, self_collision)
        self.model_urdf = model_urdf
        self.basePosition = basePosition
        self.baseOrientation = baseOrientation
        self.fixed_base = fixed_base

    def reset(self, bullet_client: Any) -> np.ndarray:
        """Begins an episode; returns the first observation."""
        self.forget()
        body = bullet_client.loadURDF(
            os.path.join(pybullet_data.getDataPath(), self.model_urdf),
            basePosition=self.basePosition,
            baseOrientation=self.baseOrientation,
            useFixedBase=self.fixed_base,
            flags=self._flags(),
        )
        self.objects = (body,)
        self.addToScene(bullet_client, body)
        self.robot_specific_reset(bullet_client)
        state = self.calc_state()
        self.potential = self.calc_potential()
        return state


class SDFBasedRobot(XmlBasedRobot):
    """A robot in an SDF file, which is loaded again for each episode: its scene has to be empty then.

    Attributes:
        model_sdf: The file, from the folder `models_robot` of the search path if it is not absolute.
    """

    def __init__(
        self,
        model_sdf: str,
        robot_name: str,
        action_dim: int,
        obs_dim: int,
        basePosition: Sequence[float] = (0, 0, 0),
        baseOrientation: Sequence[float] = (0, 0, 0, 1),
        fixed_base: bool = False,
        self_collision: bool = False,
    ) -> None:
        """Sets the file; see `XmlBasedRobot`. SDF files say where bodies are and whether they are fixed."""
        super().__init__(robot_name, action_dim, obs_dim, self_collision)
        self.model_sdf = model_sdf
        self.fixed_base = fixed_base

    def reset(self, bullet_client: Any) -> np.ndarray:
        """Begins an episode; returns the first observation."""
        self.forget()
        self.objects = bullet_client.loadSDF(os.path.join("models_robot", self.model_sdf))
        self.addToScene(bullet_client, self.objects)
        self.robot_specific_reset(bullet_client)
        state = self.calc_state()
        self.potential = self.calc_potential()
        return state
