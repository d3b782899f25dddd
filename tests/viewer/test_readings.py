"""Plots of joints, previews of images, and looking at a robot file."""

from pathlib import Path

import numpy as np
import pytest
from tests.viewer.watcher import Watcher

import carom.cli
import pybullet as p
import pybullet_data
from carom.errors import DescriptionError
from carom.formats.search import AssetSearch
from carom.viewer.robot import RobotView
from carom.viewer.viewer import Viewer
from carom.world import World

DATA = Path(pybullet_data.getDataPath())


def test_plotted_joints_are_sampled(viewer: Viewer):
    arm = p.loadURDF(str(DATA / "franka_panda/panda.urdf"), useFixedBase=True)
    p.setJointMotorControl2(arm, 1, p.POSITION_CONTROL, 0.4)
    p.setJointMotorControl2(arm, 3, p.VELOCITY_CONTROL, force=0)
    with Watcher(viewer.address) as page:
        page.tell("plot", joints=[[arm, 1], [arm, 3], [arm, 7], [arm, 99], [5, 0]])
        page.wait_for(lambda: "joints" in page.frame)
        for _ in range(20):
            p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(20 / 240))
        driven, free = page.frame["joints"]
        state = p.getJointState(arm, 1)
        assert driven[:2] == [arm, 1]
        assert driven[2:5] == pytest.approx([state[0], state[1], state[3]])
        assert driven[5] == 0.4
        assert free[:2] == [arm, 3]
        assert free[5:] == [None, None, None]
        p.setJointMotorControl2(arm, 3, p.TORQUE_CONTROL, force=1.5)
        p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(21 / 240))
        free = page.frame["joints"][1]
        assert (free[4], free[7]) == (1.5, 1.5)
        page.tell("plot", joints=[])
        page.wait_for(lambda: "joints" not in page.frame)
        p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] > 21.5 / 240)
        assert "joints" not in page.frame


def test_camera_images_are_previewed(viewer: Viewer):
    ball = p.createMultiBody(1, -1, p.createVisualShape(p.GEOM_SPHERE, radius=0.3, rgbaColor=[1, 0, 0, 1]))
    view = p.computeViewMatrix([1, 0, 0], [0, 0, 0], [0, 0, 1])
    projection = p.computeProjectionMatrixFOV(60, 2, 0.1, 10)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("body", ball) in page.shown)
        image = p.getCameraImage(400, 200, view, projection)
        preview = page.wait_for(lambda: page.shown.get(("previews", None)))
        assert (preview["width"], preview["height"]) == (200, 100)
        pictures = np.frombuffer(page.payloads["previews", None], dtype=np.uint8).reshape(3, 100, 200, 3)
        assert (pictures[0] == image[2][::2, ::2, :3]).all()
        middle, corner = (50, 100), (2, 2)
        assert (pictures[1][corner] == 255).all()
        assert (pictures[1][middle] < 100).all()
        assert (pictures[2][corner] == 255).all()
        assert (pictures[2][middle] != 255).any()


def robot_view(file: str) -> RobotView:
    return RobotView(DATA / file, AssetSearch(), "127.0.0.1", 0)


def test_a_robot_follows_its_sliders():
    view = robot_view("franka_panda/panda.urdf")
    try:
        with Watcher(view.viewer.address) as page:
            page.wait_for(lambda: sum(kind == "slider" for kind, _ in page.shown) == 9)
            assert page.shown["options", None]["names"]
            knee = page.shown["slider", 3]
            assert knee["name"] == "panda_joint4"
            assert knee["lower"] <= knee["value"] <= knee["upper"]
            page.tell("slider", slider=1, value=0.5)
            page.wait_for(lambda: page.shown["slider", 1]["value"] == 0.5)
            before = page.poses.copy()
            view.follow()
            page.wait_for(lambda: not np.array_equal(page.poses, before))
            page.tell("close")
        view.run()
    finally:
        view.viewer.close()


def test_scenes_of_several_robots_are_shown(tmp_path: Path):
    (tmp_path / "two.xml").write_text(
        "<mujoco><worldbody>"
        + "".join(
            f'<body name="b{i}" pos="{i} 0 0"><joint type="slide"/><geom type="sphere" size="0.1"/></body>'
            for i in range(2)
        )
        + "</worldbody></mujoco>"
    )
    view = RobotView(tmp_path / "two.xml", AssetSearch(), "127.0.0.1", 0)
    try:
        with Watcher(view.viewer.address) as page:
            page.wait_for(lambda: ("slider", 1) in page.shown)
            assert page.shown["slider", 0]["lower"] == -1
    finally:
        view.viewer.close()


def test_files_without_robots_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    (tmp_path / "nothing.sdf").write_text("<sdf version='1.6'/>")
    with pytest.raises(DescriptionError):
        robot_view(str(tmp_path / "nothing.sdf"))
    assert carom.cli.main(["view", str(tmp_path / "missing.urdf")]) == 1
    assert capsys.readouterr().err.startswith("carom: ")


def test_a_world_of_the_modern_api_is_shown_and_cannot_be_pulled_at():
    world = World()
    body = world.load_urdf(DATA / "cube_small.urdf", position=(0, 0, 1))
    viewer = Viewer(world, port=0)
    try:
        assert viewer.address in viewer._repr_html_()
        with Watcher(viewer.address) as page:
            page.tell("grasp", body=body.id, link=-1, point=[0, 0, 0], target=[0, 0, 1])
            page.wait_for(lambda: len(page.poses))
            world.step()
            page.wait_for(lambda: page.frame["time"] > 0)
        assert not world.user_constraints.rows
    finally:
        viewer.close()
