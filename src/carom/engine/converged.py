"""What worlds whose constraints are solved until they converge cannot have yet."""

from __future__ import annotations

from carom.engine.contact_arrays import ContactArrays
from carom.engine.parameters import COMPLIANT, CONVERGED


def refuse_unbuilt(law: str, contact_arrays: ContactArrays) -> None:
    """Raise `NotImplementedError` if something in a world is not built for its law of contacts."""
    if law not in CONVERGED:
        return
    if contact_arrays.soft.bodies:
        raise NotImplementedError(f"contact={law!r} cannot simulate soft bodies yet; use contact='bullet'")
    if law == COMPLIANT and _yields_and_twists(contact_arrays):
        raise NotImplementedError(
            "contact='compliant' has no spinning and rolling friction yet, as geoms and pairs with condim 4 "
            "and 6 have; set it to 0, or use contact='bullet' or 'rigid'"
        )


def _yields_and_twists(contact_arrays: ContactArrays) -> bool:
    """Whether some contacts that yield may have spinning or rolling friction."""
    table = contact_arrays.shapes.table.numpy
    twists = (table["shape_spinning_friction"] > 0.0) | (table["shape_rolling_friction"] > 0.0)
    if (twists & (table["shape_impedance"][..., 1] > 0.0)).any():
        return True
    used = contact_arrays.shapes.filter_count
    return bool((table["filter_friction"][:used, 1:] > 0.0).any())
