"""The views of a script's cameras, which pages can take."""

from __future__ import annotations

from threading import Lock
from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from carom.native.uninterrupted import uninterrupted
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

# Most cameras that pages list: a lens that changes all the time would make a new one with each image.
_MOST = 16
# Minimum interval between two views of one camera [s].
_PERIOD = 1 / 60
# How long an update waits for a step to end; it is then left to the next frame [s].
_PATIENCE = 0.005

_Lens = tuple[int, int, bytes]


class Mount(Protocol):
    """The link that a camera is mounted on."""

    @property
    def body(self) -> BodyCore:
        """The body that the link belongs to."""
        ...


class ViewedCamera(Protocol):
    """What the viewer needs of a camera; `carom.camera.Camera` describes it."""

    @property
    def link(self) -> Mount | None:
        """The link that it is mounted on; None if it stands in the world."""
        ...

    @property
    def width(self) -> int:
        """Columns of its images."""
        ...

    @property
    def height(self) -> int:
        """Rows of its images."""
        ...

    @property
    def view(self) -> NDArray[np.float64]:
        """(4, 4) from the world to the eye, as in OpenGL."""
        ...

    @property
    def projection(self) -> NDArray[np.float64]:
        """(4, 4) from the eye to clip coordinates."""
        ...


class Lenses:
    """Puts the views and projections of cameras among the latest messages, for pages to look through them.

    Safe to use from all threads. `world_lock` is held while the followed cameras are read.
    """

    def __init__(self, latest: LatestMessages, world_lock: Any) -> None:
        self._latest = latest
        self._world_lock = world_lock
        self._lock = Lock()
        self._numbers: dict[str | _Lens, int] = {}
        self._told: dict[int, tuple[object, ...]] = {}
        self._due: dict[int, float] = {}
        self._followed: dict[str, ViewedCamera] = {}

    def follow(self, name: str, camera: ViewedCamera) -> None:
        """Lists a camera under a name; its view is kept up to date by `update`."""
        self._followed[name] = camera

    def update(self) -> None:
        """Tells pages how the followed cameras see the world now."""
        # A body may be removed meanwhile.
        if not self._followed or not self._world_lock.acquire(timeout=_PATIENCE):
            return
        try:
            for name, camera in list(self._followed.items()):
                body = None if camera.link is None else camera.link.body
                if body is None or body.world.bodies.get(body.id) is body:
                    self._tell(name, name, camera.view, camera.projection, camera.width, camera.height)
        finally:
            self._world_lock.release()

    def saw(
        self, view: NDArray[np.float64], projection: NDArray[np.float64], width: int, height: int
    ) -> None:
        """Notes an image. Images of one size with one projection count as those of one camera.

        Args:
            view: (4, 4) from the world to the eye, as in OpenGL.
            projection: (4, 4) from the eye to clip coordinates.
            width: Columns of the image.
            height: Rows of the image.
        """
        lens = (width, height, projection.tobytes())
        if lens not in self._numbers and len(self._numbers) >= _MOST:
            return
        self._tell(lens, None, view, projection, width, height)

    def _tell(
        self,
        key: str | _Lens,
        name: str | None,
        view: NDArray[np.float64],
        projection: NDArray[np.float64],
        width: int,
        height: int,
    ) -> None:
        with uninterrupted, self._lock:
            number = self._numbers.setdefault(key, len(self._numbers) + 1)
        facts = (view.tobytes(), projection.tobytes(), width, height)
        now = monotonic()
        if self._told.get(number) == facts or now < self._due.get(number, 0.0):
            return
        if not (np.isfinite(view).all() and np.isfinite(projection).all()):
            return
        self._told[number], self._due[number] = facts, now + _PERIOD
        header = to_page.LENS(
            lens=number,
            name=name or f"camera {number}",
            width=width,
            height=height,
            # By columns, as in WebGL.
            view=view.T.ravel().tolist(),
            projection=projection.T.ravel().tolist(),
        )
        self._latest.put(("lens", number), header)
