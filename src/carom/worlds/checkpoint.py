"""Everything in which worlds differ from new copies of their scene: states and parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.engine.engine import Engine

_TABLES = ("model", "shapes", "users")


def parameters_of(engine: Engine) -> dict[str, dict[str, np.ndarray]]:
    """The parameters that can differ between worlds: copies by table and field.

    The first axis is the world; it has one entry if all worlds share the parameter.
    """
    return {
        table: {
            name: np.array(array)
            for name, array in engine.table_of(table).numpy.items()
            if engine.table_of(table).is_per_world(name)
        }
        for table in _TABLES
    }


def set_parameters(engine: Engine, saved: Mapping[str, Mapping[str, np.ndarray]]) -> None:
    """Set the parameters of all worlds to those of `parameters_of`.

    Raises:
        ValueError: They are parameters of other bodies; nothing is changed.
    """
    own = parameters_of(engine)
    for table in _TABLES:
        if _shapes(own[table]) != _shapes(saved[table]):
            raise ValueError("these are parameters of worlds with other bodies")
    for table in _TABLES:
        for name, array in saved[table].items():
            if len(array) > 1:
                engine.spread(table, name)
            parameters = engine.table_of(table)
            parameters.numpy[name][:] = array
            parameters.written(name)
    engine.contact_arrays.forget_order()


def _shapes(fields: Mapping[str, np.ndarray]) -> dict[str, tuple[Any, ...]]:
    return {name: (array.dtype.str, *array.shape[1:]) for name, array in fields.items()}
