"""Bounds of friction by themselves: what one relaxation of a contact's rows makes of their impulses."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false, reportArgumentType=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.solver.sweeps import relax_contact_friction
from carom.kernels.structs import PairRows, RowTerms, Scratch, Settings
from carom.kernels.types import Index4, Int32, RealRows, Vector4, kernel, real
from carom.layouts.codes import LATERAL_ROW, ROLLING_ROW, SPINNING_ROW

# Rows of the only contact: its normal, two lateral, two rolling, one spinning.
FIRST = {LATERAL_ROW: 1, ROLLING_ROW: 3, SPINNING_ROW: 5}
ROWS = {LATERAL_ROW: slice(1, 3), ROLLING_ROW: slice(3, 5), SPINNING_ROW: slice(5, 6)}


@kernel
def relax_contact_friction_kernel(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, kind: Int32, answers: RealRows
):
    """Relax rows of one kind."""
    answers[0, 0] = relax_contact_friction(settings, scratch, pair_rows, 0, 0, kind)


@dataclass
class Rows:
    """Six rows on one body of four freedoms.

    Attributes:
        terms: (6,), as `PairRows.row_terms`.
        jacobian: (6, 4).
        response: (6, 4), what an impulse does to the velocities.
        velocity: (4,), what has been changed so far.
    """

    terms: np.ndarray
    jacobian: np.ndarray
    response: np.ndarray
    velocity: np.ndarray

    def relax(self, kind: int, cone: bool) -> tuple[np.ndarray, np.ndarray, float]:
        """Impulses, velocities and the change squared, by the kernel."""
        setting, scratch, pair_rows = Settings(), Scratch(), PairRows()
        setting.cone_friction = int(cone)
        answers = np.zeros((1, 1))
        terms = array(self.terms, RowTerms)
        velocity = array(self.velocity[None], Vector4)
        pair_rows.row_terms = terms
        pair_rows.row_place = array(np.tile([0, 1, 0, 0], (6, 1)), Index4)
        pair_rows.row_start = wp.array2d([list(range(6))], dtype=Int32, device="cpu")
        pair_rows.row_bound = wp.array2d([[-1, 0, 0, 0, 0, 0]], dtype=Int32, device="cpu")
        pair_rows.contact_rows = array(np.array([[0, 1, 3, 5]]), Index4)
        pair_rows.jacobian_row = array(self.jacobian, Vector4)
        pair_rows.jacobian_response = array(self.response, Vector4)
        scratch.delta_velocity = velocity
        rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
        inputs = [setting, scratch, pair_rows, kind, rows]
        wp.launch(relax_contact_friction_kernel, dim=1, inputs=inputs, device="cpu")
        return terms.numpy()["impulse"][0], velocity.numpy()[0, 0], answers[0, 0]


def array(rows: np.ndarray, dtype: Any) -> Any:
    """An array with the only world in front."""
    return wp.array(rows[None], dtype=dtype, device="cpu", ndim=2)


def random_rows(seed: int, normal_impulse: float) -> Rows:
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(6, 4))
    response = jacobian * random.uniform(0.1, 2.0)
    terms = np.zeros(6, dtype=RowTerms.numpy_dtype())
    terms["inverse_mass"] = (jacobian * response).sum(axis=1)
    terms["effective_mass"] = 1.0 / terms["inverse_mass"]
    terms["share"] = random.normal(size=6)
    terms["softness"] = random.uniform(0.0, 0.5, 6)
    terms["impulse"] = random.normal(size=6) * 0.2
    terms["friction"] = random.uniform(0.0, 1.0, 6)
    # The two of a pair have one coefficient.
    terms["friction"][[2, 4]] = terms["friction"][[1, 3]]
    terms["impulse"][0] = normal_impulse
    return Rows(terms, jacobian, response, random.normal(size=4) * 0.1)


def wanted(rows: Rows, row: int, velocity: np.ndarray) -> float:
    """Impulse that a row would have without bounds."""
    terms = rows.terms[row]
    return float(
        terms["impulse"] * (1.0 - terms["softness"])
        + terms["share"]
        - rows.jacobian[row] @ velocity * terms["effective_mass"]
    )


seeds = st.integers(0, 2**32 - 1)
normals = st.floats(0.01, 3.0)


@settings(max_examples=cases(100), deadline=None)
@given(seeds, normals, st.sampled_from([LATERAL_ROW, ROLLING_ROW, SPINNING_ROW]), st.booleans())
def test_no_more_than_the_coefficient_times_the_normal_impulse(
    seed: int, normal: float, kind: int, cone: bool
) -> None:
    rows = random_rows(seed, normal)
    before = rows.terms["impulse"].copy()
    impulses, velocity, _ = rows.relax(kind, cone)
    bound = rows.terms["friction"][FIRST[kind]] * normal
    own = impulses[ROWS[kind]]
    size = np.linalg.norm(own) if cone else np.abs(own).max()
    assert size <= bound * (1.0 + 1e-12)
    # Rows of other kinds stay as they are, and the body has felt each change once.
    others = np.ones(6, dtype=bool)
    others[ROWS[kind]] = False
    np.testing.assert_array_equal(impulses[others], before[others])
    felt = rows.velocity + (impulses - before) @ rows.response
    np.testing.assert_allclose(velocity, felt, atol=1e-12)


@settings(max_examples=cases(100), deadline=None)
@given(seeds, normals, st.sampled_from([LATERAL_ROW, ROLLING_ROW]))
def test_in_the_cone_both_directions_are_cut_alike(seed: int, normal: float, kind: int) -> None:
    rows = random_rows(seed, normal)
    impulses, _, change = rows.relax(kind, cone=True)
    first = FIRST[kind]
    free = np.array([wanted(rows, first + i, rows.velocity) for i in range(2)])
    bound = rows.terms["friction"][first] * normal
    expected = free * min(1.0, bound / np.linalg.norm(free))
    np.testing.assert_allclose(impulses[ROWS[kind]], expected, atol=1e-12)
    changes = (expected - rows.terms["impulse"][ROWS[kind]]) * rows.terms["inverse_mass"][ROWS[kind]]
    assert change == pytest.approx(changes.sum() ** 2, rel=1e-9, abs=1e-14)


@settings(max_examples=cases(100), deadline=None)
@given(seeds, normals, st.sampled_from([LATERAL_ROW, ROLLING_ROW, SPINNING_ROW]))
def test_without_the_cone_each_direction_is_cut_by_itself(seed: int, normal: float, kind: int) -> None:
    rows = random_rows(seed, normal)
    impulses, _, change = rows.relax(kind, cone=False)
    bound = rows.terms["friction"][FIRST[kind]] * normal
    velocity, changes = rows.velocity.copy(), []
    for row in range(6)[ROWS[kind]]:
        # The second feels what the first has done.
        expected = np.clip(wanted(rows, row, velocity), -bound, bound)
        assert impulses[row] == pytest.approx(expected, abs=1e-12)
        step = expected - rows.terms["impulse"][row]
        velocity += step * rows.response[row]
        changes.append(abs(step * rows.terms["inverse_mass"][row]))
    assert change == pytest.approx(max(changes) ** 2, rel=1e-9, abs=1e-14)


@pytest.mark.parametrize("cone", [True, False])
@pytest.mark.parametrize("kind", [ROLLING_ROW, SPINNING_ROW])
def test_what_is_not_pressed_is_not_relaxed(cone: bool, kind: int) -> None:
    rows = random_rows(1, 0.0)
    impulses, velocity, change = rows.relax(kind, cone)
    np.testing.assert_array_equal(impulses, rows.terms["impulse"])
    np.testing.assert_array_equal(velocity, rows.velocity)
    assert change == 0.0


def test_in_the_cone_lateral_impulses_end_with_the_pressure() -> None:
    rows = random_rows(1, 0.0)
    impulses, _, _ = rows.relax(LATERAL_ROW, cone=True)
    np.testing.assert_array_equal(impulses[ROWS[LATERAL_ROW]], 0.0)
