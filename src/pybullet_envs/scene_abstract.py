"""Where robots of environments move: a world's gravity and steps, and what stands in it."""

from __future__ import annotations

from typing import Any

_SOLVER_ITERATIONS = 5
_CONTACT_ERP = 0.9


class World:
    """Gravity and steps of a connection.

    Attributes:
        gravity: Downwards [m/s²].
        timestep: Of the simulation [s].
        frame_skip: Steps of the simulation in one of an environment.
        numSolverIterations: Of the solver.
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
        """Goes on by one step of the environment, whose parts the engine takes by itself."""
        self._p.stepSimulation()


class Scene:
    """A world and what stands in it; subclasses put something there in `episode_restart`.

    Attributes:
        timestep: Of the simulation [s].
        frame_skip: Steps of the simulation in one of the environment.
        dt: Time that a step of the environment takes [s].
        cpp_world: The world.
        multiplayer: Whether several robots share it.
    """

    multiplayer = False

    def __init__(self, bullet_client: Any, gravity: float, timestep: float, frame_skip: int) -> None:
        """Sets up the world.

        Args:
            bullet_client: The connection.
            gravity: Downwards [m/s²].
            timestep: Of the simulation [s].
            frame_skip: Steps of the simulation in one of the environment.
        """
        self._p = bullet_client
        self.timestep = timestep
        self.frame_skip = frame_skip
        self.dt = timestep * frame_skip
        self.cpp_world = World(bullet_client, gravity, timestep, frame_skip)

    def actor_introduce(self, robot: Any) -> None:
        """Is told of each robot when its episode begins."""

    def episode_restart(self, bullet_client: Any) -> None:
        """Begins an episode."""
        self.cpp_world.clean_everything()

    def global_step(self) -> None:
        """Goes on by one step of the environment."""
        self.cpp_world.step(self.frame_skip)


class SingleRobotEmptyScene(Scene):
    """Nothing but one robot."""
