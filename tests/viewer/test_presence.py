"""Pages are shown the bodies that are present."""

from __future__ import annotations

from threading import RLock

from carom import World
from carom.viewer import scene_feed
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded


def test_a_body_that_is_absent_is_taken_down_until_it_comes_back() -> None:
    world = World()
    boxes = [world.add_box((0.1, 0.1, 0.1), (0.5 * number, 0.0, 0.1)) for number in range(2)]
    latest = LatestMessages()
    feed = scene_feed.SceneFeed(world, RLock(), latest)

    def bodies() -> list[int]:
        feed.frame({})
        header, _ = decoded(latest._entries["layout"].message)
        return [body for body, _ in header["bodies"]]

    assert bodies() == [boxes[0].id, boxes[1].id]
    boxes[0].present = False
    assert bodies() == [boxes[1].id]
    assert latest._entries["body", boxes[0].id].gone
    boxes[0].present = True
    assert bodies() == [boxes[0].id, boxes[1].id]
