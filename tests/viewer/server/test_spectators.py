"""Spectators: who has their link sees everything, and what else they send does nothing."""

from __future__ import annotations

import json
import re
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable
from typing import Any

import pytest
from tests.viewer.watcher import Watcher, origin_of
from websockets.exceptions import InvalidStatus

import pybullet as p
import pybullet_data
from carom import World
from carom.viewer.access import Access
from carom.viewer.protocol import from_page
from carom.viewer.viewer import Viewer

# A message of each type, sound in itself.
POINT, TURN = [0, 0, 0], [0, 0, 0, 1]
MESSAGES: dict[str, dict[str, Any]] = {
    "SLIDER": {"slider": 0, "value": 1},
    "PRESS": {"slider": 1},
    "FIELD": {"field": 2, "text": "mine"},
    "KEY": {"key": "a", "code": "KeyA", "down": True},
    "BLUR": {},
    "MOUSE": {"x": 1, "y": 1, "button": 0, "down": True},
    "CAMERA": {"distance": 9, "yaw": 0, "pitch": 0, "target": POINT},
    "SIZE": {"width": 77, "height": 66},
    "VISIBLE": {"visible": True},
    "DRAWN": {"picture": 5},
    "DRIVE": {"body": 0, "joint": 3, "target": 1.0},
    "CONTROL": {"body": 0, "actuator": 0, "control": 1.0},
    "GIVE_BACK": {"body": 0, "joint": 3},
    "HANDLE": {"handle": 0, "position": [1, 1, 1], "orientation": TURN},
    "SLEEP": {},
    "PROFILE": {"running": True},
    "GRASP": {"body": 0, "link": 3, "point": POINT, "target": [0, 0, 9]},
    "PULL": {"target": [0, 0, 9]},
    "TURN": {"body": 0, "link": 3, "orientation": TURN},
    "LET_GO": {},
    "GAMEPADS": {"gamepads": [{"name": "pad", "axes": [1], "buttons": [1], "standard": True}]},
    "PAUSE": {"paused": True},
    "STEP": {},
    "SPEED": {"speed": 0.01},
    "RESET": {},
    "MARK": {},
    "RESTORE": {"mark": 0},
    "CLOSE": {},
    "WORLDS": {"chosen": 0},
    "KEYFRAME": {"action": "save", "name": "mine"},
    "SETTING": {"name": "gravity", "value": [0, 0, 9]},
    "ARGUMENTS": {"values": {"arm": "true"}},
    "RELOAD": {},
    "UPLOAD": {"name": "robot.urdf", "start": True, "data": ""},
    "OPEN": {},
}
ASKING = {"PAST", "PREVIEW_WIDTH", "WANT"}


def fetched(address: str, cookie: str | None = None) -> tuple[str, dict[str, str]]:
    request = urllib.request.Request(address, headers={"Cookie": cookie} if cookie else {})
    with urllib.request.urlopen(request) as answer:
        return answer.read().decode("utf-8", "replace"), dict(answer.headers)


def test_nobody_finds_the_token_by_that_of_spectators():
    access = Access(token="first")
    # One way, the same in each process, and another one for each token.
    assert access.spectator_token == Access(token="first").spectator_token
    assert re.fullmatch(r"[\w-]{22}", access.spectator_token)
    assert len({Access().spectator_token for _ in range(20)}) == 20
    assert access.spectator_address(8400) == f"http://127.0.0.1:8400/?token={access.spectator_token}"
    # That of the spectators of spectators opens nothing.
    onward = Access(token=access.spectator_token).spectator_token
    for path in (f"/socket?token={onward}", "/socket?token=first ", "/socket?token="):
        assert not access.is_spectator(path)
        assert not access.may_connect(path, "localhost:8400", "http://localhost:8400")


def test_a_request_of_a_spectator_is_none_of_who_runs_it():
    access = Access("0.0.0.0")
    path = f"/socket?token={access.spectator_token}"
    assert access.is_spectator(path)
    assert access.may_connect(path, "192.168.1.20:8400", None)
    assert access.may_read(path, "hub.example.org", None)
    assert access.is_known(path, "hub.example.org", None)
    assert not access.guesses_token(path)
    assert not access.knows_token(path)
    assert not access.has_cookie(f"carom-{access.token[:4]}={access.spectator_token}")
    assert not access.is_spectator(f"/socket?token={access.token}")


def test_only_what_asks_to_be_shown_is_let_through():
    assert MESSAGES.keys() | ASKING == from_page.ALL.keys()
    assert {from_page.ALL[name].type for name in ASKING} == from_page.SPECTATING
    for name, facts in MESSAGES.items():
        from_page.checked(from_page.ALL[name](**facts))


