"""The state of a world as flat arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.checks import Array

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore


class FlatState:
    """The state of all bodies of a world as flat arrays: NumPy views of what the engine works on.

    Get it from `World.state`, or from `Worlds.state`, where arrays have the world as their first axis.
    Writing to an array changes the state, without checks. When bodies come or go other arrays may take the
    place of these: read the attribute again.
    """

    __slots__ = ("_world",)

    def __init__(self, world: WorldCore) -> None:
        self._world = world

    def __repr__(self) -> str:
        return f"<FlatState of {self._world!r}: {len(self.position)} coordinates>"

    @property
    def position(self) -> Array:
        """Coordinates: of each body those of its base, then those of its joints [rad or m].

        Those of the base are position [m] and quaternion (x, y, z, w) of its inertial frame.
        """
        return self._world.position[: self._used("position")]

    @property
    def velocity(self) -> Array:
        """Velocities: of each body those of its base, then those of its joints [rad/s or m/s].

        Those of the base are angular [rad/s], then linear [m/s], in world axes.
        """
        return self._world.velocity[: self._used("dof")]

    @property
    def joint_torque(self) -> Array:
        """Torques [N m] or forces [N] of users on joints in the next step, as `velocity`."""
        return self._world.joint_torque[: self._used("dof")]

    @property
    def motor_impulse(self) -> Array:
        """Impulses of motors in the last substep [N m s or N s], as `velocity`."""
        return self._world.motor_impulse[: self._used("dof")]

    @property
    def link_pose(self) -> Array:
        """World poses of the inertial frames, those of bases included, (links, 7)."""
        return self._world.link_pose[: self._used("link")]

    @property
    def link_velocity(self) -> Array:
        """Linear [m/s] and angular [rad/s] velocities of links in world axes, (links, 6)."""
        return self._world.link_velocity[: self._used("link")]

    @property
    def link_force(self) -> Array:
        """Forces [N] and torques [N m] of users on links in the next step, in world axes, (links, 6)."""
        return self._world.link_force[: self._used("link")]

    @property
    def joint_reaction(self) -> Array:
        """Reactions of joints whose sensors are enabled, (links, 6)."""
        return self._world.joint_reaction[: self._used("link")]

    def _used(self, axis: str) -> int:
        """Number of rows that belong to bodies; behind them there is room for more."""
        return self._world.arrays.used[axis]
