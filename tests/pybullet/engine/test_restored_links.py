"""Links right after `restoreState`, before the next step; the expected values are PyBullet 3.2.7's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pybullet as p
import pybullet_data

HAND = 6
Numbers = list[float]


@pytest.fixture
def arms(client: int) -> list[int]:
    """Two arms without motors after 60 steps, one of them with `useFixedBase`."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    both = [
        p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=1),
        p.loadURDF("kuka_iiwa/model.urdf", [3, 0, 1]),
    ]
    for arm in both:
        for joint in range(7):
            p.resetJointState(arm, joint, 0.3 * joint)
            p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
    run(60)
    return both


def run(count: int) -> None:
    for _ in range(count):
        p.stepSimulation()


def state(arm: int) -> list[Numbers]:
    """Position of the hand, its angular velocity, and the lower corner of its box."""
    link: Any = p.getLinkState(arm, HAND, computeLinkVelocity=1)
    return [list(link[0]), list(link[7]), list(p.getAABB(arm, HAND)[0])]


SAVED = [
    [
        [-0.10698307, -0.13431801, 0.88577571],
        [35.2559497, -77.2689712, -59.84882024],
        [-0.18516776, -0.19703516, 0.80393552],
    ],
    [
        [2.89301693, -0.13431801, 1.88577571],
        [35.2559497, -77.2689712, -59.84882024],
        [2.81483224, -0.19703516, 1.80393552],
    ],
]
RESTORED = [
    [
        [-0.10692804, -0.13506898, 0.8775016],
        [35.42776355, -77.26348244, -59.75437251],
        [-0.18933231, -0.20916866, 0.79877056],
    ],
    [
        [2.89307196, -0.13506898, 1.8775016],
        [35.42776355, -77.26348244, -59.75437251],
        [2.81066769, -0.20916866, 1.79877056],
    ],
]


@pytest.mark.parametrize("is_file", [False, True])
def test_links_are_where_they_were_when_the_state_was_saved(
    arms: list[int], tmp_path: Path, is_file: bool
) -> None:
    path = str(tmp_path / "state.bullet")
    p.saveBullet(path)
    number = p.saveState()
    saved = [state(arm) for arm in arms]
    run(10)
    if is_file:
        p.restoreState(fileName=path)
    else:
        p.restoreState(number)
    for arm in (0, 1):
        for before, was in zip(saved[arm], SAVED[arm], strict=True):
            assert before == pytest.approx(was, abs=1e-6)
        for now, restored in zip(state(arms[arm]), RESTORED[arm], strict=True):
            assert now == pytest.approx(restored, abs=1e-6)
    run(1)
    link: Any = p.getLinkState(arms[0], HAND)
    assert link[0] == pytest.approx(RESTORED[0][0], abs=1e-6), "that of the start of the substep"
