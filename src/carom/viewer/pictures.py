"""Pictures that a script waits for, so that pages draw each step."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from threading import Condition


class Pictures:
    """The pictures that pages are asked for, and have drawn. Safe to use from all threads.

    Attributes:
        asked: Number of the newest picture asked for; 0 before the first.
    """

    def __init__(self) -> None:
        self.asked: int = 0
        self._changed = Condition()
        self._drawn: dict[int, int] = {}
        self._hidden: set[int] = set()

    def wait(self, pages: Callable[[], Iterable[int]], patience: float) -> None:
        """Asks for a picture and waits until all visible pages have drawn it, at most for `patience` [s]."""
        with self._changed:
            self.asked += 1
            picture = self.asked

            def shown() -> bool:
                return all(
                    self._drawn.get(page, 0) >= picture for page in pages() if page not in self._hidden
                )

            self._changed.wait_for(shown, patience)

    def drawn(self, page: int, picture: int) -> None:
        """Records that a page has drawn a picture."""
        with self._changed:
            self._drawn[page] = picture
            self._changed.notify_all()

    def show(self, page: int, *, visible: bool) -> None:
        """Records whether a page is visible; browsers do not draw hidden pages."""
        with self._changed:
            (self._hidden.discard if visible else self._hidden.add)(page)
            self._changed.notify_all()

    def forget(self, page: int) -> None:
        """Forgets a page that was closed."""
        with self._changed:
            self._drawn.pop(page, None)
            self._hidden.discard(page)
            self._changed.notify_all()
