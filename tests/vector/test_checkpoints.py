"""Environments that continue from a checkpoint, bit for bit."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from tests.vector.managers.balls import Balls, actions

import pybullet_envs  # noqa: F401  # registers the environments
from carom.vector.checkpoints import Attributes, attributes_of, read_checkpoint, set_attributes
from carom.vector.panda import PandaPush
from carom.vector.quadruped.quadruped import Quadruped

ROOT = Path(__file__).parents[2]


def balls(mode: str = "NextStep") -> Any:
    return Balls(6, autoreset_mode=mode)


def quadrupeds(mode: str = "NextStep") -> Any:
    return Quadruped(6, autoreset_mode=mode, max_episode_steps=20)


def pandas(mode: str = "NextStep") -> Any:
    return PandaPush(3, autoreset_mode=mode, max_episode_steps=20)


def ants(mode: str = "NextStep") -> Any:
    return gymnasium.make_vec("AntBulletEnv-v0", num_envs=3, autoreset_mode=mode).unwrapped


def chosen(env: Any, step: int) -> np.ndarray:
    """Some actions, which depend on the world and the step."""
    count, size = env.action_space.shape
    return np.tile(actions(count, step), size).astype(np.float32)


def played(env: Any, first: int, steps: int) -> list[bytes]:
    """All that is told in some steps."""
    told = []
    for step in range(first, first + steps):
        *arrays, infos = env.step(chosen(env, step))
        told += [np.ascontiguousarray(array).tobytes() for array in arrays]
        told.append(repr(sorted(infos.items())).encode())
    return told


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("make", [balls, quadrupeds, pandas, ants])
def test_what_follows_is_the_same_bit_for_bit(make: Callable[[str], Any], mode: str, tmp_path: Path):
    env, other = make(mode), make(mode)
    env.reset(seed=3)
    played(env, 0, 15)
    env.save(tmp_path / "here.npz")
    unbroken = played(env, 15, 30)
    other.restore(tmp_path / "here.npz")
    assert played(other, 15, 30) == unbroken
    # Back in the same environments, which have gone on meanwhile.
    env.restore(tmp_path / "here.npz")
    assert played(env, 15, 30) == unbroken


@pytest.mark.parametrize("make", ["balls", "quadrupeds"])
def test_it_goes_on_in_a_new_process(make: str, tmp_path: Path):
    env = globals()[make]()
    env.reset(seed=3)
    played(env, 0, 15)
    env.save(tmp_path / "here.npz")
    unbroken = b"".join(played(env, 15, 30))
    program = f"""
import sys
from tests.vector.test_checkpoints import {make}, played
env = {make}()
env.restore({str(tmp_path / "here.npz")!r})
sys.stdout.buffer.write(b"".join(played(env, 15, 30)))
"""
    found = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, stdout=subprocess.PIPE, check=True, timeout=200
    )
    assert found.stdout == unbroken


def test_parameters_that_were_changed_afterwards_are_those_of_the_checkpoint(tmp_path: Path):
    env = balls()
    env.worlds.change_parameters(gravity=(0.0, 0.0, -3.0), where=[1])
    env.reset(seed=0)
    env.save(tmp_path / "here.npz")
    masses = env.ball.dynamics(-1)["mass"]
    env.worlds.gravity = (0.0, 0.0, -1.0)
    env.ball.change_dynamics(-1, mass=9.0, lateral_friction=0.1)
    env.restore(tmp_path / "here.npz")
    assert np.asarray(env.worlds.gravity)[:, 2].tolist() == [-9.81, -3.0, -9.81, -9.81, -9.81, -9.81]
    assert (env.ball.dynamics(-1)["mass"] == masses).all()
    assert (env.ball.dynamics(-1)["lateral_friction"] == 0.5).all()


def test_a_halted_world_stays_halted(tmp_path: Path):
    env = Balls(3, autoreset_mode="Disabled")
    env.reset(seed=0)
    env.worlds.halted[1] = True
    env.save(tmp_path / "here.npz")
    env.worlds.halted[:] = False
    env.restore(tmp_path / "here.npz")
    assert env.worlds.halted.tolist() == [False, True, False]


def test_a_checkpoint_of_something_else_is_refused(tmp_path: Path):
    balls().save(tmp_path / "balls.npz")
    with pytest.raises(ValueError, match="a checkpoint of 6 Balls; these are 6 Quadruped"):
        quadrupeds().restore(tmp_path / "balls.npz")
    with pytest.raises(ValueError, match="a checkpoint of 6 Balls; these are 2 Balls"):
        Balls(2).restore(tmp_path / "balls.npz")


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 cut off"])
def test_a_file_that_is_no_checkpoint_is_refused(content: bytes, tmp_path: Path):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="is not a checkpoint of an environment"):
        read_checkpoint(path)
    np.savez(path, numbers=np.zeros(3))
    with pytest.raises(ValueError, match="is not a checkpoint of an environment"):
        read_checkpoint(path)


class Thing(Attributes):
    def __init__(self, start: float) -> None:
        self.number = start
        self.count = np.int64(3)
        self.array = np.full(3, start)
        self.view = self.array[:2]
        self.parts = {"list": [np.full(2, start), None], "pair": (1, True)}
        self.inner = [start]
        self.function = print
        self.mixed = {"number": 1, "function": print}
        self.objects = np.array([print], dtype=object)


def test_numbers_and_arrays_are_kept_and_nothing_else():
    saved = attributes_of(Thing(1.0))
    assert set(saved) == {"number", "count", "array", "view", "parts", "inner"}
    thing = Thing(2.0)
    set_attributes(thing, saved)
    assert thing.number == 1.0
    assert (thing.array == 1.0).all()
    assert thing.view.base is thing.array
    assert (thing.parts["list"][0] == 1.0).all()
    assert thing.parts["list"][1] is None
    assert thing.parts["pair"] == (1, True)
    saved["array"][:] = 7.0
    assert (thing.array == 1.0).all()
