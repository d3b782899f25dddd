"""Plots of joints, previews of images, and looking at a robot file."""

from pathlib import Path

import numpy as np
import pytest
from tests.patience import until
from tests.viewer.watcher import Watcher

import pybullet as p
import pybullet_data
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded
from carom.viewer.rays import Rays
from carom.viewer.viewer import Viewer
from carom.world.world import World
from pybullet._clients.clients import clients

DATA = Path(pybullet_data.getDataPath())


def test_plotted_joints_are_sampled(viewer: Viewer):
    arm = p.loadURDF(str(DATA / "franka_panda/panda.urdf"), useFixedBase=True)
    p.setJointMotorControl2(arm, 1, p.POSITION_CONTROL, 0.4)
    p.setJointMotorControl2(arm, 3, p.VELOCITY_CONTROL, force=0)
    with Watcher(viewer.address) as page:
        page.tell("want", joints=[arm, 99])
        page.wait_for(lambda: len(page.blocks.get("joints", ())) == 9)
        for _ in range(20):
            p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(20 / 240))
        driven, free = page.blocks["joints"][[1, 3]]
        state = p.getJointState(arm, 1)
        assert tuple(driven[:2]) == (arm, 1)
        assert driven[2:5] == pytest.approx([state[0], state[1], state[3]], rel=1e-5)
        assert driven[5] == pytest.approx(0.4)
        assert tuple(free[:2]) == (arm, 3)
        assert np.isnan(free[5:]).all()
        p.setJointMotorControl2(arm, 3, p.TORQUE_CONTROL, force=1.5)
        p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(21 / 240))
        free = page.blocks["joints"][3]
        assert (free[4], free[7]) == (1.5, 1.5)
        # The past of joints can be plotted later, but what scripts apply is read only while it is wanted.
        page.tell("want", joints=[])
        world = clients[0].world
        assert until(lambda: not world.observers)
        p.setJointMotorControl2(arm, 3, p.TORQUE_CONTROL, force=1.5)
        p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] == pytest.approx(22 / 240))
        assert len(page.blocks["joints"]) == 9
        assert np.isnan(page.blocks["joints"][3][7])


def test_readings_of_many_bodies_are_not_recorded_unless_they_are_wanted(viewer: Viewer):
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    for n in range(65):
        p.createMultiBody(1, shape, basePosition=[n, 0, 1])
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: page.frame.get("poses") == 65)
        assert until(lambda: not viewer._frames.details._links)
        page.take_what_came()
        p.stepSimulation()
        page.wait_for(lambda: page.frame["time"] > 0)
        assert "links" not in page.blocks
        p.removeBody(0)
        p.stepSimulation()
        page.wait_for(lambda: len(page.blocks.get("links", ())) == 64)


def test_contacts_are_told_as_scripts_are_told_of_them(viewer: Viewer):
    p.setGravity(0, 0, -10)
    p.loadURDF(str(DATA / "plane.urdf"))
    cube = p.loadURDF(str(DATA / "cube_small.urdf"), [0, 0, 0.026])
    for _ in range(240):
        p.stepSimulation()
    p.applyExternalForce(cube, -1, [0.2, 0, 0], [0, 0, 0.025], p.WORLD_FRAME)
    with Watcher(viewer.address) as page:
        page.tell("want", contacts=True)
        p.stepSimulation()
        page.wait_for(lambda: len(page.blocks.get("contacts", ())) == 4)
        page.wait_for(lambda: page.frame["time"] == pytest.approx(241 / 240))
        told = page.blocks["contacts"]
        known = p.getContactPoints()
        assert told[:, [0, 2]].tolist() == [[point[1], point[2]] for point in known]
        assert told[:, [1, 3]].tolist() == [[point[3] + 1, point[4] + 1] for point in known]
        assert told[:, 4:7] == pytest.approx(np.array([point[6] for point in known]), abs=1e-6)
        assert told[:, 7:10] == pytest.approx(np.array([point[7] for point in known]), abs=1e-6)
        assert told[:, 10] == pytest.approx([point[9] for point in known], abs=1e-5)
        sideways = [np.multiply(point[10], point[11]) + np.multiply(point[12], point[13]) for point in known]
        assert told[:, 11:14] == pytest.approx(np.array(sideways), abs=1e-5)
        assert np.abs(told[:, 11].sum()) == pytest.approx(0.2, abs=0.05)
        rubber = [p.getDynamicsInfo(body, -1)[1] for body in (0, cube)]
        assert told[:, 14] == pytest.approx(rubber[0] * rubber[1])


