"""What the viewer needs of many worlds; `carom.worlds.worlds.Worlds` has it, which is above the viewer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from carom.scene.core.restorable import Restorable
    from carom.worlds.saved import SavedWorlds


class ViewedGlimpses(Protocol):
    """What is seen of some of the worlds, and done to them; `carom.worlds.glimpse.Glimpses` describes it."""

    def poses(self, worlds: np.ndarray) -> NDArray[np.float32]:
        """Present poses of the inertial frames of all links of some worlds: (n, links, 7)."""
        ...

    def absent(self, worlds: np.ndarray, links: np.ndarray) -> NDArray[np.bool_] | None:
        """Which links belong to bodies that are absent: (n, links); None if none is."""
        ...

    def push(self, world: int, link: int, force: np.ndarray, torque: np.ndarray) -> None:
        """Apply a force [N] and a torque [N m] (3,) to a link of a world, by its row, in the next step."""
        ...

    def put(self, name: str, world: int, row: int, values: float | np.ndarray) -> None:
        """Set a row of an array of the state in one world."""
        ...

    def refill(self, world: Any, number: int, *, parameters: bool) -> None:
        """Give a world of `extract` the state and, if wanted, the parameters of another of the worlds."""
        ...


class ViewedWorlds(Protocol):
    """Many worlds that are shown.

    Attributes:
        lock: Held during steps.
        time: Simulated time of each world [s], (count,).
        observers: What is told before and after steps.
    """

    lock: Any
    time: NDArray[np.float64]
    observers: list[Any]

    @property
    def count(self) -> int:
        """Number of worlds."""
        ...

    @property
    def time_step(self) -> float:
        """Duration of a step [s]."""
        ...

    @property
    def glimpses(self) -> ViewedGlimpses:
        """What is seen of some of the worlds."""
        ...

    def __getitem__(self, body: int) -> Any:
        """A body in all worlds, by its number, as `carom.worlds.body.BodyBatch` describes it."""
        ...

    def extract(self, world: int) -> Restorable:
        """A copy of one of the worlds."""
        ...

    def snapshot(self, where: Sequence[int]) -> SavedWorlds:
        """The present states of some worlds."""
        ...

    def restore(self, start: SavedWorlds, where: np.ndarray) -> None:
        """Restore some worlds."""
        ...

    def reset(self, *, where: Sequence[int]) -> None:
        """Put some worlds back to their start."""
        ...
