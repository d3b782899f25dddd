"""Null-space steps of inverse kinematics by themselves, against NumPy's solution of the same equations."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false, reportArgumentType=false

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.inverse_kinematics.steps import null_space_step
from carom.kernels.structs import Chain, ChainSizes, ColumnChoice, ColumnModel, DofChoice, Search
from carom.kernels.types import Int32, Matrix3, Reals, Vector3, kernel, real

# As in PyBullet: gains towards rest poses and back into the limits, damping, and the largest rotation.
REST_GAIN, LIMIT_GAIN, DAMPING, MOST = 0.001, 10.0, 0.36, math.pi / 4.0
DOFS = 6


@kernel
def null_space_step_kernel(
    sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals, blocks: Int32, answers: Reals
):
    """One step."""
    answers[0] = null_space_step(sizes, chain, search, coordinates, blocks)


@dataclass
class Arm:
    """Joints with one dof each; the last dof has no coordinate, like those of spherical joints.

    Attributes:
        positions: (DOFS,) [rad].
        lower: (DOFS,) limits [rad].
        upper: (DOFS,) limits [rad].
        ranges: (DOFS,) [rad].
        rest: (DOFS,) rest pose [rad].
        jacobian: (rows, DOFS), a multiple of three rows.
        errors: (rows,).
    """

    positions: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    ranges: np.ndarray
    rest: np.ndarray
    jacobian: np.ndarray
    errors: np.ndarray

    def step(self) -> tuple[np.ndarray, float]:
        """The step by the kernel, and its largest component before it was scaled down."""
        blocks = len(self.errors) // 3
        sizes, chain, search = ChainSizes(), Chain(), Search()
        sizes.columns = sizes.dofs = sizes.coordinates = DOFS
        columns = np.zeros(DOFS, ColumnModel.numpy_dtype())
        columns["dof"] = np.arange(DOFS)
        chain.column = array(columns, ColumnModel)
        chain.dof_coordinate = array(np.append(np.arange(DOFS - 1), -1).astype(np.int32), Int32)
        dofs = np.zeros(DOFS, DofChoice.numpy_dtype())
        dofs["lower"], dofs["upper"], dofs["range"] = self.lower, self.upper, self.ranges
        dofs["rest"] = self.rest
        choices = np.zeros(DOFS, ColumnChoice.numpy_dtype())
        choices["weight"] = 1.0
        search.dof, search.column = array(dofs, DofChoice), array(choices, ColumnChoice)
        search.block_error = array(self.errors.reshape(-1, 3), Vector3)
        search.block_solution = wp.zeros(blocks, dtype=Vector3, device="cpu")
        search.entry_jacobian = array(self.jacobian.T.reshape(-1, 3), Vector3)
        search.square_matrix = wp.zeros(blocks * blocks, dtype=Matrix3, device="cpu")
        answers = wp.zeros(1, dtype=real, device="cpu")
        inputs = [sizes, chain, search, array(self.positions, real), blocks, answers]
        wp.launch(null_space_step_kernel, dim=1, inputs=inputs, device="cpu")
        return search.dof.numpy()["step"], float(answers.numpy()[0])

    def solution(self) -> np.ndarray:
        """The step by the equations: z + Jᵀ (J Jᵀ + μ)⁻¹ (e - J z), where z pulls the joints."""
        pull = REST_GAIN * (self.rest - self.positions)
        outside = np.clip(self.positions, self.lower, self.upper) - self.positions
        has_range = self.ranges != 0.0
        pull[has_range] += LIMIT_GAIN * outside[has_range] / self.ranges[has_range]
        pull[-1] = 0.0
        rows = len(self.errors)
        matrix = self.jacobian @ self.jacobian.T + DAMPING * np.eye(rows)
        return pull + self.jacobian.T @ np.linalg.solve(matrix, self.errors - self.jacobian @ pull)


def array(values: np.ndarray, dtype: Any) -> Any:
    return wp.array(np.ascontiguousarray(values), dtype=dtype, device="cpu")


def arm(seed: int, blocks: int, beyond: float) -> Arm:
    """An arm near its target with two joints beyond their limits by that angle [rad], one without range."""
    random = np.random.default_rng(seed)
    lower, upper = random.uniform(-2.0, -1.0, DOFS), random.uniform(1.0, 2.0, DOFS)
    positions = random.uniform(-0.9, 0.9, DOFS)
    positions[0], positions[1], positions[2] = upper[0] + beyond, lower[1] - beyond, upper[2] + beyond
    ranges = random.uniform(2.0, 4.0, DOFS)
    ranges[2] = 0.0
    rest = random.uniform(-1.0, 1.0, DOFS)
    jacobian, errors = random.normal(size=(3 * blocks, DOFS)), 0.01 * random.normal(size=3 * blocks)
    return Arm(positions, lower, upper, ranges, rest, jacobian, errors)


@pytest.mark.parametrize("blocks", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_joints_are_pulled_to_rest_and_into_their_limits(seed: int, blocks: int) -> None:
    bent = arm(seed, blocks, beyond=0.05)
    step, greatest = bent.step()
    np.testing.assert_allclose(step, bent.solution(), atol=1e-12)
    assert greatest == pytest.approx(np.abs(step).max(), abs=1e-12)
    assert greatest < MOST


def test_a_joint_far_beyond_its_limit_turns_no_more_than_any_other() -> None:
    bent = arm(1, 1, beyond=3.0)
    step, greatest = bent.step()
    wanted = bent.solution()
    assert greatest == pytest.approx(np.abs(wanted).max()) and greatest > MOST
    np.testing.assert_allclose(step, wanted * (MOST / greatest), atol=1e-12)
