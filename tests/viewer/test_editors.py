"""The window in notebooks of others: VS Code, code-server and Colab, by stand-ins for them in a real browser.

What is stood in for is what matters to the page: names that are not this machine's, frames of other sites
around it (so that the browser sends no cookie), the addresses that each hands out, and Colab's proxy, which
passes requests and no sockets. The sites are known to the browser alone.
"""

import json
import threading
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from tests.patience import until
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom import World
from carom.viewer.looks.still import still
from carom.viewer.viewer import Viewer

# As Colab and VS Code have it around the outputs of cells.
SANDBOX = "allow-scripts allow-same-origin allow-forms allow-downloads allow-pointer-lock allow-popups"
# VS Code runs the scripts of an output itself; where it runs them is no web site.
IN_A_WEBVIEW = """
    const place = { protocol: "vscode-webview:", hostname: "1n3c0v8", href: "vscode-webview://1n3c0v8/" };
    const output = document.createElement("div");
    output.innerHTML = MARKUP;
    document.body.append(output);
    for (const script of output.querySelectorAll("script")) {
        new Function("location", script.textContent)(place);
    }
"""
IN_COLAB = """
    const proxyPort = async (port) => PROXY.replace("PORT", port);
    globalThis.google = { colab: { kernel: { proxyPort } } };
    document.body.append(document.createRange().createContextualFragment(MARKUP));
"""
IN_CODE_SERVER = "document.body.append(document.createRange().createContextualFragment(MARKUP));"


