"""Tasks relative to links, constraints that hold, joints that stay, limits by name."""

import numpy as np
import pytest
from tests.controllers.robots import HAND, READY, panda

from carom import World
from carom.controllers import (
    Configuration,
    ConfigurationLimit,
    DampingTask,
    EqualityTask,
    FrameTask,
    FreezeTask,
    NoSolutionError,
    PostureTask,
    RelativeFrameTask,
    TaskIK,
    VelocityLimit,
)
from carom.description.pose import Pose
from carom.description.transform import rotation_matrix
from carom.layouts.codes import UserConstraintKind

pytest.importorskip("daqp")

# A loop of four bars, a free body that is welded to a link, and a joint that follows another.
LOOP = """<mujoco><worldbody>
<body name="left" pos="0 0 1"><joint name="left" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 0.4" size=".02"/>
<body name="top" pos="0 0 0.4"><joint name="top" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0.5 0 0" size=".02"/></body>
<body name="dial" pos="0 0.1 0.2"><joint name="dial" axis="0 1 0"/><geom size=".03"/></body></body>
<body name="right" pos="0.5 0 1"><joint name="right" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 0.4" size=".02"/></body>
</worldbody><equality><connect name="closed" body1="top" body2="world" anchor="0.5 0 0"/>
<joint name="follows" joint1="dial" joint2="left" polycoef="0.1 2 0.5 0 0"/>
</equality></mujoco>"""


def loop(tmp_path) -> Configuration:
    path = tmp_path / "loop.xml"
    path.write_text(LOOP)
    world = World()
    bodies = world.load_mjcf(path)
    return Configuration(next(body for body in bodies if "top" in [link.name for link in body.links]))


def derivatives(configuration: Configuration, task) -> np.ndarray:
    """Central differences of minus the error of a task, (k, n)."""
    start, columns = configuration.positions, []
    for dof in range(configuration.dofs):
        errors = []
        for size in (1e-5, -1e-5):
            configuration.positions = start
            configuration.integrate(np.eye(configuration.dofs)[dof], size)
            errors.append(task.rows(configuration).error)
        columns.append((errors[1] - errors[0]) / 2e-5)
    configuration.positions = start
    return np.array(columns).T


def test_rows_of_relative_frames_are_derivatives():
    configuration = Configuration(panda()[1])
    base = configuration.link_rotation("panda_link3")
    relative = base.T @ (
        configuration.link_pose("panda_hand").position - configuration.link_pose("panda_link3").position
    )
    # Near the goal, where rotation vectors add up.
    x, y, z, w = configuration.link_pose("panda_link3").orientation
    turn = np.array(rotation_matrix((-x, -y, -z, w))) @ configuration.link_rotation("panda_hand")
    task = RelativeFrameTask("panda_hand", "panda_link3", relative + np.array([0.02, 0.01, -0.03]))
    assert task.rows(configuration).error[:3] == pytest.approx((0.02, 0.01, -0.03))
    assert (task.cost[3:] == 0.0).all()
    task = RelativeFrameTask(
        "panda_hand", "panda_link3", relative, (0.2, 0.1, 0.3, 0.9), offset=(0.01, 0.02, 0.1)
    )
    task._wanted = turn
    found = task.rows(configuration)
    assert found.error[3:] == pytest.approx(np.zeros(3), abs=1e-9)
    assert derivatives(configuration, task) == pytest.approx(found.jacobian, abs=1e-6)


