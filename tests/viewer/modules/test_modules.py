"""Modules of the page that need neither a simulation nor pictures, in an empty page, which is quick."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import inf, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.viewer.browser import needs_browser
from tests.viewer.watcher import origin_of

import carom.viewer as viewer_package
from carom.description.pose import Pose
from carom.description.transform import compose, rotation_matrix
from carom.viewer.page_files import lasting_files
from carom.viewer.protocol import from_page
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
# Beside the modules that it imports.
FOLDER = next(iter(lasting_files())).partition("/")[0]
FUNCTIONS = Path(__file__).with_name("functions.js")
NOTEBOOK = Path(viewer_package.__file__).parent / "page" / "notebook.js"


@pytest.fixture
def evaluate(viewer: Viewer, browser) -> Iterator:
    """Calls a function of `functions.js`, which imports modules of the page, in an empty page."""
    page = browser.new_page()
    page.route("**/empty", lambda route: route.fulfill(body="<!doctype html>", content_type="text/html"))
    page.route("**/functions.js", lambda route: route.fulfill(path=FUNCTIONS))
    page.goto(origin_of(viewer.address) + "/empty")
    yield lambda name, value=None: page.evaluate(
        f"async (value) => (await import('/{FOLDER}/functions.js')).{name}(value)", value
    )


def messages(x: float) -> list[dict[str, Any]]:
    """A message of each type that has numbers, all of them the same."""
    point, orientation = [x] * 3, [x] * 4
    pad = {"name": "pad", "axes": [x, x], "buttons": [x], "standard": True}
    return [
        from_page.SLIDER(slider=x, value=x),
        from_page.PRESS(slider=x),
        from_page.FIELD(field=x, text="mine"),
        from_page.MOUSE(x=x, y=x, button=x, down=True),
        from_page.CAMERA(distance=x, yaw=x, pitch=x, target=point, chosen=True),
        from_page.SIZE(width=x, height=x),
        from_page.DRAWN(picture=x),
        from_page.PAST(before=x, known=True),
        from_page.PREVIEW_WIDTH(width=x),
        from_page.WANT(joints=[x], links=[[x, x]], sensors=[x], rays=True),
        from_page.DRIVE(body=x, joint=x, mode="torque", target=x),
        from_page.CONTROL(body=x, actuator=x, control=x),
        from_page.GIVE_BACK(body=x, joint=x),
        from_page.HANDLE(handle=x, position=point, orientation=orientation),
        from_page.GRASP(body=x, link=x, point=point, target=point),
        from_page.PULL(target=point),
        from_page.TURN(body=x, link=x, orientation=orientation),
        from_page.GAMEPADS(gamepads=[pad, pad]),
        from_page.SPEED(speed=x),
        from_page.RESTORE(mark=x),
        from_page.WORLDS(chosen=x, shown=x, arrangement="grid"),
        from_page.SETTING(name="gravity", value=point),
    ]


def test_a_page_never_sends_a_number_that_is_refused(evaluate):
    with_numbers = {
        message.type
        for message in from_page.ALL.values()
        if any(field.kind.bounds for field in message.fields.values())
    }
    assert {header["type"] for header in messages(0)} == with_numbers
    for x in (-inf, -1e200, 0, 1e200, inf):
        for header in evaluate("bounds", messages(x)):
            from_page.checked(header)
    within = from_page.DRIVE(body=2, joint=3, mode="velocity", target=-0.125)
    others = [from_page.SPEED(speed=None), from_page.WANT(joints="all"), from_page.PAUSE(paused=True), within]
    assert evaluate("bounds", others) == others
    assert evaluate("bounds", messages(nan)) == [None] * len(with_numbers)


def test_a_message_is_shown_until_another_takes_its_place_or_it_is_removed(evaluate):
    shown, kept, later, newest, stays = evaluate("shown")
    assert shown == ["s", "sa", "sa", "sb", "sb", "s", "s"]
    # A version that ended with frame 3 is not needed from that frame on.
    assert kept == [[2, 3], [1, 2], [1, 2], [0, 1]]
    assert later == ["s", "s"]
    assert newest is None
    assert stays == "s"


def test_what_was_shown_before_the_page_joined_ends_where_the_page_knows_better(evaluate):
    shown, newest = evaluate("earlier")
    assert shown == [
        ["gone g", "left l", "replaced old", "same s"],
        ["gone g", "left l", "replaced old", "same s"],
        ["left l", "replaced old", "same s"],
        ["replaced new", "same s"],
    ]
    assert newest == ["s", "new", None, None]


def test_what_is_plotted_is_asked_for(evaluate):
    everything, nothing = evaluate("wants")
    assert everything == {"joints": [1], "links": [[2, -1]], "sensors": [3, 4], "contacts": True}
    assert nothing == {"joints": [], "links": [], "sensors": [], "contacts": False}


def test_the_last_part_of_a_motion_counts_that_only_the_release_of_the_button_tells(evaluate):
    down, up = ["mouse", 10, 10, True], ["mouse", 40, 10, False]
    told = evaluate("motions")
    assert told["turned"] == [
        down, ["mouse", 40, 10, None], ["begin", 10, 10, False], ["orbit", 30, 0], ["moved"], up, ["end"]
    ]  # fmt: skip
    assert told["clicked"] == [down, ["clicked", 10, 10], ["mouse", 10, 10, False], ["end"]]
    assert ["mouse", 0, 0, None] not in told["cancelled"]
    assert [each for each in told["pulled"] if each[0] in ("move", "end")] == [
        ["move", 20, 10], ["move", 40, 15], ["end"]
    ]  # fmt: skip


def test_the_scale_of_arrows_grows_at_once_and_shrinks_after_a_calm(evaluate):
    # The longest arrow is 0.3 m for a camera 1 m away: 3 N make 10 N/m, 30 N make 100 N/m.
    pictures = [
        (3, 0.0),
        (30, 0.1),
        (3, 0.2),
        (3, 0.6),
        (3, 0.8),
        (0, 2.0),
        (30, 3.0),
        (3, 4.0),
        (30, 4.1),
        (3, 9.0),
    ]
    assert evaluate("scales", pictures) == [10, 100, 100, 100, 10, 10, 100, 100, 100, 100]


def test_a_trail_has_the_last_seconds_of_a_link_in_frames_of_one_layout(evaluate):
    last, first, base, *nothing = evaluate("trails", 10)
    assert last == [4, 5, 6, 7, 8, 9]
    assert first == [1, 2]
    assert base == [0, 0]
    assert nothing == [[], [], []]
    assert evaluate("trails", 3)[:2] == [[0, 1, 2], [0, 1, 2]]


def test_links_are_named_that_are_shown(evaluate):
    assert evaluate("names") == [["base", 1, 0, 0], ["arm", 1, 1, 0]]


def test_shapes_are_drawn_where_their_links_have_them(evaluate):
    rng = np.random.default_rng(3)

    def pose() -> Pose:
        quaternion = rng.normal(size=4)
        x, y, z, w = (quaternion / np.linalg.norm(quaternion)).tolist()
        return Pose((x + 1, y, z - 2), (w, x, y, z))

    links, places = [pose() for _ in range(3)], [pose() for _ in range(3)]
    scales, colours = rng.uniform(0.5, 2.0, (3, 3)), rng.uniform(size=(3, 4))
    shapes = [
        {
            "position": list(place.position),
            "orientation": list(place.orientation),
            "scale": scale.tolist(),
            "colour": colour.tolist(),
            "specular": [0.25, 0.5, 0.75],
        }
        for place, scale, colour in zip(places, scales, colours, strict=True)
    ]
    poses = [[*link.position, *link.orientation] for link in links]
    found = np.array(evaluate("instances", {"poses": poses, "shapes": shapes}))
    for link, place, scale, colour, numbers in zip(links, places, scales, colours, found, strict=True):
        shown = compose(link, place)
        axes = np.reshape(rotation_matrix(shown.orientation), (3, 3)) * scale
        assert numbers[:9] == pytest.approx(axes.T.ravel(), abs=1e-5)
        assert numbers[9:12] == pytest.approx(shown.position, abs=1e-5)
        assert numbers[12:16] == pytest.approx(colour)
        assert numbers[16:].tolist() == [0.25, 0.5, 0.75]


def test_lines_seen_through_bodies_are_drawn_over_a_coarse_picture(evaluate):
    red, blue, nothing = [255, 0, 0], [0, 0, 255], [0, 0, 0]
    both = [True, red, blue]
    assert evaluate("sharpLines") == [both, [True, nothing, blue], [False], both]


def test_knobs_are_as_large_on_the_screen_from_everywhere(evaluate):
    near, far = evaluate("knobs", [2.0, 6.0])
    assert [kind for kind, _ in near] == ["carry", *["shift", "turn"] * 3]
    assert near[0][1] == 0.0 and near[1][1] > 0.0
    # They grow with the distance along the view, and not aside of it.
    assert [reach for _, reach in far] == pytest.approx([3.0 * reach for _, reach in near])


def test_the_box_of_a_sheet_is_flat_and_there_is_none_without_its_mesh(evaluate):
    assert evaluate("sheet") == [[[1, -2, -2], [1, 2, 4]], None]


def test_two_fingers_zoom_and_one_does_nothing(evaluate):
    alone, spread, after = evaluate("pinches")
    assert alone == after == []
    # From 10 to 20 pixels apart, and their middle from 55 to 60, which the zoom about 50 leaves at 60.
    assert spread == [["zoom", 0.5], ["pan", 0, 0]]


def test_a_page_takes_over_all_switches(evaluate):
    count, undecided = evaluate("undecided")
    assert count > 30 and undecided == []


def test_a_page_keeps_whether_its_plots_are_open(evaluate):
    (first, opened), (last, closed) = evaluate("docks")
    assert first == last == "dock"
    assert (opened["open"], closed["open"]) == (True, False)


def test_a_page_that_polls_begins_anew_with_each_number_of_the_server(evaluate):
    assert evaluate("polls", [5, 5, 260, 260, 5]) == 3


def test_a_notebook_says_that_no_server_can_be_reached(evaluate):
    facts = {"id": "frame", "port": 1, "token": "x", "proxy": None, "unreachable": "nobody"}
    script = NOTEBOOK.read_text(encoding="utf-8").replace("FACTS", json.dumps(facts))
    assert evaluate("notebook", script) == "nobody"


def test_a_look_at_the_page_draws_what_has_changed_or_has_another_size(evaluate):
    looks = [(False, False), (True, False), (False, False), (False, True), (True, True), (False, False)]
    assert evaluate("drawn", looks) == [0, 1, 0, 1, 1, 0]


def test_reflections_are_seen_from_below_the_plane_that_mirrors(evaluate):
    (x, y, z), none, ground, plane = evaluate("reflections")
    assert none == []
    assert ground == [[pytest.approx([x, y, -z]), 0]]
    assert plane == [[pytest.approx([x, y, 0.5 - z]), 0.25]]
