"""Updates the latest messages from a world: its bodies, their appearance, and their poses."""

from __future__ import annotations

from collections.abc import Sequence
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.layouts.codes import Activity
from carom.model.body_spec import BASE
from carom.render.appearance import Appearance, appearance_of
from carom.scene.core.soft_core import SoftCore
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.looks.shapes import Assets, described, skins_on
from carom.viewer.looks.stage import staged
from carom.viewer.messages import encoded
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

Blocks = Sequence[tuple[str, NDArray[np.float32]]]

# Maximum time to wait for a step to end; the check for new bodies is then left to the next frame [s].
_PATIENCE = 0.02
# Averaging time of the real-time factor [s].
_RATE_WINDOW = 1.0
# Minimum interval between updates of a soft body's shape [s]: each update is a whole mesh.
_SHAPE_INTERVAL = 1 / 15
# Members of enumerations are found slowly.
_ABSENT = int(Activity.ABSENT)


class RealTime:
    """How fast simulated time has passed of late, beside real time."""

    def __init__(self) -> None:
        self._clock: list[tuple[float, float]] = []

    def at(self, time: float) -> float:
        """Recent real-time factor, simulated time / real time, at a simulated time [s] that is now."""
        now = monotonic()
        if self._clock and time < self._clock[-1][1]:
            self._clock.clear()
        self._clock.append((now, time))
        while now - self._clock[0][0] > _RATE_WINDOW and len(self._clock) > 2:
            self._clock.pop(0)
        passed = now - self._clock[0][0]
        return round((time - self._clock[0][1]) / passed, 3) if passed > 0.0 else 0.0


