"""The simulator's sections of the page, in a real browser."""

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.simulator.files import SCENE, scene, xacro
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet_data
from carom.simulator.simulator import Simulator, Start

pytestmark = needs_browser
DATA = Path(pybullet_data.getDataPath())


class Run:
    """A simulator that makes its turns in a thread of its own, and its page."""

    def __init__(self, browser, *files: Path, width: int = 1280, height: int = 800) -> None:
        self.simulator = Simulator(files, Start(port=0))
        self.thread = threading.Thread(target=self.simulator.run)
        self.thread.start()
        self.shown = Page(browser, self.simulator.viewer.address, width, height)
        self.shown.until("window.app?.scene.layout.layout > 0 && app.simulation.on")
        self.page = self.shown.page

    def open(self, *sections: str) -> None:
        for name in sections:
            self.page.evaluate("name => (document.getElementById(name).open = true)", name)

    def end(self) -> None:
        self.shown.expect_the_end()
        self.page.close()
        self.simulator.viewer._close_by_user()
        self.thread.join()
        self.simulator.close()
        assert self.shown.complaints == []


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return scene(tmp_path)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, browser, file: Path) -> Iterator[Run]:
    monkeypatch.setenv("CI", "true")
    run = Run(browser, file)
    yield run
    run.end()


def test_it_plays_steps_pauses_and_resets(run: Run):
    page, world = run.page, run.simulator.world
    assert page.locator("#pause").text_content() == "Play"
    page.locator("#step").click()
    wait_for(lambda: world.time == pytest.approx(0.002), run.shown)
    page.locator("#pause").click()
    wait_for(lambda: world.time > 0.1, run.shown)
    assert page.locator("#pause").text_content() == "Pause"
    page.locator("#pause").click()
    wait_for(lambda: run.simulator.viewer.pause_control.closed, run.shown)
    page.locator("#reset").click()
    wait_for(lambda: world.time == 0, run.shown)
    # The page's own past goes back without changing the simulation.
    run.shown.until("app.history.count > 2")
    page.locator("#back").click()
    run.shown.until("!app.player.live")
    assert world.time == 0


def test_a_keyframe_is_a_button_and_the_state_is_saved_as_one(run: Run):
    page, world = run.page, run.simulator.world
    page.get_by_role("button", name="bent", exact=True).click()
    wait_for(lambda: world.time == 1.5, run.shown)
    page.get_by_label("Name of the keyframe to save").fill("here")
    page.locator("#keyframe-save").click()
    page.get_by_role("button", name="here", exact=True).wait_for()
    page.evaluate("navigator.clipboard.writeText = async (text) => { window.copied = text; }")
    page.get_by_label("Copy here").click()
    run.shown.until('window.copied?.startsWith(\'<key name="here" time="1.5" qpos="0.5 0 0.1 1 0 0 0 0.25\')')
    page.get_by_label("Drop here").click()
    page.get_by_role("button", name="here", exact=True).wait_for(state="detached")


def test_actuators_and_joints_have_sliders(run: Run):
    page, body = run.page, run.simulator.world["block"]
    run.shown.until(f"document.getElementById('all-actuator-{body.id}-0').min === '-1'")
    slider = page.locator(f"#all-actuator-{body.id}-0")
    slider.evaluate("(element) => { element.value = 0.5; element.dispatchEvent(new Event('input')); }")
    wait_for(lambda: body.actuators["drive"].control == 0.5, run.shown)
    run.open("joints")
    run.shown.until(f"document.getElementById('all-joint-{body.id}-0').min < -3")
    # While it is paused a joint is put where its slider is.
    slider = page.locator(f"#all-joint-{body.id}-0")
    slider.evaluate("(element) => { element.value = -1; element.dispatchEvent(new Event('input')); }")
    wait_for(lambda: body.joints["swing"].position == -1, run.shown)


def test_sensors_have_bars_and_a_click_plots_them(run: Run):
    page = run.page
    run.simulator._tasks.append(lambda: run.simulator._keyframe(0, {"action": "reset", "name": "bent"}))
    run.open("sensors")
    page.locator("#pause").click()
    bar = page.locator("#sensors-list .sensor").first.locator("output")
    run.shown.until(
        "Math.abs(Number(document.querySelector('#sensors-list .sensor output').textContent)) > 0.1"
    )
    assert bar.count() == 1
    assert page.locator("#sensors-list .sensor").nth(1).locator("output").count() == 3
    page.get_by_role("button", name="angle", exact=True).click()
    page.locator(".chart", has_text="angle").wait_for()


def test_bodies_links_joints_and_sites_are_found_and_chosen(run: Run):
    page = run.page
    run.open("bodies")
    page.get_by_label("Links, joints and sites of block (body 1)").click()
    texts = page.locator("#bodies-list .part").all_text_contents()
    assert [" ".join(text.split()) for text in texts] == [
        *(
            "link block",
            "site top",
            "joint swing continuous",
            "link arm",
            "joint wrist spherical",
            "link hand",
        ),
    ]
    page.locator("#find").fill("wri")
    page.locator("#bodies-list .part").get_by_text("wrist").click()
    assert page.locator("#bodies-list button[data-body]:not([data-link])").count() == 1
    run.shown.until("app.overlays.selection?.body === 1 && app.overlays.selection.link === 2")
    assert "hand" in str(page.locator("#body-card").text_content())
    page.locator("#find").fill("no such thing")
    run.shown.until("document.querySelectorAll('#bodies-list button').length === 0")


