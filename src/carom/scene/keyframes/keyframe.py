"""A keyframe of several bodies, as a handle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.keyframe import BodyKeyframe
from carom.scene.keyframes.changes import reset
from carom.scene.keyframes.state import keyframe_of

if TYPE_CHECKING:
    from carom.scene.body import Body


class Keyframe:
    """A state of the bodies of a scene that have a keyframe of this name.

    Attributes:
        name: Its name.
        bodies: The bodies.
    """

    def __init__(self, name: str, bodies: Sequence[Body]) -> None:
        self.name: str = name
        self.bodies: list[Body] = list(bodies)

    def __repr__(self) -> str:
        return f"<Keyframe {self.name!r} of {', '.join(repr(body.name) for body in self.bodies)}>"

    def of(self, body: Body) -> BodyKeyframe:
        """The state of one body.

        Raises:
            KeyError: It has no keyframe of this name.
        """
        return keyframe_of(body, self.name)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.of(self.bodies[0]).time

    @property
    def positions(self) -> Array:
        """Positions of the movable joints of all bodies, one after the other; NaN where they are not set."""
        return self._all("positions", "position", np.nan)

    @property
    def velocities(self) -> Array:
        """Their velocities."""
        return self._all("velocities", "velocity", 0.0)

    @property
    def controls(self) -> Array:
        """Controls of the actuators of all bodies."""
        return self._all("controls", "actuator", 0.0)

    @property
    def activations(self) -> Array:
        """Their activations."""
        return self._all("activations", "actuator", 0.0)

    def reset(self) -> None:
        """Reset the bodies to this state, and the time of their world to that of the keyframe."""
        reset(self.bodies, self.name, with_time=True)

    def _all(self, field: str, kind: str, unset: float) -> Array:
        parts: list[float] = []
        for body in self.bodies:
            counts = {
                "position": sum(body.position_count),
                "velocity": sum(body.velocity_count),
                "actuator": len(body.spec.actuators),
            }
            values = getattr(self.of(body), field)
            parts += [unset] * counts[kind] if values is None else values
        return np.array(parts)


def keyframes_of(bodies: Sequence[Body]) -> dict[str, Keyframe]:
    """The keyframes of bodies, by name."""
    names = dict.fromkeys(keyframe.name for body in bodies for keyframe in body.spec.keyframes)
    return {
        name: Keyframe(name, [body for body in bodies if any(it.name == name for it in body.spec.keyframes)])
        for name in names
    }
