"""Scenes of environments: the gravity and time step of a world, and the bodies in it."""

from __future__ import annotations

from typing import Any

_SOLVER_ITERATIONS = 5
_CONTACT_ERP = 0.9


class World:
    """Gravity and time step of a connection.

    Attributes:
        gravity: Downward acceleration [m/s²].
        timestep: Time step of the simulation [s].
        frame_skip: Number of simulation steps per environment step.
        numSolverIterations: Number of solver iterations.
    """

    def __init__(self, bullet_client: Any, gravity: float, timestep: float, frame_skip: int) -> None:
        self._p = bullet_client
        self.gravity = gravity
        self.timestep = timestep
        self.frame_skip = frame_skip
        self.numSolverIterations = _SOLVER_ITERATIONS
        self.clean_everything()

    def clean_everything(self) -> None:
        """Sets the parameters of the engine; bodies stay."""
        self._p.setGravity(0, 0, -self.gravity)
        self._p.setDefaultContactERP(_CONTACT_ERP)
        self._p.setPhysicsEngineParameter(
            fixedTimeStep=self.timestep * self.frame_skip,
            numSolverIterations=self.numSolverIterations,
            numSubSteps=self.frame_skip,
        )

    def step(self, frame_skip: int) -> None:
        """Advances by one environment step; the engine itself divides it into substeps."""
        self._p.stepSimulation()


class Scene:
    """A world and the bodies in it; subclasses load them in `episode_restart`.

    Attributes:
        timestep: Time step of the simulation [s].
        frame_skip: Number of simulation steps per environment step.
        dt: Duration of an environment step [s].
        cpp_world: The world.
        multiplayer: Whether several robots share the scene.
        multiplayer_robots: These robots, by their `player_n`.
    """

    multiplayer = False

    def __init__(self, bullet_client: Any, gravity: float, timestep: float, frame_skip: int) -> None:
        """Sets up the world.

        Args:
            bullet_client: The connection.
            gravity: Downward acceleration [m/s²].
            timestep: Time step of the simulation [s].
            frame_skip: Number of simulation steps per environment step.
        """
        self._p = bullet_client
        self.timestep = timestep
        self.frame_skip = frame_skip
        self.dt = timestep * frame_skip
        self.cpp_world = World(bullet_client, gravity, timestep, frame_skip)
        self.multiplayer_robots: dict[int, Any] = {}
        self.test_window_still_open = True
        self.human_render_detected = False

    def test_window(self) -> bool:
        """Notes that somebody looks at the scene; whether the window is open still."""
        self.human_render_detected = True
        return self.test_window_still_open

    def actor_introduce(self, robot: Any) -> None:
        """Called by each robot when its episode begins; notes those that share the scene."""
        if self.multiplayer:
            self.multiplayer_robots[robot.player_n] = robot

    def actor_is_active(self, robot: Any) -> bool:
        """Whether a robot is alone in the scene."""
        return not self.multiplayer

    def episode_restart(self, bullet_client: Any) -> None:
        """Begins an episode."""
        self.cpp_world.clean_everything()

    def global_step(self) -> None:
        """Advances by one environment step."""
        self.cpp_world.step(self.frame_skip)


class SingleRobotEmptyScene(Scene):
    """A scene with nothing but one robot."""
