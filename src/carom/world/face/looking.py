"""How a world looks: colours and textures of its shapes, the window that shows it, and recordings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array, finite
from carom.native.gates import gated
from carom.scene.populated import Populated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from carom.render.appearance import Appearance
    from carom.render.images import Texels
    from carom.scene.body import Body
    from carom.scene.core.restorable import Restorable
    from carom.viewer.many.viewed import ViewedWorlds
    from carom.viewer.replay.recorder import ReplayRecorder
    from carom.viewer.viewer import Viewer


class Looking(Populated):
    """What a world looks like: windows and recordings of it, colours and textures of its shapes."""

    def view(
        self,
        *,
        speed: float | None = 1.0,
        title: str = "Carom",
        port: int | None = None,
        host: str = "127.0.0.1",
    ) -> Viewer:
        """Open a window on the world: a page in the browser, which shows each step.

        It prints where it is. Where there is no display, as over SSH, open that address elsewhere.

        Args:
            speed: Simulated time / real time, which steps wait for; None for as fast as they go.
            title: Title of the page.
            port: Port to listen on; None for any.
            host: Address to listen on; by default only for this machine.

        Returns:
            The window: `is_open`, `camera`, `drawings`, sliders, keys, `close()`. In a notebook the last line
            of a cell shows it.

        Raises:
            OSError: It cannot listen on the address.
        """
        return window(self, speed, title=title, port=port, host=host)

    def _repr_html_(self) -> str:
        from carom.scene.html_tables import world_table

        return world_table(self)

    def record(
        self,
        path: str | Path,
        *,
        fps: float = 60.0,
        title: str | None = None,
        contacts: bool = True,
        joints: bool = True,
    ) -> ReplayRecorder:
        """Record all steps into one HTML file that replays them, without a server or a network.

            with world.record("fall.html"):
                world.step(480)

        Args:
            path: The file; an existing one is replaced.
            fps: Frames for each second of simulated time.
            title: Title of the page; the name of the file by default.
            contacts: Record contacts and their forces.
            joints: Record positions, velocities and torques of joints.

        Returns:
            A context manager that writes the file when the context is left, as its `stop()` does.

        Raises:
            ValueError: The rate is not positive.
        """
        from carom.viewer.replay.recorder import ReplayRecorder

        return ReplayRecorder(self, path, fps=fps, title=title, contacts=contacts, joints=joints)

    @gated("call_lock")
    def _colour(self, body: Body, link: int, shape: int | None) -> Array:
        """Colour of a link's shape, or of the first that is seen of it; (4,)."""
        looks = self._looks(body, link)
        shown = looks.shown_by(body, link, shape)
        return np.array(looks.shapes(body, link)[shown[0]].rgba if shown else (1.0, 1.0, 1.0, 1.0))

    @gated("call_lock")
    def _set_colour(self, body: Body, link: int, shape: int | None, value: Any) -> None:
        looks, rgba = self._looks(body, link), colour_from(value)
        for look in looks.shown_by(body, link, shape):
            r, g, b, a = rgba.tolist()
            looks.change(body, link, look, rgba=(r, g, b, a))

    @gated("call_lock")
    def _texture(self, body: Body, link: int, shape: int | None) -> NDArray[np.uint8] | None:
        """Texture of a link's shape, or of the first that is seen of it."""
        from carom.render.textures import NO_TEXTURE

        looks = self._looks(body, link)
        shown = looks.shown_by(body, link, shape)
        number = looks.shapes(body, link)[shown[0]].texture if shown else NO_TEXTURE
        return None if number == NO_TEXTURE else looks.textures.image(number).copy()

    @gated("call_lock")
    def _set_texture(self, body: Body, link: int, shape: int | None, value: Any) -> None:
        from carom.render.textures import NO_TEXTURE

        looks, image = self._looks(body, link), texture_from(value)
        number = NO_TEXTURE
        if image is not None:
            number = looks.add_texture(image, [*self.bodies.values()])
        for look in looks.shown_by(body, link, shape):
            looks.change(body, link, look, texture=number)

    def _set_size(self, body: Body, link: int, shape: int, value: ArrayLike) -> None:
        from carom.world.face.sizing import set_size

        set_size(body, link, shape, value)

    def _looks(self, body: Body, link: int) -> Appearance:
        # Most worlds are never looked at.
        from carom.render.appearance import appearance_of

        looks = appearance_of(self)
        # Reads it for the first time.
        looks.shapes(body, link)
        return looks


def window(worlds: Restorable | ViewedWorlds, speed: float | None, **options: Any) -> Viewer:
    """Open a window on a world, or on some of many, and say where it is."""
    # The viewer shows many worlds as well, and is above this.
    import carom

    viewer = carom.viewer.Viewer(worlds, **options)
    if speed is not None:
        viewer.set_speed(speed)
    viewer.announce()
    return viewer


def colour_from(value: Any) -> Array:
    """Red, green, blue and alpha from what users give as a colour, (..., 4).

    Raises:
        ValueError: It has not three or four numbers from 0 to 1.
    """
    numbers = finite(value, "colour")
    if numbers.shape[-1:] not in ((3,), (4,)) or (numbers < 0.0).any() or (numbers > 1.0).any():
        raise ValueError(
            "a colour is red, green and blue from 0 to 1, and alpha if it is not opaque, not "
            f"{value!r}: divide those of 0 to 255 by 255"
        )
    if numbers.shape[-1] == 3:
        numbers = np.concatenate([numbers, np.ones((*numbers.shape[:-1], 1))], axis=-1)
    return numbers


def texture_from(value: Any) -> Texels | None:
    """An image from what users give as a texture: a file, an array (height, width, 3), or None for none.

    Raises:
        ValueError: An array has another shape, or numbers that are not colours.
        carom.errors.DescriptionError: The file cannot be read.
    """
    if value is None:
        return None
    if isinstance(value, str | Path):
        from carom.render.images import read_image

        return read_image(Path(value))
    image = np.asarray(value)
    if image.ndim != 3 or image.shape[-1] != 3 or not image.size:
        raise ValueError(
            f"a texture is an image file, or an array (height, width, 3), not shape {image.shape}"
        )
    if image.dtype != np.uint8:
        if not np.issubdtype(image.dtype, np.floating) or not ((image >= 0.0) & (image <= 1.0)).all():
            raise ValueError("the numbers of a texture are uint8 from 0 to 255, or floats from 0 to 1")
        image = np.rint(255.0 * image).astype(np.uint8)
    return np.ascontiguousarray(image)
