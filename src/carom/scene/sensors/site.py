"""Sites of a body, as handles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.site import SiteSpec
from carom.description.transform import compose
from carom.pose import Pose as WorldPose
from carom.pose import Velocity
from carom.scene.handles import world_of
from carom.scene.link import Link
from carom.scene.named import Named

if TYPE_CHECKING:
    from carom.scene.body import Body


class BodySite:
    """A named frame on a link.

    Attributes:
        body: The body.
        index: Its number among the sites of the body.
    """

    __slots__ = ("body", "index")

    def __init__(self, body: Body, index: int) -> None:
        self.body: Body = body
        self.index: int = index

    def __repr__(self) -> str:
        return f"<Site {self.index} {self.name!r} of {self.body.name!r}: link {self.link.name!r}>"

    @property
    def spec(self) -> SiteSpec:
        """What it was made from."""
        return self.body.spec.sites[self.index]

    @property
    def name(self) -> str:
        """Its name."""
        return self.spec.name

    @property
    def link(self) -> Link:
        """The link that it is on."""
        return self.body.links[self.spec.link]

    @property
    def pose(self) -> WorldPose:
        """World pose of the frame: position [m] and quaternion (x, y, z, w)."""
        import numpy as np

        position, orientation = self.link.pose
        px, py, pz = position.tolist()
        x, y, z, w = orientation.tolist()
        pose = compose(Pose((px, py, pz), (x, y, z, w)), self.spec.pose)
        return WorldPose(np.array(pose.position), np.array(pose.orientation))

    @property
    def velocity(self) -> Velocity:
        """Velocity of its origin [m/s] and angular velocity [rad/s], in world axes."""
        from carom.description.sensor import SensorObject
        from carom.scene.sensors.frames import frame_of, motion
        from carom.scene.sensors.lone_source import LoneSource

        found = motion(LoneSource(world_of(self.body)), frame_of(self.body, SensorObject.SITE, self.name))
        return Velocity(found.linear[0], found.angular[0])


class BodySites(Named[BodySite]):
    """All sites of a body: `sites["tcp"]`, `sites[0]`."""

    def __init__(self, body: Body) -> None:
        super().__init__("site", [BodySite(body, index) for index in range(len(body.spec.sites))])
        self._body = body

    def __repr__(self) -> str:
        return f"<Sites of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"
