"""Some of many worlds in a window: which are shown and where, at what cost, and what users do to them."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Thread
from typing import Any

import numpy as np
import pytest
from tests.patience import until
from tests.viewer.watcher import Watcher

import pybullet_data
from carom import World, Worlds
from carom.viewer import Viewer
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.many import feed
from carom.viewer.messages import decoded

DATA = pybullet_data.getDataPath()
COUNT = 20
CUBE = 1


def scene() -> World:
    world = World()
    world.parameters.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{DATA}/plane.urdf", fixed_base=True)
    world.load_urdf(f"{DATA}/cube_small.urdf", position=(0.3, 0.2, 0.5))
    cart = world.load_urdf(f"{DATA}/cartpole.urdf", position=(0.0, 0.0, 1.0), fixed_base=True)
    cart.joints.free()
    return world


def many() -> Worlds:
    worlds = Worlds(scene(), COUNT)
    heights = 0.5 + 0.1 * np.arange(COUNT)
    positions = np.column_stack((np.full(COUNT, 0.3), np.full(COUNT, 0.2), heights))
    worlds["cube.urdf"].set_pose((positions, np.tile([0.0, 0.0, 0.0, 1.0], (COUNT, 1))))
    return worlds


@pytest.fixture
def worlds() -> Worlds:
    return many()


@pytest.fixture
def viewer(worlds: Worlds, monkeypatch: pytest.MonkeyPatch) -> Iterator[Viewer]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(worlds, port=0, shown=9)
    yield viewer
    viewer.close()


@pytest.fixture
def page(viewer: Viewer) -> Iterator[Watcher]:
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: page.frame and told(page) and page.frame["layout"] == layout(page)["layout"])
        yield page


def told(page: Watcher) -> dict[str, Any]:
    return page.shown.get(("worlds", None), {})


def layout(page: Watcher) -> dict[str, Any]:
    return page.shown["layout", None]


def base_poses(page: Watcher) -> dict[int, np.ndarray]:
    """Pose of the base of each body on the page."""
    starts = np.cumsum([0, *(links for _, links in layout(page)["bodies"])])
    return {
        number: page.poses[start] for (number, _), start in zip(layout(page)["bodies"], starts, strict=False)
    }


def wait_for_choice(page: Watcher, **facts: Any) -> None:
    page.wait_for(
        lambda: (
            all(told(page)[name] == value for name, value in facts.items())
            and page.frame["layout"] == layout(page)["layout"]
        )
    )


def held(viewer: Viewer) -> dict[int, Any]:
    """What is pulled, by the number of the page."""
    hands: Any = viewer._hands
    return hands._hands


def is_pulled(viewer: Viewer) -> bool:
    """Whether somebody pulls something, and has moved the mouse since."""
    return any(hand.moved for hand in list(held(viewer).values()))


def cube_of(page: Watcher, world: int) -> int:
    """Number on the page of the cube of a world."""
    if told(page)["chosen"] == world:
        return CUBE
    return next(
        number
        for (kind, number), facts in page.shown.items()
        if kind == "body" and facts.get("world") == world and facts["like"] == CUBE
    )


def test_the_shown_worlds_stand_side_by_side(worlds: Worlds, page: Watcher):
    worlds.step(30)
    page.wait_for(lambda: page.frame["time"] == worlds.time[0])
    assert told(page)["shown"] == list(range(9))
    cells = np.array(told(page)["cells"])
    poses = base_poses(page)
    positions = worlds["cube.urdf"].base_inertial_poses
    for world in range(9):
        found = poses[cube_of(page, world)][:3] - (cells[world] - cells[0])
        assert found == pytest.approx(positions[world, :3], abs=1e-5)
    assert np.linalg.norm(cells[1] - cells[0]) == pytest.approx(told(page)["size"])
    # The floor is that of all.
    assert [facts["name"] for (kind, _), facts in page.shown.items() if kind == "body"].count("plane") == 1


def test_the_chosen_world_is_where_it_is_and_has_its_own_numbers(worlds: Worlds, page: Watcher):
    page.tell("worlds", chosen=4)
    wait_for_choice(page, chosen=4)
    assert told(page)["shown"] == list(range(9))
    assert base_poses(page)[CUBE][:3] == pytest.approx(worlds["cube.urdf"].pose.position[4], abs=1e-5)
    assert page.shown["body", CUBE]["name"] == "cube.urdf"
    assert "world" not in page.shown["body", CUBE]
    # What else is told of bodies is about it.
    page.tell("want", joints="all", links=[[CUBE, -1]])
    worlds.step(3)
    page.wait_for(lambda: "links" in page.blocks and page.frame["time"] == worlds.time[4])
    rows = {int(row[0]): row for row in page.blocks["links"]}
    assert rows[CUBE][4] == pytest.approx(worlds["cube.urdf"].velocity.linear[4, 2], rel=1e-4)
    assert {int(row[0]) for row in page.blocks["joints"]} == {2}


def test_a_world_that_is_not_shown_brings_those_around_it(page: Watcher):
    page.tell("worlds", chosen=19)
    wait_for_choice(page, chosen=19, shown=list(range(11, 20)))
    page.tell("worlds", shown=4)
    wait_for_choice(page, chosen=19, shown=[16, 17, 18, 19])
    page.tell("worlds", chosen=20)
    page.tell("worlds", shown=1)
    wait_for_choice(page, chosen=19, shown=[19])


def test_in_one_place_all_but_the_chosen_world_are_seen_through(page: Watcher):
    page.tell("worlds", arrangement="overlay")
    wait_for_choice(page, arrangement="overlay", size=0.0)
    assert np.ptp(told(page)["cells"], axis=0).max() == 0.0
    own, other = page.shown["body", CUBE], page.shown["body", cube_of(page, 3)]
    assert own["shapes"][0]["rgba"][3] == 1.0
    assert 0.0 < other["shapes"][0]["rgba"][3] < 0.5
    assert base_poses(page)[cube_of(page, 3)][:2] == pytest.approx(base_poses(page)[CUBE][:2])


def test_worlds_are_seen_at_the_rate_of_pictures_and_not_at_each_step(
    worlds: Worlds, viewer: Viewer, page: Watcher, monkeypatch: pytest.MonkeyPatch
):
    assert viewer.shown is not None
    before = viewer.shown.seen.time
    # No time for pictures passes.
    monkeypatch.setattr(feed, "monotonic", lambda: 0.0)
    page.tell("worlds", chosen=1)
    wait_for_choice(page, chosen=1)
    for _ in range(50):
        worlds.step()
    assert viewer.shown.seen.time == before
    monkeypatch.undo()
    page.wait_for(lambda: page.frame["time"] == worlds.time[1])


def test_a_frame_says_whether_anything_has_moved(worlds: Worlds, viewer: Viewer):
    shown = viewer.shown
    assert shown is not None
    own = feed.ManyFeed(shown, LatestMessages())
    seen: list[tuple[bool, int]] = []
    for number in (5, 6, 7, 8):
        if number == 7:
            worlds.step()
        assert shown.look(1.0)
        own.follow()
        # What else is told is new each time, so that there is a message.
        message = own.frame({"values": {"n": number}}, number=number)
        assert message is not None
        seen.append((own.moved, decoded(message)[0]["number"]))
    assert seen == [(True, 5), (False, 5), (True, 7), (False, 7)]


def test_only_the_shown_worlds_are_placed(worlds: Worlds, viewer: Viewer, monkeypatch: pytest.MonkeyPatch):
    assert viewer.shown is not None
    placed: list[np.ndarray] = []
    place = worlds.glimpses._place
    monkeypatch.setattr(worlds.glimpses, "_place", lambda which: [placed.append(which), place(which)])
    assert viewer.shown.look(1.0)
    assert {tuple(which.tolist()) for which in placed} == {tuple(range(9))}


def test_worlds_that_are_watched_move_as_others_bit_for_bit(worlds: Worlds, page: Watcher):
    alone = many()
    for count in (1, 5, 20, 1):
        worlds.step(count)
        alone.step(count)
        page.take_what_came()
    assert np.array_equal(worlds["cube.urdf"].base_inertial_poses, alone["cube.urdf"].base_inertial_poses)
    assert np.array_equal(worlds["physics"].joints.positions, alone["physics"].joints.positions)


def test_a_body_is_pulled_in_its_world_alone(worlds: Worlds, viewer: Viewer, page: Watcher):
    alone = many()
    number = cube_of(page, 3)
    at = base_poses(page)[number][:3]
    target = (at + np.array([0.0, 0.0, 1.0])).tolist()
    page.tell("grasp", body=number, link=-1, point=[0, 0, 0], target=at.tolist())
    page.tell("pull", target=target)
    assert until(lambda: is_pulled(viewer))
    # It is pulled at each of these steps.
    worlds.step(200)
    alone.step(200)
    heights = worlds["cube.urdf"].base_inertial_poses[:, 2]
    assert heights[3] == pytest.approx(0.8 + 1.0, abs=0.12)
    others = np.arange(COUNT) != 3
    assert np.array_equal(heights[others], alone["cube.urdf"].base_inertial_poses[others, 2])
    page.tell("let go")
    assert until(lambda: not held(viewer))
    worlds.step(300)
    assert worlds["cube.urdf"].base_inertial_poses[3, 2] < 0.2


def test_a_link_is_pulled_and_the_robot_stays_sound(worlds: Worlds, viewer: Viewer, page: Watcher):
    starts = np.cumsum([0, *(links for _, links in layout(page)["bodies"])])
    at = page.poses[starts[[number for number, _ in layout(page)["bodies"]].index(2)] + 1][:3]
    page.tell("grasp", body=2, link=0, point=[0, 0, 0], target=at.tolist())
    page.tell("pull", target=(at + np.array([0.5, 0.0, 0.0])).tolist())
    assert until(lambda: is_pulled(viewer))
    worlds["physics"].joints.reset(0.0)
    worlds.step(500)
    assert worlds["physics"].joints.positions[0, 0] == pytest.approx(0.5, abs=0.1)
    assert not worlds.halted.any()


def test_while_paused_bodies_are_moved_at_once_and_steps_wait(worlds: Worlds, viewer: Viewer, page: Watcher):
    page.tell("pause", paused=True)
    page.wait_for(lambda: page.shown["pause", None]["paused"])
    stepping = Thread(target=lambda: [worlds.step() for _ in range(3)])
    stepping.start()
    number = cube_of(page, 5)
    at = base_poses(page)[number][:3]
    page.tell("grasp", body=number, link=-1, point=[0, 0, 0], target=at.tolist())
    page.tell("pull", target=(at + np.array([0.0, 0.0, 2.0])).tolist())
    page.wait_for(lambda: base_poses(page)[number][2] > at[2] + 1.9)
    assert (worlds.time == 0.0).all()
    page.tell("let go")
    page.tell("step")
    page.wait_for(lambda: page.frame["time"] == worlds.time_step)
    page.tell("pause", paused=False)
    stepping.join()
    assert worlds.time[0] == pytest.approx(3 * worlds.time_step)


def test_marks_and_reset_are_of_the_chosen_world(worlds: Worlds, page: Watcher):
    worlds.step(10)
    page.tell("worlds", chosen=2)
    wait_for_choice(page, chosen=2)
    page.tell("mark")
    page.wait_for(lambda: ("mark", 0) in page.shown)
    kept = worlds["cube.urdf"].base_inertial_poses.copy()
    worlds.step(20)
    page.wait_for(lambda: page.frame["time"] == worlds.time[2])
    page.tell("restore", mark=0)
    page.wait_for(lambda: page.frame["time"] == page.shown["mark", 0]["time"])
    now = worlds["cube.urdf"].base_inertial_poses
    assert np.array_equal(now[2], kept[2])
    assert not np.array_equal(now[1], kept[1])
    page.tell("reset")
    page.wait_for(lambda: page.frame["time"] == 0.0)
    assert worlds.time[2] == 0.0
    assert worlds.time[1] > 0.0


def test_a_body_that_is_absent_somewhere_is_not_shown_there(worlds: Worlds, page: Watcher):
    number = cube_of(page, 3)
    worlds["cube.urdf"].set_present(False, where=[3])
    page.wait_for(lambda: ("body", number) not in page.shown)
    assert ("body", cube_of(page, 2)) in page.shown


def test_what_cannot_be_shown_is_refused_and_the_worlds_stay_as_they_were(worlds: Worlds):
    refused: list[tuple[dict[str, Any], str]] = [
        ({"shown": 0}, "shown must be 1 to 256 worlds"),
        ({"shown": 300}, "not 300"),
        ({"shown": [0, 20]}, "there is no world 20: there are worlds 0 to 19"),
        ({"chosen": -1}, "there is no world -1"),
        ({"arrangement": "heap"}, "arrangement must be one of 'grid', 'overlay', not 'heap'"),
        ({"spacing": 0.0}, "spacing must be a distance above 0"),
    ]
    for choice, words in refused:
        with pytest.raises(ValueError, match=words):
            Viewer(worlds, port=0, **choice)
    with pytest.raises(ValueError, match=r"shown: only for Worlds; this is a single World"):
        Viewer(scene(), port=0, shown=4)
    assert worlds.observers == []


def test_a_closed_viewer_leaves_the_worlds_alone(worlds: Worlds):
    viewer = Viewer(worlds, port=0, shown=[5, 1, 3], chosen=1)
    assert viewer.shown is not None
    assert viewer.shown.plan.numbers == (5, 1, 3)
    assert len(worlds.observers) == 1
    viewer.close()
    assert worlds.observers == []
    worlds.step()
