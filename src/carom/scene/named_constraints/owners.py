"""The bodies of a constraint as users know them."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore


def handle_of(body: BodyCore) -> Body:
    """The handle that a body of a world is."""
    return cast("Body", body)
