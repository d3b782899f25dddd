"""Replays: recordings as pages of their own, in real browsers and without a network."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.thorough.profiles import cases
from tests.viewer.browser import Page, needs_browser
from tests.viewer.firefox import firefox, needs_firefox
from tests.viewer.scripts import ROOT

import pybullet
import pybullet_data
from carom import World
from carom.cli.command_line import main
from carom.native.building.cache import cache_folder
from carom.viewer.replay.page import replay_page
from carom.viewer.replay.recording import Recording, unpacked

DATA = Path(pybullet_data.getDataPath())
ALL_POSES = """async () => {
  const { history } = app;
  return history.frames.map(({ header, payload }) =>
    [header.time, ...new Float32Array(payload, 0, 7 * header.poses)]);
}"""


def record(file: Path, seconds: float) -> NDArray[np.float64]:
    """Records a Panda that moves and a cube that falls; returns times and poses of each 60th of a second."""
    world = World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf(DATA / "plane.urdf")
    arm = world.load_urdf(DATA / "franka_panda/panda.urdf", fixed_base=True)
    world.load_urdf(DATA / "cube_small.urdf", (0.5, 0, 0.5))
    rows = []
    with world.record(file):
        for step in range(round(seconds * 240)):
            if step % 4 == 0:
                rows.append([world.time, *world.link_pose[: 1 + 12 + 1 + 1].flat])
            arm.joints["panda_joint4"].set_position_target(-1.5 + np.sin(step / 120), max_force=80)
            world.step()
    rows.append([world.time, *world.link_pose[: 1 + 12 + 1 + 1].flat])
    return np.array(rows)


@pytest.fixture(scope="module")
def panda(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, NDArray[np.float64]]:
    file = tmp_path_factory.mktemp("replay") / "panda.html"
    return file, record(file, 10)


def test_ten_seconds_of_the_panda_are_less_than_a_megabyte(panda):
    assert panda[0].stat().st_size < 1_000_000


def test_nothing_in_the_page_comes_from_elsewhere():
    page = replay_page()
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert "https://" not in page
    assert ' src="' not in page


@pytest.mark.long
@needs_browser
def test_a_replay_is_the_run(panda, browser):
    file, run = panda
    page = Page(browser, file.as_uri())
    page.until("window.app?.history.count > 0")
    replayed = np.array(page.page.evaluate(ALL_POSES))
    assert replayed.shape == run.shape
    assert replayed == pytest.approx(run, abs=1e-6)
    assert page.page.title() == "panda"
    assert page.complaints == []
    page.page.close()


@needs_browser
def test_a_replay_is_scrubbed_played_and_looped(panda, browser):
    page = Page(browser, panda[0].as_uri(), 1100, 600)
    moment = page.page.locator("#moment")
    page.until("window.app?.history.count > 0")
    page.page.locator("#scrub").fill("4")
    assert moment.text_content() == "4.000 s, -6.00"
    page.page.locator("#forth").click()
    assert moment.text_content() == "4.017 s, -5.98"
    page.page.locator("#back").click(click_count=2)
    assert moment.text_content() == "3.983 s, -6.02"
    page.page.locator("#scrub").fill("9.5")
    page.page.select_option("#playback", "4")
    page.page.locator("#loop").click()
    page.page.locator("#play").click()
    page.until("app.player.clock < 5")
    page.page.locator("#play").click()
    assert not page.page.evaluate("app.player.running")
    page.page.locator("#loop").click()
    page.page.locator("#scrub").fill("9.5")
    page.page.locator("#play").click()
    page.until("!app.player.running")
    assert page.page.evaluate("app.player.clock") == pytest.approx(10)
    assert page.complaints == []
    page.page.close()


@needs_browser
def test_a_replay_opens_playing_where_there_is_something_to_see(tmp_path: Path, browser):
    world = World()
    with world.record(tmp_path / "late & bright.html"):
        world.add_plane()
        world.step(240)
        world.load("r2d2.urdf", (0, 0, 0.5))
        world.step(480)
    file = tmp_path / "late & bright.html"
    page = Page(browser, file.as_uri(), 900, 600)
    # It may have come to its end before a busy machine looks.
    page.until("window.app?.history.count > 0 && !app.player.live && app.player.clock > 1.2")
    assert page.page.evaluate("app.scene.bodies.size") == 2
    assert page.complaints == []
    page.page.close()
    page = browser.new_page(reduced_motion="reduce")
    page.goto(file.as_uri())
    page.wait_for_function("window.app?.history.count > 0 && !app.player.live")
    assert page.evaluate("[app.player.running, app.player.clock, app.scene.bodies.size]") == [
        False,
        pytest.approx(1.0, abs=0.02),
        2,
    ]
    page.close()
    told = file.read_text(encoding="utf-8")
    assert '<meta property="og:title" content="late &amp; bright" />' in told
    assert "<title>late &amp; bright</title>" in told


@pytest.mark.long
@needs_browser
def test_a_replay_shows_contacts_and_joints_and_plots_them(panda, browser):
    page = Page(browser, panda[0].as_uri(), 900, 700)
    page.until("window.app?.history.count > 0")
    page.page.locator("#scrub").fill("8")
    # Those of the cube; the arm lies on the floor, too.
    assert page.page.evaluate("app.readings.contacts.filter(({ b }) => b[0] === 2).length") == 4
    page.page.locator("#joint").select_option(label="panda · panda_joint4")
    plotted = float(page.page.locator(".chart").get_attribute("data-position"))
    page.page.locator("#scrub").fill("10")
    assert plotted == page.page.evaluate("app.readings.joints.get('1,3').position")
    assert not page.page.locator("#pause").is_visible()
    assert not page.page.locator("#save").is_visible()
    page.page.close()


@needs_firefox
def test_firefox_plays_it_too(panda, tmp_path: Path):
    file, run = panda
    with firefox(tmp_path, file.as_uri()) as page:
        assert page.wait_for("window.app ? app.history.count > 0 : false")
        assert page.evaluate("app.history.count") == len(run)
        page.evaluate("app.player.pause(); app.player.seek(5)")
        index = 5 * 60
        position = page.evaluate("String(app.scene.poses.subarray(7 * 8, 7 * 8 + 3))")
        assert [float(x) for x in position.split(",")] == pytest.approx(run[index, 57:60], abs=1e-6)
        assert page.evaluate("document.getElementById('notice').hidden")


@pytest.mark.long
@needs_browser
def test_bodies_and_drawings_come_and_go_in_a_replay(tmp_path: Path, browser):
    world = World()
    with world.record(tmp_path / "two.html"):
        world.load_urdf(DATA / "cube_small.urdf")
        world.step(240)
        second = world.load_urdf(DATA / "sphere_small.urdf", (1, 0, 0))
        world.step(240)
        world.remove(second.id)
        world.step(240)
    page = Page(browser, (tmp_path / "two.html").as_uri())
    page.until("window.app?.history.count > 0")
    for clock, bodies in (("0.5", 1), ("1.5", 2), ("2.5", 1), ("1.5", 2), ("0.5", 1)):
        page.page.locator("#scrub").fill(clock)
        assert page.page.evaluate("app.scene.bodies.size") == bodies
    assert page.complaints == []
    page.page.close()


@settings(deadline=None, max_examples=cases(30))
@given(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 3), st.floats(width=32)), max_size=40))
def test_recordings_come_back_as_they_were(frames: list[tuple[int, int, float]]):
    recording, told = Recording(), []
    for number, (layout, size, value) in enumerate(frames):
        header = {"type": "frame", "layout": layout, "poses": 0, "time": number / 60}
        payload = np.full(size, value, dtype="<f4").tobytes()
        told.append((header, payload))
        if number % 7 == 3:
            told.append(({"type": "line", "item": number}, b"abc"))
    for header, payload in told:
        recording.add(header, payload)
    assert unpacked(recording.packed(title="x")) == ({"format": 1, "title": "x"}, told)


def test_a_script_is_recorded_by_the_command_line(tmp_path: Path):
    script = tmp_path / "fall.py"
    script.write_text(
        "import pybullet as p, sys\n"
        "print(sys.argv[1:])\n"
        "p.connect(p.GUI)\n"
        "p.setGravity(0, 0, -10)\n"
        "p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1]))\n"
        "p.addUserDebugText('falls', [0, 0, 1])\n"
        "while p.isConnected():\n"
        "    p.stepSimulation()\n",
        encoding="utf-8",
    )
    file = tmp_path / "fall.html"
    command = [sys.executable, "-m", "carom", "record", "--seconds", "2", script, file, "--fast"]
    # In another home there would be no library yet.
    environment = {
        "PYTHONPATH": str(ROOT / "src"),
        "PATH": "",
        "HOME": str(tmp_path.parent),
        "CAROM_CACHE_PATH": str(cache_folder()),
    }
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    assert "['--fast']" in done.stdout
    facts, messages = unpacked(_recording_in(file))
    frames = [header for header, _ in messages if header["type"] == "frame"]
    assert frames[-1]["time"] == pytest.approx(2, abs=0.02)
    assert any(header["type"] == "text" for header, _ in messages)
    assert facts["title"] == "fall"


def _recording_in(file: Path) -> bytes:
    from base64 import b64decode

    text = file.read_text(encoding="utf-8")
    start = text.index('id="recording">') + len('id="recording">')
    return b64decode(text[start : text.index("</script>", start)])


FOREVER = """
import sys, time
import pybullet as p

