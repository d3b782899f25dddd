"""Groups of observations, models of noise, and the ready terms."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from tests.face.scene import ARM

from carom import Camera, World
from carom.vector.managers import (
    Command,
    Event,
    ImageGroup,
    ManagerEnv,
    Observation,
    Reward,
    Task,
    Termination,
)
from carom.vector.managers import library as ready
from carom.vector.managers.noises import Bias, Chain, Dropout, Gain, Gaussian, Uniform

COUNT = 3


class Arms(ManagerEnv):
    """Arms whose actuators are controlled."""

    def __init__(self, task: Task) -> None:
        world = World()
        world.load(ARM)
        action = np.ones(2, np.float32)
        super().__init__(world, COUNT, gymnasium.spaces.Box(-action, action), task, steps=2)

    def apply(self, actions: np.ndarray) -> None:
        self.worlds.controls = actions


def one(function: Any, **options: Any) -> Task:
    return Task({"value": Observation(function, **options)}, {"alive": Reward(ready.alive(), 1.0)})


def camera() -> Camera:
    return Camera.with_field_of_view(8, 6, 60.0).look_at((2.0, 0.0, 1.0), (0.0, 0.0, 1.0))


def test_groups_are_a_dictionary_of_arrays_and_images() -> None:
    task = Task(
        {
            "policy": {"joints": Observation(ready.joint_positions("arm"))},
            "critic": {
                "joints": Observation(ready.joint_positions("arm"), history=2),
                "height": Observation(ready.base_height("box")),
            },
            "seen": ImageGroup(camera()),
            "depth": ImageGroup(camera(), "depth", farthest=3.0),
        },
        {"alive": Reward(ready.alive(), 1.0)},
    )
    env = Arms(task)
    observation, _ = env.reset(seed=1)
    assert {name: part.shape for name, part in observation.items()} == {
        "policy": (COUNT, 2), "critic": (COUNT, 5), "seen": (COUNT, 6, 8, 3), "depth": (COUNT, 6, 8, 1),
    }  # fmt: skip
    assert env.observation_space.contains(observation)
    assert observation["depth"].max() <= 3.0
    observation, reward, *_ = env.step(np.ones((COUNT, 2)))
    assert env.observation_space.contains(observation)
    assert reward == pytest.approx(env.duration)
    with pytest.raises(ValueError, match="either terms, or groups"):
        Arms(Task({"a": Observation(ready.alive()), "policy": {}}, {}))  # type: ignore[dict-item]


@pytest.mark.parametrize(
    "noise",
    [
        Uniform(-0.1, 0.1),
        Gaussian(0.1),
        Bias((0.1, 0.2)),
        Gain(0.1),
        Dropout(0.5),
        Chain((Bias(0.1), Gaussian(0.01))),
    ],
)
def test_noise_is_drawn_from_the_seeds_and_kept_in_checkpoints(noise: Any, tmp_path: Any) -> None:
    def run(env: Arms, steps: int) -> np.ndarray:
        return np.array([env.step(np.full((COUNT, 2), 0.5))[0] for _ in range(steps)])

    task = one(ready.joint_positions("arm", relative_to=-1.0), noise=noise)
    env, same, clean = Arms(task), Arms(task), Arms(one(ready.joint_positions("arm", relative_to=-1.0)))
    for each in (env, same, clean):
        each.reset(seed=3)
    found, without = run(env, 4), run(clean, 4)
    assert np.array_equal(run(same, 4), found)
    assert not np.allclose(found, without)
    if isinstance(noise, Bias):
        np.testing.assert_allclose(found - without, (found - without)[:1].repeat(4, axis=0), atol=1e-6)
    env.save(tmp_path / "c")
    wanted = run(env, 3)
    same.reset(seed=9)
    same.restore(tmp_path / "c")
    assert np.array_equal(run(same, 3), wanted)


def test_ready_terms_measure_what_they_say() -> None:
    env = Arms(one(ready.sensors()))
    env.reset(seed=1)
    env.step(np.ones((COUNT, 2)))
    arm, box = env.worlds["arm"], env.worlds["box"]
    half = np.sqrt(0.5)
    box.pose = (1.0, 2.0, 3.0), (half, 0.0, 0.0, half)
    box.velocity = (0.0, 0.0, 2.0), (0.0, 1.0, 0.0)
    for function, wanted in (
        (ready.joint_positions("arm", ["elbow"]), arm.joints["elbow"].position[:, None]),
        (ready.joint_velocities("arm"), arm.joints.velocities),
        (ready.base_height("box"), np.full(COUNT, 3.0)),
        (ready.base_velocity("box"), np.tile((0.0, 2.0, 0.0), (COUNT, 1))),
        (ready.base_rate("box"), np.tile((0.0, 0.0, -1.0), (COUNT, 1))),
        (ready.gravity_direction("box"), np.tile((0.0, -1.0, 0.0), (COUNT, 1))),
        (ready.position_of("arm", "hand"), arm.links["hand"].pose.position),
        (ready.position_of("box", relative_to="arm"), np.tile((1.0, 2.0, 3.0), (COUNT, 1))),
        (ready.last_actions(), np.ones((COUNT, 2))),
        (ready.near("box", None, (1.0, 2.0, 2.9)), np.full(COUNT, np.exp(-1.0))),
        (ready.tracking(ready.base_height("box"), ready.base_height("box")), np.ones(COUNT)),
        (ready.tilt("box"), np.ones(COUNT)),
        (ready.action_rate(), np.full(COUNT, 2.0)),
        (ready.squared_torques("arm"), np.square(arm.joints.motor_torques).sum(axis=1)),
        (ready.below("box", 3.5), np.ones(COUNT, bool)),
        (ready.leaning("box", 0.5), np.ones(COUNT, bool)),
        (ready.longer_than(env.duration), np.ones(COUNT, bool)),
        (ready.touching("box"), np.zeros(COUNT, bool)),
    ):
        np.testing.assert_allclose(function(env), wanted, atol=1e-9)
    arm.joints.positions = (2.5, 0.0)
    np.testing.assert_allclose(ready.beyond_limits("arm")(env), 0.5)


def test_ready_events_change_the_worlds_they_are_told() -> None:
    friction, masses = [], []

    def note(env: Any, worlds: np.ndarray) -> None:
        friction.append(env.worlds["box"].shapes[0].friction)
        masses.append(env.worlds["box"].mass)

    task = Task(
        {"arm": Observation(ready.joint_positions("arm")), "goal": Observation(ready.command("goal"))},
        {"alive": Reward(ready.alive(), 1.0)},
        {"late": Termination(ready.longer_than(0.02), time_out=True)},
        {
            "friction": Event(ready.random_friction("box", 0.2, 0.9), "start"),
            "masses": Event(ready.random_masses("box", 0.5, 2.0), "start"),
            "joints": Event(ready.scatter_joints("arm", (0.1, 0.5))),
            "place": Event(ready.scatter_base("box", (0.0, 1.0, 2.0), (0.5, 2.0, 3.0))),
            "note": Event(note),
            "push": Event(ready.push("box", 0.5), "interval", seconds=(0.01, 0.01)),
        },
        {"goal": Command(lambda env, worlds: env.random.uniform(worlds, -1.0, 1.0, 2))},
    )
    env = Arms(task)
    observation, _ = env.reset(seed=5)
    assert (np.abs(observation[:, :2]) <= (0.1, 0.5)).all()
    assert len(set(np.ravel(observation).tolist())) == 4 * COUNT
    assert ((friction[0] >= 0.2) & (friction[0] <= 0.9)).all()
    assert len(set(masses[0].tolist())) == COUNT
    place = env.worlds["box"].pose.position
    assert ((place >= (0.0, 1.0, 2.0)) & (place <= (0.5, 2.0, 3.0))).all()
    over = [env.step(np.zeros((COUNT, 2)))[3] for _ in range(3)]
    assert over[2].all()
    assert np.abs(env.worlds["box"].velocity.linear[:, :2]).max() > 0.01
