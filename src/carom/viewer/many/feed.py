"""Updates the latest messages from some of many worlds: a body of each on the pages."""

from __future__ import annotations

from collections.abc import Iterable
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.model.body_spec import BASE
from carom.render.appearance import appearance_of
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.looks.shapes import Assets, described
from carom.viewer.looks.stage import staged
from carom.viewer.many.extent import is_ground
from carom.viewer.messages import encoded
from carom.viewer.protocol import to_page
from carom.viewer.scene_feed import Blocks, RealTime

if TYPE_CHECKING:
    from carom.viewer.many.shown import Plan, Seen, ShownWorlds

# Opacity of the worlds that are not chosen, where all are in one place.
_GLASS = 0.2
# How long a frame waits for steps to end [s]; they see the worlds themselves then.
_PATIENCE = 0.004
# Pictures a second at which worlds are seen.
_RATE = 30.0
# Numbers of bodies on pages: those of the chosen world are its own, others begin at multiples of this.
_STRIDE = 100_000


class ManyFeed:
    """Puts the bodies of the shown worlds among the latest messages. For use by one thread.

    The bodies of the chosen world have their own numbers, and are where they are; those of others have
    numbers and places of their own. So whatever else is told of bodies is about the chosen world.

    Attributes:
        collisions: Whether to describe collision shapes as well.
        moved: Whether the last frame has another time, or other numbers, than the one before it.
        wanted: Steps are to see the worlds when they end, as frames come between none.
    """

    def __init__(self, shown: ShownWorlds, latest: LatestMessages) -> None:
        self.collisions: bool = False
        self.moved: bool = False
        self.wanted: bool = False
        self._shown = shown
        self._latest = latest
        self._assets = Assets(latest)
        self._rate = RealTime()
        self._known: tuple[Plan, bool, bytes] | None = None
        self._described: dict[int, dict[str, Any]] = {}
        self._places: NDArray[np.int64] = np.zeros((0, 2), dtype=np.int64)
        self._layout = 0
        self._seen: Seen = shown.seen
        self._looked = 0.0
        self._last = b""
        self._numbers = 0.0, b""

    def body_of(self, number: int) -> tuple[int, int] | None:
        """World and number there of a body on the pages; None if it is not shown any more."""
        place, body = divmod(number, _STRIDE)
        plan = self._seen.plan
        if place > len(plan.numbers):
            return None
        return (plan.chosen if place == 0 else plan.numbers[place - 1]), body

    def offset_of(self, number: int) -> NDArray[np.float32]:
        """Where a body on the pages is drawn, beside where it is in its world (3,) [m]."""
        place = number // _STRIDE
        plan = self._seen.plan
        return np.zeros(3, np.float32) if place == 0 else plan.offsets()[place - 1]

    def follow(self) -> None:
        """Sees the worlds, and describes what has changed."""
        now = monotonic()
        if self._shown.plan is not self._shown.seen.plan or now - self._looked >= 1.0 / _RATE:
            # The next end of a step does it, if steps leave no room for a frame.
            self.wanted = True
            if self._shown.look(_PATIENCE):
                self.wanted = False
                self._looked = now
        if self._shown.seen is not self._seen:
            self._looked = now
        self._seen = seen = self._shown.seen
        absent = b"" if seen.absent is None else seen.absent.tobytes()
        known = (seen.plan, self.collisions, absent)
        if known != self._known:
            self._describe(seen)
            self._known = known

    def frame(
        self,
        extras: dict[str, Any],
        blocks: Blocks = (),
        number: int | None = None,
        time: float | None = None,
    ) -> bytes | None:
        """What was seen last as a message; None if it is as the one before. See `SceneFeed.frame`."""
        seen = self._seen
        places, links = self._places.T
        poses = seen.poses[places, links]
        poses[:, :3] += seen.plan.offsets()[places]
        payload = poses.astype("<f4").tobytes()
        header = to_page.FRAME(
            layout=self._layout, poses=len(poses), time=seen.time, rate=self._rate.at(seen.time), **extras
        )
        if blocks:
            header["blocks"] = [[name, len(columns)] for name, columns in blocks]
            payload += b"".join(columns.astype("<f4").tobytes() for _, columns in blocks)
        self.moved = (seen.time, payload) != self._numbers
        self._numbers = seen.time, payload
        if number is not None:
            header["number"] = number if self.moved else number - 1
        message = encoded(header, payload)
        if message == self._last:
            return None
        self._last = message
        return message

    def _describe(self, seen: Seen) -> None:
        """Tells pages which bodies there are, and whose poses come with the frames that follow."""
        plan = seen.plan
        lone = self._shown.lone
        appearance = appearance_of(lone)
        with lone.lock:
            bodies = list(lone.bodies.values())
            own = {
                body.id: described(body, appearance, self._assets, collisions=self.collisions)
                for body in bodies
            }
        grounds = {body.id for body in bodies if is_ground(body)}
        new: dict[int, dict[str, Any]] = {}
        places: list[tuple[int, int]] = []
        order: list[list[int]] = []
        chosen = plan.numbers.index(plan.chosen)
        for place, key, world in [(chosen, 0, None), *((place, place + 1, n) for place, n in plan.others())]:
            for body in bodies:
                rows = np.arange(body.first_link, body.first_link + body.joint_count - BASE)
                if seen.absent is not None and seen.absent[place, rows[0]]:
                    continue
                if world is not None and body.id in grounds:
                    continue
                number = key * _STRIDE + body.id
                new[number] = own[body.id] if world is None else _copied(own[body.id], number, world, plan)
                order.append([number, len(rows)])
                places += [(place, row) for row in rows.tolist()]
        for number, facts in new.items():
            if self._described.get(number) != facts:
                self._latest.put(("body", number), facts)
        for number in self._described.keys() - new.keys():
            self._latest.remove(("body", number), to_page.NO_BODY(body=number))
        stage = staged(appearance, self._assets)
        if self._layout == 0 and stage is not None:
            self._latest.put("stage", stage)
        self._described = new
        meshes, textures = _used(own.values())
        if stage is not None:
            textures.add(stage["sky"])
        self._assets.keep_only(meshes, textures)
        self._places = np.array(places, np.int64).reshape(-1, 2)
        self._layout += 1
        self._latest.put("layout", to_page.LAYOUT(layout=self._layout, bodies=order))
        self._latest.put("worlds", _facts(plan, self._shown))


