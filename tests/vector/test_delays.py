"""Histories and delays of observations and actions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.vector.managers.balls import COUNT, Balls, actions, changed

from carom.vector.delays import DelayLine
from carom.vector.managers import Observation
from carom.vector.random import RandomSources


def seeded(count: int = COUNT) -> RandomSources:
    random = RandomSources(count)
    random.seed(3, np.arange(count))
    return random


def test_values_arrive_late_in_each_environment_by_its_own_delay():
    line = DelayLine(4, (2,), (0, 3), history=2)
    line.start(np.arange(4), seeded())
    line.delays[:] = [0, 1, 2, 3]
    line.fill(np.arange(4), -1.0)
    for step in range(5):
        line.push(np.full((4, 2), float(step)))
        arrives = np.maximum(step - line.delays, -1)
        assert (line.value == arrives[:, None]).all()
        assert (line.history[:, 1] == line.value).all()
        assert (line.history[:, 0] == np.maximum(arrives - 1, -1)[:, None]).all()
    line.fill(np.array([1]), np.array([[7.0, 8.0]]))
    assert (line.history[1] == [7.0, 8.0]).all()
    line.push(np.array([[9.0, 9.0]]), np.array([0]))
    assert line.value[:, 0].tolist() == [9.0, 7.0, 2.0, 1.0]


def test_random_delays_depend_on_the_seed_of_an_environment_alone():
    line, other = DelayLine(50, (), (1, 4)), DelayLine(50, (), (1, 4))
    line.start(np.arange(50), seeded(50))
    other.start(np.arange(10, 50), seeded(50))
    assert (line.delays[10:] == other.delays[10:]).all()
    assert set(line.delays.tolist()) == {1, 2, 3, 4}


@pytest.mark.parametrize("delay", [-1, (2, 1), (-1, 2)])
def test_delays_that_make_no_sense_are_refused(delay: int | tuple[int, int]):
    with pytest.raises(ValueError, match="action_delay: delay must be a number of steps"):
        Balls(task=changed(action_delay=delay))


def test_actions_are_applied_late():
    class Noting(Balls):
        def apply(self, actions: np.ndarray) -> None:
            applied.append(actions.copy())
            super().apply(actions)

    applied: list[np.ndarray] = []
    late, prompt = Noting(task=changed(events={}, action_delay=2)), Balls(task=changed(events={}))
    for env in (late, prompt):
        env.reset(seed=0)
    for step in range(5):
        late.step(actions(COUNT, step))
        prompt.step(actions(COUNT, step - 2) if step >= 2 else np.zeros((COUNT, 1)))
        assert (late.ball.base_velocities == prompt.ball.base_velocities).all()
    assert (late.actions == actions(COUNT, 4)).all()
    assert (applied[4] == actions(COUNT, 2)).all()
    assert not applied[1].any()
    late.reset(options={"reset_mask": np.arange(COUNT) == 0})
    late.step(actions(COUNT, 5))
    assert not applied[5][0].any()
    assert (applied[5][1:] == actions(COUNT, 3)[1:]).all()


def test_observations_are_late_and_remembered():
    def height(**options: Any) -> Observation:
        return Observation(lambda env: env.ball.base_inertial_poses[:, 2], **options)

    terms = {"now": height(), "late": height(delay=2), "past": height(delay=1, history=2)}
    env = Balls(task=changed(observations=terms, terminations={}))
    seen = [env.reset(seed=1)[0]]
    seen += [env.step(actions(COUNT, step))[0] for step in range(5)]
    for step, (_, late, before, last) in enumerate(np.swapaxes(one, 0, 1) for one in seen):
        assert (late == seen[max(step - 2, 0)][:, 0]).all()
        assert (last == seen[max(step - 1, 0)][:, 0]).all()
        assert (before == seen[max(step - 2, 0)][:, 0]).all()
    assert (env.observe() == seen[-1]).all()


def test_what_is_on_its_way_belongs_to_a_checkpoint(tmp_path: Path):
    def made() -> Balls:
        late = Observation(lambda env: env.ball.base_inertial_poses[:, 2], delay=(0, 3), history=2)
        return Balls(task=changed(observations={"late": late}, action_delay=(0, 4)))

    env, other = made(), made()
    env.reset(seed=5)
    other.reset(seed=99)
    for step in range(3):
        env.step(actions(COUNT, step))
    env.save(tmp_path / "here.npz")
    other.restore(tmp_path / "here.npz")
    for step in range(3, 40):
        ours, theirs = (each.step(actions(COUNT, step)) for each in (env, other))
        for one, two in zip(ours[:4], theirs[:4], strict=True):
            assert (one == two).all()
    assert (env._late_actions.delays == other._late_actions.delays).all()
    assert len(set(env._late_actions.delays.tolist())) > 1
