"""Islands and falling asleep by themselves: SciPy's connected components, and when bodies have been still."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false, reportArgumentType=false

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

pytest.importorskip("warp", reason="it compiles the kernels")

import warp as wp
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from carom.kernels.maths.union_find import find_root
from carom.kernels.solver.islands import unite_tied
from carom.kernels.solver.sleeping import watch
from carom.kernels.structs import Model, Settings, State, UserConstraints
from carom.kernels.types import Int32, kernel, real
from carom.kernels.warp_types import warp_type
from carom.layouts.codes import ABSENT, ACTIVE
from carom.layouts.model import LinkModel, TreeModel

STEP = 0.25
DELAY = 2.0


@kernel
def unite_tied_kernel(settings: Settings, model: Model, state: State, users: UserConstraints):
    """Each tree's island, by the root it has."""
    for tree in range(settings.tree_count):
        state.tree_island[0, tree] = tree
    unite_tied(settings, model, state, users, 0)
    for tree in range(settings.tree_count):
        state.tree_island[0, tree] = find_root(state.tree_island, 0, Int32(tree))


@kernel
def watch_trees_kernel(settings: Settings, model: Model, state: State):
    """Watch all trees after one substep."""
    for tree in range(settings.tree_count):
        watch(model, settings, state, 0, tree)


def integers(values: Any, ndim: int) -> Any:
    numbers = np.asarray(values, dtype=np.int32)
    return wp.array(numbers[None] if ndim == 2 else numbers, dtype=Int32, device="cpu", ndim=ndim)


def rows_of(layout: Any, rows: Iterable[dict[str, Any]]) -> Any:
    """Rows of a struct with these fields."""
    made = []
    for fields in rows:
        row = warp_type(layout)()
        for name, value in fields.items():
            setattr(row, name, value)
        made.append(row)
    return wp.array(made, dtype=warp_type(layout), device="cpu")


def model_of(*trees: dict[str, Any]) -> Any:
    """Trees with these fields."""
    model = Model()
    model.tree = rows_of(TreeModel, trees)
    return model


@settings(max_examples=cases(100), deadline=None)
@given(st.data(), st.integers(1, 30))
def test_islands_are_the_connected_components_of_what_can_move(data: st.DataObject, count: int) -> None:
    place = st.integers(0, count - 1)
    tie = st.tuples(st.integers(-1, count - 1), place, st.booleans(), st.booleans())
    ties = data.draw(st.lists(tie, max_size=40))
    moves = np.array(data.draw(st.lists(st.booleans(), min_size=count, max_size=count)))
    setting, state, users = Settings(), State(), UserConstraints()
    setting.tree_count, setting.user_count = count, len(ties)
    state.tree_island = integers([-7] * count, 2)
    present = data.draw(st.lists(st.booleans(), min_size=count, max_size=count))
    state.tree_activity = integers([ACTIVE if there else ABSENT for there in present], 2)
    users.user_enabled = integers([enabled for *_, enabled, _ in ties] or [0], 2)
    users.user_tree_a = integers([a for a, *_ in ties] or [0], 1)
    users.user_tree_b = integers([b for _, b, *_ in ties] or [0], 1)
    # A tree has two links, of which the second never moves.
    users.user_link_a = integers([2 * a if a >= 0 else -1 for a, *_ in ties] or [0], 1)
    users.user_link_b = integers([2 * b + is_still for _, b, _, is_still in ties] or [0], 1)
    model = model_of(*({"dof_count": 6 * int(free)} for free in moves))
    links = [number for tree, free in enumerate(moves) for number in (tree if free else -1, -1)]
    model.link = rows_of(LinkModel, ({"nearest_dof": number, "number": number} for number in links))
    wp.launch(unite_tied_kernel, dim=1, inputs=[setting, model, state, users], device="cpu")
    roots = state.tree_island.numpy()[0]
    # The world, -1, and what cannot move, is still or absent tie nothing together.
    tied = [
        (a, b)
        for a, b, enabled, is_still in ties
        if enabled and not is_still and a >= 0 and present[a] and present[b]
    ]
    edges = [(a, b) for a, b in tied if moves[a] and moves[b]]
    a, b = np.array(edges, dtype=int).reshape(-1, 2).T
    labels = connected_components(
        coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count)), directed=False
    )[1]
    # An island goes by the first of its trees.
    first = {label: tree for tree, label in reversed(list(enumerate(labels)))}
    assert roots.tolist() == [first[label] for label in labels]


def watched(steps: list[float], **fields: Any) -> list[tuple[int, float]]:
    """Whether a tree of one dof wants to sleep, and its idle time [s], after steps with these velocities."""
    setting, state = Settings(), State()
    setting.tree_count, setting.time_step = 1, STEP
    state.tree_wants_sleep = integers([0], 2)
    state.tree_idle_time = wp.zeros((1, 1), dtype=real, device="cpu")
    model = model_of({"first_dof": 0, "dof_count": 1, "sleep_threshold": 0.04, **fields})
    results = []
    for velocity in steps:
        state.dof_velocity = wp.array([[velocity]], dtype=real, device="cpu")
        wp.launch(watch_trees_kernel, dim=1, inputs=[setting, model, state], device="cpu")
        wants, idle = state.tree_wants_sleep.numpy()[0, 0], state.tree_idle_time.numpy()[0, 0]
        results.append((int(wants), float(idle)))
    return results


def test_what_has_been_still_for_longer_than_the_delay_wants_to_sleep() -> None:
    count = int(DELAY / STEP)
    results = watched([0.1, -0.1] * count, can_sleep=1)
    assert [idle for _, idle in results] == [STEP * (i + 1) for i in range(2 * count)]
    assert [wants for wants, _ in results] == [0] * count + [1] * count


def test_what_moves_begins_anew_and_wakes_only_if_it_may() -> None:
    still = [0.0] * (int(DELAY / STEP) + 1)
    # The threshold is of the squared velocity.
    for speed, moves in ((0.19, False), (0.21, True)):
        for can_wake in (0, 1):
            *_, before, after = watched([*still, speed], can_sleep=1, can_wake=can_wake)
            assert before == (1, STEP * len(still))
            assert after == ((0 if moves and can_wake else 1), 0.0 if moves else STEP * (len(still) + 1))


def test_what_may_not_sleep_never_wants_to() -> None:
    assert set(watched([0.0] * 20, can_sleep=0)) == {(0, 0.0)}
