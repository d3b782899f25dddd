"""Directional light."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from carom.description.pose import Vector3


@dataclass(frozen=True, slots=True)
class Light:
    """How a scene is lit. The defaults are PyBullet's.

    Attributes:
        direction: Towards the light, world axes; of any length but 0.
        colour: Red, green and blue of the directional light.
        distance: From the origin of the world to the lamp that casts the shadows [m]; infinite for parallel
            light.
        ambient: Ambient share of a surface's colour, visible without light.
        diffuse: Diffuse share: the more a surface faces the light, the brighter it is.
        specular: Strength of highlights.
        shadow: Whether shapes cast shadows.
        shade: Factor on the directional light in a shadow.

    Raises:
        ValueError: The direction has length 0, or a number is NaN or, but for the distance, infinite.
    """

    direction: Vector3 = (-50.0, 30.0, 100.0)
    colour: Vector3 = (1.0, 1.0, 1.0)
    distance: float = 2.0
    ambient: float = 0.6
    diffuse: float = 0.35
    specular: float = 0.05
    shadow: bool = False
    shade: float = 0.8

    def __post_init__(self) -> None:
        numbers = (*self.direction, *self.colour, self.ambient, self.diffuse, self.specular, self.shade)
        if not all(map(isfinite, numbers)) or not self.distance >= 0.0:
            raise ValueError(f"every number of a light must be finite, and the distance at least 0: {self}")
        if not any(self.direction):
            raise ValueError("the direction towards the light has length 0")
