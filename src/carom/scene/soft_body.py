"""A soft body in a world: nodes tied by springs and tetrahedra."""

from __future__ import annotations

from typing import Any

from carom.scene.body import Body
from carom.scene.core.soft_core import SoftCore

# Parameters of a soft body that cannot be changed.
_FIXED = ("mass", "inertia", "collision_margin")


class SoftBody(SoftCore, Body):
    """Handle of a soft body; stays valid until the body is removed.

    Its base stands for the whole body: it is at the centre of mass of the nodes, with their mean rotation and
    velocity.
    """

    def change_dynamics(self, link: int | str, **changes: Any) -> None:
        """Change contact parameters, as `Body.change_dynamics`; as in PyBullet the mass does not change."""
        super().change_dynamics(
            link, **{name: value for name, value in changes.items() if name not in _FIXED}
        )
