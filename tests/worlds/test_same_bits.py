"""World k of N is bit for bit the world that it would have been alone."""

from __future__ import annotations

import importlib

import numpy as np
import pytest
from tests.conformance.catalogue import all_scenarios
from tests.conformance.scenario import Kind, Scenario
from tests.physics.contact_scenes import add_ball, add_floor, earth
from tests.physics.test_contact_worlds import heap
from tests.rings import few
from tests.worlds.same_bits import (
    assert_all_same_bits,
    assert_as_stirred,
    assert_same_bits,
    stirred,
    stirred_worlds,
)

from carom import World, Worlds
from carom.layouts.flags import ActivationChange

# The step of a scenario at which its world is copied, and how far the copies go on.
CAPTURED_AT, STEPS = 5, 30
SCENARIOS = [scenario for scenario in all_scenarios().values() if scenario.kind is Kind.MOTION]


def captured(scenario: Scenario, monkeypatch: pytest.MonkeyPatch) -> World | None:
    """The world of a scenario in the middle of it; None if it does not step."""
    pybullet = importlib.import_module("pybullet")
    step, worlds = World.step, []

    def watched(self: World, count: int = 1) -> None:
        worlds.append(self.copy()) if len(worlds) < CAPTURED_AT else None
        step(self, count)

    with monkeypatch.context() as patched:
        patched.setattr(World, "step", watched)
        scenario.series(pybullet)
    return worlds[-1] if worlds else None


@pytest.mark.parametrize("scenario", few(SCENARIOS, 25), ids=lambda scenario: scenario.name)
def test_robots_and_scenes_of_the_conformance_suite(
    scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = captured(scenario, monkeypatch)
    if scene is None:
        return
    worlds = stirred_worlds(scene, 3, threads=2)
    worlds.step(STEPS)
    assert_as_stirred(worlds, scene, STEPS)


def falling_heap() -> World:
    """Boxes and balls high enough that contacts outgrow their arrays on the way."""
    world = earth()
    heap(world, 24)
    return world


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_any_number_of_worlds_and_threads(count: int, threads: int) -> None:
    scene = falling_heap()
    worlds = stirred_worlds(scene, count, threads)
    room = worlds._engine.contact_arrays.contacts.capacity["contact"]
    for _ in range(10):
        worlds.step(6)
    assert worlds._engine.contact_arrays.contacts.capacity["contact"] > room
    assert_as_stirred(worlds, scene, 60)


def test_256_worlds_of_which_few_have_contacts() -> None:
    scene = earth()
    add_floor(scene)
    ball = add_ball(scene, (0.0, 0.0, 1.0))
    worlds = Worlds(scene, 256, threads=2)
    heights = np.linspace(0.1, 30.0, 256)
    worlds[ball].set_base_inertial_poses(np.stack([0 * heights, 0 * heights, heights], axis=1))
    worlds.step(120)
    for number in range(0, 256, 17):
        lone = scene.copy()
        lone.bodies[ball.id].set_inertial_pose((0.0, 0.0, heights[number]), (0.0, 0.0, 0.0, 1.0))
        lone.step(120)
        assert_same_bits(worlds, number, lone)


@pytest.mark.parametrize("substeps", [0, 3])
def test_resets_of_some_worlds_in_between(substeps: int) -> None:
    scene = earth(substeps=substeps)
    heap(scene, 8)
    worlds = stirred_worlds(scene, 5, threads=2)
    start = worlds.snapshot()
    worlds.step(40)
    middle = worlds.snapshot(where=[3])
    worlds.step(7)
    worlds.restore(start, where=np.array([True, False, False, True, False]))
    worlds.restore(middle, where=[4])
    worlds.step(25)
    for number, steps in ((0, 25), (1, 72), (2, 72), (3, 25)):
        lone = stirred(scene, number)
        lone.step(steps)
        assert_same_bits(worlds, number, lone)
        assert worlds.time[number] == lone.time
    lone = stirred(scene, 3)
    lone.step(65)
    assert_same_bits(worlds, 4, lone)


def test_bodies_that_fall_asleep_and_are_woken() -> None:
    scene = earth()
    add_floor(scene)
    bodies = [add_ball(scene, (0.5 * i, 0.0, 0.11)) for i in range(2)]
    for body in bodies:
        body.change_dynamics(-1, activation_state=int(ActivationChange.ENABLE_SLEEPING), rolling_friction=0.1)
    worlds = stirred_worlds(scene, 4, threads=2)
    lone = [stirred(scene, number) for number in range(4)]
    worlds.step(700)
    for world in lone:
        world.step(700)
    assert lone[0].bodies[bodies[0].id].asleep
    # A ball that is thrown at one of them in some worlds wakes it up there.
    pushed = [1, 3]
    worlds[bodies[1]].set_base_inertial_poses((0.2, 0.0, 0.11), where=pushed)
    for number in pushed:
        lone[number].bodies[bodies[1].id].set_inertial_pose((0.2, 0.0, 0.11), (0.0, 0.0, 0.0, 1.0))
    worlds.step(50)
    assert_all_same_bits(worlds, lone, 50)


def test_what_is_left_in_the_workspace_changes_nothing() -> None:
    scene = falling_heap()
    clean, dirty = scene.copy(), scene.copy()
    for _ in range(60):
        clean.step()
        dirty.step()
        workspace = dirty.engine.workspace
        for table in (workspace.scratch, workspace.pairs, workspace.pair_rows):
            for array in table.numpy.values():
                array.fill(-7 if array.dtype.kind == "i" else np.nan)
    np.testing.assert_array_equal(clean.position, dirty.position)
    np.testing.assert_array_equal(clean.velocity, dirty.velocity)
