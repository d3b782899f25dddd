"""Texts attached to bodies, links and visual shapes."""

from __future__ import annotations

from typing import Any

from pybullet._access.texts import c_string, count_of, info_of, number_of, value_of
from pybullet._calls.arguments import integer, sequence
from pybullet._calls.builtin import exported, exported_as
from pybullet._calls.errors import fail, no_body
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import body_of

__all__ = [
    "addUserData",
    "getNumUserData",
    "getUserData",
    "getUserDataId",
    "getUserDataInfo",
    "removeUserData",
    "syncUserData",
]

_NONE = -1


@exported
def addUserData(
    bodyUniqueId: int,
    key: str,
    value: str,
    linkIndex: int = -1,
    visualShapeIndex: int = -1,
    physicsClientId: int = 0,
) -> int:
    """Attaches a text to a body. An existing text with the same place and key is replaced and keeps its id.

    Args:
        bodyUniqueId: The body.
        key: Its name.
        value: The text.
        linkIndex: The link it belongs to; -1 for the base, or the whole body. Need not exist.
        visualShapeIndex: The visual shape of that link; -1 for none. Need not exist.
        physicsClientId: The connection.

    Returns:
        Its id. Ids of removed texts are used again, the last one first.

    Raises:
        pybullet.error: Not connected, or there is no such body.

    Examples:
        >>> data = p.addUserData(cube, "colour", "green")
        >>> p.getUserData(data)
        b'green'
    """
    client = client_of(physicsClientId)
    name, content = c_string(key, "key"), c_string(value, "value")
    link, shape = integer(linkIndex, "linkIndex"), integer(visualShapeIndex, "visualShapeIndex")
    with client.call_lock:
        body = body_of(client, bodyUniqueId, "Error in addUserData command.")
        return client.world.user_data.add(body.id, link, shape, name, content).id


@exported
def getUserData(userDataId: int, physicsClientId: int = 0) -> bytes | None:
    """The text with an id.

    Args:
        userDataId: Its id.
        physicsClientId: The connection.

    Returns:
        The text, as bytes; None if there is no such id.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> data = p.addUserData(cube, "colour", "green")
        >>> p.getUserData(data).decode()
        'green'
    """
    return value_of(client_of(physicsClientId).world.user_data, userDataId)


@exported
def getUserDataId(
    bodyUniqueId: int, key: str, linkIndex: int = -1, visualShapeIndex: int = -1, physicsClientId: int = 0
) -> int:
    """The id of a text.

    Args:
        bodyUniqueId: The body.
        key: Name of the text.
        linkIndex: The link it belongs to; -1 for the base, or the whole body.
        visualShapeIndex: The visual shape it belongs to; -1 for none.
        physicsClientId: The connection.

    Returns:
        Its id, or -1 if there is none.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> data = p.addUserData(cube, "colour", "green")
        >>> p.getUserDataId(cube, "colour") == data
        True
    """
    data = client_of(physicsClientId).world.user_data
    return number_of(data, bodyUniqueId, key, linkIndex, visualShapeIndex)


@exported
def getNumUserData(bodyUniqueId: int, physicsClientId: int = 0) -> int:
    """The number of texts of a body, its links and shapes included.

    Args:
        bodyUniqueId: The body.
        physicsClientId: The connection.

    Returns:
        The number; 0 if there is no such body.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getNumUserData(cube)
        0
    """
    return count_of(client_of(physicsClientId).world.user_data, bodyUniqueId)


@exported
def getUserDataInfo(
    bodyUniqueId: int, userDataIndex: int, physicsClientId: int = 0
) -> tuple[int, bytes, int, int, int]:
    """Name and place of a text.

    Args:
        bodyUniqueId: The body.
        userDataIndex: From 0 to `getNumUserData() - 1`. Removing a text moves the last to its place.
        physicsClientId: The connection.

    Returns:
        (id, key, body, link, visual shape); link and shape are -1 if the text belongs to none.

    Raises:
        pybullet.error: Not connected, or there are not that many texts.

    Examples:
        >>> data = p.addUserData(cube, "colour", "green")
        >>> p.getUserDataInfo(cube, 0)[1]
        b'colour'
    """
    return info_of(client_of(physicsClientId).world.user_data, bodyUniqueId, userDataIndex)


@exported
def removeUserData(userDataId: int, physicsClientId: int = 0) -> None:
    """Removes a text.

    Args:
        userDataId: Its id.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or there is no such id.

    Examples:
        >>> data = p.addUserData(cube, "colour", "green")
        >>> p.removeUserData(data)
        >>> p.getNumUserData(cube)
        0
    """
    client = client_of(physicsClientId)
    number = integer(userDataId, "userDataId")
    with client.call_lock:
        datum = client.world.user_data.get(number)
        if datum is None:
            fail("Error in removeUserData command.", f"There is no user data {number}.")
        client.world.user_data.remove(datum)


@exported_as("(bodyUniqueId=-1, physicsClientId=0, *, bodyUniqueIds=None)")
def syncUserData(bodyUniqueId: Any = -1, physicsClientId: int = 0, *, bodyUniqueIds: Any = None) -> None:
    """Updates the texts that other clients of the same world may have changed.

    A client of a server knows the texts as of the time when it connected, and its own changes since. Without
    other clients texts are always up to date.

    Args:
        bodyUniqueId: The body, or a sequence of bodies; -1 for all.
        physicsClientId: The connection.
        bodyUniqueIds: Several bodies.

    Raises:
        pybullet.error: Not connected, or there is no such body.

    Examples:
        >>> p.syncUserData(arm)
    """
    client = client_of(physicsClientId)
    problem = "Error in syncUserInfo command."
    try:
        number = integer(bodyUniqueId, "bodyUniqueId")
        asked_for = () if number == _NONE else (number,)
    except TypeError:
        asked_for = sequence(bodyUniqueId, problem, "bodyUniqueId")
    if bodyUniqueIds is not None:
        asked_for = sequence(bodyUniqueIds, problem, "bodyUniqueIds")
    for body_id in asked_for:
        if client.body(body_id) is None:
            fail(problem, no_body(body_id))
