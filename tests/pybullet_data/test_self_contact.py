"""With self-collision on, robots touch themselves where the originals do, not where stand-ins bulge."""

from __future__ import annotations

from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

DATA = Path(pybullet_data.getDataPath())
BENDS = (0.0, 0.1, -0.2)
"""What all joints stand at [rad]."""
DEEP = 5e-4
"""Links that overlap by more touch; by less it is up to margins [m]."""

Pairs = list[tuple[int, int]]
_A1: Pairs = [(2, 3), (7, 8), (12, 13), (17, 18)]
_LAIKAGO_BENT: Pairs = [(2, 7), (3, 6), (3, 7), (10, 15), (11, 14), (11, 15)]
# Without (6, 8), links that are tied to each other by fixed joints.
_PANDA: Pairs = [(4, 6), (4, 8)]
NOTHING: tuple[Pairs, Pairs, Pairs] = ([], [], [])
# Links of the originals that real PyBullet finds to overlap, for each bend.
ORIGINALS: dict[str, tuple[Pairs, Pairs, Pairs]] = {
    "a1/a1.urdf": (_A1, _A1, _A1),
    "aliengo/aliengo.urdf": NOTHING,
    "franka_panda/panda.urdf": ([*_PANDA, (9, 10)], [(4, 6), (4, 8), (4, 10)], _PANDA),
    "humanoid/humanoid.urdf": NOTHING,
    "husky/husky.urdf": NOTHING,
    "kuka_iiwa/model.urdf": NOTHING,
    "laikago/laikago.urdf": NOTHING,
    "laikago/laikago_toes.urdf": ([], [], _LAIKAGO_BENT),
    "laikago/laikago_toes_zup.urdf": ([], [], _LAIKAGO_BENT),
    "mini_cheetah/mini_cheetah.urdf": NOTHING,
    "pr2_gripper.urdf": ([(1, 3)], [], [(0, 2), (0, 3), (1, 2)]),
    "quadruped/minitaur.urdf": NOTHING,
    "quadruped/quadruped.urdf": NOTHING,
    "racecar/racecar.urdf": NOTHING,
}


@pytest.mark.parametrize("file", ORIGINALS)
def test_links_overlap_where_the_originals_do(file: str) -> None:
    p.connect(p.DIRECT)
    try:
        robot = p.loadURDF(str(DATA / file), useFixedBase=True, flags=p.URDF_USE_SELF_COLLISION)
        moving = [
            joint
            for joint in range(p.getNumJoints(robot))
            if p.getJointInfo(robot, joint)[2] in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC)
        ]
        for bend, pairs in zip(BENDS, ORIGINALS[file], strict=True):
            for joint in moving:
                p.resetJointState(robot, joint, bend)
            p.performCollisionDetection()
            touching = {tuple(sorted(point[3:5])) for point in p.getContactPoints() if point[8] < -DEEP}
            assert sorted(touching) == pairs, f"at {bend}"
    finally:
        p.disconnect()
