"""Debug drawing in the window: lines, texts, points, colours."""

from __future__ import annotations

from collections.abc import Iterable

from carom.description.pose import Vector3
from pybullet._calls.arguments import Vector, integer, real, rotation, sequence, text, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._calls.optional_vectors import optional_vector3
from pybullet._clients.clients import client_of

__all__ = [
    "addUserDebugLine",
    "addUserDebugPoints",
    "addUserDebugText",
    "removeAllUserDebugItems",
    "removeUserDebugItem",
    "setDebugObjectColor",
]


_WHITE = (1.0, 1.0, 1.0)


@exported
def addUserDebugLine(
    lineFromXYZ: Vector,
    lineToXYZ: Vector,
    lineColorRGB: Vector | None = None,
    lineWidth: float = 1,
    lifeTime: float = 0,
    parentObjectUniqueId: int = -1,
    parentLinkIndex: int = -1,
    replaceItemUniqueId: int = -1,
    physicsClientId: int = 0,
) -> int:
    """Draws a line.

    Args:
        lineFromXYZ: Start point [m].
        lineToXYZ: End point [m].
        lineColorRGB: Red, green and blue from 0 to 1; white by default.
        lineWidth: In pixels.
        lifeTime: Life time [s]; 0 for ever.
        parentObjectUniqueId: Body to draw it on: the points are then in the frame of its link.
        parentLinkIndex: That link, from 0; -1 for the base.
        replaceItemUniqueId: Item that it replaces.
        physicsClientId: The connection.

    Returns:
        The id of the item; -1 in `DIRECT`.

    Raises:
        pybullet.error: Not connected, a point is not three finite numbers, or a number is not finite.

    Examples:
        >>> line = p.addUserDebugLine([0, 0, 0], [1, 0, 0], lineColorRGB=[1, 0, 0], lineWidth=3)
    """
    from carom.viewer.items import DebugLine

    client = client_of(physicsClientId)
    line = DebugLine(
        start=vector3(lineFromXYZ, "Error converting lineFrom[3]", "lineFromXYZ"),
        end=vector3(lineToXYZ, "Error converting lineTo[3]", "lineToXYZ"),
        colour=optional_vector3(lineColorRGB, "Error converting lineColorRGB[3]", "lineColorRGB") or _WHITE,
        width=real(lineWidth, "lineWidth"),
        life_time=real(lifeTime, "lifeTime"),
        parent_body=integer(parentObjectUniqueId, "parentObjectUniqueId"),
        parent_link=integer(parentLinkIndex, "parentLinkIndex"),
    )
    return client.window.draw(line, integer(replaceItemUniqueId, "replaceItemUniqueId"))


@exported
def addUserDebugText(
    text: str,
    textPosition: Vector,
    textColorRGB: Vector | None = None,
    textSize: float = 1,
    lifeTime: float = 0,
    textOrientation: Vector | None = None,
    parentObjectUniqueId: int = -1,
    parentLinkIndex: int = -1,
    replaceItemUniqueId: int = -1,
    physicsClientId: int = 0,
) -> int:
    """Writes text into the scene.

    Args:
        text: The text.
        textPosition: Position of the text [m].
        textColorRGB: Red, green and blue from 0 to 1; white by default.
        textSize: Height of the letters.
        lifeTime: Life time [s]; 0 for ever.
        textOrientation: Quaternion (x, y, z, w); without one the text faces the camera.
        parentObjectUniqueId: Body to write it on: the position is then in the frame of its link.
        parentLinkIndex: That link, from 0; -1 for the base.
        replaceItemUniqueId: Item that it replaces.
        physicsClientId: The connection.

    Returns:
        The id of the item; -1 in `DIRECT`.

    Raises:
        pybullet.error: Not connected, an argument is not three, or four, finite numbers, or a number is
            not finite.

    Examples:
        >>> label = p.addUserDebugText("goal", [0, 0, 1], textColorRGB=[1, 0, 0])
    """
    from carom.viewer.items import DebugText

    client = client_of(physicsClientId)
    orientation = None
    if textOrientation is not None:
        orientation = rotation(textOrientation, "Error converting textOrientation[4]", "textOrientation")
    item = DebugText(
        text=_text(text, "text"),
        position=vector3(textPosition, "Error converting textPositionObj[3]", "textPosition"),
        colour=_colour(textColorRGB, "Error converting textColorRGBObj[3]", "textColorRGB"),
        size=real(textSize, "textSize"),
        life_time=real(lifeTime, "lifeTime"),
        orientation=orientation,
        parent_body=integer(parentObjectUniqueId, "parentObjectUniqueId"),
        parent_link=integer(parentLinkIndex, "parentLinkIndex"),
    )
    return client.window.draw(item, integer(replaceItemUniqueId, "replaceItemUniqueId"))


