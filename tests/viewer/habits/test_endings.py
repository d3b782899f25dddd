"""How a script ends: by the cross of the panel, or by an exception."""

from pathlib import Path

import pytest
from tests.patience import PATIENCE
from tests.viewer.browser import Page, needs_browser
from tests.viewer.scripts import started

import pybullet as p
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
SCRIPT = """
import time
import pybullet as p
p.connect(p.GUI, options="--port=0")
go = p.addUserDebugParameter("go", 1, 0, 0)
while p.isConnected() and p.readUserDebugParameter(go) == 0:
    time.sleep(0.01)
{end}
"""


def test_the_cross_asks_first(page: Page, viewer: Viewer):
    question = page.page.get_by_text("End the script?")
    page.page.get_by_title("End the simulation").click()
    question.wait_for()
    page.page.get_by_role("button", name="Let it run").click()
    question.wait_for(state="hidden")
    page.page.wait_for_timeout(100)
    assert viewer.is_open
    page.page.get_by_title("End the simulation").click()
    page.page.get_by_role("button", name="End it").click()
    page.until("document.querySelector('#notice').hidden")
    while p.isConnected():
        page.page.wait_for_timeout(10)


@pytest.mark.parametrize(
    ("end", "said"),
    [
        ("[1, 2][3]", "The script has ended by an error: IndexError: list index out of range"),
        ("p.loadURDF('missing.urdf')", "The script has ended by an error: pybullet.error: "),
        ("raise SystemExit('done')", "The simulation has ended."),
        ("raise KeyboardInterrupt", "The simulation has ended."),
    ],
)
def test_the_page_says_by_what_error_the_script_has_ended(browser, tmp_path: Path, end: str, said: str):
    file = tmp_path / "script.py"
    file.write_text(SCRIPT.format(end=end))
    script, address = started(file)
    page = Page(browser, address)
    page.until("window.app?.panel.controls.size === 1")
    page.page.get_by_role("button", name="go").click()
    page.page.get_by_text(said).wait_for()
    script.wait(PATIENCE)


def test_who_ends_a_script_by_the_cross_sees_no_error(browser, tmp_path: Path):
    file = tmp_path / "script.py"
    file.write_text(SCRIPT.format(end="p.stepSimulation()"))
    script, address = started(file)
    page = Page(browser, address)
    page.until("window.app?.panel.controls.size === 1")
    page.page.get_by_title("End the simulation").click()
    page.page.get_by_role("button", name="End it").click()
    page.page.get_by_text("The simulation has ended.").wait_for()
    script.wait(PATIENCE)
    assert script.returncode == 1
