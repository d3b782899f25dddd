"""Forward kinematics: the poses that a body's links have once its joints are there."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.robots import random_tree

from carom import Body, World
from carom.algorithms import forward_kinematics
from carom.description import JointType
from carom.description.pose import Pose
from carom.description.transform import compose

KINDS = (JointType.REVOLUTE, JointType.PRISMATIC, JointType.SPHERICAL, JointType.PLANAR, JointType.FIXED)


def tree(seed: int, kind: JointType) -> tuple[Body, list[float]]:
    """A tree in a world, away from the origin, and joint positions for it."""
    rng = np.random.default_rng(seed)
    body = World().load(
        random_tree(seed, 6, fixed_base=False, joint_types=(kind, JointType.FIXED)), (1.0, 2.0, 3.0)
    )
    turn = rng.normal(size=4)
    body.set_inertial_pose(rng.normal(size=3).tolist(), turn.tolist())
    numbers: list[float] = []
    for count in body.position_count:
        values = rng.normal(size=count)
        numbers += (values / np.linalg.norm(values) if count == 4 else values).tolist()
    return body, numbers


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_poses_are_those_of_a_body_that_is_there(seed: int, kind: JointType) -> None:
    body, numbers = tree(seed, kind)
    before = body.coordinates()
    found = forward_kinematics(body, numbers)
    assert body.coordinates() == before
    first = 0
    for joint, count in enumerate(body.position_count):
        body.set_joint_state(joint, numbers[first : first + count], None)
        first += count
    assert len(found) == body.joint_count
    for link, pose in enumerate(found):
        there = body.links[link].pose
        assert pose.position == pytest.approx(there.position, abs=1e-12)
        assert abs(np.dot(pose.orientation, there.orientation)) == pytest.approx(1.0, abs=1e-12)


def test_links_of_choice_in_the_frame_of_the_base() -> None:
    body, numbers = tree(5, JointType.REVOLUTE)
    base, last = forward_kinematics(body, numbers, [-1, 4])
    assert base.position == pytest.approx(body.links.base.pose.position, abs=1e-12)
    (relative,) = forward_kinematics(body, numbers, [4], in_base_frame=True)
    position, orientation = body.links.base.inertial_pose
    x, y, z = position.tolist()
    a, b, c, d = orientation.tolist()
    again = compose(Pose((x, y, z), (a, b, c, d)), relative)
    assert again.position == pytest.approx(last.position, abs=1e-12)


def test_mistakes() -> None:
    body, numbers = tree(5, JointType.REVOLUTE)
    with pytest.raises(ValueError, match=f"{len(numbers) - 1} joint positions; .* has {len(numbers)}"):
        forward_kinematics(body, numbers[1:])
    with pytest.raises(IndexError, match="no link 6"):
        forward_kinematics(body, numbers, [6])
