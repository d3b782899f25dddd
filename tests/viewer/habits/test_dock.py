"""Plots of the whole past: chosen late, docked below the view, with several lines, zoomed, read and saved."""

import csv
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.patience import until
from tests.viewer.browser import Page, needs_browser, wait_for

import pybullet as p
import pybullet_data
from carom.viewer.viewer import Viewer

pytestmark = needs_browser
DATA = pybullet_data.getDataPath()


@pytest.fixture
def run(viewer: Viewer, browser) -> Iterator[Page]:
    """A page that comes when an arm has moved for a second beside a cube that falls onto a plane."""
    p.setGravity(0, 0, -10)
    p.loadURDF(f"{DATA}/plane.urdf")
    arm = p.loadURDF(f"{DATA}/franka_panda/panda.urdf", useFixedBase=True)
    p.loadURDF(f"{DATA}/cube_small.urdf", [1, 0, 0.5])
    until(lambda: viewer._past.next_number > 0)
    for step in range(240):
        p.setJointMotorControl2(arm, 1, p.POSITION_CONTROL, 0.3 * math.sin(step / 40))
        p.stepSimulation()
        # However busy the machine is, there is a frame every thirtieth of a second.
        if step % 8 == 7:
            number = viewer._past.next_number
            assert until(lambda number=number: viewer._past.next_number > number)
    page = Page(browser, viewer.address, 1100, 760)
    page.until("window.app?.history.start < -0.8 && app.scene.bodies.size === 3")
    yield page
    page.page.close()
    assert page.complaints == []


def choose(page: Page, key: str) -> None:
    page.page.locator("#joint").select_option(value=key)


def docked(page: Page, *keys: str) -> None:
    for key in keys:
        choose(page, key)
    page.page.locator("#dock-open").click()
    page.until("app.plots.dock.legend.children.length > 0")


def saved(page: Page, path: Path) -> tuple[list[str], list[list[str]]]:
    with page.page.expect_download() as download:
        page.page.locator("#dock-save").click()
    download.value.save_as(path)
    with open(path, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return header, rows


@pytest.mark.parametrize(
    ("key", "chart"), [("1,1", 0), ("1,1", 2), ("body 2", 0), ("body 2", 1), ("contact 2", 0)]
)
def test_what_is_chosen_late_is_plotted_from_the_start(run: Page, key: str, chart: int):
    choose(run, key)
    series = f"app.plots.plotted.get({key!r}).samples"
    known = f"{series}.filter(({{ values }}) => values[{chart}][0] !== null)"
    run.until(f"{known}.length > 15 && {known}[0].time < 0.2")
    last = run.page.evaluate(f"{series}.at(-1).values[{chart}]")
    if key == "contact 2":
        assert last[0] == pytest.approx(10 * p.getDynamicsInfo(2, -1)[0], rel=0.2)
    elif key == "1,1":
        state = p.getJointState(1, 1)
        assert last[0] == pytest.approx(state[3 if chart == 2 else 0], abs=1e-4)
    speeds = run.page.evaluate(f"{series}.map(({{ values }}) => values[{chart}][2] ?? 0)")
    if (key, chart) == ("body 2", 1):
        assert min(speeds) < -2


def test_plots_stay_where_a_body_is_not_there_yet(run: Page):
    choose(run, "body 2")
    first = run.page.evaluate("app.plots.plotted.get('body 2').samples.length")
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3), basePosition=[2, 0, 0.1])
    run.until("app.scene.bodies.size === 4")
    p.stepSimulation()
    # Frames of the layout before are read as well.
    run.until(f"app.plots.plotted.get('body 2').samples.length > {first}")
    choose(run, "body 3")
    run.until("app.plots.plotted.get('body 3').samples.length > 0")
    # The very first frames may show a world that is being loaded.
    run.page.evaluate("app.player.seek(app.history.end - 0.5)")
    run.until("app.scene.bodies.size === 3")
    assert run.page.evaluate("[...app.plots.plotted.keys()]") == ["body 2", "body 3"]


def test_the_pane_lies_below_the_view_and_is_enlarged_and_put_back(run: Page):
    box = "document.getElementById({!r}).getBoundingClientRect()"
    before = run.page.evaluate(f"{box.format('view')}.height")
    docked(run, "1,1")
    assert not run.page.locator(".chart canvas").first.is_visible()
    view, dock = (
        run.page.evaluate(f"(b => [b.top, b.bottom])({box.format(name)})") for name in ("view", "dock")
    )
    assert view[1] <= dock[0]
    run.until(f"Math.abs(app.camera.height - {view[1]}) <= 1")
    edge = run.page.locator("#dock-edge").bounding_box()
    run.page.mouse.move(edge["x"] + 50, edge["y"] + 5)
    run.page.mouse.down()
    run.page.mouse.move(edge["x"] + 50, edge["y"] - 115, steps=3)
    run.page.mouse.up()
    higher = run.page.locator("#dock").bounding_box()["height"]
    assert higher == pytest.approx(dock[1] - dock[0] + 120, abs=12)
    run.until_kept()
    run.page.reload()
    run.until("window.app?.plots.dock.isOpen")
    assert run.page.locator("#dock").bounding_box()["height"] == pytest.approx(higher, abs=1)
    run.page.locator("#dock-close").click()
    assert not run.page.locator("#dock").is_visible()
    assert run.page.evaluate(f"{box.format('view')}.height") == before
    assert run.page.locator(".chart canvas").first.is_visible()


