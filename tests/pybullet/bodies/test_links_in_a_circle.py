"""Links of `createMultiBody` that hang on each other and on no base are refused, in any order."""

from __future__ import annotations

import pytest

import pybullet as p


@pytest.mark.parametrize(("parents", "link"), [([2, 1], 1), ([0, 3, 2], 2), ([1], 1)], ids=str)
def test_links_in_a_circle_are_refused(client: int, parents: list[int], link: int) -> None:
    every, nowhere = [1] * len(parents), [[0, 0, 0.1]] * len(parents)
    with pytest.raises(p.error, match=rf"linkParentIndices: link {link} is its own ancestor"):
        p.createMultiBody(
            1,
            linkMasses=every,
            linkCollisionShapeIndices=[-1] * len(parents),
            linkVisualShapeIndices=[-1] * len(parents),
            linkPositions=nowhere,
            linkOrientations=[[0, 0, 0, 1]] * len(parents),
            linkInertialFramePositions=nowhere,
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * len(parents),
            linkParentIndices=parents,
            linkJointTypes=[p.JOINT_REVOLUTE] * len(parents),
            linkJointAxis=[[0, 0, 1]] * len(parents),
        )
    assert p.getNumBodies() == 0
