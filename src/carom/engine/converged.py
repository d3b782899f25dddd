"""What worlds whose constraints are solved until they converge cannot have yet."""

from __future__ import annotations

from carom.engine.contact_arrays import ContactArrays
from carom.engine.parameters import CONVERGED


def refuse_unbuilt(law: str, contact_arrays: ContactArrays) -> None:
    """Raise `NotImplementedError` if something in a world is not built for its law of contacts."""
    if law not in CONVERGED:
        return
    if contact_arrays.soft.bodies:
        raise NotImplementedError(f"contact={law!r} cannot simulate soft bodies yet; use contact='bullet'")
