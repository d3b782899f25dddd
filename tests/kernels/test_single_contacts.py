"""Single contacts of rigid bodies by themselves: what one relaxation makes of impulses and velocities."""

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

from carom.kernels.solver.single_contacts import relax_single_friction, relax_single_normal
from carom.kernels.structs import LateralRows, NormalRow, PairRows, Scratch, Settings
from carom.kernels.types import Index2, RealRows, Vector4, kernel, real

# First blocks of the bodies among the delta velocities; the last two numbers of each are not used.
A, B = 2, 6
USED = np.r_[0:6]


@kernel
def relax_single_kernel(settings: Settings, scratch: Scratch, pair_rows: PairRows, answers: RealRows):
    """Relax the normal row of the only contact, then its friction rows."""
    answers[0, 0] = relax_single_normal(scratch, pair_rows, 0, 0)
    answers[0, 1] = relax_single_friction(settings, scratch, pair_rows, 0, 0)


@dataclass
class Contact:
    """A contact of two bodies; the second may be unable to move.

    Attributes:
        jacobian: (2, 3, 6): by body, then the normal row and both friction rows; 0 for a body that is fixed.
        response: (2, 3, 6), likewise.
        share: (3,).
        mass: (3,), effective masses.
        kept: Of the normal row.
        softness: Of the lateral rows.
        impulse: (4,), as `PairRows.single_impulse`.
        velocity: (8, 4), delta velocities before.
        fixed: Whether the second body cannot move.
    """

    jacobian: np.ndarray
    response: np.ndarray
    share: np.ndarray
    mass: np.ndarray
    kept: float
    softness: float
    impulse: np.ndarray
    velocity: np.ndarray
    fixed: bool

    def relax(self, cone: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Impulses, delta velocities (8, 4) and changes of velocity of normal and friction, by the kernel."""
        normal = np.zeros(1, dtype=NormalRow.numpy_dtype())
        lateral = np.zeros(1, dtype=LateralRows.numpy_dtype())
        normal["jacobian"] = self.jacobian[:, 0].T.ravel()
        normal["response_a"], normal["response_b"] = self.response[:, 0]
        normal["share"], normal["effective_mass"] = self.share[0], self.mass[0]
        normal["inverse_mass"], normal["kept"] = 1.0 / self.mass[0], self.kept
        for body, name in enumerate("ab"):
            lateral[f"jacobian_{name}"] = self.jacobian[body, 1:].T.ravel()
            lateral[f"response_{name}1"], lateral[f"response_{name}2"] = self.response[body, 1:]
        lateral["share"], lateral["effective_mass"] = self.share[1:], self.mass[1:]
        lateral["inverse_mass"] = 1.0 / self.mass[1:]
        setting, scratch, pair_rows = Settings(), Scratch(), PairRows()
        setting.cone_friction = int(cone)
        pair_rows.single_place = array(np.array([[A, A if self.fixed else B]]), Index2)
        pair_rows.single_impulse = array(self.impulse[None], Vector4)
        pair_rows.single_softness = array(np.array([self.softness]), real)
        pair_rows.single_normal = array(normal, NormalRow)
        pair_rows.single_lateral = array(lateral, LateralRows)
        scratch.delta_velocity = array(self.velocity, Vector4)
        answers = np.zeros((1, 2))
        rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
        wp.launch(relax_single_kernel, dim=1, inputs=[setting, scratch, pair_rows, rows], device="cpu")
        velocity = scratch.delta_velocity.numpy()[0]
        return pair_rows.single_impulse.numpy()[0, 0], velocity, answers[0]

    def expected(self, cone: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same by one Gauss-Seidel step for each row; the friction rows of a cone are one."""
        impulse, velocity = self.impulse.copy(), self.velocity.copy()
        bodies = velocity.reshape(4, 8)[[A // 2, B // 2]][:, USED]

        def wanted(row: int) -> float:
            rate = (self.jacobian[:, row] * bodies).sum()
            kept = self.kept if row == 0 else 1.0 - self.softness * self.mass[row]
            return impulse[row] * kept + self.share[row] - rate * self.mass[row]

        def change_to(row: int, after: float) -> float:
            change = after - impulse[row]
            impulse[row] = after
            bodies[:] += change * self.response[:, row]
            return change / self.mass[row]

        normal = change_to(0, max(0.0, wanted(0)))
        bound = impulse[3] * impulse[0]
        if cone:
            free = np.array([wanted(1), wanted(2)])
            first, second = free * min(1.0, bound / np.linalg.norm(free))
            friction = change_to(1, first) + change_to(2, second)
        else:
            rows = (1, 2) if bound > 0.0 else ()
            friction = max(
                [abs(change_to(row, np.clip(wanted(row), -bound, bound))) for row in rows], default=0.0
            )
        velocity.reshape(4, 8)[[A // 2, B // 2], :6] = bodies
        return impulse, velocity, np.array([normal, friction])


def array(rows: np.ndarray, dtype: Any) -> Any:
    """An array with the only world in front."""
    return wp.array(rows[None], dtype=dtype, device="cpu", ndim=2)


def random_contact(seed: int, push: float, fixed: bool) -> Contact:
    """A contact whose normal impulse will probably be positive if `push` is."""
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(2, 3, 6))
    response = jacobian * random.uniform(0.1, 2.0, (2, 1, 1))
    if fixed:
        jacobian[1] = response[1] = 0.0
    velocity = random.normal(size=(8, 4)) * 0.1
    velocity.reshape(4, 8)[:, 6:] = 0.0
    impulse = np.append(random.normal(size=3) * 0.2, random.uniform(0.1, 1.0))
    impulse[0] = abs(impulse[0])
    share = random.normal(size=3)
    share[0] = push
    mass = 1.0 / (jacobian * response).sum(axis=(0, 2))
    kept, softness = random.uniform(0.5, 1.0), max(0.0, random.uniform(-0.1, 0.1))
    return Contact(jacobian, response, share, mass, kept, softness, impulse, velocity, fixed)


@settings(max_examples=cases(200), deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 0.1, -5.0]), st.booleans(), st.booleans())
def test_rows_are_relaxed_one_after_the_other(seed: int, push: float, fixed: bool, cone: bool) -> None:
    contact = random_contact(seed, push, fixed)
    for found, expected in zip(contact.relax(cone), contact.expected(cone), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("cone", [True, False])
def test_a_contact_that_is_pulled_apart_exerts_no_force(cone: bool) -> None:
    contact = random_contact(1, -50.0, False)
    contact.impulse[1:3] = 0.0
    impulse, _, _ = contact.relax(cone)
    np.testing.assert_array_equal(impulse[:3], 0.0)