@contextmanager
def site(
    answer: Callable[[BaseHTTPRequestHandler], tuple[int, list[tuple[str, str]], bytes]],
) -> Iterator[int]:
    """A web server of this machine, by its port; browsers know it under other names."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            status, headers, content = answer(self)
            self.send_response(status)
            for name, value in headers:
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *args: object) -> None:
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server, ExitStack() as stack:
        stack.callback(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_port


def pages(texts: dict[str, str]) -> Callable:
    """Answers by the names that a server is asked under."""

    def answer(request: BaseHTTPRequestHandler) -> tuple[int, list[tuple[str, str]], bytes]:
        text = texts.get(request.headers["Host"].partition(":")[0], "")
        return 200, [("Content-Type", "text/html; charset=utf-8")], f"<!doctype html>{text}".encode()

    return answer


def proxy(passed: list[str]) -> Callable:
    """Passes requests for /kernel/PORT/... to that port, under its own name, and no sockets, as Colab's does.

    Args:
        passed: The paths it has been asked for.
    """

    def answer(request: BaseHTTPRequestHandler) -> tuple[int, list[tuple[str, str]], bytes]:
        passed.append(request.path)
        if "Upgrade" in request.headers:
            return 501, [], b""
        port, _, path = request.path.removeprefix("/kernel/").partition("/")
        path += ("&" if "?" in path else "?") + "authuser=0"
        names = ("Host", "Cookie", "Origin")
        headers = {name: request.headers[name] for name in names if name in request.headers}
        passing_on = urllib.request.Request(f"http://127.0.0.1:{port}/{path}", headers=headers)
        try:
            with urllib.request.urlopen(passing_on) as found:
                dropped = ("Connection", "Date", "Server")
                kept = [pair for pair in found.headers.items() if pair[0] not in dropped]
                return found.status, kept, found.read()
        except urllib.error.HTTPError as problem:
            return problem.code, [], problem.read()
        except OSError:
            return 502, [], b""

    return answer


@contextmanager
def cell(browser, markup: str, script: str, proxy_address: str) -> Iterator[Page]:
    """A notebook of another site, with the output of a cell in a frame of a third one."""
    script = script.replace("MARKUP", json.dumps(markup).replace("</", "<\\/"))
    script = script.replace("PROXY", json.dumps(proxy_address))
    texts = {"outputs.test": f"<body><script>{script}</script>"}
    with site(pages(texts)) as port:
        texts["notebook.test"] = (
            f'<body><iframe sandbox="{SANDBOX}" src="http://outputs.test:{port}/" width=850 height=560>'
        )
        yield Page(browser, f"http://notebook.test:{port}/", 900, 600)


def slider_arrives(page: Page, gain: int) -> None:
    """Moves a slider in the window of the cell, and waits until the script reads it."""
    window = page.page.frame_locator("iframe").frame_locator("iframe")
    window.get_by_label("gain", exact=True).wait_for()
    window.get_by_label("gain", exact=True).evaluate(
        "(element) => { element.value = 7.5; element.dispatchEvent(new Event('input')); }"
    )
    wait_for(lambda: p.readUserDebugParameter(gain) == 7.5, page)


@needs_browser
def test_a_cell_of_vs_code_shows_the_window(viewer: Viewer, browser):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    with cell(browser, viewer._repr_html_(), IN_A_WEBVIEW, "") as page:
        slider_arrives(page, gain)


@needs_browser
def test_an_editor_in_the_browser_shows_the_window_through_its_proxy(
    viewer: Viewer, browser, monkeypatch: pytest.MonkeyPatch
):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    passed: list[str] = []
    with site(proxy(passed)) as port:
        monkeypatch.setenv("VSCODE_PROXY_URI", f"http://proxy.test:{port}/kernel/{{{{port}}}}/")
        with cell(browser, viewer._repr_html_(), IN_CODE_SERVER, "") as page:
            slider_arrives(page, gain)
    assert passed


@needs_browser
def test_a_cell_of_colab_shows_the_window_without_sockets(viewer: Viewer, browser):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    cube = p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3))
    passed: list[str] = []
    with (
        site(proxy(passed)) as port,
        cell(browser, viewer._repr_html_(), IN_COLAB, f"http://proxy.test:{port}/kernel/PORT") as page,
    ):
        slider_arrives(page, gain)
        window = next(frame for frame in page.page.frames if "/kernel/" in frame.url)
        for height in (1, 2):
            p.resetBasePositionAndOrientation(cube, [0, 0, height], [0, 0, 0, 1])
            wait_for(
                lambda: window.evaluate("app.scene.inertialPose(0, 0)?.position[2]") == height,  # noqa: B023
                page,
            )
        assert any("/poll?" in path for path in passed)
        # It says so when the simulation ends.
        p.disconnect()
        page.page.frame_locator("iframe").frame_locator("iframe").get_by_text("has ended").wait_for()


@needs_browser
@pytest.mark.long
def test_a_page_whose_request_is_never_answered_says_that_the_run_has_ended(viewer: Viewer, browser):
    gain = p.addUserDebugParameter("gain", 0, 10, 2)
    answered, is_gone, released = proxy([]), threading.Event(), threading.Event()

    def silent(request: BaseHTTPRequestHandler) -> tuple[int, list[tuple[str, str]], bytes]:
        if is_gone.is_set():
            released.wait()
        return answered(request)

    with (
        site(silent) as port,
        cell(browser, viewer._repr_html_(), IN_COLAB, f"http://proxy.test:{port}/kernel/PORT") as page,
    ):
        slider_arrives(page, gain)
        window = next(frame for frame in page.page.frames if "/kernel/" in frame.url)
        window.evaluate(
            "AbortSignal.timeout = (of => ms => of.call(AbortSignal, ms / 40))(AbortSignal.timeout)"
        )
        is_gone.set()
        page.page.frame_locator("iframe").frame_locator("iframe").get_by_text("has ended").wait_for()
        released.set()


@needs_browser
def test_a_cell_that_reaches_nothing_shows_a_picture(viewer: Viewer, browser):
    assert "image/png" not in viewer._repr_html_()
    p.loadURDF(f"{pybullet_data.getDataPath()}/r2d2.urdf")
    with cell(browser, viewer._repr_html_(), IN_CODE_SERVER, "") as page:
        shown = page.page.frame_locator("iframe").frame_locator("iframe")
        picture = shown.get_by_alt_text("The simulation")
        picture.wait_for()
        assert picture.evaluate("(image) => image.naturalWidth") == 640
        shown.get_by_text("cannot be reached").wait_for()


def test_a_picture_shows_what_there_is():
    world = World()
    assert still(world) is None
    world.load_urdf("plane.urdf")
    world.load_urdf("r2d2.urdf", (2, 3, 0.5))
    world.load_urdf("cube.urdf", (0, 0, 0.5))
    picture = np.asarray(Image.open(BytesIO(still(world) or b"")))
    assert picture.shape == (420, 640, 3)
    # The blue of R2D2, the red and the grey of other things: many shades in the middle.
    assert len(np.unique(picture[100:320, 160:480].reshape(-1, 3), axis=0)) > 100


def test_a_page_that_asks_is_open_until_it_stops(viewer: Viewer, monkeypatch: pytest.MonkeyPatch):
    address = viewer.address.replace("/?", "/poll?")
    for told in ('{"type": "key", "key": "a", "code": "KeyA", "down": true}', "nonsense", "[]"):
        with urllib.request.urlopen(f"{address}&page=1&told={urllib.parse.quote(told)}") as answer:
            assert int.from_bytes(answer.read()[:4], "little") == 1
    assert viewer.page_count == 1
    assert p.getKeyboardEvents()[ord("a")] & p.KEY_IS_DOWN
    monkeypatch.setattr("carom.viewer.polling._SILENCE", 0.1)
    assert until(lambda: viewer.page_count == 0)
    assert p.getKeyboardEvents()[ord("a")] & p.KEY_WAS_RELEASED


@pytest.mark.parametrize(
    ("query", "status"), [("?page=1", 403), ("?token=guessed&page=1", 403), ("?TOKEN", 400)]
)
def test_who_asks_needs_the_token_and_a_number(viewer: Viewer, query: str, status: int):
    base, _, token = viewer.address.partition("/?")
    request = urllib.request.Request(f"{base}/poll{query.replace('TOKEN', token)}")
    # A cookie goes to all ports of a machine, so it is not enough.
    request.add_header("Cookie", viewer._server.access.cookie)
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(request)
    assert refused.value.code == status