class SceneFeed:
    """Puts the bodies of a world among the latest messages. For use by one thread.

    A frame copies the poses without the lock: at worst some links are one time step ahead of the others and
    of its time, and steps never wait. The world is locked only after bodies were added, removed or
    changed their appearance, while they are described.

    Attributes:
        collisions: Whether to describe collision shapes as well.
        moved: Whether the last frame has another time, or other numbers, than the one before it.
    """

    def __init__(self, world: WorldCore, lock: Any, latest: LatestMessages) -> None:
        self.collisions = False
        self.moved: bool = False
        self._world = world
        self._lock = lock
        self._latest = latest
        self._assets = Assets(latest)
        self._bodies: list[BodyCore] = []
        self._all: list[BodyCore] = []
        self._absent = b""
        self._arrays: object = None
        self._appearance: Appearance | None = None
        self._looks: tuple[object, ...] = ()
        self._stage: dict[str, Any] | None = None
        self._described: dict[int, dict[str, Any]] = {}
        self._rows: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._row_count = 0
        self._layout = 0
        self._last = b""
        self._numbers = b""
        self._time = 0.0
        self._rate = RealTime()
        self._shapes_sent = 0.0
        self._shapes: dict[int, bytes] = {}

    def follow(self) -> None:
        """Puts what has changed there. What is read after it belongs to the next frame."""
        self._follow_bodies()
        self._follow_nodes()

    def frame(
        self,
        extras: dict[str, Any],
        blocks: Blocks = (),
        number: int | None = None,
        time: float | None = None,
    ) -> bytes | None:
        """The present poses, and arrays by name, as a message with extras; None if nothing has changed.

        A number is told with the frame; a frame that is as the last one has the number before it. Its time is
        that before its arrays were read [s], by default the present one.
        """
        self.moved = False
        if time is None:
            time = float(self._world.time)
        self.follow()
        poses = self._world.link_pose
        if self._row_count > len(poses):
            return None
        payload = poses[self._rows].astype("<f4").tobytes()
        header = to_page.FRAME(
            layout=self._layout,
            poses=self._rows.size,
            time=time,
            rate=self._rate.at(time),
            **extras,
        )
        if blocks:
            header["blocks"] = [[name, len(columns)] for name, columns in blocks]
            payload += b"".join(columns.astype("<f4").tobytes() for _, columns in blocks)
        self.moved = time != self._time or payload != self._numbers
        self._time, self._numbers = time, payload
        if number is not None:
            header["number"] = number if self.moved else number - 1
        message = encoded(header, payload)
        if message == self._last:
            return None
        self._last = message
        return message

    def _follow_bodies(self) -> None:
        if self._knows_bodies() or not self._lock.acquire(timeout=_PATIENCE):
            return
        try:
            self._describe()
        finally:
            self._lock.release()

    def _knows_bodies(self) -> bool:
        """Whether bodies and their looks are as they were described last; it takes little time for each."""
        world = self._world
        return (
            # A reset gives a world new arrays.
            world.arrays is self._arrays
            and list(world.bodies.values()) == self._all
            and _absent_trees(world) == self._absent
            and self._looks == self._present_looks()
        )

    def _follow_nodes(self) -> None:
        """Puts the present shapes of soft bodies and skins among the latest messages."""
        now = monotonic()
        skins = self._appearance is not None and self._appearance.skins
        if not (skins or self._world.contact_arrays.soft.bodies) or now - self._shapes_sent < _SHAPE_INTERVAL:
            return
        # A body may be removed meanwhile.
        if not self._lock.acquire(timeout=_PATIENCE):
            return
        try:
            self._describe_nodes()
        finally:
            self._lock.release()
        self._shapes_sent = now

    def _describe_nodes(self) -> None:
        appearance = self._appearance
        if appearance is None:
            return
        for body in self._bodies:
            if body.world.bodies.get(body.id) is not body:
                continue
            shape = body.nodes.tobytes() if isinstance(body, SoftCore) else b""
            if appearance.skins:
                meshes = (look.mesh.positions for _, look in skins_on(body, appearance))
                shape += b"".join(mesh.tobytes() for mesh in meshes)
            if not shape or self._shapes.get(body.id) == shape:
                continue
            self._shapes[body.id] = shape
            facts = self._facts(body, appearance)
            self._described[body.id] = facts
            self._latest.put(("body", body.id), facts)
        self._keep_used_assets()

    def _facts(self, body: BodyCore, appearance: Appearance) -> dict[str, Any]:
        return described(body, appearance, self._assets, collisions=self.collisions, with_skins=True)

    def _present_looks(self) -> tuple[object, ...]:
        appearance = self._appearance
        assert appearance is not None
        return (appearance, appearance.changes, appearance.textures.changes, self.collisions)

    def _keep_used_assets(self) -> None:
        shapes = [shape for facts in self._described.values() for shape in facts["shapes"]]
        textures = {shape["texture"] for shape in shapes}
        if self._stage is not None:
            textures.add(self._stage["sky"])
        self._assets.keep_only({mesh for shape in shapes for mesh, _ in shape["meshes"]}, textures)

    def _show_stage(self, appearance: Appearance) -> None:
        stage = staged(appearance, self._assets)
        if stage == self._stage:
            return
        self._stage = stage
        if stage is None:
            self._latest.remove("stage", to_page.NO_STAGE())
        else:
            self._latest.put("stage", stage)

    def _describe(self) -> None:
        everything, absent = list(self._world.bodies.values()), _absent_trees(self._world)
        bodies = [body for body in everything if not absent[body.rows.tree]]
        self._appearance = appearance = appearance_of(self._world)
        appearance.number_textures(list(self._world.bodies.values()))
        looks = self._present_looks()
        known = set(map(id, self._bodies)) if looks == self._looks else set()
        new = {}
        for body in bodies:
            if id(body) in known:
                new[body.id] = self._described[body.id]
                continue
            new[body.id] = self._facts(body, appearance)
            if self._described.get(body.id) != new[body.id]:
                self._latest.put(("body", body.id), new[body.id])
        for number in self._described.keys() - new.keys():
            self._latest.remove(("body", number), to_page.NO_BODY(body=number))
        self._described = new
        self._show_stage(appearance)
        self._keep_used_assets()
        rows = [np.arange(body.first_link, body.first_link + body.joint_count - BASE) for body in bodies]
        self._rows = np.concatenate([np.zeros(0, dtype=np.int64), *rows])
        self._row_count = int(self._rows.max(initial=-1)) + 1
        self._layout += 1
        order = [[body.id, body.joint_count - BASE] for body in bodies]
        self._latest.put("layout", to_page.LAYOUT(layout=self._layout, bodies=order))
        # The bodies are kept for the comparison by id, because Python reuses the ids of deleted objects.
        self._bodies, self._all, self._absent = bodies, everything, absent
        self._arrays = self._world.arrays
        self._looks = looks


def _absent_trees(world: WorldCore) -> bytes:
    """For each tree whether it is absent; a script may have added bodies since."""
    return (world.arrays.state.numpy["tree_activity"][0] == _ABSENT).tobytes()
