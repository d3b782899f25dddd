"""Adding tendons to bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.tendon import TendonSpec
from carom.errors import DescriptionError
from carom.native.gates import gated
from carom.scene.handles import world_of
from carom.scene.tendons.making import new_tendon, tendons_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@gated("world.call_lock")
def add_tendon(body: BodyCore, spec: TendonSpec) -> None:
    """Add a tendon to a body, as `Body.add_tendon` does."""
    world = world_of(body)
    if not spec.name or any(other.name == spec.name for other in tendons_of(body)):
        raise DescriptionError(f"tendon {spec.name!r}: each one of a body needs a name of its own")
    world.add_constraint(new_tendon(body, spec))
