"""What pages are told over their socket, and what they can do."""

import http.client
import logging
import re
import socket
import threading
from pathlib import Path

import numpy as np
import pytest
from tests.patience import PATIENCE
from tests.viewer.watcher import Watcher, origin_of, socket_address
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin

import pybullet as p
import pybullet_data
from carom.viewer.page_files import lasting_files
from carom.viewer.viewer import Viewer

PAGE = Path(__file__).parents[3] / "src" / "carom" / "viewer" / "page"


def panda() -> int:
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    return p.loadURDF("franka_panda/panda.urdf", [0, 0, 0.5], useFixedBase=True)


def request(
    viewer: Viewer, path: str, host: str | None = None, *, known: bool = True
) -> http.client.HTTPResponse:
    address = origin_of(viewer.address).removeprefix("http://")
    if known:
        path += ("&" if "?" in path else "?") + viewer.address.partition("/?")[2]
    connection = http.client.HTTPConnection(address, timeout=PATIENCE)
    connection.request("GET", path, headers={"Host": host or address})
    return connection.getresponse()


def test_the_page_and_nothing_else_is_served(viewer: Viewer):
    folder, _, _ = next(iter(lasting_files())).partition("/")
    for name in ("main.js", "style.css", "icon.svg", "view/scene.js"):
        answer = request(viewer, f"/{folder}/{name}?x=1")
        assert answer.status == 200
        assert answer.read() == (PAGE / name).read_bytes()
        assert "default-src 'self'" in (answer.getheader("Content-Security-Policy") or "")
        assert answer.getheader("Cache-Control") == "public, max-age=31536000, immutable"
        assert answer.getheader("Set-Cookie") is None
    page = request(viewer, "/")
    assert (page.status, page.getheader("Cache-Control")) == (200, "no-cache")
    named = set(re.findall(r' (?:href|src)="([^"]+)"', page.read().decode()))
    assert named == set(lasting_files())
    for path in (
        "/../server.py",
        "/%2e%2e/server.py",
        "/etc/passwd",
        "//",
        "/server.py",
        f"/{folder}/main.js/",
    ):
        assert request(viewer, path).status == 404
    assert request(viewer, "/icon.svg", known=False).getheader("Cache-Control") == "no-cache"
    assert request(viewer, "/main.js").status == request(viewer, f"/{'0' * 16}/main.js").status == 404


def test_strangers_are_turned_away(viewer: Viewer):
    assert request(viewer, "/", host="evil.example", known=False).status == 421
    with pytest.raises(InvalidStatus, match="403"):
        Watcher(f"{origin_of(viewer.address)}/?", origin="http://evil.example")
    with Watcher(viewer.address, origin=origin_of(viewer.address)) as page:
        page.wait_for(lambda: ("title", None) in page.shown)


def test_other_users_of_the_machine_are_turned_away(viewer: Viewer):
    origin = origin_of(viewer.address)
    with pytest.raises(InvalidStatus, match="403"):
        Watcher(f"{origin}/?token=guessed")
    with pytest.raises(InvalidStatus, match="403"):
        Watcher(f"{origin}/?", origin=origin)
    refused = request(viewer, "/", known=False)
    assert refused.status == 403
    assert b"whole address" in refused.read()


def test_a_browser_that_knew_the_token_once_is_known_by_its_cookie(viewer: Viewer):
    origin = origin_of(viewer.address)
    cookie = (request(viewer, "/").getheader("Set-Cookie") or "").partition(";")[0]
    assert cookie
    with connect(socket_address(f"{origin}/?"), origin=Origin(origin), additional_headers={"Cookie": cookie}):
        pass
    with pytest.raises(InvalidStatus, match="403"):
        connect(
            socket_address(f"{origin}/?"),
            origin=Origin("http://evil.example"),
            additional_headers={"Cookie": cookie},
        )


def test_a_page_that_joins_late_gets_the_whole_scene(viewer: Viewer):
    arm = panda()
    p.loadURDF("plane.urdf")
    p.addUserDebugLine([0, 0, 0], [1, 2, 3], [1, 0, 0], 2)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: len(page.poses) == 1 + p.getNumJoints(arm) + 1)
        body = page.shown["body", arm]
        assert body["name"] == "panda"
        names = [p.getJointInfo(arm, joint)[12].decode() for joint in range(p.getNumJoints(arm))]
        assert [link["name"] for link in body["links"][1:]] == names
        looks = p.getVisualShapeData(arm)
        assert len(body["shapes"]) == len(looks)
        for shape in body["shapes"]:
            mesh = page.shown["mesh", shape["meshes"][0][0]]
            assert (
                len(page.payloads["mesh", shape["meshes"][0][0]])
                == 32 * mesh["vertices"] + 12 * mesh["triangles"]
            )
        floor = page.shown["body", 1]["shapes"][0]
        assert ("texture", floor["texture"]) in page.shown
        assert page.shown["item", 0]["end"] == [1, 2, 3]


