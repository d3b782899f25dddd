"""What a link has in one world and in many."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, Literal, TypeVar

from carom.checks import Array
from carom.description.pose import Pose
from carom.model.body_spec import BASE, LinkSpec
from carom.pose import Pose as WorldPose

if TYPE_CHECKING:
    from typing_extensions import Self

Frame = Literal["world", "link"]
JointOf = TypeVar("JointOf")


class CommonLink(Generic[JointOf]):
    """What leads from a link to others, and its centre of mass."""

    __slots__ = ()

    index: int

    @property
    def spec(self) -> LinkSpec:
        """The specification of the link, from the file."""
        raise NotImplementedError

    @property
    def joint(self) -> JointOf | None:
        """The joint that moves it; None for the base."""
        return None if self.index == BASE else self._joint(self.index)

    @property
    def parent(self) -> Self | None:
        """The parent link; None for the base."""
        return None if self.index == BASE else self._other(self.spec.parent)

    @property
    def inertial_frame(self) -> Pose:
        """Centre of mass and principal axes in the link frame."""
        return self.spec.inertial_frame

    @property
    def inertial_pose(self) -> WorldPose:
        """World pose of the inertial frame: centre of mass and principal axes."""
        raise NotImplementedError

    @property
    def com(self) -> Array:
        """Centre of mass in world axes [m], shape (3,), in many worlds (count, 3)."""
        return self.inertial_pose.position

    @property
    def com_pose(self) -> WorldPose:
        """`inertial_pose`."""
        return self.inertial_pose

    def _joint(self, number: int) -> JointOf:
        raise NotImplementedError

    def _other(self, number: int) -> Self:
        """Another link of the body."""
        raise NotImplementedError