def test_lines_of_several_quantities_are_read_under_the_mouse(run: Page):
    docked(run, "1,1", "body 2")
    legend = run.page.locator("#dock-legend label")
    height = legend.filter(has_text="position · z")
    assert "m" in height.locator("output").inner_text()
    chart = run.page.locator("#dock-chart")
    # Between two samples that are many pixels from each other, so that the mouse is surely after the first.
    samples = "app.plots.plotted.get('body 2').samples"
    clocks = run.page.evaluate(f"{samples}.map(({{ clock }}) => clock)")
    start, end = run.page.evaluate("app.plots.dock.chart.range")
    inner = [i for i in range(len(clocks) - 1) if 0.2 < (clocks[i] - start) / (end - start) < 0.7]
    before = max(inner, key=lambda i: clocks[i + 1] - clocks[i])
    middle = (clocks[before] + clocks[before + 1]) / 2
    left, right = run.page.evaluate("app.plots.dock.chart.edges")
    chart.hover(position={"x": left + (right - left) * (middle - start) / (end - start), "y": 60})
    found = f"{samples}[{before}]"
    at = run.page.evaluate(f"{found}.values[0][2]")

    def told() -> float:
        return float(height.locator("output").inner_text().split()[0])

    wait_for(lambda: told() == pytest.approx(at, rel=1e-3), run)
    time_there = run.page.evaluate(f"{found}.time") + middle - clocks[before]
    assert float(run.page.locator("#dock-time").inner_text()[:-2]) == pytest.approx(time_there, abs=0.01)
    height.locator("input").uncheck()
    run.until("app.plots.dock.traces.all.filter(({ shown }) => shown).length === 4")


def test_zoom_in_time_limits_the_time_bar_and_what_is_saved(run: Page, tmp_path: Path):
    docked(run, "1,1", "body 2")
    chart = run.page.locator("#dock-chart")
    start, end = run.page.evaluate("app.part.range")
    _, everything = saved(run, tmp_path / "all.csv")
    x = run.page.evaluate("(([left, right]) => (left + right) / 2)(app.plots.dock.chart.edges)")
    chart.hover(position={"x": x, "y": 60})
    for _ in range(4):
        run.page.mouse.wheel(0, -100)
    run.until(f"app.part.range[1] - app.part.range[0] < {0.5 * (end - start)}")
    scrub = run.page.locator("#scrub")
    run.until("Math.abs(Number(document.getElementById('scrub').min) - app.part.range[0]) < 1e-9")
    before = run.page.evaluate("app.part.range")
    run.page.mouse.down()
    run.page.mouse.move(chart.bounding_box()["x"] + x + 80, chart.bounding_box()["y"] + 60, steps=4)
    run.page.mouse.up()
    run.until(f"app.part.range[0] < {before[0]} - 0.01")
    low, high = run.page.evaluate("app.part.range")
    assert float(scrub.get_attribute("max")) == pytest.approx(high)
    # A click shows the moment.
    chart.click(position={"x": x, "y": 60})
    run.until(f"!app.player.live && Math.abs(app.player.clock - {(low + high) / 2}) < 0.01")
    header, rows = saved(run, tmp_path / "part.csv")
    assert header[:2] == ["time [s]", "panda · panda_joint2 · position [rad]"]
    assert "cube.urdf (body 2) · position · z [m]" in header
    assert 0 < len(rows) < 0.6 * len(everything)
    offset = run.page.evaluate("app.history.frames.at(-1).header.time - app.history.end")
    assert all(low + offset - 1e-6 <= float(row[0]) <= high + offset + 1e-6 for row in rows)
    run.page.locator("#dock-all").click()
    assert run.page.evaluate("app.part.zoomed") is None
    assert float(scrub.get_attribute("min")) == pytest.approx(start)


def test_values_of_the_script_are_plotted_in_a_saved_page_as_well(
    run: Page, viewer: Viewer, browser, tmp_path: Path
):
    viewer.plot("error", 0.25)
    p.stepSimulation()
    run.until("app.plots.plotted.get('value error')?.samples.length > 0")
    with run.page.expect_download() as download:
        run.page.get_by_role("button", name="Save", exact=True).click()
    download.value.save_as(tmp_path / "run.html")
    replay = Page(browser, (tmp_path / "run.html").as_uri(), 1100, 760)
    replay.until("window.app?.plots.plotted.get('value error')?.samples.at(-1)?.values[0][0] === 0.25")
    # What was before the page was opened is in the file.
    assert replay.page.evaluate("app.history.frames[0].header.time") < 0.2
    docked(replay)
    assert "error" in replay.page.locator("#dock-legend").inner_text()
    assert replay.complaints == []
