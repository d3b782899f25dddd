"""Videos: their pictures are those of the camera, at the right times."""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import pybullet as p
import pybullet_data
from carom import Camera, Recorder, World
from carom.recording.video import VideoFile
from pybullet._clients.clients import clients

av = pytest.importorskip("av")
WIDTH, HEIGHT = 65, 48


def pictures(path: Path) -> list[np.ndarray]:
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def rate(path: Path) -> float:
    with av.open(str(path)) as container:
        return float(container.streams.video[0].average_rate)


def ball_in_the_air() -> World:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(Path(pybullet_data.getDataPath()) / "sphere_small.urdf", position=(0.0, 0.0, 0.5))
    return world


def camera() -> Camera:
    return Camera.with_field_of_view(WIDTH, HEIGHT, 60).look_at((0.0, -1.0, 0.3), (0.0, 0.0, 0.3))


def height_of_ball(picture: np.ndarray) -> float:
    rows, _ = np.nonzero((picture < 235).any(axis=2))
    return float(-rows.mean())


def test_a_fall_is_filmed(tmp_path: Path) -> None:
    world = ball_in_the_air()
    with Recorder(tmp_path / "fall.mp4", camera(), world, fps=60):
        world.step(48)
    world.step(48)
    film = pictures(tmp_path / "fall.mp4")
    # One before the first step, then one every four steps.
    assert len(film) == 13
    assert rate(tmp_path / "fall.mp4") == 60
    # Odd sizes are made even.
    assert film[0].shape == (HEIGHT, WIDTH + 1, 3)
    heights = [height_of_ball(picture) for picture in film]
    assert all(later <= earlier for earlier, later in pairwise(heights))
    assert heights[-1] < heights[0] - 3
    assert world.observers == []


@pytest.mark.skipif("libx264" not in av.codecs_available, reason="this build of PyAV lacks H.264")
def test_films_have_a_better_quality_than_the_default_of_the_encoder(tmp_path: Path) -> None:
    with Recorder(tmp_path / "fall.mp4", camera(), ball_in_the_air()) as recorder:
        recorder._film.shoot()
    # The encoder notes its settings in the file; without any its quality is 23, and less is better.
    assert b" crf=18.0 " in (tmp_path / "fall.mp4").read_bytes()


def test_pictures_of_odd_sizes_stay_where_they_are(tmp_path: Path) -> None:
    picture = np.zeros((47, 65, 3), np.uint8)
    picture[:21, :33] = picture[21:, 33:] = 255
    file = VideoFile(tmp_path / "x.mp4", 65, 47, 30)
    file.add(picture)
    file.close()
    (shown,) = pictures(tmp_path / "x.mp4")
    # What makes the size even repeats the last row and column.
    whole = np.pad(picture, ((0, 1), (0, 1), (0, 0)), mode="edge")
    assert shown.shape == whole.shape
    assert np.abs(shown.astype(int) - whole).max() < 100


@pytest.mark.parametrize(("width", "height"), [(1, 1), (1, 40), (40, 1)])
def test_the_least_picture_is_of_one_pixel(tmp_path: Path, width: int, height: int) -> None:
    file = VideoFile(tmp_path / "x.mp4", width, height, 30)
    file.add(np.full((height, width, 3), 200, np.uint8))
    file.close()
    (shown,) = pictures(tmp_path / "x.mp4")
    assert shown.shape == (height + height % 2, width + width % 2, 3)
    assert shown == pytest.approx(200, abs=6)


def test_slow_motion_and_steps_longer_than_pictures(tmp_path: Path) -> None:
    world = ball_in_the_air()
    slow = Recorder(tmp_path / "slow.mp4", camera(), world, fps=30, speed=0.125)
    fast = Recorder(tmp_path / "fast.mp4", camera(), world, fps=480)
    world.step(10)
    for recorder in (slow, fast, fast):
        recorder.stop()
    assert len(pictures(tmp_path / "slow.mp4")) == 11
    assert len(pictures(tmp_path / "fast.mp4")) == 21


def test_the_film_of_a_step_of_years_comes_to_an_end(tmp_path: Path) -> None:
    world = ball_in_the_air()
    world.parameters.time_step = 1e9
    world.apply_parameters()
    with Recorder(tmp_path / "years.mp4", camera(), world):
        world.step()
    assert len(pictures(tmp_path / "years.mp4")) == 241


