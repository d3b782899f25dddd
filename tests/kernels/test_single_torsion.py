"""Rolling and spinning friction of single contacts by itself: what one relaxation of each does."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false, reportArgumentType=false

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.solver.single_contacts import relax_single_torsion
from carom.kernels.structs import LateralRows, NormalRow, PairRows, Scratch, Settings
from carom.kernels.types import Index2, Int32, RealRows, Vector4, kernel, real
from carom.layouts.codes import ROLLING_ROW, SPINNING_ROW

# First blocks of the bodies among the delta velocities; the last two numbers of each are not used.
A, B = 0, 2
NORMAL_IMPULSE = 0.7


@kernel
def relax_torsion_kernel(settings: Settings, scratch: Scratch, pair_rows: PairRows, answers: RealRows):
    """Relax the spinning row of the contact at the first two places, then its rolling rows."""
    answers[0, 0] = relax_single_torsion(settings, scratch, pair_rows, 0, 0, Int32(SPINNING_ROW))
    answers[0, 1] = relax_single_torsion(settings, scratch, pair_rows, 0, 0, Int32(ROLLING_ROW))


def relax(random: np.random.Generator, rolling: float, spinning: float, cone: bool) -> dict[str, Any]:
    """One relaxation of random rows with these coefficients, by the kernel, and what was there before."""
    jacobian = random.normal(size=(2, 3, 6))
    response = jacobian * random.uniform(0.1, 2.0, (2, 1, 1))
    share, mass = random.normal(size=3), 1.0 / (jacobian * response).sum(axis=(0, 2))
    velocity = random.normal(size=(2, 8)) * 0.1
    velocity[:, 6:] = 0.0
    impulse = np.zeros((2, 4))
    impulse[0, 0], impulse[1, 3] = NORMAL_IMPULSE, rolling
    normal = np.zeros(2, dtype=NormalRow.numpy_dtype())
    lateral = np.zeros(2, dtype=LateralRows.numpy_dtype())
    normal["jacobian"][1] = jacobian[:, 0].T.ravel()
    normal["response_a"][1], normal["response_b"][1] = response[:, 0]
    normal["share"][1], normal["effective_mass"][1], normal["inverse_mass"][1] = (
        share[0],
        mass[0],
        1 / mass[0],
    )
    normal["kept"][1], normal["friction"][1] = 1.0, spinning
    for body, name in enumerate("ab"):
        lateral[f"jacobian_{name}"][1] = jacobian[body, 1:].T.ravel()
        lateral[f"response_{name}1"][1], lateral[f"response_{name}2"][1] = response[body, 1:]
    lateral["share"][1], lateral["effective_mass"][1], lateral["inverse_mass"][1] = (
        share[1:], mass[1:], 1 / mass[1:],
    )  # fmt: skip
    setting, scratch, pair_rows = Settings(), Scratch(), PairRows()
    setting.cone_friction = int(cone)
    pair_rows.single_place = array(np.array([[A, B], [A, B]]), Index2)
    pair_rows.single_impulse = array(impulse, Vector4)
    pair_rows.single_softness = array(np.zeros(2), real)
    pair_rows.single_normal, pair_rows.single_lateral = array(normal, NormalRow), array(lateral, LateralRows)
    scratch.delta_velocity = array(velocity.reshape(4, 4), Vector4)
    answers = np.zeros((1, 2))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    wp.launch(relax_torsion_kernel, dim=1, inputs=[setting, scratch, pair_rows, rows], device="cpu")
    return {
        "impulse": pair_rows.single_impulse.numpy()[0],
        "velocity": scratch.delta_velocity.numpy()[0].reshape(2, 8),
        "changes": answers[0],
        "before": (jacobian, response, share, mass, velocity),
    }


def array(rows: np.ndarray, dtype: Any) -> Any:
    """An array with the only world in front."""
    return wp.array(rows[None], dtype=dtype, device="cpu", ndim=2)


@settings(max_examples=cases(200), deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 0.01, 2.0]),
    st.sampled_from([0.0, 0.01, 2.0]),
    st.booleans(),
)
def test_rows_are_relaxed_one_after_the_other(seed: int, rolling: float, spinning: float, cone: bool) -> None:
    found = relax(np.random.default_rng(seed), rolling, spinning, cone)
    jacobian, response, share, mass, velocity = found["before"]
    bodies, impulse, changes = velocity[:, :6].copy(), np.zeros(3), [0.0, 0.0]

    def wanted(row: int) -> float:
        return impulse[row] + share[row] - (jacobian[:, row] * bodies).sum() * mass[row]

    def change_to(row: int, after: float) -> float:
        change, impulse[row] = after - impulse[row], after
        bodies[:] += change * response[:, row]
        return change / mass[row]

    bound = spinning * NORMAL_IMPULSE
    changes[0] = change_to(0, np.clip(wanted(0), -bound, bound))
    bound = rolling * NORMAL_IMPULSE
    if cone:
        free = np.array([wanted(1), wanted(2)])
        free = free * min(1.0, bound / np.linalg.norm(free))
        changes[1] = change_to(1, free[0]) + change_to(2, free[1])
    else:
        changes[1] = max(abs(change_to(row, np.clip(wanted(row), -bound, bound))) for row in (1, 2))
    np.testing.assert_allclose(found["impulse"][1, :3], impulse, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found["velocity"][:, :6], bodies, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found["changes"], changes, rtol=1e-9, atol=1e-12)
    # The normal and lateral rows, at the first place, are as they were.
    np.testing.assert_array_equal(found["impulse"][0], [NORMAL_IMPULSE, 0.0, 0.0, 0.0])
