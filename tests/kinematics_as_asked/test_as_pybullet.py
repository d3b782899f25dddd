"""`calculateInverseKinematics` gives PyBullet's answer, for every combination of arguments."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.kinematics_as_asked.cases import (
    ASSETS,
    COMBINATIONS,
    ROBOTS,
    SEVERAL,
    UNSTEADY,
    Asker,
    small_steps,
)

import pybullet as p
from pybullet._calls import errors

ORACLE = json.loads(Path(__file__).with_name("oracle.json").read_text(encoding="utf-8"))
STEADY, LOOSE = 1e-9, 1e-6
"""Tolerances [rad or m]: where rounding does not decide about PyBullet's answer, and where it does."""


@pytest.fixture(scope="module", params=ROBOTS)
def asker(request: pytest.FixtureRequest) -> Any:
    asker = Asker(p, request.param, ASSETS)
    yield asker
    asker.close()


def recorded(asker: Asker) -> dict[str, Any]:
    return ORACLE[next(name for name, robot in ROBOTS.items() if robot is asker.robot)]


def test_every_combination_of_arguments_has_pybullets_answer(asker: Asker) -> None:
    for combination in COMBINATIONS + SEVERAL:
        for seed, (answer, own) in enumerate(recorded(asker)[combination]):
            tolerance = max(LOOSE, 10.0 * own) if own > UNSTEADY else STEADY
            ours = asker.answer(combination, seed)
            assert_allclose(ours, answer, rtol=0, atol=tolerance, err_msg=f"{combination}, {seed}")


def test_few_answers_hang_on_rounding() -> None:
    owns = [own for robot in ORACLE.values() for pairs in robot.values() for _, own in pairs]
    assert len(owns) > 400
    assert sum(own > UNSTEADY for own in owns) < 0.05 * len(owns)


def test_sixty_small_steps_end_at_the_same_place(asker: Asker) -> None:
    assert_allclose(small_steps(asker), recorded(asker)["small steps"][0][0], rtol=0, atol=1e-8)


def test_saying_the_defaults_changes_nothing(asker: Asker) -> None:
    end, target = asker.robot.ends[0], [0.4, 0.1, 0.5]
    options: dict[str, Any] = {"targetOrientation": [1, 0, 0, 0], "physicsClientId": asker.client}
    plain = p.calculateInverseKinematics(asker.body, end, target, **options)
    said = {"maxNumIterations": 20, "residualThreshold": 1e-4, "jointDamping": [0.5] * len(asker.joints)}
    assert p.calculateInverseKinematics(asker.body, end, target, **options, **said) == plain


@pytest.mark.parametrize("asker", ["kuka"], indirect=True)
class TestOneArm:
    """What one robot is enough for."""

    target = (0.3, 0.2, 0.5)

    def ask(self, asker: Asker, **options: Any) -> np.ndarray:
        asker.place(np.array([0.1, 0.5, 0.0, -1.5, 0.0, 1.0, 0.0]))
        asker.p.resetBasePositionAndOrientation(
            asker.body, [0, 0, 0], [0, 0, 0, 1], physicsClientId=asker.client
        )
        return np.array(
            p.calculateInverseKinematics(asker.body, 6, self.target, physicsClientId=asker.client, **options)
        )

    def lists(self, width: float = 2.0) -> dict[str, Any]:
        low, high = [-width] * 7, [width] * 7
        return {"lowerLimits": low, "upperLimits": high, "jointRanges": [4.0] * 7, "restPoses": [0.1] * 7}

    def test_limits_without_rest_poses_are_ignored_with_a_warning(
        self, asker: Asker, caplog: pytest.LogCaptureFixture
    ) -> None:
        errors.warn_once.cache_clear()
        lists = self.lists(0.3)
        two = {name: lists[name] for name in ("lowerLimits", "upperLimits")}
        assert self.ask(asker, **two).tolist() == self.ask(asker).tolist()
        assert "solver=IK_SDLS keeps lowerLimits and upperLimits" in caplog.text

    def test_carom_goes_on_to_the_target_and_keeps_limits_if_asked_for(self, asker: Asker) -> None:
        asker.place(np.array([1.4, -0.9, 1.3, 1.2, -1.0, -1.4, 0.3]))
        state: Any = p.getLinkState(asker.body, 6, physicsClientId=asker.client)
        asker.place(np.zeros(7))
        options = {"lowerLimits": [-1.5] * 7, "upperLimits": [1.5] * 7, "physicsClientId": asker.client}
        left = []
        for solver in (p.IK_DLS, p.IK_SDLS):
            asker.place(np.full(7, 0.1))
            found = p.calculateInverseKinematics(asker.body, 6, state[4], state[1], solver=solver, **options)
            assert solver == p.IK_DLS or np.abs(found).max() <= 1.5
            asker.place(np.array(found))
            reached: Any = p.getLinkState(asker.body, 6, physicsClientId=asker.client)
            left.append(np.linalg.norm(np.subtract(reached[4], state[4])))
        assert left[0] > 0.01
        assert left[1] < 2e-4

    def test_the_solver_does_not_matter_with_rest_poses(self, asker: Asker) -> None:
        lists = self.lists()
        assert self.ask(asker, solver=p.IK_SDLS, **lists).tolist() == self.ask(asker, **lists).tolist()

    def test_the_damping_does_not_matter_with_rest_poses(self, asker: Asker) -> None:
        lists = self.lists()
        damped = self.ask(asker, jointDamping=[3.0] * 7, **lists)
        assert damped.tolist() == self.ask(asker, **lists).tolist()

    def test_joints_without_damping_move_no_farther_than_the_target_needs(self, asker: Asker) -> None:
        """PyBullet divides by 0 or by rounding."""
        found = self.ask(asker, jointDamping=[0.0] * 7)
        asker.place(found)
        state: Any = p.getLinkState(asker.body, 6, physicsClientId=asker.client)
        assert_allclose(state[4], self.target, rtol=0, atol=1e-4)

    def test_a_range_of_zero_pulls_no_joint(self, asker: Asker) -> None:
        """PyBullet divides by it."""
        found = self.ask(asker, **(self.lists(0.3) | {"jointRanges": [0.0] * 7}))
        assert np.isfinite(found).all()

    def test_several_ends_with_rest_poses_have_only_those(self, asker: Asker) -> None:
        """As in PyBullet, which then forgets the targets."""
        asker.place(np.zeros(7))
        targets = [[0.5, 0.2, 0.6], [0.1, 0.2, 0.3]]
        found = p.calculateInverseKinematics2(
            asker.body, [6, 3], targets, physicsClientId=asker.client, **self.lists()
        )
        assert_allclose(found, [found[0]] * 7, rtol=0, atol=1e-15)
        assert 0.0 < found[0] < 0.01