def test_a_film_without_steps_is_a_proper_file(tmp_path: Path) -> None:
    Recorder(tmp_path / "nothing.mp4", camera(), ball_in_the_air()).stop()
    assert (tmp_path / "nothing.mp4").stat().st_size > 0
    av.open(str(tmp_path / "nothing.mp4")).close()


def test_what_cannot_be_filmed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = ball_in_the_air()
    with pytest.raises(ValueError, match="which world"):
        Recorder(tmp_path / "x.mp4", camera())
    for wrong in ({"fps": 0.0}, {"fps": float("nan")}, {"speed": -1.0}):
        with pytest.raises(ValueError, match="must be"):
            Recorder(tmp_path / "x.mp4", camera(), world, **wrong)
    with pytest.raises(OSError):
        Recorder(tmp_path / "nowhere" / "x.mp4", camera(), world)
    with pytest.raises(ValueError, match="0 x 5"):
        VideoFile(tmp_path / "x.mp4", 0, 5, 30)
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(ImportError, match=r"pip install 'carom\[video\]'"):
        Recorder(tmp_path / "x.mp4", camera(), world)
    assert world.observers == []
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def falling_cube():
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.loadURDF(pybullet_data.getDataPath() + "/cube_small.urdf", [0, 0, 0.3])
    yield
    if p.isConnected(client):
        p.disconnect(client)


def test_state_logging_films_the_window(falling_cube, tmp_path: Path) -> None:
    file = tmp_path / "cube.mp4"
    log = p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(file))
    for _ in range(20):
        p.stepSimulation()
    p.stopStateLogging(log)
    film = pictures(file)
    assert len(film) == 6
    assert film[0].shape == (480, 640, 3)
    # The cube is in front of PyBullet's background.
    assert film[0][5, 5] == pytest.approx([178, 178, 204], abs=6)
    assert len(np.unique(film[0].reshape(-1, 3), axis=0)) > 10
    with pytest.raises(p.error, match=r"^startStateLogging failed\."):
        p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(tmp_path / "nowhere" / "x.mp4"))


def test_without_pyav_a_log_of_video_is_one_that_makes_none(
    falling_cube, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    # PyBullet films its window, and returns ids without one: 0, 1, ...
    monkeypatch.setitem(sys.modules, "av", None)
    logs = [p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(tmp_path / "x.mp4")) for _ in range(2)]
    assert logs == [0, 1]
    assert "no video is made: " in caplog.text and "carom[video]" in caplog.text
    p.stepSimulation()
    p.stopStateLogging(logs[0])
    assert list(tmp_path.iterdir()) == []


def test_a_new_video_ends_the_one_before(falling_cube, tmp_path: Path) -> None:
    file = tmp_path / "cube.mp4"
    other = p.startStateLogging(p.STATE_LOGGING_CONTACT_POINTS, str(tmp_path / "contacts.bin"))
    first = p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(file))
    p.stepSimulation()
    second = p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(file))
    assert first not in clients[0].logs.by_id
    for _ in range(4):
        p.stepSimulation()
    p.stopStateLogging(first)
    assert set(clients[0].logs.by_id) == {other, second}
    p.stopStateLogging(second)
    assert len(pictures(file)) == 2


def test_a_video_can_be_told_when_to_take_its_pictures(falling_cube, tmp_path: Path) -> None:
    file = tmp_path / "cube.mp4"
    p.startStateLogging(p.STATE_LOGGING_VIDEO_MP4, str(file))
    for _ in range(3):
        p.configureDebugVisualizer(p.COV_ENABLE_SINGLE_STEP_RENDERING, 1)
        for _ in range(40):
            p.stepSimulation()
    # Whoever disconnects finishes the file.
    p.disconnect()
    assert len(pictures(file)) == 3


def test_the_option_mp4_films_the_window(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CI", "true")
    file = tmp_path / "window.mp4"
    options = f'--port=0 --width=64 --height=48 --mp4="{file}" --mp4fps=240 --background_color_red=1'
    p.connect(p.GUI, options=options)
    for _ in range(4):
        p.stepSimulation()
    p.disconnect()
    film = pictures(file)
    assert len(film) == 5
    assert rate(file) == 240
    assert film[0][5, 5] == pytest.approx([255, 204, 204], abs=6)
    with pytest.raises(p.error, match=r"^Cannot write "):
        p.connect(p.GUI, options=f"--port=0 --mp4={tmp_path}/nowhere/x.mp4")
    assert not p.isConnected()
