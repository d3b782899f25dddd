"""The window in a cell of a real JupyterLab, in a browser, at home and behind its proxy."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec

import pytest
from tests.viewer.browser import Page, needs_browser
from tests.viewer.scripts import ROOT

pytestmark = [
    needs_browser,
    pytest.mark.skipif(
        find_spec("jupyterlab") is None or find_spec("jupyter_server_proxy") is None,
        reason="no JupyterLab with jupyter-server-proxy here",
    ),
]
# This machine, and a name that is not its own, as a hub has one.
HOSTS = ("127.0.0.1", "hub.test")
WINDOW = """import pybullet as p
import pybullet_data
p.connect(p.GUI, options="--port=0")
p.setAdditionalSearchPath(pybullet_data.getDataPath())
arm = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
gain = p.addUserDebugParameter("gain", 0, 10, 2)"""
# The page tells its server, and the server its thread.
READ = """import time
while p.readUserDebugParameter(gain) != 7.5: time.sleep(0.01)
print('gain is', p.readUserDebugParameter(gain))"""
TABLES = """from carom import World, Camera
world = World()
body = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
display(world); display(body); display(body.joints)
camera = Camera.with_field_of_view(160, 120, 60).look_at((1, 1, 1), (0, 0, 0.3))
display(camera); display(camera.capture(world))"""
REPLAY = """with world.record("run.html") as replay:
    world.step(60)
replay"""


def notebook(*cells: str) -> str:
    return json.dumps(
        {
            "nbformat": 4,
            "nbformat_minor": 5,
            "metadata": {"kernelspec": {"name": "python3", "display_name": "Python 3"}},
            "cells": [
                {
                    "cell_type": "code",
                    "id": str(number),
                    "metadata": {},
                    "source": cell,
                    "outputs": [],
                    "execution_count": None,
                }
                for number, cell in enumerate(cells)
            ],
        }
    )


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a JupyterLab with a notebook; its host is to be filled in."""
    folder = tmp_path_factory.mktemp("lab")
    # Each has a kernel of its own.
    for host in HOSTS:
        (folder / f"{host}.ipynb").write_text(notebook(WINDOW, READ, TABLES, REPLAY))
    command = ["-m", "jupyterlab", "--no-browser", "--ServerApp.port=0", "--ServerApp.port_retries=0"]
    command += ["--IdentityProvider.token=secret", "--ServerApp.allow_remote_access=True"]
    command += [f"--ServerApp.root_dir={folder}", "--allow-root"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "JUPYTER_CONFIG_DIR": str(folder / "etc")}
    environment.pop("SSH_CONNECTION", None)
    server = subprocess.Popen(
        [sys.executable, *command], env=environment, stderr=subprocess.PIPE, text=True, cwd=folder
    )
    try:
        assert server.stderr is not None
        port = next(found[1] for line in server.stderr if (found := re.search(r"127\.0\.0\.1:(\d+)/", line)))
        yield f"http://%s:{port}/lab/tree/%s.ipynb?token=secret&reset"
    finally:
        server.terminate()
        server.wait()


def run(page: Page, number: int) -> None:
    cell = page.page.locator(".jp-Notebook .jp-CodeCell").nth(number)
    cell.locator(".cm-content").click()
    page.page.keyboard.press("Shift+Enter")
    cell.locator(".jp-InputPrompt", has_text=re.compile(r"\[\d+\]")).wait_for()


@pytest.mark.parametrize("host", HOSTS)
def test_a_window_is_shown_below_the_cell(lab: str, browser, host: str):
    page = Page(browser, lab % (host, host), 1200, 1000)
    page.page.locator(".jp-Notebook .jp-CodeCell").first.wait_for()
    page.page.get_by_text("| Idle").wait_for()
    run(page, 0)
    address = "/proxy/" if host == "hub.test" else "//127.0.0.1"
    window = page.page.locator(f".jp-OutputArea iframe[src*='{address}']").first.content_frame
    slider = window.get_by_label("gain", exact=True)
    slider.wait_for()
    slider.evaluate("(element) => { element.value = 7.5; element.dispatchEvent(new Event('input')); }")
    run(page, 1)
    page.page.get_by_text("gain is 7.5").wait_for()
    page.page.keyboard.press("Escape")
    run(page, 2)
    tables = page.page.locator(".jp-CodeCell").nth(2).locator(".jp-RenderedHTMLCommon")
    # The kernel may say that it is done before what it displays has come.
    tables.filter(has_text="panda_joint4").nth(1).wait_for()
    page.page.locator(".jp-CodeCell").nth(2).locator("img").first.wait_for()
    run(page, 3)
    replay = page.page.locator(".jp-CodeCell").nth(3).locator("iframe").content_frame
    replay.locator("#play").wait_for()
    # It plays at once: whoever comes later sees a later time, and the end in the end.
    replay.get_by_text(re.compile(r"^\s*0\.[012]\d\d s")).first.wait_for()
    page.page.close()