def _copied(facts: dict[str, Any], number: int, world: int, plan: Plan) -> dict[str, Any]:
    """A body of a world that is not chosen; where all worlds are in one place it can be seen through."""
    copy = {**facts, "body": number, "world": world, "like": facts["body"]}
    if plan.arrangement == "overlay":
        copy["shapes"] = [
            {**shape, "rgba": (*shape["rgba"][:3], shape["rgba"][3] * _GLASS)} for shape in facts["shapes"]
        ]
    return copy


def _used(bodies: Iterable[dict[str, Any]]) -> tuple[set[int], set[int]]:
    """Numbers of the meshes, and of the textures, that bodies use."""
    shapes = [shape for facts in bodies for shape in facts["shapes"]]
    return {mesh for shape in shapes for mesh, _ in shape["meshes"]}, {shape["texture"] for shape in shapes}


def _facts(plan: Plan, shown: ShownWorlds) -> dict[str, Any]:
    x, y = shown.centre
    return to_page.WORLDS(
        count=shown.worlds.count,
        shown=list(plan.numbers),
        chosen=plan.chosen,
        arrangement=plan.arrangement,
        cells=[(x + dx, y + dy, dz) for dx, dy, dz in plan.offsets().tolist()],
        size=plan.spacing if plan.arrangement == "grid" else 0.0,
    )
