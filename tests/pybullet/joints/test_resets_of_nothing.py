"""Resets that change no joint bring link poses up to date as any reset; so it is in PyBullet 3.2.7."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import pybullet as p

TURNING, FIXED, BALL = 0, 2, 3

RESETS: dict[str, Callable[[int], object]] = {
    "fixed": lambda zoo: p.resetJointState(zoo, FIXED, 0.3, 0.4),
    "ball": lambda zoo: p.resetJointState(zoo, BALL, 0.7),
    "numbers for a fixed joint": lambda zoo: p.resetJointStateMultiDof(zoo, FIXED, [0]),
    "too few numbers": lambda zoo: p.resetJointStateMultiDof(zoo, BALL, [0, 0]),
    "too many numbers": lambda zoo: p.resetJointStateMultiDof(zoo, TURNING, [0, 0]),
    "velocity only": lambda zoo: p.resetJointStateMultiDof(zoo, TURNING, [], [0]),
    "several": lambda zoo: p.resetJointStatesMultiDof(zoo, [FIXED], [[0]]),
    "scaling": lambda zoo: p.unsupportedChangeScaling(zoo, [1, 1, 1]),
}


def pose(zoo: int, current: bool = False) -> Any:
    link: Any = p.getLinkState(zoo, TURNING, computeForwardKinematics=current)
    return link[:2]


@pytest.mark.parametrize("name", RESETS)
def test_link_poses_are_brought_up_to_date(zoo: int, name: str) -> None:
    p.resetJointState(zoo, TURNING, 0.1, 1.0)
    p.setJointMotorControl2(zoo, TURNING, p.VELOCITY_CONTROL, force=0)
    for _ in range(20):
        p.stepSimulation()
    stepped, joint = pose(zoo), p.getJointStateMultiDof(zoo, TURNING)
    RESETS[name](zoo)
    now = pose(zoo)
    assert now != stepped
    assert p.getJointStateMultiDof(zoo, TURNING) == joint
    assert now == pose(zoo, current=True)


def test_no_joint_is_no_reset(zoo: int) -> None:
    p.resetJointState(zoo, TURNING, 0.1, 1.0)
    p.stepSimulation()
    before = pose(zoo)
    p.resetJointStatesMultiDof(zoo, [], [])
    assert pose(zoo) == before