p.connect(p.DIRECT)
p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
print(sys.argv[1:])
for _ in range(240):
    p.stepSimulation()
    time.sleep(1000)
"""


@pytest.fixture
def forever(tmp_path: Path) -> Path:
    """A script that takes days, as it sleeps a quarter of an hour after every step."""
    script = tmp_path / "first.py"
    script.write_text(FOREVER, encoding="utf-8")
    return script


def test_options_of_the_recording_stand_anywhere_and_sleeping_is_skipped(
    forever: Path, capsys: pytest.CaptureFixture[str]
):
    page = str(forever.with_name("first.html"))
    for words in (
        ["--seconds", "0.5", "--fps=30", str(forever), page, "--fast", "3"],
        [str(forever), page, "--seconds", "0.5", "--fast", "3", "--fps=30"],
        [str(forever), "--seconds=0.5", page, "--fast", "--fps", "30", "--", "3"],
    ):
        assert main(["record", *words]) == 0
        pybullet.disconnect()
        output, progress = capsys.readouterr()
        assert output.splitlines() == ["['--fast', '3']", f"Wrote {page}"]
        assert "of 0.5 s of simulated time" in progress
        times = [header["time"] for header, _ in unpacked(_recording_in(Path(page)))[1] if "time" in header]
        assert times[-1] == pytest.approx(0.5)
        assert len(times) == 16


def test_a_script_sleeps_while_it_is_recorded_where_that_is_asked_for(
    forever: Path, monkeypatch: pytest.MonkeyPatch
):
    slept: list[float] = []
    monkeypatch.setattr("time.sleep", slept.append)
    words = [str(forever), str(forever.with_name("first.html")), "--seconds", "0.1"]
    for more, sleeps in (["--keep-sleep"], [1000] * 23), ([], [0.0] * 23):
        assert main(["record", *words, *more]) == 0
        pybullet.disconnect()
        assert slept == sleeps
        slept.clear()


def test_words_after_two_dashes_are_the_scripts(forever: Path, capsys: pytest.CaptureFixture[str]):
    page = str(forever.with_name("first.html"))
    assert main(["record", str(forever), page, "--seconds", "0.1", "--", "--seconds", "7", "--"]) == 0
    pybullet.disconnect()
    assert capsys.readouterr().out.startswith("['--seconds', '7', '--']\n")


def test_a_wrong_option_after_the_file_is_refused(forever: Path, capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        main(["record", str(forever), "first.html", "--seconds", "never"])
    said = "carom record: error: argument --seconds: 'never' is not a positive number"
    assert said in capsys.readouterr().err


def test_seconds_count_through_resets(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    script = tmp_path / "episodes.py"
    script.write_text(
        "import pybullet as p\np.connect(p.DIRECT)\nfor _ in range(100):\n    p.resetSimulation()\n"
        "    for _ in range(24):\n        p.stepSimulation()\nprint('too long')\n",
        encoding="utf-8",
    )
    assert main(["record", str(script), str(tmp_path / "episodes.html"), "--seconds", "1"]) == 0
    pybullet.disconnect()
    assert "too long" not in capsys.readouterr().out
