"""A client's copy of the texts (user data) of a world that other clients can change, too.

In PyBullet every client has a copy of all texts as of the time when it connected, with its own changes since.
Changes by other clients appear after `syncUserData`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from inspect import BoundArguments, signature
from typing import TYPE_CHECKING, Any

from carom.native.change import Change
from carom.scene.user_data import UserData, UserDatum
from pybullet._access.texts import READERS

if TYPE_CHECKING:
    from pybullet._calls.detours import Function

_CHANGING = frozenset({"addUserData", "removeUserData", "syncUserData", "removeBody", "resetSimulation"})
_LOADING = frozenset({"loadURDF", "loadSDF", "loadMJCF", "loadBullet"})
_ALL = -1

Ask = Callable[..., Any]
"""A function that calls a function of PyBullet in the world's process: name, positional arguments."""


class UserDataView:
    """The copy of one client; `ask` calls a function in the world's process."""

    def __init__(self, ask: Ask) -> None:
        self._ask = ask
        self._known = UserData()
        self._read_all()

    def call(
        self, function: Function, arguments: Any, keywords: dict[str, Any], go_on: Callable[[], Any]
    ) -> Any:
        """Answer a call from the copy, or let `go_on` make it in the world's process and copy the changes."""
        reader = READERS.get(function.name)
        if function.name in _LOADING:
            result = go_on()
            # PyBullet copies the texts that come with bodies loaded from files only on request.
            self._read_anew(result if isinstance(result, tuple) else (result,))
            return result
        if reader is None and function.name not in _CHANGING:
            return go_on()
        bound = signature(function.plain).bind(*arguments, **keywords)
        bound.apply_defaults()
        if reader is not None:
            bound.arguments.pop("physicsClientId")
            return reader(self._known, *bound.arguments.values())
        result = go_on()
        self._take_over(function.name, bound, result)
        return result

    def _take_over(self, name: str, bound: BoundArguments, result: Any) -> None:
        """Make the same change in the copy as in the world."""
        given = bound.arguments
        match name:
            case "addUserData":
                place = given["bodyUniqueId"], given["linkIndex"], given["visualShapeIndex"]
                self._known.put(UserDatum(result, *place, given["key"], given["value"]))
            case "removeUserData":
                datum = self._known.get(given["userDataId"])
                if datum is not None:
                    self._known.remove(datum)
            case "removeBody":
                self._forget(given["bodyUniqueId"])
            case "resetSimulation":
                self._known = UserData()
            case _:
                self._synchronise(given["bodyUniqueId"], given["bodyUniqueIds"])

    def _synchronise(self, one: Any, several: Any) -> None:
        asked = several if several is not None else one
        if isinstance(asked, Iterable):
            self._read_anew(tuple(asked))
        elif asked == _ALL:
            self._read_all()
        else:
            self._read_anew((asked,))

    def _read_all(self) -> None:
        """Copy all texts."""
        self._known = UserData()
        count = self._ask("getNumBodies")
        self._read_anew(tuple(self._ask("getBodyUniqueId", place) for place in range(count)))

    def _read_anew(self, bodies: tuple[int, ...]) -> None:
        """Copy the texts of some bodies."""
        for body in bodies:
            self._forget(body)
            for place in range(self._ask("getNumUserData", body)):
                number, key, _, link, shape = self._ask("getUserDataInfo", body, place)
                value = self._ask("getUserData", number)
                self._known.put(UserDatum(number, body, link, shape, key.decode(), value.decode()))

    def _forget(self, body: int) -> None:
        """Forget the texts of a body."""
        change = Change()
        self._known.remove_all(change, body)
        change.commit()