def test_a_hand_keeps_its_place_relative_to_a_link():
    configuration = Configuration(panda()[1])
    configuration.positions = np.array(READY) + np.array([0.3, -0.2, 0.2, 0.3, 0.2, -0.3, 0.1, 0.0, 0.0])
    base, hand = (configuration.link_rotation(link) for link in ("panda_link3", HAND))
    goal = base.T @ (configuration.link_pose(HAND).position - configuration.link_pose("panda_link3").position)
    # The rotation matrix of the goal as a quaternion.
    w = 0.5 * np.sqrt(1.0 + np.trace(base.T @ hand))
    skew = base.T @ hand - hand.T @ base
    turn = np.array([skew[2, 1], skew[0, 2], skew[1, 0], 4.0 * w * w]) / (4.0 * w)
    configuration.positions = READY
    task = RelativeFrameTask(HAND, "panda_link3", goal, 2.0 * turn)
    ik = TaskIK(configuration, [task, PostureTask(READY, 1e-3)])
    for _ in range(300):
        ik.tick(0.01)
    assert task.rows(configuration).error == pytest.approx(np.zeros(6), abs=1e-3)
    base, hand = (configuration.link_rotation(link) for link in ("panda_link3", HAND))
    offset = configuration.link_pose(HAND).position - configuration.link_pose("panda_link3").position
    assert base.T @ offset == pytest.approx(goal, abs=1e-3)
    assert base.T @ hand == pytest.approx(np.array(rotation_matrix(tuple(turn))), abs=2e-3)
    with pytest.raises(ValueError, match="quaternion that is not 0"):
        task.move((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))


def test_damping_slows_down():
    speeds = []
    for cost in (0.0, 0.5, 2.0):
        configuration = Configuration(panda()[1])
        ik = TaskIK(configuration, [FrameTask(HAND, (0.5, 0.2, 0.5)), DampingTask(cost)])
        speeds.append(np.linalg.norm(ik.solve(0.01)))
    assert speeds[0] > 1.5 * speeds[1] > 3.0 * speeds[2] > 0.0


def test_frozen_joints_stay_and_others_do_the_task():
    configuration = Configuration(panda()[1])
    names = ["panda_joint2", "panda_joint4"]
    frame = FrameTask(HAND, (0.45, 0.2, 0.45))
    ik = TaskIK(configuration, [frame], constraints=[FreezeTask(configuration, names)])
    free = TaskIK(Configuration(panda()[1]), [frame])
    for _ in range(100):
        ik.tick(0.01)
        free.tick(0.01)
    assert configuration.positions[[1, 3]] == pytest.approx(np.array(READY)[[1, 3]], abs=1e-12)
    assert np.abs(configuration.positions - READY).max() > 0.05
    assert np.abs(free.configuration.positions - READY)[[1, 3]].max() > 0.05
    with pytest.raises(KeyError):
        FreezeTask(configuration, ["panda_joint99"])


def test_constraints_that_contradict_each_other_are_refused(tmp_path):
    configuration = loop(tmp_path)
    configuration.integrate(np.array([0.2, 0.0, 0.0]), 1.0)
    joints = ["left", "top", "dial"]
    constraints = [EqualityTask(configuration, ["closed"]), FreezeTask(configuration, joints)]
    with pytest.raises(NoSolutionError, match="contradict each other, by"):
        TaskIK(configuration, [], constraints=constraints).solve(0.01)
    ik = TaskIK(configuration, [], [VelocityLimit(0.0)], constraints=constraints[:1])
    with pytest.raises(NoSolutionError, match="constraints and limits"):
        ik.solve(0.01)


def test_a_loop_stays_closed_and_a_joint_follows(tmp_path):
    configuration = loop(tmp_path)
    configuration.integrate(np.array([0.1, -0.05, 0.2]), 1.0)
    kept = EqualityTask(configuration)
    rows = kept.rows(configuration)
    assert rows.error.shape == (4,)
    assert np.abs(rows.error).max() > 1e-3
    assert derivatives(configuration, kept) == pytest.approx(rows.jacobian, abs=1e-6)
    ik = TaskIK(configuration, [], constraints=[kept])
    for _ in range(20):
        ik.tick(0.01)
    assert kept.rows(configuration).error == pytest.approx(np.zeros(4), abs=1e-9)
    left, _, dial = configuration.positions
    assert dial == pytest.approx(0.1 + 2.0 * left + 0.5 * left**2, abs=1e-9)


