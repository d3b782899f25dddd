"""After how many steps a contact is warm started, by itself."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.solver.warm_starting import (
    NOT_RESTING,
    SOLVED,
    SOLVED_AND_HOLDS,
    UNSOLVED,
    next_warm_start,
)
from carom.kernels.types import Int32, Ints, Reals, kernel, real
from carom.layouts.contacts import HOLDING


@kernel
def counters_kernel(start: real, outcomes: Ints, counters: Reals):
    """The counter of a contact after each of some steps."""
    counter = start
    for step in range(outcomes.shape[0]):
        counter = next_warm_start(counter, outcomes[step])
        counters[step] = counter


def counters(start: float, *outcomes: int) -> list[float]:
    found = wp.zeros(len(outcomes), dtype=real, device="cpu")
    told = wp.array(outcomes, dtype=Int32, device="cpu")
    wp.launch(counters_kernel, dim=1, inputs=[start, told, found], device="cpu")
    return found.numpy().tolist()


def test_a_new_contact_is_warm_started_in_the_next_step() -> None:
    assert counters(0.0, SOLVED, SOLVED, NOT_RESTING) == [1.0, 1.0, 1.0]


def test_one_that_did_not_converge_pauses_for_sixty_steps() -> None:
    after = counters(1.0, UNSOLVED, *[SOLVED] * 62)
    # From 1 on it is warm started.
    assert (np.array(after) >= 1.0).tolist() == [False] * 60 + [True] * 3
    assert counters(-30.0, UNSOLVED) == [after[0]]


def test_one_whose_block_holds_is_marked_as_such() -> None:
    assert counters(-5.0, SOLVED_AND_HOLDS, SOLVED) == [HOLDING, 1.0]
