"""The structs of `carom.layouts` as Warp structs, for device code to import."""

from typing import TYPE_CHECKING, Any

from carom.kernels.warp_types import warp_type
from carom.layouts import (
    chain,
    contacts,
    images,
    linearization,
    mechanism,
    model,
    newton,
    pair_rows,
    parallel,
    queries,
    soft,
)
from carom.layouts.types import Array, Rows, Struct

if TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Kernel code is checked by Warp, not by the Python type checker."""

else:
    for layout in (
        chain,
        contacts,
        images,
        linearization,
        mechanism,
        model,
        newton,
        pair_rows,
        parallel,
        queries,
        soft,
    ):
        for name, declared in vars(layout).items():
            if isinstance(declared, type) and issubclass(declared, Struct):
                globals()[name] = warp_type(declared)

    CandidateRows = warp_type(Rows[contacts.Candidate])
    ConstraintRows = warp_type(Rows[model.RowScratch])
    Dofs = warp_type(Array[model.DofModel])
    DofRows = warp_type(Rows[model.DofScratch])
    NewtonRows = warp_type(Rows[newton.NewtonRow])
