"""What worlds do at the start of a run of steps, by itself."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp

from carom.kernels.parallel.runs import ask_kernel
from carom.kernels.structs import RunWork, State
from carom.kernels.types import Int32
from carom.layouts.parallel import BEGIN, RESUME, STAY
from carom.layouts.status import LEFT_OUT, OVERFLOW, STATUS, STEPS_DONE, WELL


def test_worlds_begin_resume_or_stay() -> None:
    state, run = State(), RunWork()
    before = np.full((3, 4), 7, dtype=np.int32)
    before[:, STATUS] = OVERFLOW
    state.status_entry = wp.array(before, dtype=Int32, device="cpu")
    run.world_part = wp.array([BEGIN, RESUME, STAY], dtype=Int32, device="cpu")
    wp.launch(ask_kernel, dim=3, inputs=[state, run], device="cpu")
    after = state.status_entry.numpy()
    # One that begins has done no step; one that resumes, after its arrays have grown, goes on counting.
    assert after[:, STEPS_DONE].tolist() == [0, 7, 7]
    assert after[:, STATUS].tolist() == [WELL, WELL, LEFT_OUT]
    # Only the world that stays keeps how many pairs and contacts it wanted.
    assert (after[:2, STATUS + 1 : STEPS_DONE] == 0).all()
    assert (after[2, STATUS + 1 : STEPS_DONE] == 7).all()
