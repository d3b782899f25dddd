"""Scenes in a stadium."""

from __future__ import annotations

import os
from typing import Any

import pybullet_data
from pybullet_envs.scene_abstract import Scene


class StadiumScene(Scene):
    """A field of grass.

    Attributes:
        stadium_halflen: Half the length of the field [m].
        stadium_halfwidth: Half the width of the field [m].
        ground_plane_mjcf: Ids of the bodies of the field, once the first episode has begun.
    """

    stadium_halflen = 105 * 0.25
    stadium_halfwidth = 50 * 0.25
    ground_plane_mjcf: tuple[int, ...] = ()

    def episode_restart(self, bullet_client: Any) -> None:
        """Begins an episode; loads the field before the first one."""
        self._p = bullet_client
        super().episode_restart(bullet_client)
        if self.ground_plane_mjcf:
            return
        file = os.path.join(pybullet_data.getDataPath(), "plane_stadium.sdf")
        self.ground_plane_mjcf = bullet_client.loadSDF(file)
        for body in self.ground_plane_mjcf:
            bullet_client.changeDynamics(body, -1, lateralFriction=0.8, restitution=0.5)


class SinglePlayerStadiumScene(StadiumScene):
    """A stadium for one robot."""


class MultiplayerStadiumScene(StadiumScene):
    """A stadium for three robots, each on a lane of its own."""

    multiplayer = True
    players_count = 3

    def actor_introduce(self, robot: Any) -> None:
        """Moves a robot sideways, onto the lane of its `player_n`."""
        super().actor_introduce(robot)
        robot.move_robot(0, robot.player_n - 1, 0)
