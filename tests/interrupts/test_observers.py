"""Observers may change the world before and after a step; in the middle of one, numbers only."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tests.interrupts.test_prepared_changes import made, seen

from carom import World
from carom.errors import StateError
from carom.layouts.codes import UserConstraintKind


class Observer:
    """Does something once, at one of the times at which it is called."""

    def __init__(self, when: str, do: Callable[[], Any], count: int = 1) -> None:
        self._when, self._do, self._left = when, do, count
        self.error: BaseException | None = None
        self.calls: list[str] = []

    def _call(self, when: str) -> None:
        self.calls.append(when)
        if when == self._when:
            self._left -= 1
            if self._left == 0:
                try:
                    self._do()
                except StateError as problem:
                    self.error = problem

    def before_step(self) -> None:
        self._call("before")

    def after_step(self) -> None:
        self._call("after")

    def after_substep(self) -> None:
        self._call("substep")

    def step_repeated(self) -> None:
        self._call("repeated")


# What needs a world between steps; of `made`, and its snapshot.
CHANGES: dict[str, Callable[[World, Any], Any]] = {
    "load": lambda world, _: world.load_urdf("rrbot.urdf", (0.0, 2.0, 0.0), as_pybullet=True),
    "load a cloth": lambda world, _: world.load_cloth(size=(0.1, 0.1), cells=(1, 1), position=(0, 5, 1)),
    "remove": lambda world, _: world.remove(1),
    "restore": lambda world, state: world.restore(state),
    "reset": lambda world, _: world.clear(),
    "constrain": lambda world, _: world.constrain_links(
        UserConstraintKind.FIXED, world.bodies[3], -1, None, -1
    ),
    "untie": lambda world, _: world.remove_constraint(world.user_constraints.all[0]),
    "set gravity": lambda world, _: setattr(world, "gravity", (0.0, 0.0, -1.0)),
    "change a mass": lambda world, _: world.bodies[3].change_dynamics(0, mass=2.0),
    "add an absence": lambda world, _: setattr(world.bodies[2], "present", False),
    "detect": lambda world, _: world.detect_collisions(),
    "step": lambda world, _: world.step(),
}


def _watched(substeps: int) -> tuple[World, Any]:
    world = made()
    world.change_parameters(substeps=substeps)
    state = world.snapshot()
    world.step()
    return world, state


@pytest.mark.parametrize("when", ["before", "after"])
@pytest.mark.parametrize("name", CHANGES)
def test_a_change_of_an_observer_comes_between_steps(name: str, when: str) -> None:
    world, state = _watched(0)
    observer = Observer(when, lambda: CHANGES[name](world, state))
    world.observers.append(observer)
    world.step()
    assert observer.error is None
    world.observers.remove(observer)
    world.step(2)
    other, its_state = _watched(0)
    for do in (lambda: CHANGES[name](other, its_state), other.step)[:: 1 if when == "before" else -1]:
        do()
    other.step(2)
    assert seen(world) == seen(other)


@pytest.mark.parametrize("substeps", [0, 3])
@pytest.mark.parametrize("name", CHANGES)
def test_a_change_in_the_middle_of_a_step_is_refused(name: str, substeps: int) -> None:
    world, state = _watched(substeps)
    # Of one substep, the first is the last, and the step has ended.
    observer = Observer("substep", lambda: CHANGES[name](world, state))
    world.watch_substeps(observer)
    world.step()
    world.unwatch_substeps(observer)
    other, its_state = _watched(substeps)
    other.watch_substeps(Observer("never", lambda: None))
    other.step()
    if substeps:
        assert "in the middle of a step" in str(observer.error)
    else:
        assert observer.error is None
        CHANGES[name](other, its_state)
    other.unwatch_substeps(other._substep_observers[0])
    world.step(2)
    other.step(2)
    assert seen(world) == seen(other)


def test_what_an_observer_sets_in_the_middle_of_a_step_counts_from_the_next_substep() -> None:
    heights = []
    for number in (1, 3):
        world = World()
        ball = world.add_sphere(0.1, position=(0.0, 0.0, 5.0))
        world.change_parameters(substeps=4, time_step=0.1)
        world.watch_substeps(
            Observer("substep", lambda ball=ball: ball.set_base_velocity((0, 0, 1.0), (0, 0, 0)), number)
        )
        world.step()
        heights.append(float(world.position[2]))
        assert world.time == 0.1
    assert heights == pytest.approx([5.075, 5.025])


@pytest.mark.parametrize("substeps", [1, 2, 3])
def test_an_observer_sees_every_substep_as_a_step_of_its_length(substeps: int) -> None:
    world, plain = World(time_step=0.1), World(time_step=0.1 / substeps)
    for each in (world, plain):
        each.gravity = (0.0, 0.0, -10.0)
        each.add_sphere(0.1, position=(0.0, 0.0, 5.0), mass=1.0)
    world.change_parameters(substeps=substeps)
    heights, expected = list[float](), list[float]()

    class Watcher(Observer):
        def after_substep(self) -> None:
            heights.append(float(world.position[2]))

    world.watch_substeps(Watcher("never", lambda: None))
    world.step(2)
    for _ in range(2 * substeps):
        plain.step()
        expected.append(float(plain.position[2]))
    assert heights == pytest.approx(expected, abs=1e-12)


def _state(world: World) -> tuple[Any, ...]:
    """All there is, but the memory of the last order of sorting."""
    *rest, tables = seen(world)
    return (*rest, [{name: it for name, it in rows.items() if name != "overlap_sorted"} for rows in tables])


@pytest.mark.parametrize("number", [1, 2, 3])
def test_an_error_in_the_middle_of_a_step_undoes_it(number: int) -> None:
    world, _ = _watched(3)
    world.bodies[3].links[0].apply_force((1.0, 2.0, 3.0))

    def fail() -> None:
        raise KeyError("mine")

    before = _state(world)
    observer = Observer("substep", fail, number)
    world.watch_substeps(observer)
    with pytest.raises(KeyError, match="mine"):
        world.step()
    if number < 3:
        assert _state(world) == before
    world.step()
    world.unwatch_substeps(observer)
    other, _ = _watched(3)
    other.bodies[3].links[0].apply_force((1.0, 2.0, 3.0))
    calm = Observer("never", lambda: None)
    other.watch_substeps(calm)
    other.step(1 + (number == 3))
    other.unwatch_substeps(calm)
    assert seen(world) == seen(other)
