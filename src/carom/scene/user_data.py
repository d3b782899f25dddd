"""Texts that files and users attach to bodies, links and shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from carom.model.body_spec import BASE, BodySpec
from carom.native.undo import Undo

WHOLE = -1
"""Used instead of a visual shape if the text belongs to the link, or, for the base, to the body."""


@dataclass(slots=True)
class UserDatum:
    """A text attached to a body, a link or a visual shape.

    Attributes:
        id: Its number.
        body: Number of the body.
        link: Index of the link; -1 is the base.
        shape: Index of the visual shape, -1 for none.
        key: Its name.
        value: The text.
    """

    id: int
    body: int
    link: int
    shape: int
    key: str
    value: str


class UserData:
    """The texts of a world. Numbers of removed texts are reused, the last first."""

    def __init__(self) -> None:
        self._by_id: dict[int, UserDatum] = {}
        self._of_body: dict[int, list[UserDatum]] = {}
        self._free: list[int] = []

    def of_body(self, body: int) -> list[UserDatum]:
        """All texts of a body; removing one moves the last to its place."""
        return self._of_body.get(body, [])

    def get(self, number: int) -> UserDatum | None:
        """The text with a number, or None."""
        return self._by_id.get(number)

    def find(self, body: int, link: int, shape: int, key: str) -> UserDatum | None:
        """The text with a name that is attached to this place, or None."""
        for datum in self.of_body(body):
            if (datum.link, datum.shape, datum.key) == (link, shape, key):
                return datum
        return None

    def add(self, body: int, link: int, shape: int, key: str, value: str) -> UserDatum:
        """Attach a text; an existing one with the same place and name is replaced and keeps its number."""
        datum = self.find(body, link, shape, key)
        if datum is not None:
            datum.value = value
            return datum
        number = self._free[-1] if self._free else len(self._by_id)
        datum = UserDatum(number, body, link, shape, key, value)
        data, free = [*self.of_body(body), datum], self._free[:-1]

        def put() -> None:
            self._by_id[number] = datum
            self._of_body[body] = data
            self._free = free

        Undo().at_once(put)
        return datum

    def put(self, datum: UserDatum) -> None:
        """Add a text with its own number; existing ones with that number or name are removed."""
        same = self.find(datum.body, datum.link, datum.shape, datum.key)
        if same is not None and same.id == datum.id:
            same.value = datum.value
            return
        for other in (same, self.get(datum.id)):
            if other is not None and self.get(other.id) is other:
                self.remove(other)
        self._by_id[datum.id] = datum
        self._of_body.setdefault(datum.body, []).append(datum)

    def add_stated(self, body: int, spec: BodySpec) -> None:
        """Attach the texts that the file of a new body contains."""
        for key, value in spec.user_data.items():
            self.add(body, BASE, WHOLE, key, value)
        for index, link in enumerate((spec.base, *spec.links), start=BASE):
            for key, value in link.user_data.items():
                self.add(body, index, WHOLE, key, value)
            for place, visual in enumerate(link.visuals):
                for key, value in visual.user_data.items():
                    self.add(body, index, place, key, value)

    def remove(self, datum: UserDatum) -> None:
        """Remove a text."""
        others = self._of_body[datum.body].copy()
        others[others.index(datum)] = others[-1]
        others.pop()
        free = [*self._free, datum.id]

        def remove() -> None:
            self._by_id.pop(datum.id, None)
            self._of_body[datum.body] = others
            self._free = free

        Undo().at_once(remove)

    def way_back(self) -> Callable[[], None]:
        """A function that removes the texts of all bodies that are added from now on."""
        texts, bodies, free = len(self._by_id), len(self._of_body), self._free.copy()

        def go_back() -> None:
            while len(self._by_id) > texts:
                self._by_id.popitem()
            while len(self._of_body) > bodies:
                self._of_body.popitem()
            self._free = free.copy()

        return go_back

    def removal(self, body: int) -> Callable[[], None]:
        """Prepare to remove all texts of a body; the function that is returned can be called again."""
        gone = [datum.id for datum in self.of_body(body)]
        free = [*self._free, *gone]

        def remove() -> None:
            for number in gone:
                self._by_id.pop(number, None)
            self._of_body.pop(body, None)
            self._free = free

        return remove
