"""Light that comes from far away in one direction."""

from __future__ import annotations

from dataclasses import dataclass

from carom.description.pose import Vector3


@dataclass(frozen=True, slots=True)
class Light:
    """How a scene is lit. The defaults are PyBullet's.

    Attributes:
        direction: Towards the light, world axes; of any length but 0.
        colour: Red, green and blue of the directed light.
        distance: From the origin of the world to the lamp that casts the shadows [m]; infinite for parallel
            light.
        ambient: Share of a surface's colour that is seen without any light.
        diffuse: Share that is seen more the more it faces the light.
        specular: Strength of highlights.
        shadow: Things cast shadows.
        shade: What remains of the directed light in a shadow.
    """

    direction: Vector3 = (-50.0, 30.0, 100.0)
    colour: Vector3 = (1.0, 1.0, 1.0)
    distance: float = 2.0
    ambient: float = 0.6
    diffuse: float = 0.35
    specular: float = 0.05
    shadow: bool = False
    shade: float = 0.8
