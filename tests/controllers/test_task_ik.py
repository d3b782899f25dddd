"""Inverse kinematics by tasks: rows beside differences, targets, limits, distances."""

import numpy as np
import pytest
from tests.controllers.robots import DATA, HAND, READY, panda

from carom import World
from carom.controllers import (
    CenterOfMassTask,
    CollisionAvoidanceLimit,
    Configuration,
    ConfigurationLimit,
    FrameTask,
    LookAtTask,
    PostureTask,
    TaskIK,
    VelocityLimit,
)
from carom.description.transform import rotation_matrix

pytest.importorskip("daqp")

TURNED = np.array([0.9, 0.3, 0.1, -0.2]) / np.linalg.norm([0.9, 0.3, 0.1, -0.2])


def floating() -> Configuration:
    """A tree with all kinds of joints and a free base."""
    world = World()
    quadruped = world.load_urdf(DATA / "laikago" / "laikago_toes.urdf", (0.1, 0.2, 0.6), (0.1, 0.2, 0.3, 0.9))
    quadruped.joints.reset(np.linspace(-0.5, 0.5, len(quadruped.joints.movable)))
    return Configuration(quadruped)


def fixed() -> Configuration:
    return Configuration(panda()[1])


@pytest.mark.parametrize("made", [fixed, floating])
@pytest.mark.parametrize("link", [-1, 5, 10])
def test_jacobians_are_derivatives_of_poses(made, link):
    configuration = made()
    start = configuration.positions
    point = configuration.link_pose(link).position + np.array([0.1, -0.2, 0.05])
    rotation, origin = configuration.link_rotation(link), configuration.link_pose(link).position
    jacobian, at_origin = configuration.jacobian(link, point), configuration.jacobian(link)
    for dof in range(configuration.dofs):
        places, origins, turns = [], [], []
        for size in (1e-6, -1e-6):
            configuration.positions = start
            configuration.integrate(np.eye(configuration.dofs)[dof], size)
            turned, moved = configuration.link_rotation(link), configuration.link_pose(link).position
            places.append(moved + turned @ (rotation.T @ (point - origin)))
            origins.append(moved)
            turns.append(turned)
        change = (turns[0] - turns[1]) / 2e-6 @ rotation.T
        assert (places[0] - places[1]) / 2e-6 == pytest.approx(jacobian[:3, dof], abs=1e-8)
        assert (origins[0] - origins[1]) / 2e-6 == pytest.approx(at_origin[:3, dof], abs=1e-8)
        assert [change[2, 1], change[0, 2], change[1, 0]] == pytest.approx(jacobian[3:, dof], abs=1e-8)


@pytest.mark.parametrize("made", [fixed, floating])
@pytest.mark.parametrize("kind", ["com", "look", "posture"])
def test_rows_of_tasks_are_derivatives_of_their_errors(made, kind):
    configuration = made()
    start = configuration.positions
    count = configuration.dofs - configuration.base_dofs
    task = {
        "com": CenterOfMassTask((0.1, 0.2, 0.3)),
        # Near its goal, where rotation vectors add up.
        "look": LookAtTask(
            5, configuration.link_pose(5).position + configuration.link_rotation(5) @ (0.003, 0.002, 2.0)
        ),
        "posture": PostureTask(start + np.r_[np.zeros(len(start) - count), np.full(count, 0.1)]),
    }[kind]
    jacobian = task.rows(configuration).jacobian
    for dof in range(configuration.dofs):
        errors = []
        for size in (1e-5, -1e-5):
            configuration.positions = start
            configuration.integrate(np.eye(configuration.dofs)[dof], size)
            errors.append(task.rows(configuration).error)
        found = (errors[1] - errors[0]) / 2e-5
        assert found == pytest.approx(jacobian[:, dof], abs=1e-5 if kind != "look" else 3e-3)


def test_names_and_poses_are_those_of_links():
    _, robot = panda()
    configuration = Configuration(robot)
    for link in ("panda_hand", HAND, -1):
        pose = robot.links[link].pose
        found = configuration.link_pose(link)
        assert found.position == pytest.approx(pose.position, abs=1e-12)
        assert np.abs(found.orientation @ pose.orientation) == pytest.approx(1.0, abs=1e-12)
    assert configuration.link_rotation("panda_hand") == pytest.approx(
        np.array(rotation_matrix(tuple(robot.links["panda_hand"].pose.orientation)))
    )
    with pytest.raises(KeyError):
        configuration.link_pose("foot")


def test_errors_of_orientations_are_rotation_vectors():
    configuration = fixed()
    rotation, origin = configuration.link_rotation(-1), configuration.link_pose(-1).position
    assert rotation == pytest.approx(np.eye(3), abs=1e-12)
    axis = np.array([2.0, 3.0, 6.0]) / 7.0
    for angle in (0.0, 1e-5, 1.0, 3.0, np.pi):
        turned = np.append(np.sin(angle / 2) * axis, np.cos(angle / 2))
        error = FrameTask(-1, origin, turned).rows(configuration).error
        assert error == pytest.approx(np.r_[np.zeros(3), angle * axis], abs=1e-9)