def test_contacts_are_listed_with_their_forces(run: Run):
    page = run.page
    run.open("touching")
    page.locator("#pause").click()
    row = page.locator("#touching-list .contact").first
    row.wait_for()
    wait_for(lambda: " N, friction " in str(row.text_content()), run.shown)
    assert "block" in str(row.text_content())
    assert "world" in str(row.text_content())
    row.click()
    run.shown.until("app.overlays.selection !== null")


def test_parameters_are_changed_and_wrong_ones_are_told(run: Run):
    page, world = run.page, run.simulator.world
    run.open("physics", "console")
    assert page.get_by_label("Gravity z").input_value() == "-9.81"
    page.get_by_role("button", name="None", exact=True).click()
    wait_for(lambda: not world.gravity.any(), run.shown)
    page.get_by_label("Law of contact").select_option("rigid")
    wait_for(lambda: world.contact == "rigid", run.shown)
    page.get_by_label("Split impulse").uncheck()
    wait_for(lambda: not world.parameters.split_impulse, run.shown)
    field = page.get_by_label("Time step", exact=True)
    field.fill("-1")
    field.press("Enter")
    page.locator("#console-list .error").get_by_text("Time step needs 1 finite number").wait_for()
    run.shown.until("document.querySelector('[data-setting=time_step] input').value === '0.002'")


def test_a_changed_file_is_shown_and_a_broken_one_told(run: Run, file: Path):
    page, world = run.page, run.simulator.world
    run.open("console")
    page.get_by_role("button", name="bent", exact=True).click()
    wait_for(lambda: world.time == 1.5, run.shown)
    file.write_text(SCENE.replace('name="hand"', 'name="paw"'))
    run.shown.until("app.scene.bodies.get(1).links.some(({ name }) => name === 'paw')")
    assert world.time == 1.5
    file.write_text("<mujoco><worldbody>")
    page.locator("#console-list .error").wait_for()
    page.locator("#notice").get_by_text("scene.xml").first.wait_for()
    run.shown.until("app.scene.bodies.get(1).links.some(({ name }) => name === 'paw')")


def test_files_that_are_dropped_are_shown(run: Run):
    page = run.page
    text = (DATA / "cartpole.urdf").read_text(encoding="utf-8")
    page.evaluate(
        """text => {
          const data = new DataTransfer();
          data.items.add(new File([text], "cart.urdf"));
          window.dispatchEvent(new DragEvent("dragover", { dataTransfer: data, cancelable: true }));
          window.shownWhileOver = !document.getElementById("dropping").hidden;
          window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
        }""",
        text,
    )
    run.shown.until("document.title === 'cart.urdf' && app.scene.bodies.get(0)?.links.length === 3")
    assert page.evaluate("window.shownWhileOver && document.getElementById('dropping').hidden")
    # It is in view, and has sliders, but no keyframes or actuators.
    run.shown.until("app.viewpoint.fitted && document.getElementById('actuators').hidden")
    assert page.locator("#keyframes-list button").count() == 0
    assert page.locator("#joints").get_attribute("hidden") is None


def test_other_files_are_in_view_also_if_their_bodies_came_first(run: Run):
    run.shown.until("app.viewpoint.fitted")
    # No frame follows while the simulation rests.
    run.page.evaluate("app.simulation.take({ files: ['other.urdf'], stated: [] })")
    assert run.page.evaluate("app.viewpoint.fitted && app.viewpoint.box !== null")


@pytest.mark.long
def test_arguments_of_xacro_are_fields(monkeypatch: pytest.MonkeyPatch, browser, tmp_path: Path):
    monkeypatch.setenv("CI", "true")
    run = Run(browser, xacro(tmp_path))
    try:
        field = run.page.get_by_label("height")
        assert field.input_value() == "1.5"
        field.fill("3")
        field.press("Enter")
        wait_for(lambda: run.simulator.files[0].arguments["height"] == "3", run.shown)
    finally:
        run.end()


@pytest.mark.long
@pytest.mark.parametrize("size", [(1280, 800), (480, 800)])
def test_nothing_is_wider_than_the_panel(monkeypatch: pytest.MonkeyPatch, browser, file: Path, size):
    monkeypatch.setenv("CI", "true")
    run = Run(browser, file, width=size[0], height=size[1])
    try:
        run.open("keyframes", "actuators", "joints", "sensors", "bodies", "touching", "physics", "console")
        assert (
            run.page.evaluate(
                "[...document.querySelectorAll('#rooms *')].filter((it) => it.checkVisibility() && "
                "it.getBoundingClientRect().right > "
                "document.getElementById('panel').getBoundingClientRect().right + 0.5)"
                ".map((it) => it.id || it.className)"
            )
            == []
        )
    finally:
        run.end()
