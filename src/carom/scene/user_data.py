"""Texts that files and users attach to bodies, links and shapes."""

from __future__ import annotations

from dataclasses import dataclass

from carom.model.body_spec import BASE, BodySpec
from carom.native.change import Change

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

    @property
    def everything(self) -> list[UserDatum]:
        """The texts of all bodies."""
        return list(self._by_id.values())

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
        change = Change()
        change.put(self._by_id, number, datum)
        change.put(self._of_body, body, [*self.of_body(body), datum])
        change.set(self, "_free", self._free[:-1])
        change.commit()
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

    def add_stated(self, change: Change, body: int, spec: BodySpec) -> None:
        """Attach the texts that the file of a new body contains, with a change."""
        stated = {(BASE, WHOLE, key): value for key, value in spec.user_data.items()}
        for index, link in enumerate((spec.base, *spec.links), start=BASE):
            # Most have none.
            if link.user_data:
                stated.update({(index, WHOLE, key): value for key, value in link.user_data.items()})
            for place, visual in enumerate(link.visuals):
                if visual.user_data:
                    stated.update({(index, place, key): value for key, value in visual.user_data.items()})
        if not stated:
            return
        taken, free = len(change.content(self._by_id)), change.get(self, "_free").copy()
        data = []
        for (index, place, key), value in stated.items():
            number = free.pop() if free else taken + len(data)
            data.append(UserDatum(number, body, index, place, key, value))
        change.put_all(self._by_id, {datum.id: datum for datum in data})
        change.put(self._of_body, body, data)
        change.set(self, "_free", free)

    def remove(self, datum: UserDatum) -> None:
        """Remove a text."""
        others = self._of_body[datum.body].copy()
        others[others.index(datum)] = others[-1]
        others.pop()
        change = Change()
        change.drop(self._by_id, datum.id)
        change.put(self._of_body, datum.body, others)
        change.set(self, "_free", [*self._free, datum.id])
        change.commit()

    def remove_all(self, change: Change, body: int) -> None:
        """Remove all texts of a body with a change."""
        gone = [datum.id for datum in self.of_body(body)]
        for number in gone:
            change.drop(self._by_id, number)
        change.drop(self._of_body, body)
        change.set(self, "_free", [*self._free, *gone])