def test_poses_are_those_of_the_world(viewer: Viewer):
    arm = panda()
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: len(page.poses))
        for joint in range(7):
            p.resetJointState(arm, joint, 0.3 * joint - 1)
        for _ in range(10):
            p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(10 / 240))
        for joint in range(p.getNumJoints(arm)):
            state = p.getLinkState(arm, joint)
            assert state is not None
            position, orientation = state[:2]
            np.testing.assert_allclose(page.poses[joint + 1, :3], position, atol=1e-6)
            assert abs(page.poses[joint + 1, 3:] @ orientation) == pytest.approx(1, abs=1e-6)


def test_bodies_come_and_go(viewer: Viewer):
    ball = p.createVisualShape(p.GEOM_SPHERE, radius=0.25, rgbaColor=[1, 0, 0, 0.5])
    bodies = [p.createMultiBody(1, -1, ball, [i, 0, 0]) for i in range(3)]
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: len(page.poses) == 3)
        levels = [page.shown["body", body]["shapes"][0]["meshes"] for body in bodies]
        assert levels[0] == levels[1] == levels[2]
        # The smaller a ball looks, the fewer triangles it needs.
        triangles = [page.shown["mesh", mesh]["triangles"] for mesh, _ in levels[0]]
        reaches = [reach for _, reach in levels[0]]
        assert triangles == sorted(triangles, reverse=True)
        assert reaches[0] is None
        assert reaches[1:] == sorted(reaches[1:], reverse=True)
        assert page.shown["body", bodies[0]]["shapes"][0]["rgba"] == [1, 0, 0, 0.5]
        assert page.shown["body", bodies[0]]["shapes"][0]["scale"] == [0.25] * 3
        p.removeBody(bodies[1])
        page.wait_for(lambda: len(page.poses) == 2)
        assert ("body", bodies[1]) not in page.shown
        assert page.poses[:, 0].tolist() == [0, 2]
        p.changeVisualShape(bodies[0], -1, rgbaColor=[0, 1, 0, 1])
        page.wait_for(lambda: page.shown["body", bodies[0]]["shapes"][0]["rgba"] == [0, 1, 0, 1])
        p.resetSimulation()
        page.wait_for(lambda: len(page.poses) == 0)
        page.wait_for(lambda: not any(kind in ("body", "mesh") for kind, _ in page.shown))
        p.createMultiBody(1, -1, p.createVisualShape(p.GEOM_BOX, halfExtents=[1, 2, 3]))
        page.wait_for(lambda: len(page.poses) == 1)
        assert page.shown["body", 0]["shapes"][0]["scale"] == [1, 2, 3]


def test_changed_textures_are_sent_again(viewer: Viewer):
    panda()
    plane = p.loadURDF("plane.urdf")
    texture = p.loadTexture("checker_blue.png")
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("body", plane) in page.shown)
        p.changeVisualShape(plane, -1, textureUniqueId=texture)
        p.changeTexture(texture, [255, 0, 0] * 4, 2, 2)
        page.wait_for(
            lambda: (
                page.payloads.get(("texture", page.shown["body", plane]["shapes"][0]["texture"]))
                == bytes([255, 0, 0]) * 4
            )
        )


def test_collision_shapes_are_sent_when_a_page_wants_them(viewer: Viewer):
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 1]), -1)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("body", 0) in page.shown)
        page.tell("want", collisions=True)
        page.wait_for(lambda: any(shape.get("collision") for shape in page.shown["body", 0]["shapes"]))
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: len(page.poses))
        page.wait_for(lambda: not any(shape.get("collision") for shape in page.shown["body", 0]["shapes"]))


