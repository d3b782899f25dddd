"""Memory for sweeps over the rows of several worlds at once.

Each world writes its rows into the workspace of its lane. `lane_sweep_kernel` has arrays of its own, into
which `native/source/lanes/lane_sweeps.cpp` gathers their numbers. Places of rows over two trees are those of
the first lane, where all have the same.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from carom.engine.lane_arrays import NUMBER, Wide, each_row_of_lanes, struct_of, widened
from carom.layouts.programs import LANES, KernelCall, LaneSweeps
from carom.native.arrays import zeros
from carom.native.kernels import lane_sweep_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import array_view

_WIDE = {
    "scratch": ("row", "row_share", "row_softness", "block_response", "delta_velocity"),
    "pair_rows": ("row_terms", "jacobian_row", "jacobian_response"),
}
_PLACES = ("row_place", "row_start")
# Rows over one tree for which there is room, by those of one world: where worlds have different rows.
_SLOTS_PER_ROW = 2
_WHOLE = np.dtype(np.int32)
_ROW_NUMBERS, _ROW_IMPULSE = ("change", "impulse"), ("impulse", "impulse")
_TERMS = ("share", "friction")


class LaneSweepWork:
    """Arrays of the rows of several worlds, and what native code needs to relax these at once.

    Attributes:
        record: For `LaneMotion.sweeps`; valid as long as this object exists and no array is replaced.

    Args:
        structs: Those of the workspace of each lane.
    """

    def __init__(self, structs: Sequence[KernelStructs]) -> None:
        first = structs[0]
        self._wide = {
            name: {field: _widened(field, first[name].memory[field]) for field in fields}
            for name, fields in _WIDE.items()
        }
        self._residuals = zeros((1, 1, LANES), NUMBER)
        self._begun = zeros((1,), np.dtype(np.int64))
        places = {field: first["pair_rows"].memory[field] for field in _PLACES}
        slot_count = len(self._wide["scratch"]["row"].array)
        visits = first["pair_rows"].memory["visit_row"].shape[1]
        self._slots = zeros((slot_count, LANES), _WHOLE)
        self._order = places["visit_row"] = zeros((1, slot_count + visits), _WHOLE)
        self._launch = Launch(
            lane_sweep_kernel,
            1,
            [
                struct_of(first["scratch"], self._wide["scratch"], {}),
                struct_of(first["pair_rows"], self._wide["pair_rows"], places),
                array_view(self._residuals, 2),
                0,
                0,
            ],
        )
        self._settings = first["settings"]
        *call, visits, number = self._launch.addresses("visits", "sweep")
        rows = self._wide["scratch"]["row"].array
        of = _RowsOf(structs, self._wide)
        self.record = LaneSweeps(
            row=of("scratch", "row", _ROW_NUMBERS),
            row_impulse=of("scratch", "row", _ROW_IMPULSE),
            share=of("scratch", "row_share"),
            softness=of("scratch", "row_softness"),
            response=of("scratch", "block_response"),
            delta=of("scratch", "delta_velocity"),
            terms=of("pair_rows", "row_terms", _TERMS),
            term_impulse=of("pair_rows", "row_terms", _ROW_IMPULSE),
            jacobian=of("pair_rows", "jacobian_row"),
            jacobian_response=of("pair_rows", "jacobian_response"),
            sweep=KernelCall(*call),
            visits=visits,
            number=number,
            residuals=self._residuals.ctypes.data,
            order=self._order.ctypes.data,
            slots=self._slots.ctypes.data,
            slot_count=slot_count,
            row_numbers=rows.ctypes.data,
            row_stride=first["scratch"].memory["row"].strides[1],
            wide_row_stride=rows.strides[0],
            iterations=self._address("iterations"),
            inner_iterations=self._address("inner_iterations"),
            threshold=self._address("residual_threshold"),
            begun=self._begun.ctypes.data,
        )

    @property
    def begun(self) -> int:
        """How many sweeps over the rows of `LANES` worlds have been made."""
        return int(self._begun[0])

    def _address(self, setting: str) -> int:
        settings = self._settings
        return ctypes.addressof(settings) + getattr(type(settings), setting).offset


class _RowsOf:
    """Makes the records of rows."""

    def __init__(self, structs: Sequence[KernelStructs], wide: dict[str, dict[str, Wide]]) -> None:
        self._structs = structs
        self._wide = wide

    def __call__(self, name: str, field: str, numbers: tuple[str, str] | None = None) -> Any:
        lone = [structs[name].memory[field] for structs in self._structs]
        return each_row_of_lanes(lone, self._wide[name][field].array, numbers)


def _widened(field: str, lone: np.ndarray) -> Wide:
    rows = lone.shape[1]
    return widened(lone, _SLOTS_PER_ROW * rows if field in ("row", "row_share", "row_softness") else rows)
