"""The fine launches that steps on GPUs are made of do on the CPU what a step does, bit for bit."""

from contextlib import ExitStack

import numpy as np
import pytest

pytest.importorskip("warp", reason="launches the kernels")

from tests.gpu.scenes import scene
from tests.gpu.side_by_side import SideBySide

from carom.errors import SimulationError
from carom.gpu import workspace
from carom.kernels.contact.manifold import THERE
from carom.layouts.contacts import SORTED
from carom.layouts.status import CONTACTS_WANTED, OVERFLOW, STATUS

COUNT = 3


@pytest.mark.long
@pytest.mark.parametrize(
    ("build", "steps", "touches"),
    [
        ("arms", 60, 0),
        ("heap", 200, 20),
        ("stack", 700, 12),
        ("hurried_stack", 400, 12),
        ("robots", 100, 8),
        ("late", 100, 1),
    ],
)
def test_worlds_side_by_side_are_each_what_they_are_alone(build: str, steps: int, touches: int) -> None:
    with ExitStack() as stack:
        alone = [stack.enter_context(scene(build, seed)) for seed in range(COUNT)]
        worlds = SideBySide(alone)
        start = alone[0].position.copy()
        for _ in range(steps):
            worlds.step()
            assert (worlds.engine.status[:, STATUS] != OVERFLOW).all()
            for world in alone:
                world.step()
        for number, world in enumerate(alone):
            assert worlds.differences(number, world) == []
            assert world.contact_arrays.contact_count >= touches
        assert np.abs(alone[0].position - start).max() > 1e-4
        assert not np.array_equal(alone[0].position, alone[1].position)


def test_a_velocity_that_is_not_finite_takes_its_own_world_back_and_no_other() -> None:
    with ExitStack() as stack:
        alone = [stack.enter_context(scene("heap", seed)) for seed in range(COUNT)]
        for body in (7, 4):
            alone[1].velocity[list(alone[1].bodies.values())[body].first_velocity + 3] = np.nan
        worlds = SideBySide(alone)
        start = worlds.tables["state"].numpy["position"][1].copy()
        worlds.step()
        np.testing.assert_array_equal(worlds.engine.status[:, STATUS], [0, 4 + 1, 0])
        np.testing.assert_array_equal(worlds.tables["state"].numpy["position"][1], start)
        with pytest.raises(SimulationError, match="body 4 "):
            alone[1].step()
        for number in (0, 2):
            alone[number].step()
            assert worlds.differences(number, alone[number]) == []


def test_late_velocities_go_back_with_the_step_of_their_world() -> None:
    with ExitStack() as stack:
        alone = [stack.enter_context(scene("late", seed)) for seed in range(COUNT)]
        worlds = SideBySide(alone)
        worlds.step()
        state = worlds.tables["state"].numpy
        state["dof_velocity"][1, alone[1].bodies[1].first_velocity] = np.nan
        before = {name: state[name].copy() for name in ("late_velocity", "late_joint")}
        worlds.step()
        np.testing.assert_array_equal(worlds.engine.status[:, STATUS] > 0, [False, True, False])
        for name, rows in before.items():
            assert rows.any()
            np.testing.assert_array_equal(state[name][1], rows[1])
            assert (state[name][0] != rows[0]).any()


@pytest.mark.parametrize("build", ["robots", "heap"])
def test_a_world_whose_rows_do_not_fit_goes_back_to_where_the_step_began(
    build: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Robots have rows over two trees, the heap has single contacts.
    monkeypatch.setitem(workspace._FIRST_ROOM, "single", 2)
    with ExitStack() as stack:
        alone = [stack.enter_context(scene(build, seed)) for seed in range(COUNT)]
        worlds = SideBySide(alone, rows=1)
        state = worlds.tables["state"].numpy
        start, velocity = state["position"].copy(), state["dof_velocity"].copy()
        worlds.step()
        assert (state["status_entry"][:, STATUS] == OVERFLOW).all()
        np.testing.assert_array_equal(state["position"], start)
        np.testing.assert_array_equal(state["dof_velocity"], velocity)


def test_contacts_that_do_not_fit_are_counted_and_those_there_were_are_put_back() -> None:
    with ExitStack() as stack:
        alone = [stack.enter_context(scene("heap", seed)) for seed in range(COUNT)]
        for world in alone:
            world.step(2)
        worlds = SideBySide(alone, contacts=0)
        state, contacts = (worlds.tables[name].numpy for name in ("state", "contacts"))
        room, counts = worlds.tables["contacts"].capacity["contact"], contacts["count_contacts"][:, THERE]
        status = state["status_entry"]
        before: dict[str, np.ndarray] = {}
        for _ in range(100):
            before = {name: values.copy() for name, values in {**state, **contacts}.items()}
            worlds.step()
            for world in alone:
                world.step()
            if status[:, STATUS].any():
                break
        wanted = np.array([world.contact_arrays.contact_count for world in alone])
        short = status[:, STATUS] == OVERFLOW
        np.testing.assert_array_equal(short, wanted > room)
        assert short.any()
        for number in np.flatnonzero(short):
            assert status[number, CONTACTS_WANTED] == wanted[number]
            np.testing.assert_array_equal(
                contacts["count_contacts"][number, :SORTED], before["count_contacts"][number, :SORTED]
            )
            for name in ("position", "dof_velocity", "link_wrench"):
                np.testing.assert_array_equal({**state, **contacts}[name][number], before[name][number])
            for name in ("contact_impulse", "contact_local_a", "contact_point_b", "contact_shapes"):
                kept = contacts[name][number, : counts[number]]
                np.testing.assert_array_equal(kept, before[name][number, : counts[number]])
