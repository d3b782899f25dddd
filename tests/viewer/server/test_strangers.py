"""Connections that do not show the token: they take nothing from the user's process and pages."""

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import pytest
from tests.patience import PATIENCE
from tests.viewer.server.test_server import request
from tests.viewer.watcher import Watcher, origin_of

from carom.viewer import strangers
from carom.viewer.page_files import lasting_files
from carom.viewer.viewer import Viewer

COUNT = 150


@contextmanager
def silent(viewer: Viewer, count: int) -> Iterator[list[socket.socket]]:
    """Connections that say nothing."""
    host, port = origin_of(viewer.address).removeprefix("http://").rsplit(":", 1)
    peers: list[socket.socket] = []
    with ExitStack() as opened:
        for _ in range(count):
            peers.append(opened.enter_context(socket.create_connection((host, int(port)), PATIENCE)))
            # Those that find the backlog full are made a second later.
            time.sleep(0.002)
        yield peers


def is_open(peer: socket.socket) -> bool:
    peer.settimeout(0.0)
    try:
        return peer.recv(1) != b""
    except BlockingIOError:
        return True
    except OSError:
        return False


def wait_until(is_so: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_only_some_strangers_are_kept_and_none_for_long(
    viewer: Viewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(strangers, "PATIENCE", 600.0)
    with silent(viewer, COUNT) as peers:
        wait_until(lambda: sum(map(is_open, peers)) == strangers.MOST)
        assert all(map(is_open, peers[-strangers.MOST :]))
        monkeypatch.setattr(strangers, "PATIENCE", 0.2)
        with silent(viewer, strangers.MOST) as later:
            wait_until(lambda: not any(map(is_open, [*peers, *later])))
    assert not len(viewer._server._strangers)


def test_pages_get_in_and_stay_while_strangers_hold_all_places(viewer: Viewer) -> None:
    with silent(viewer, COUNT), Watcher(viewer.address, origin=origin_of(viewer.address)) as page:
        page.wait_for(lambda: ("title", None) in page.shown)
        assert request(viewer, "/").status == 200
        with silent(viewer, COUNT) as peers:
            wait_until(lambda: sum(map(is_open, peers)) == strangers.MOST)
            assert request(viewer, "/").status == 200
            assert request(viewer, f"/{next(iter(lasting_files()))}", known=False).status == 200
        assert len(viewer._server._pages) == 1


def test_requests_that_never_end_are_cut_off(viewer: Viewer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strangers, "PATIENCE", 0.2)
    with silent(viewer, 3) as peers:
        for peer, text in zip(peers, (b"GET", b"GET / HTTP/1.1\r\nHost: ", b"GET /poll"), strict=True):
            peer.sendall(text)
        wait_until(lambda: not any(map(is_open, peers)))
