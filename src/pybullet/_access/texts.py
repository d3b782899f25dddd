"""Answers about the texts (user data) of bodies, from those of a world or from the copy of a connection."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import integer, text
from pybullet._calls.errors import fail

if TYPE_CHECKING:
    from carom.scene.user_data import UserData

_NONE = -1


def value_of(data: UserData, user_data_id: Any) -> bytes | None:
    """What `getUserData` returns."""
    datum = data.get(integer(user_data_id, "userDataId"))
    return None if datum is None else datum.value.encode()


def number_of(data: UserData, body: Any, key: Any, link: Any, shape: Any) -> int:
    """What `getUserDataId` returns."""
    datum = data.find(
        integer(body, "bodyUniqueId"),
        integer(link, "linkIndex"),
        integer(shape, "visualShapeIndex"),
        c_string(key, "key"),
    )
    return _NONE if datum is None else datum.id


def count_of(data: UserData, body: Any) -> int:
    """What `getNumUserData` returns."""
    return len(data.of_body(integer(body, "bodyUniqueId")))


def info_of(data: UserData, body: Any, place: Any) -> tuple[int, bytes, int, int, int]:
    """What `getUserDataInfo` returns."""
    number, index = integer(body, "bodyUniqueId"), integer(place, "userDataIndex")
    texts = data.of_body(number)
    if not 0 <= index < len(texts):
        fail(
            "Could not get user data info.", f"Body {number} has {len(texts)} texts, so there is no {index}."
        )
    datum = texts[index]
    return datum.id, datum.key.encode(), datum.body, datum.link, datum.shape


READERS: dict[str, Callable[..., Any]] = {
    "getUserData": value_of,
    "getUserDataId": number_of,
    "getNumUserData": count_of,
    "getUserDataInfo": info_of,
}
"""Functions that answer queries about texts, by public name; their first argument holds all texts."""


def c_string(value: Any, name: str) -> str:
    """A text that fits a C string: it holds no null character and can be encoded as UTF-8."""
    words = text(value, name)
    if "\0" in words:
        fail(f"{name} must not contain a null character: {words!r}.")
    try:
        words.encode()
    except UnicodeEncodeError as problem:
        fail(f"{name} cannot be encoded: {problem}.")
    return words
