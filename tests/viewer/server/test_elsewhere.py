"""The page in other places: behind a tunnel, and inside a notebook."""

import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from tests.viewer.browser import Page, needs_browser, wait_for
from tests.viewer.watcher import Watcher, origin_of

import pybullet as p
from carom.viewer.viewer import Viewer


@contextmanager
def tunnel(address: str) -> Iterator[str]:
    """Another port of this machine that leads to an address, as `ssh -L` makes one."""
    host, _, port = origin_of(address).removeprefix("http://").partition(":")

    def pass_on(source: socket.socket, target: socket.socket) -> None:
        try:
            while data := source.recv(65536):
                target.sendall(data)
        except OSError:
            pass
        finally:
            for end in (source, target):
                end.close()

    def serve(listener: socket.socket) -> None:
        while True:
            try:
                near, _ = listener.accept()
            except OSError:
                return
            far = socket.create_connection((host, int(port)))
            for ends in ((near, far), (far, near)):
                threading.Thread(target=pass_on, args=ends, daemon=True).start()

    with socket.create_server(("127.0.0.1", 0)) as listener:
        threading.Thread(target=serve, args=(listener,), daemon=True).start()
        yield f"http://localhost:{listener.getsockname()[1]}/?{address.partition('/?')[2]}"
        listener.shutdown(socket.SHUT_RDWR)


@pytest.mark.long
def test_a_socket_through_a_tunnel_is_the_pages_own(viewer: Viewer) -> None:
    with tunnel(viewer.address) as address, Watcher(address, origin=origin_of(address)) as page:
        page.wait_for(lambda: ("title", None) in page.shown)


@pytest.mark.long
@needs_browser
def test_the_page_works_through_a_tunnel(viewer: Viewer, browser) -> None:
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    with tunnel(viewer.address) as address:
        page = Page(browser, address)
        slider = page.page.get_by_label("gain", exact=True)
        slider.fill("7.5")
        wait_for(lambda: p.readUserDebugParameter(gain) == 7.5, page)
        assert page.complaints == []


@contextmanager
def site(folder: Path) -> Iterator[str]:
    """A web site, as the notebook's is to the page."""
    handler = partial(SimpleHTTPRequestHandler, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, ExitStack() as stack:
        stack.callback(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://localhost:{server.server_port}/"


@needs_browser
def test_a_notebook_shows_the_page_below_a_cell(viewer: Viewer, browser, tmp_path: Path) -> None:
    html = viewer._repr_html_()
    (tmp_path / "notebook.html").write_text(f"<!doctype html><title>notebook</title>{html}", encoding="utf-8")
    button = p.addUserDebugParameter("again", 1, 0, 0)
    with site(tmp_path) as address:
        page = Page(browser, address + "notebook.html", 900, 600)
        page.page.frame_locator("iframe").get_by_role("button", name="again").click()
        wait_for(lambda: p.readUserDebugParameter(button) == 1, page)
        page.expect("favicon", "404")
        assert page.complaints == []


def test_notebooks_are_told_by_html(viewer: Viewer) -> None:
    html = viewer._repr_html_()
    assert html.startswith("<iframe")
    assert f'src="{viewer.address}' in html