def test_sliders_and_buttons_are_moved_by_pages(viewer: Viewer):
    slider = p.addUserDebugParameter("gain", -1, 2, 0.5)
    button = p.addUserDebugParameter("again", 1, 0, 0)
    with Watcher(viewer.address) as page, Watcher(viewer.address) as other:
        page.wait_for(lambda: ("slider", button) in page.shown)
        assert page.shown["slider", slider]["value"] == 0.5
        assert page.shown["slider", button]["button"]
        page.tell("slider", slider=slider, value=1.25)
        page.tell("press", slider=button)
        page.tell("press", slider=button)
        other.wait_for(lambda: other.shown.get(("slider", button), {}).get("value") == 2)
        assert p.readUserDebugParameter(slider) == 1.25
        assert p.readUserDebugParameter(button) == 2
        page.tell("slider", slider=slider, value=99)
        page.tell("press", slider=slider)
        page.tell("slider", slider=button, value=7)
        other.wait_for(lambda: other.shown["slider", slider]["value"] == 2)
        assert p.readUserDebugParameter(button) == 2
        p.removeAllUserParameters()
        page.wait_for(lambda: not any(kind == "slider" for kind, _ in page.shown))


def test_nonsense_from_a_page_does_no_harm(viewer: Viewer):
    slider = p.addUserDebugParameter("gain", 0, 1, 0.5)
    with Watcher(viewer.address) as page:
        for text in (
            "",
            "{",
            "[]",
            "{}",
            '{"type": 3}',
            '{"type": "what"}',
            '{"type": "slider"}',
            b"\xff\x00",
            "[" * 5000,
            '{"type": "key", "key": ' + "[" * 5000,
            '{"type": "size", "width": 1e999, "height": 1}',
        ):
            page.send_raw(text)
        for value in ("x", None, [], float("nan"), float("inf")):
            page.tell("slider", slider=slider, value=value)
        page.tell("camera", distance=float("nan"), yaw=0, pitch=0, target=[0, 0, 0])
        page.tell("camera", distance=1, yaw=0, pitch=0, target=[0, 0])
        page.tell("size", width=0, height=-3)
        page.tell("slider", slider=slider, value=0.75)
        page.wait_for(lambda: page.shown.get(("slider", slider), {}).get("value") == 0.75)
    assert p.getDebugVisualizerCamera()[:2] == (1024, 768)


def test_a_message_that_is_too_long_ends_the_socket_and_no_more(viewer: Viewer):
    with Watcher(viewer.address) as page:
        page.send_raw("x" * (1 << 17))
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("title", None) in page.shown)


def test_the_camera_goes_both_ways(viewer: Viewer):
    with Watcher(viewer.address) as page:
        p.resetDebugVisualizerCamera(2, 30, -20, [1, 2, 3])
        page.wait_for(lambda: page.shown.get(("camera", None), {}).get("distance") == 2)
        assert page.shown["camera", None]["target"] == [1, 2, 3]
        page.tell("size", width=800, height=400)
        page.tell("camera", distance=4, yaw=10, pitch=-5, target=[0, 0, 1])
        page.tell("press", slider=-1)
        slider = p.addUserDebugParameter("news")
        page.tell("slider", slider=slider, value=1)
        page.wait_for(lambda: page.shown.get(("slider", slider), {}).get("value") == 1)
    info = p.getDebugVisualizerCamera()
    assert info[:2] == (800, 400)
    assert info[8:] == (10, -5, 4, (0, 0, 1))
    assert info[3][5] / info[3][0] == pytest.approx(2)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("camera", None) in page.shown)
        assert page.shown["camera", None]["distance"] == 4


def test_drawings_appear_change_and_go(viewer: Viewer):
    line = p.addUserDebugLine([0, 0, 0], [1, 0, 0])
    points = p.addUserDebugPoints([[0, 0, i] for i in range(10_000)], [[1, 0, 0]] * 10_000, 3)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("item", points) in page.shown)
        assert len(page.payloads["item", points]) == 10_000 * 24
        p.addUserDebugText(
            "tip", [0, 0, 1], parentObjectUniqueId=0, parentLinkIndex=2, replaceItemUniqueId=line
        )
        page.wait_for(lambda: page.shown["item", line]["type"] == "text")
        assert page.shown["item", line]["link"] == 3
        brief = p.addUserDebugLine([0, 0, 0], [0, 0, 1], lifeTime=0.2)
        page.wait_for(lambda: ("item", brief) in page.shown)
        page.wait_for(lambda: ("item", brief) not in page.shown)
        p.removeAllUserDebugItems()
        page.wait_for(lambda: not any(kind == "item" for kind, _ in page.shown))


def test_drawings_that_are_over_do_not_pile_up_unwatched(viewer: Viewer):
    for _ in range(50):
        p.addUserDebugLine([0, 0, 0], [0, 0, 1], lifeTime=1e-9)
    assert len(viewer.drawings.items) <= 2