@exported
def addUserDebugPoints(
    pointPositions: Iterable[Vector],
    pointColorsRGB: Iterable[Vector],
    pointSize: float = 1,
    lifeTime: float = 0,
    parentObjectUniqueId: int = -1,
    parentLinkIndex: int = -1,
    replaceItemUniqueId: int = -1,
    physicsClientId: int = 0,
) -> int:
    """Draws a cloud of points.

    Args:
        pointPositions: Positions of the points [m].
        pointColorsRGB: A colour for each: red, green and blue from 0 to 1.
        pointSize: In pixels.
        lifeTime: Life time [s]; 0 for ever.
        parentObjectUniqueId: Body to draw them on: the points are then in the frame of its link.
        parentLinkIndex: That link, from 0; -1 for the base.
        replaceItemUniqueId: Item that they replace.
        physicsClientId: The connection.

    Returns:
        The id of the item; -1 in `DIRECT`.

    Raises:
        pybullet.error: Not connected, there are no points, there are not as many colours as points, an
            entry is not three finite numbers, or a number is not finite.

    Examples:
        >>> points = p.addUserDebugPoints([[0, 0, 1], [0, 1, 1]], [[1, 0, 0], [0, 1, 0]], pointSize=5)
    """
    from carom.viewer.items import DebugPoints

    client = client_of(physicsClientId)
    positions = _vectors(pointPositions, "pointPositions")
    colours = _vectors(pointColorsRGB, "pointColorsRGB")
    if not positions:
        fail("pointPositions needs at least one point.")
    if len(colours) != len(positions):
        fail(
            "numColors must match numPositions.",
            f"There are {len(positions)} points and {len(colours)} colours.",
        )
    points = DebugPoints(
        positions=positions,
        colours=colours,
        size=real(pointSize, "pointSize"),
        life_time=real(lifeTime, "lifeTime"),
        parent_body=integer(parentObjectUniqueId, "parentObjectUniqueId"),
        parent_link=integer(parentLinkIndex, "parentLinkIndex"),
    )
    return client.window.draw(points, integer(replaceItemUniqueId, "replaceItemUniqueId"))


@exported
def removeUserDebugItem(itemUniqueId: int, physicsClientId: int = 0) -> None:
    """Removes a line, text, cloud of points, slider or button. One that does not exist is no error.

    Args:
        itemUniqueId: The item.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> line = p.addUserDebugLine([0, 0, 0], [1, 0, 0])
        >>> p.removeUserDebugItem(line)
    """
    client_of(physicsClientId).window.remove(integer(itemUniqueId, "itemUniqueId"))


@exported
def removeAllUserDebugItems(physicsClientId: int = 0) -> None:
    """Removes all lines, texts and points, but not sliders and buttons.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.removeAllUserDebugItems()
    """
    client_of(physicsClientId).window.remove_drawings()


@exported
def setDebugObjectColor(
    objectUniqueId: int, linkIndex: int, objectDebugColorRGB: Vector | None = None, physicsClientId: int = 0
) -> None:
    """Colours a link in wireframe drawings.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        objectDebugColorRGB: Red, green and blue from 0 to 1; without it the link gets its own colour again.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the colour is not three finite numbers.

    Examples:
        >>> p.setDebugObjectColor(cube, -1, [1, 0, 0])
    """
    client = client_of(physicsClientId)
    problem = "Error converting objectDebugColorRGB[3]"
    colour = optional_vector3(objectDebugColorRGB, problem, "objectDebugColorRGB")
    client.window.colour_link(
        integer(objectUniqueId, "objectUniqueId"), integer(linkIndex, "linkIndex"), colour
    )


# In `addUserDebugText`, PyBullet's parameter `text` hides the function `text`.
_text = text


def _colour(values: Vector | None, problem: str, name: str) -> Vector3:
    return _WHITE if values is None else vector3(values, problem, name)


def _vectors(values: Iterable[Vector], name: str) -> tuple[Vector3, ...]:
    items = sequence(values, "expected a sequence of vertex positions", name)
    return tuple(vector3(item, f"{name} needs 3 numbers for each point.", name) for item in items)
