"""What the camera of a window sees; without a window, PyBullet's default camera."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pybullet._maths.camera_maths import Z_UP, Matrix16, look_at, orbit, window_lens

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from pybullet._clients.clients import Client


def square(columns: Sequence[float]) -> NDArray[np.float64]:
    """4 x 4 matrix from 16 numbers, column after column."""
    import numpy as np

    return np.array(columns).reshape(4, 4).T


def view_of_window(client: Client) -> NDArray[np.float64]:
    """View matrix of the window's camera; without a window that of PyBullet's default camera."""
    width, _, view = client.window.camera_info()[:3]
    if width and isinstance(view, tuple):
        return square(view)
    target = (0.0, 0.0, 0.0)
    eye, up = orbit(target, 1.5, -80.0, -10.0, 0.0, Z_UP)
    default: Matrix16 | None = look_at(eye, target, up)
    assert default is not None
    return square(default)


def projection_of_window(client: Client) -> NDArray[np.float64]:
    """Projection matrix of the window's camera; without a window that of PyBullet's default camera."""
    width, _, _, projection = client.window.camera_info()[:4]
    if width and isinstance(projection, tuple):
        return square(projection)
    return square(window_lens(4.0 / 3.0))