def test_motion_of_links_masses_and_constraints_are_told(viewer: Viewer):
    arm = p.loadURDF(str(DATA / "franka_panda/panda.urdf"), useFixedBase=True)
    cube = p.loadURDF(str(DATA / "cube_small.urdf"), [1, 0, 1])
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, targetVelocity=1, force=500)
    p.enableJointForceTorqueSensor(arm, 6)
    p.createConstraint(cube, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0.02], [1, 0, 1])
    with Watcher(viewer.address) as page:
        page.tell("want", links=[[arm, 6], [cube, -1], [77, 0]], dynamics=True, constraints=True)
        for _ in range(10):
            p.stepSimulation()
        page.wait_for(lambda: page.frame.get("time") == pytest.approx(10 / 240) and "links" in page.blocks)
        hand, _ = page.blocks["links"]
        state = p.getLinkState(arm, 6, computeLinkVelocity=1)
        assert state is not None
        *_, linear, angular = state
        assert hand[2:8] == pytest.approx([*linear, *angular], abs=1e-5)
        assert hand[8:] == pytest.approx(p.getJointState(arm, 6)[2], abs=1e-4)
        page.wait_for(lambda: ("dynamics", arm) in page.shown)
        masses = [link["mass"] for link in page.shown["dynamics", arm]["links"]]
        assert masses == [p.getDynamicsInfo(arm, link)[0] for link in range(-1, p.getNumJoints(arm))]
        page.wait_for(lambda: ("constraints", None) in page.shown)
        (tie,) = page.shown["constraints", None]["constraints"]
        assert (tie["parent"]["body"], tie["child"]["body"]) == (cube, -1)
        p.changeDynamics(cube, -1, mass=3)
        page.wait_for(lambda: page.shown["dynamics", cube]["links"][0]["mass"] == 3)


def test_rays_are_told_while_a_page_shows_them(viewer: Viewer):
    p.loadURDF(str(DATA / "cube_small.urdf"))
    p.rayTest([0, 0, 1], [0, 0, 0])
    with Watcher(viewer.address) as page:
        page.tell("want", rays=True)
        assert until(lambda: viewer.rays.wanted)
        p.rayTestBatch([[0, 0, 1], [1, 0, 1]], [[0, 0, -1], [1, 0, -1]])
        page.wait_for(lambda: ("rays", None) in page.shown)
        rays = np.frombuffer(page.payloads["rays", None], dtype="<f4").reshape(-1, 10)
        assert rays[0] == pytest.approx([0, 0, 1, 0, 0, -1, 0, 0, 1, (1 - 0.025) / 2], abs=1e-6)
        assert rays[1, 9] == 1


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


def colours(page: Watcher) -> np.ndarray:
    return np.frombuffer(page.payloads["previews", None], dtype=np.uint8).reshape(3, 100, 200, 3)[0]


def test_the_last_image_is_shown_also_if_it_came_before_the_page_or_at_once_after_another_one(viewer: Viewer):
    ball = p.createMultiBody(1, -1, p.createVisualShape(p.GEOM_SPHERE, radius=0.3, rgbaColor=[1, 0, 0, 1]))
    projection = p.computeProjectionMatrixFOV(60, 2, 0.1, 10)

    def photograph(place: float) -> np.ndarray:
        view = p.computeViewMatrix([place, 0, 0], [0, 0, 0], [0, 0, 1])
        image = p.getCameraImage(400, 200, view, projection)[2]
        shown = image[::2, ::2, :3].copy()
        # What a script does to its image is its own business.
        image[:] = 0
        return shown

    before = photograph(1.0)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: ("body", ball) in page.shown and ("previews", None) in page.shown)
        assert (colours(page) == before).all()
        photograph(2.0)
        last = photograph(3.0)
        page.wait_for(lambda: np.array_equal(colours(page), last))


def test_a_world_of_the_modern_api_is_shown_and_can_be_pulled_at():
    world = World()
    body = world.load_urdf(DATA / "cube_small.urdf", position=(0, 0, 1))
    viewer = Viewer(world, port=0)
    try:
        assert viewer.address in viewer._repr_html_()
        with Watcher(viewer.address) as page:
            page.wait_for(lambda: len(page.poses))
            page.tell("grasp", body=body.id, link=-1, point=[0, 0, 0], target=[0.3, 0, 1])
            assert until(lambda: world.user_constraints.rows)
            world.step(60)
            page.wait_for(lambda: page.frame["time"] > 0.2)
            assert world.link_pose[0, 0] > 0.2
            page.tell("let go")
            assert until(lambda: not world.user_constraints.rows)
    finally:
        viewer.close()


def test_rays_of_one_call_are_shown_together():
    latest = LatestMessages()
    rays = Rays(latest)
    hit = (-1, -1, 1.0, (0, 0, 0), (0, 0, 0))

    def hits():
        for _ in range(2):
            # A frame is made meanwhile.
            rays.show()
            yield hit

    rays.tell([[0, 0, 0], [1, 0, 0]], [[0, 0, 1], [1, 0, 1]], hits())  # pyright: ignore[reportArgumentType]
    assert not latest.holds("rays")
    rays.show()
    ((message,), _) = latest.since(0)
    assert decoded(message)[0]["count"] == 2