def test_options_reach_the_page(viewer: Viewer):
    with Watcher(viewer.address) as page:
        p.configureDebugVisualizer(
            p.COV_ENABLE_WIREFRAME, 1, lightPosition=[1, 2, 3], rgbBackground=[0, 0, 1]
        )
        p.setDebugObjectColor(3, 1, [1, 0, 0])
        options = page.wait_for(lambda: page.shown.get(("options", None)))
        page.wait_for(lambda: page.shown["options", None]["colours"])
        options = page.shown["options", None]
        assert options["flags"] == {str(p.COV_ENABLE_WIREFRAME): True}
        assert options["light_position"] == [1, 2, 3]
        assert options["background"] == [0, 0, 1]
        assert options["colours"] == [[3, 2, [1, 0, 0]]]


def test_keys_and_mouse_reach_the_script(viewer: Viewer):
    slider = p.addUserDebugParameter("news")
    with Watcher(viewer.address) as page:

        def settle() -> None:
            value = p.readUserDebugParameter(slider) or 0
            page.tell("slider", slider=slider, value=1 - value)
            page.wait_for(lambda: page.shown.get(("slider", slider), {}).get("value") == 1 - value)

        page.tell("key", key="Enter", code="Enter", down=True)
        page.tell("mouse", x=10, y=20, button=0, down=True)
        settle()
        assert p.getKeyboardEvents() == {p.B3G_RETURN: p.KEY_IS_DOWN | p.KEY_WAS_TRIGGERED}
        assert p.getMouseEvents() == ((2, 10, 20, 0, p.KEY_IS_DOWN | p.KEY_WAS_TRIGGERED),)
        assert p.getKeyboardEvents() == {p.B3G_RETURN: p.KEY_IS_DOWN}
        page.tell("key", key="Enter", code="Enter", down=False)
        settle()
        assert p.getKeyboardEvents() == {p.B3G_RETURN: p.KEY_WAS_RELEASED}


def test_pausing_holds_steps_until_they_are_let_through(viewer: Viewer):
    made = []
    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        page.wait_for(lambda: page.shown.get(("pause", None), {}).get("paused"))

        def steps() -> None:
            for number in range(3):
                p.stepSimulation()
                made.append(number)

        script = threading.Thread(target=steps)
        script.start()
        page.tell("step")
        page.wait_for(lambda: page.frame.get("time", 0) > 0)
        script.join(0.2)
        assert made == [0]
        page.tell("pause", paused=False)
        script.join(PATIENCE)
    assert made == [0, 1, 2]


def test_the_close_button_ends_the_connection(viewer: Viewer):
    with Watcher(viewer.address) as page:
        page.tell("pause", paused=True)
        page.wait_for(lambda: page.shown.get(("pause", None), {}).get("paused"))
        page.tell("close")
        with pytest.raises(p.error, match=r"^Not connected to physics server\."):
            while True:
                p.stepSimulation()
        assert not p.isConnected()
    assert p.connect(p.GUI, options="--port=0") == 0
    p.disconnect()


def test_an_address_that_cannot_be_had():
    with pytest.raises(p.error, match=r"^Cannot open the window:"):
        p.connect(p.GUI, options="--host=203.0.113.7")
    assert not p.isConnected()


def test_a_request_with_two_names_is_turned_away(viewer: Viewer):
    host, port = origin_of(viewer.address).removeprefix("http://").rsplit(":", 1)
    with socket.create_connection((host, int(port)), PATIENCE) as peer:
        name = f"Host: {host}:{port}\r\n"
        peer.sendall(f"GET / HTTP/1.1\r\n{name}{name}\r\n".encode())
        assert peer.recv(100).startswith(b"HTTP/1.1 421")


def test_asyncio_keeps_its_complaints_to_itself(viewer: Viewer, caplog: pytest.LogCaptureFixture):
    """As of sockets that fail, and of tasks that nobody waits for."""
    server, done = viewer._server, threading.Event()
    loop = server._loop
    assert loop is not None
    loop.call_soon_threadsafe(lambda: loop.call_exception_handler({"message": "a socket is gone"}))
    loop.call_soon_threadsafe(done.set)
    assert done.wait(PATIENCE)
    assert not caplog.records
    logging.getLogger("asyncio").warning("of somebody else's loop")
    assert caplog.messages == ["of somebody else's loop"]