def test_a_weld_between_two_bodies():
    world, robot = panda()
    box = world.add_box((0.02, 0.02, 0.02), (0.5, 0.2, 0.5), mass=1.0)
    frames = Pose((0.0, 0.0, 0.05)), Pose((0.01, 0.0, 0.0), (0.0, 0.6, 0.0, 0.8))
    ends = robot, robot.links["panda_hand"].index, box, -1
    new = world.user_constraints.new(UserConstraintKind.FIXED, *ends, (0.0, 0.0, 0.0), *frames)
    world.add_constraint(new)
    configuration = Configuration(robot)
    kept = EqualityTask(configuration, gain=0.5)
    rows = kept.rows(configuration)
    assert rows.error.shape == (6,)
    assert derivatives(configuration, kept)[:3] == pytest.approx(rows.jacobian[:3], abs=1e-6)
    ik = TaskIK(configuration, [PostureTask(READY, 1e-3), kept])
    for _ in range(300):
        ik.tick(0.01)
    assert np.abs(kept.rows(configuration).error).max() < 2e-3
    by_box = Configuration(box)
    other = EqualityTask(by_box)
    assert derivatives(by_box, other)[:3] == pytest.approx(other.rows(by_box).jacobian[:3], abs=1e-6)


def test_names_of_constraints_are_checked(tmp_path):
    configuration = loop(tmp_path)
    with pytest.raises(KeyError, match=r"no constraint 'open'; those of 'left': .*'closed'"):
        EqualityTask(configuration, ["open"])
    assert len(EqualityTask(configuration, ["follows"]).rows(configuration).error) == 1
    for constraint in configuration.world.user_constraints.all:
        constraint.enabled = False
    assert EqualityTask(configuration).rows(configuration).jacobian.shape == (0, 3)


def test_limits_of_joints_by_name():
    configuration = Configuration(panda()[1])
    limit = ConfigurationLimit(configuration, {"panda_joint1": (-0.1, 0.1), "panda_joint2": (-9.0, 9.0)})
    ik = TaskIK(
        configuration, [PostureTask(np.array(READY) + 2.5)], [limit, VelocityLimit({"panda_joint3": 0.5})]
    )
    velocities = ik.tick(0.01)
    assert np.abs(velocities[2]) == pytest.approx(0.5)
    assert np.abs(velocities[1]) > 5.0
    for _ in range(200):
        ik.tick(0.01)
    assert configuration.positions[0] == pytest.approx(0.1)
    assert configuration.positions[1] == pytest.approx(READY[1] + 2.5, abs=1e-6)
    with pytest.raises(ValueError, match="limits of joint 'panda_joint1' must be in order"):
        ConfigurationLimit(configuration, {"panda_joint1": (0.1, -0.1)})
    with pytest.raises(KeyError):
        ConfigurationLimit(configuration, {"elbow": (0.0, 1.0)})
    with pytest.raises(ValueError, match="velocity of 'panda_joint1'"):
        VelocityLimit({"panda_joint1": -1.0})


@pytest.mark.parametrize("velocities", [0.5, np.linspace(0.1, 0.9, 9), {"panda_joint3": 0.5}])
@pytest.mark.parametrize("way", [2.5, -2.5])
def test_limits_of_velocities_hold_in_both_directions(velocities: object, way: float):
    configuration = Configuration(panda()[1])
    limit: VelocityLimit = VelocityLimit(velocities)  # type: ignore[arg-type]
    ik = TaskIK(configuration, [PostureTask(np.array(READY) + way)], [limit])
    bounds = np.full(9, np.inf)
    if isinstance(velocities, dict):
        bounds[2] = 0.5
    else:
        bounds[:] = velocities
    found, limited = ik.tick(0.01)[:7], np.isfinite(bounds[:7])
    assert found[limited] == pytest.approx(np.sign(way) * bounds[:7][limited], rel=1e-6)
    assert (np.sign(way) * found[~limited] > 5.0).all()
