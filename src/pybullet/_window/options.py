"""The camera of the window, and the options of `configureDebugVisualizer`."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.description.transform import subtracted
from pybullet._maths.camera_maths import Y_UP, cross, look_at, orbit, unit, window_lens

if TYPE_CHECKING:
    from carom.viewer.camera import Orbit

# Length of the image's edges as `getDebugVisualizerCamera` reports them, for rays through its pixels.
_RAY_PLANE = 20000.0


def camera_info(camera: Orbit, up_axis: int) -> tuple[int | float | tuple[float, ...], ...]:
    """The 12 fields of `getDebugVisualizerCamera`; `up_axis` is the upward axis: 1 for y, 2 for z."""
    aspect = camera.width / camera.height
    eye, _ = orbit(camera.target, camera.distance, camera.yaw, camera.pitch, 0.0, up_axis)
    up = (0.0, 1.0, 0.0) if up_axis == Y_UP else (0.0, 0.0, 1.0)
    forward = unit(subtracted(camera.target, eye)) or (1.0, 0.0, 0.0)
    # When it looks straight up or down, any horizontal direction will do.
    right = unit(cross(forward, up)) or (1.0, 0.0, 0.0)
    upward = cross(right, forward)
    return (
        camera.width,
        camera.height,
        look_at(eye, camera.target, up) or look_at(eye, camera.target, upward) or (0.0,) * 16,
        window_lens(aspect),
        up,
        forward,
        _scaled(right, _RAY_PLANE * aspect),
        _scaled(upward, _RAY_PLANE / hypot(*upward)),
        camera.yaw,
        camera.pitch,
        camera.distance,
        camera.target,
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