def _answered(viewer: Viewer, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The types of the messages that the viewer takes from now on."""
    answered: list[str] = []

    def noting(kind: str, take: Callable[..., None]) -> Callable[..., None]:
        def note(page: int, message: dict[str, Any]) -> None:
            answered.append(kind)
            take(page, message)

        return note

    for message, take in list(viewer._answers.items()):
        monkeypatch.setitem(viewer._answers, message, noting(message.type, take))
    return answered


def test_hostile_messages_of_a_spectator_do_nothing(viewer: Viewer, monkeypatch: pytest.MonkeyPatch):
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    slider, button = p.addUserDebugParameter("gain", 0, 2, 0.5), p.addUserDebugParameter("again", 1, 0, 0)
    viewer.handle("goal", (0, 0, 1))
    p.stepSimulation()
    before = p.getJointState(arm, 3), p.getDebugVisualizerCamera()
    answered = _answered(viewer, monkeypatch)
    with Watcher(viewer.spectator_address) as page:
        for name, facts in MESSAGES.items():
            page.tell(from_page.ALL[name].type, **facts)
            # Types that are none, or look alike.
            page.tell(f" {from_page.ALL[name].type}", **facts)
        for text in ("", "[]", '{"type": ["pause"]}', '{"type": "pause", "type": "what"}'):
            page.send_raw(text)
        page.tell("want", collisions=True)
        body = {"shapes": []}
        page.wait_for(
            lambda: any(it.get("collision") for it in page.shown.get(("body", arm), body)["shapes"])
        )
        assert answered == ["want"]
        assert (p.getJointState(arm, 3), p.getDebugVisualizerCamera()) == before
        assert p.readUserDebugParameter(slider) == 0.5
        assert p.readUserDebugParameter(button) == 0
        assert p.getKeyboardEvents() == {}
        assert p.getMouseEvents() == ()
        assert viewer.gamepads() == []
        assert viewer.is_open
        assert not viewer.pause_control.closed
        assert viewer.pause_control.speed is None
        p.stepSimulation()
    assert p.isConnected()


def test_a_spectator_sees_everything_and_the_past(viewer: Viewer):
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    slider = p.addUserDebugParameter("gain", 0, 2, 0.5)
    with Watcher(viewer.spectator_address) as page:
        for _ in range(10):
            p.stepSimulation()
        page.wait_for(lambda: page.frame.get("time", 0) == pytest.approx(10 / 240))
        assert ("body", ball) in page.shown
        assert page.shown["slider", slider]["value"] == 0.5
        page.tell("past", before=page.frame["number"] + 1, known=True)
        page.wait_for(lambda: ("past", None) in page.shown)


def test_who_asks_again_and_again_is_a_spectator_too(viewer: Viewer, monkeypatch: pytest.MonkeyPatch):
    slider = p.addUserDebugParameter("gain", 0, 2, 0.5)
    answered = _answered(viewer, monkeypatch)
    told = urllib.parse.quote(json.dumps({"type": "slider", "slider": slider, "value": 2}))
    own, theirs = (address.replace("/?", "/poll?") for address in (viewer.address, viewer.spectator_address))

    def number(address: str, name: str) -> int:
        with urllib.request.urlopen(f"{address}&page={name}&told={told}") as answer:
            return int.from_bytes(answer.read()[:4], "little")

    first = number(theirs, "other")
    assert answered == []
    # The name of a page of somebody else makes it none of theirs.
    page = number(own, "page")
    assert answered == ["slider"]
    assert number(theirs, "page") not in (first, page)
    assert number(theirs, "other") == first
    assert answered == ["slider"]
    assert number(own, "other") not in (first, page)
    assert answered == ["slider", "slider"]


def test_no_cookie_comes_of_their_link_and_none_makes_more_of_it(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
):
    text, headers = fetched(viewer.spectator_address)
    assert '<body class="spectator">' in text
    assert "Set-Cookie" not in headers
    assert viewer._server.access.token not in text
    _, headers = fetched(viewer.address)
    cookie = headers["Set-Cookie"].partition(";")[0]
    text, headers = fetched(viewer.spectator_address, cookie)
    assert '<body class="spectator">' in text
    assert "Set-Cookie" not in headers
    answered = _answered(viewer, monkeypatch)
    headers = {"Cookie": cookie}
    origin = origin_of(viewer.address)
    with Watcher(viewer.spectator_address, origin=origin, additional_headers=headers) as page:
        page.tell("pause", paused=True)
        page.tell("want", contacts=True)
        page.wait_for(lambda: answered)
    assert answered == ["want"]
    assert '<body class="spectator">' not in fetched(viewer.address)[0]
    replay = viewer.spectator_address.replace("/?", "/replay.html?")
    assert "RECORDING" in fetched(replay)[0]


def test_without_their_token_spectators_see_nothing(viewer: Viewer):
    address = viewer.spectator_address
    for wrong in (address[:-1], address + "x", address.partition("?")[0]):
        with pytest.raises(urllib.error.HTTPError) as refused:
            fetched(wrong)
        assert refused.value.code == 403
        with pytest.raises(InvalidStatus, match="403"):
            Watcher(wrong if "?" in wrong else f"{wrong}?")


def test_no_script_waits_for_a_spectator(monkeypatch: pytest.MonkeyPatch):
    viewer = Viewer(World(), port=0)
    waited: list[set[int]] = []
    wait = viewer._pictures.wait
    monkeypatch.setattr(
        viewer._pictures, "wait", lambda pages, patience: (waited.append(pages()), wait(pages, 0.0))
    )
    try:
        with Watcher(viewer.spectator_address) as spectator:
            spectator.wait_for(lambda: spectator.shown)
            assert viewer.page_count == 1
            viewer.draw_now()
            assert waited == []
            with Watcher(viewer.address) as page:
                page.wait_for(lambda: page.shown)
                viewer.draw_now()
                assert [len(pages) for pages in waited] == [1]
    finally:
        viewer.close()


def test_a_pause_that_spectators_alone_could_see_ends(viewer: Viewer, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("carom.viewer.viewer._RECONNECTION", 0.01)
    with Watcher(viewer.spectator_address) as spectator:
        with Watcher(viewer.address) as page:
            page.tell("pause", paused=True)
            spectator.wait_for(lambda: spectator.shown.get(("pause", None), {}).get("paused"))
        spectator.wait_for(lambda: not spectator.shown["pause", None]["paused"])
    assert not viewer.pause_control.closed
