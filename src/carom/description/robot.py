"""A robot: a tree of links connected by joints."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.joint import Joint
from carom.description.link import Link, Material

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.description.deformable import Deformable


@dataclass(frozen=True, slots=True)
class Robot:
    """Links and joints as a file describes them, checked to form one tree.

    Attributes:
        links: In file order.
        joints: In file order; `parent` and `child` index `links`.
        root: Index of the link without parent.
        source: The file it came from, if any.
        user_data: Key and value pairs stated by the file for the model.
        deformable: Its description if it is a soft body; it then has a single link with the name of the
            `<deformable>` or `<reduced_deformable>` element, and no joints.
        actuators: What drives its joints; PyBullet's API has none.
        base_damping: Viscous damping of the root if it is free, the same along and about all axes; of the
            motion of its inertial frame [N s/m, N m s/rad].
        base_armature: Inertia that is added there, likewise [kg, kg m²].
        base_stiffness: Of a spring from there to the pose at which it is loaded, along and about all axes
            [N/m, N m/rad].
        is_mocap: Its root is moved by users only, as a `mocap` body of MJCF.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    root: int = 0
    materials: tuple[Material, ...] = ()
    source: Path | None = None
    user_data: dict[str, str] = field(default_factory=dict)
    deformable: Deformable | None = None
    actuators: tuple[ActuatorSpec, ...] = ()
    is_mocap: bool = False
    base_damping: float = 0.0
    base_armature: float = 0.0
    base_stiffness: float = 0.0
