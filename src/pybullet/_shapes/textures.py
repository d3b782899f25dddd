"""The appearance of shapes: colours and textures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.errors import DescriptionError
from pybullet._calls.arguments import MAX_ITEMS, Vector, integer, text
from pybullet._calls.builtin import exported
from pybullet._calls.constants import VISUAL_SHAPE_DOUBLE_SIDED
from pybullet._calls.errors import fail, logger
from pybullet._calls.nested import nested
from pybullet._calls.optional_vectors import optional_vector3, optional_vector4
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import link_or_warning
from pybullet._shapes.shape_arguments import find_file

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["changeTexture", "changeVisualShape", "loadTexture", "resetVisualShapeData"]

_CANNOT_LOAD = "Error loading texture"
_CANNOT_CHANGE = "Error resetting visual shape info"
_CANNOT_REPLACE = "Error processing changeTexture."
_BAD_TEXTURE = "Error: invalid arguments in changeTexture."
_UNCHANGED, _NO_TEXTURE = -2, -1


@exported
def loadTexture(textureFilename: str, physicsClientId: int = 0) -> int:
    """Loads an image as a texture for `changeVisualShape`.

    `resetSimulation` removes it.

    Args:
        textureFilename: A PNG, JPEG, TGA or BMP file: as given, in `data` folders near the working
            directory, or in the directory of `setAdditionalSearchPath`.
        physicsClientId: The connection.

    Returns:
        Its texture id.

    Raises:
        pybullet.error: Not connected, or the file is missing or broken.

    Examples:
        >>> texture = p.loadTexture("checker_blue.png")
        >>> p.changeVisualShape(cube, -1, textureUniqueId=texture)
    """
    client = client_of(physicsClientId)
    name = text(textureFilename, "textureFilename")

    from carom.render.appearance import appearance_of
    from carom.render.images import read_image

    path = find_file(client, name, _CANNOT_LOAD)
    try:
        image = read_image(path)
    except DescriptionError as problem:
        fail(_CANNOT_LOAD, str(problem))
    with client.call_lock:
        return appearance_of(client.world).add_texture(image, list(client.world.bodies.values()))


@exported
def changeTexture(
    textureUniqueId: int, pixels: Any, width: int, height: int, physicsClientId: int = 0
) -> None:
    """Replaces the image of a texture, on all shapes that have it.

    Args:
        textureUniqueId: The texture.
        pixels: Red, green and blue from 0 to 255 of each pixel, the top row first, one after the other:
            bytes, a list, a tuple or an array.
        width: Number of columns.
        height: Number of rows.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such texture, or `pixels` has fewer than 3 * width * height
            numbers or a number that is not a whole number from 0 to 255.

    Examples:
        >>> texture = p.loadTexture("checker_blue.png")
        >>> p.changeTexture(texture, [255, 0, 0] * 4, 2, 2)
    """
    client = client_of(physicsClientId)
    number = integer(textureUniqueId, "textureUniqueId")
    columns, rows = integer(width, "width"), integer(height, "height")

    from carom.render.appearance import appearance_of

    if number < 0 or columns < 1 or rows < 1:
        fail(_BAD_TEXTURE, f"Texture {number} cannot have {columns} x {rows} pixels.")
    image = _pixels(pixels, columns, rows)
    with client.call_lock:
        textures = appearance_of(client.world).textures
        if number not in textures:
            fail(_CANNOT_REPLACE, f"There is no texture {number}.")
        textures.replace(number, image)


@exported
def changeVisualShape(
    objectUniqueId: int,
    linkIndex: int,
    shapeIndex: int = -1,
    textureUniqueId: int = -2,
    rgbaColor: Vector | None = None,
    specularColor: Vector | None = None,
    flags: int = -1,
    physicsClientId: int = 0,
) -> None:
    """Changes the colour or texture of a link. A body, link or shape that does not exist is no error.

    A colour of the wrong length becomes white, as in PyBullet, with a warning.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        shapeIndex: Index of the visual shape, from 0; -1 for all.
        textureUniqueId: The new texture; -1 for none, -2: no change.
        rgbaColor: The new colour (red, green, blue, alpha), each from 0 to 1; it multiplies the texture.
            Alpha 0 hides the shape from cameras.
        specularColor: Colour of its highlights, in a window.
        flags: `VISUAL_SHAPE_DOUBLE_SIDED` draws back faces as well, 0 does not; -1: no change.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such texture, or a colour is not four, or three, finite
            numbers.

    Examples:
        >>> p.changeVisualShape(cube, -1, rgbaColor=[1, 0, 0, 1])
        >>> p.getVisualShapeData(cube)[0][7]
        (1.0, 0.0, 0.0, 1.0)
    """
    client = client_of(physicsClientId)
    shape, texture = integer(shapeIndex, "shapeIndex"), integer(textureUniqueId, "textureUniqueId")
    bits = integer(flags, "flags")
    colour = highlight = None
    if rgbaColor is not None:
        colour = optional_vector4(rgbaColor, _CANNOT_CHANGE, "rgbaColor") or (1.0, 1.0, 1.0, 1.0)
    if specularColor is not None:
        highlight = optional_vector3(specularColor, _CANNOT_CHANGE, "specularColor") or (1.0, 1.0, 1.0)
    found = link_or_warning(client, objectUniqueId, linkIndex, "changeVisualShape")
    if found is None:
        return
    body, link = found

    from carom.render.appearance import appearance_of

    with client.call_lock:
        appearance = appearance_of(client.world)
        count = len(appearance.shapes(body, link))
        if shape >= count:
            logger.warning("changeVisualShape: link %d has %d shapes, so no shape %d.", link, count, shape)
            return
        if texture > _NO_TEXTURE and texture not in appearance.textures:
            fail(_CANNOT_CHANGE, f"There is no texture {texture}.")
        appearance.change(
            body,
            link,
            shape if shape >= 0 else None,
            rgba=colour,
            specular=highlight,
            texture=texture if texture > _UNCHANGED else None,
            two_sided=None if bits < 0 else bool(bits & VISUAL_SHAPE_DOUBLE_SIDED),
        )


@exported
def resetVisualShapeData(
    objectUniqueId: int,
    linkIndex: int,
    shapeIndex: int = -1,
    textureUniqueId: int = -2,
    rgbaColor: Vector | None = None,
    specularColor: Vector | None = None,
    flags: int = -1,
    physicsClientId: int = 0,
) -> None:
    """The old name of `changeVisualShape`.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        shapeIndex: Index of the visual shape, from 0; -1 for all.
        textureUniqueId: From `loadTexture`; -1 removes the texture, -2: no change.
        rgbaColor: Red, green, blue, opacity, each from 0 to 1.
        specularColor: Red, green, blue of highlights, each from 0 to 1.
        flags: `VISUAL_SHAPE_DOUBLE_SIDED`, or 0; -1: no change.
        physicsClientId: The connection.

    Raises:
        pybullet.error: As `changeVisualShape` does.

    Examples:
        >>> p.resetVisualShapeData(cube, -1, rgbaColor=[0, 1, 0, 1])
        >>> p.getVisualShapeData(cube)[0][7]
        (0.0, 1.0, 0.0, 1.0)
    """
    changeVisualShape(**locals())


def _pixels(values: Any, columns: int, rows: int) -> NDArray[np.uint8]:
    import numpy as np

    if isinstance(values, (bytes, bytearray, memoryview)):
        flat = np.frombuffer(values, dtype=np.uint8)
    else:
        most = max(4 * columns * rows, MAX_ITEMS)
        try:
            flat = np.asarray(nested(values, _BAD_TEXTURE, "pixels", most))
        except ValueError as problem:
            fail(_BAD_TEXTURE, f"pixels: {problem}.")
        flat = flat.reshape(-1)
    if len(flat) < 3 * columns * rows:
        fail(_BAD_TEXTURE, f"pixels has {len(flat)} numbers instead of {3 * columns * rows}.")
    flat = flat[: 3 * columns * rows]
    if flat.dtype.kind not in "iub" or flat.min() < 0 or flat.max() > 255:
        fail(_BAD_TEXTURE, "pixels has to hold whole numbers from 0 to 255.")
    return flat.astype(np.uint8).reshape(rows, columns, 3)
