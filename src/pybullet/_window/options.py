"""The camera of the window, and the options of `configureDebugVisualizer`."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot

from carom.description.pose import Vector3
from carom.description.transform import subtracted
from pybullet._maths.camera_maths import Y_UP, Z_UP, cross, frustum, look_at, orbit, unit

_NEAR, _FAR = 0.01, 1000.0
# Length of the image's edges as `getDebugVisualizerCamera` reports them, for rays through its pixels.
_RAY_PLANE = 20000.0


@dataclass(slots=True)
class DebugCamera:
    """The camera of the window, which orbits a target [m]; angles in degrees, image size in pixels."""

    width: int = 0
    height: int = 0
    distance: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    target: Vector3 = (0.0, 0.0, 0.0)
    up_axis: int = Z_UP

    def info(self) -> tuple[int | float | tuple[float, ...], ...]:
        """The 12 fields of `getDebugVisualizerCamera`."""
        aspect = self.width / self.height
        eye, _ = orbit(self.target, self.distance, self.yaw, self.pitch, 0.0, self.up_axis)
        up = (0.0, 1.0, 0.0) if self.up_axis == Y_UP else (0.0, 0.0, 1.0)
        forward = unit(subtracted(self.target, eye)) or (1.0, 0.0, 0.0)
        # When it looks straight up or down, any horizontal direction will do.
        right = unit(cross(forward, up)) or (1.0, 0.0, 0.0)
        upward = cross(right, forward)
        return (
            self.width,
            self.height,
            look_at(eye, self.target, up) or look_at(eye, self.target, upward) or (0.0,) * 16,
            frustum(-aspect * _NEAR, aspect * _NEAR, -_NEAR, _NEAR, _NEAR, _FAR),
            up,
            forward,
            _scaled(right, _RAY_PLANE * aspect),
            _scaled(upward, _RAY_PLANE / hypot(*upward)),
            self.yaw,
            self.pitch,
            self.distance,
            self.target,
        )


@dataclass(slots=True)
class VisualizerOptions:
    """The options of `configureDebugVisualizer`; None if not set.

    Attributes:
        flags: Whether a flag is on, by its `COV_*` number.
    """

    flags: dict[int, bool] = field(default_factory=dict)
    light_position: Vector3 | None = None
    shadow_map_resolution: int | None = None
    shadow_map_world_size: int | None = None
    shadow_map_intensity: float | None = None
    remote_sync_transform_interval: float | None = None
    background: Vector3 | None = None


def _scaled(v: Vector3, factor: float) -> Vector3:
    return (v[0] * factor, v[1] * factor, v[2] * factor)
