"""Which contacts slide, by themselves: those whose friction is on its bound, but for rounding."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.solver.warm_starting import slides
from carom.kernels.types import Int32, Ints, Vector4, Vectors4, kernel

COUNT = 200


@kernel
def slides_kernel(contacts: Vectors4, answers: Ints):
    """Ask of each contact: its impulses, and its coefficient of friction."""
    i = wp.tid()
    contact = contacts[i]
    if slides(contact[0], contact[1], contact[2], contact[3]):
        answers[i] = Int32(1)


def sliding(share: float) -> np.ndarray:
    """Which of random contacts slide if their friction is that share of its bound."""
    random = np.random.default_rng(5)
    normal, friction = random.uniform(0.01, 10.0, COUNT), random.uniform(0.1, 2.0, COUNT)
    # As the solver does: the impulses are scaled, so that they are on the bound but for rounding.
    wanted = random.normal(size=(2, COUNT))
    # Some are along one direction only.
    wanted[0, :20] = wanted[1, 20:40] = 0.0
    lateral = wanted * (normal * friction / np.sqrt((wanted**2).sum(axis=0))) * share
    contacts = np.column_stack([normal, *lateral, friction])
    answers = wp.zeros(COUNT, dtype=Int32, device="cpu")
    rows = wp.array(contacts, dtype=Vector4, device="cpu")
    wp.launch(slides_kernel, dim=COUNT, inputs=[rows, answers], device="cpu")
    return answers.numpy() == 1


@pytest.mark.parametrize("share", [1.0, 1.0 + 1e-8, 2.0])
def test_friction_on_its_bound_slides(share: float) -> None:
    assert sliding(share).all()


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0 - 1e-8])
def test_friction_below_its_bound_sticks(share: float) -> None:
    assert not sliding(share).any()
