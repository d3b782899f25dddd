"""The tutorial with sliders and ESC, as it is, driven from its page."""

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.viewer.browser import Page, chromium, needs_browser
from tests.viewer.watcher import PATIENCE

ROOT = Path(__file__).parents[2]


@needs_browser
def test_the_pid_tutorial_is_tuned_by_its_sliders_and_ends_with_escape():
    environment = {**os.environ, "CI": "1", "PYTHONUNBUFFERED": "1", "PYTHONPATH": str(ROOT / "src")}
    script = subprocess.Popen(
        [sys.executable, ROOT / "examples" / "pid_sliders.py"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert script.stdout is not None
    try:
        address = None
        for line in script.stdout:
            address = re.search(r"http://\S+", line)
            if address:
                break
        assert address
        with chromium() as browser:
            page = Page(browser, address[0])
            plots = page.page.locator("#joint")
            plots.locator("option").nth(1).wait_for(state="attached")
            plots.select_option(index=1)
            angle = page.page.locator(".chart canvas[title=position]")
            angle.wait_for()
            page.page.get_by_label(re.compile(r"target \[rad\]")).fill("-0.7")
            value = None
            for _ in range(int(PATIENCE * 5)):
                value = page.page.locator(".chart").get_attribute("data-position")
                if value and abs(float(value) + 0.7) < 0.03:
                    break
                page.page.wait_for_timeout(200)
            else:
                raise AssertionError(f"the arm is at {value}")
            page.page.focus("#view")
            page.page.keyboard.press("Escape")
            assert script.wait(PATIENCE) == 0
            page.page.get_by_text("has ended").wait_for()
    finally:
        script.kill()
        script.wait()
