"""The state of many worlds as flat arrays."""

from __future__ import annotations

from typing import Any

from carom.checks import Array
from carom.engine.engine import Engine
from carom.scene.state_views import VIEWS
from carom.world.face.state import FlatState


class _Rows:
    """An array of many worlds, of which the rows are chosen as those of one."""

    def __init__(self, array: Any) -> None:
        self._array = array

    def __getitem__(self, rows: slice) -> Array:
        return self._array[:, rows]


class _Views:
    """The arrays of an engine under the names that they have in a world."""

    def __init__(self, engine: Engine) -> None:
        self.arrays = engine.arrays

    def __getattr__(self, name: str) -> _Rows:
        return _Rows(self.arrays.state.numpy[VIEWS[name]])


class FlatStates(FlatState):
    """The state of all bodies in many worlds: arrays of `FlatState` with the world in front."""

    def __init__(self, engine: Engine) -> None:
        views: Any = _Views(engine)
        super().__init__(views)

    def __repr__(self) -> str:
        worlds, coordinates = self.position.shape
        return f"<FlatStates: {coordinates} coordinates in {worlds} worlds>"