def test_the_panda_reaches_poses_within_its_limits():
    configuration = fixed()
    limits = [ConfigurationLimit(configuration), VelocityLimit(2.0)]
    low, high = configuration.body.joints.limits
    frame = FrameTask(HAND, (0.4, 0.0, 0.4), TURNED)
    ik = TaskIK(configuration, [frame, PostureTask(READY, 1e-3)], limits)
    for goal in ((0.45, 0.2, 0.4), (0.35, -0.3, 0.6), (0.5, 0.0, 0.3)):
        frame.move(goal, TURNED)
        for _ in range(400):
            velocities = ik.tick(0.01)
            assert np.abs(velocities).max() <= 2.0 + 1e-9
            assert (configuration.positions >= low - 1e-9).all()
            assert (configuration.positions <= high + 1e-9).all()
        rotation, origin = configuration.link_rotation(HAND), configuration.link_pose(HAND).position
        assert origin == pytest.approx(goal, abs=1e-4)
        assert rotation == pytest.approx(np.array(rotation_matrix(tuple(TURNED))), abs=1e-4)


def test_a_posture_out_of_reach_leaves_joints_at_their_limits():
    configuration = fixed()
    low, high = configuration.body.joints.limits
    ik = TaskIK(
        configuration,
        [FrameTask(HAND, (0.4, 0.1, 0.5), position_cost=0.1), PostureTask(np.array(READY) + 4.0)],
        [ConfigurationLimit(configuration, margin=0.05), VelocityLimit(3.0)],
    )
    for _ in range(400):
        ik.tick(0.01)
    arm = configuration.positions[:7]
    assert (arm >= low[:7] + 0.05 - 1e-9).all()
    assert (arm <= high[:7] - 0.05 + 1e-9).all()
    assert (high[:7] - arm < 0.05 + 1e-9).sum() >= 4


@pytest.mark.parametrize("avoids", [False, True])
def test_the_hand_stays_away_from_an_obstacle(avoids):
    world, robot = panda()
    obstacle = world.add_sphere(0.1, (0.5, 0.0, 0.45))
    configuration = Configuration(robot)
    group = [(robot.id, link) for link in range(3, 11)]
    avoid = CollisionAvoidanceLimit(
        configuration, [(group, [(obstacle.id, -1)])], minimum_distance=0.02, detection_distance=0.15
    )
    limits = [ConfigurationLimit(configuration), VelocityLimit(2.0)]
    frame = FrameTask(HAND, (0.55, 0.3, 0.45))
    ik = TaskIK(configuration, [frame, PostureTask(READY, 0.03)], limits)
    for _ in range(150):
        ik.tick(0.01)
    assert configuration.link_pose(HAND).position == pytest.approx((0.55, 0.3, 0.45), abs=0.01)
    if avoids:
        ik.limits.append(avoid)
    frame.move((0.55, -0.3, 0.45))
    nearest = []
    for _ in range(500):
        ik.tick(0.01)
        nearest += avoid.distances(configuration)
    assert (min(nearest) > 0.019) == avoids
    assert min(nearest) < 0.05


def test_a_body_that_overlaps_an_obstacle_moves_out_of_it():
    world, robot = panda()
    obstacle = world.add_sphere(0.1, robot.links[HAND].pose.position.tolist())
    configuration = Configuration(robot)
    group = [(robot.id, link) for link in range(7, 11)]
    avoid = CollisionAvoidanceLimit(configuration, [(group, [(obstacle.id, -1)])])
    ik = TaskIK(configuration, [PostureTask(READY)], [VelocityLimit(0.2), avoid])
    before = min(avoid.distances(configuration))
    for _ in range(300):
        ik.tick(0.01)
    assert before < -0.02
    assert min(avoid.distances(configuration), default=1.0) > before + 0.05


def test_the_camera_looks_at_its_target_and_the_centre_of_mass_moves():
    configuration = floating()
    target = np.array((1.5, 0.5, 0.2))
    center = configuration.center_of_mass()[0] + (0.05, -0.03, 0.1)
    ik = TaskIK(
        configuration,
        [
            LookAtTask(-1, target, axis=(0, 0, 1)),
            CenterOfMassTask(center),
            PostureTask(configuration.positions, 1e-3),
        ],
    )
    for _ in range(200):
        ik.tick(0.01)
    rotation, origin = configuration.link_rotation(-1), configuration.link_pose(-1).position
    sight = target - origin
    assert rotation[:, 2] == pytest.approx(sight / np.linalg.norm(sight), abs=1e-4)
    assert configuration.center_of_mass()[0] == pytest.approx(center, abs=1e-4)


def test_the_configuration_follows_its_world_and_does_not_change_it():
    world, robot = panda()
    box = world.add_box((0.1, 0.1, 0.1), (1.0, 0.0, 0.0), mass=1.0)
    configuration = Configuration(robot)
    configuration.integrate(np.ones(9), 0.1)
    assert robot.joints.positions == pytest.approx(READY)
    box.set_inertial_pose((2.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    configuration.follow(keep=True)
    assert configuration.positions == pytest.approx(np.array(READY) + 0.1)
    assert configuration.world.bodies[box.id].links.base.pose.position[0] == pytest.approx(2.0)
    configuration.follow()
    assert configuration.positions == pytest.approx(READY)
