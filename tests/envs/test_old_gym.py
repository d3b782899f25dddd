"""Environments for `gym`, the predecessor of Gymnasium; a small stand-in is installed for it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from tests.rings import few

REGISTRATION = """
registry = {}

def register(id, entry_point, **options):
    registry[id] = entry_point

def make(id, **options):
    return registry[id](**options)
"""

SPACES = """
class Space:
    pass

class Box(Space):
    def __init__(self, low, high, shape=None, dtype=None):
        self.low, self.high, self.shape, self.dtype = low, high, shape, dtype

class Discrete(Space):
    def __init__(self, n):
        self.n = n
"""

BEGIN = """
if {hidden}:
    sys.modules["gymnasium"] = None
import gym
import pybullet_envs
from gym.envs.registration import make
"""


def run(folder: Path, version: str, script: str, *, hidden: bool) -> str:
    """The output of a script, after gym and the environments are imported."""
    package = folder / "gym"
    (package / "envs").mkdir(parents=True)
    (package / "__init__.py").write_text(
        f'from gym import spaces\nfrom gym.envs.registration import make\n__version__ = "{version}"\n'
        "class Env:\n    pass\n"
    )
    (package / "spaces.py").write_text(SPACES)
    (package / "envs" / "__init__.py").write_text("")
    (package / "envs" / "registration.py").write_text(REGISTRATION)
    code = f"import sys\nsys.path.insert(0, {str(folder)!r})\n" + BEGIN.format(hidden=hidden) + script
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


EPISODE = """
env = make({name!r})
start = env.reset()
result = env.step({action})
print(type(start).__name__, len(result), [type(it).__name__ for it in result[1:]])
print(isinstance(env, gym.Env), isinstance(env.action_space, gym.spaces.Space), type(env).__name__)
print(env.seed(3))
env.close()
"""


@pytest.mark.parametrize("hidden", few([False, True], 1))
@pytest.mark.parametrize(
    ("name", "action", "kind"),
    [
        ("CartPoleBulletEnv-v1", "0", "CartPoleBulletEnv"),
        ("HopperBulletEnv-v0", "[0, 0, 0]", "HopperBulletEnv"),
        ("KukaBulletEnv-v0", "[0, 0, 0]", "KukaGymEnv"),
    ],
)
def test_old_gym_has_four_values(name: str, action: str, kind: str, hidden: bool, tmp_path: Path) -> None:
    shown = run(tmp_path, "0.21.0", EPISODE.format(name=name, action=action), hidden=hidden)
    assert shown.splitlines() == ["ndarray 4 ['float', 'bool', 'dict']", f"True True {kind}", "[3]"]


@pytest.mark.parametrize("hidden", [False, True])
def test_the_last_gym_has_five_values(hidden: bool, tmp_path: Path) -> None:
    shown = run(tmp_path, "0.26.2", EPISODE.format(name="CartPoleBulletEnv-v1", action=1), hidden=hidden)
    assert shown.splitlines()[0] == "tuple 5 ['float', 'bool', 'bool', 'dict']"


def test_classes_have_four_values_where_there_is_gym_alone(tmp_path: Path) -> None:
    script = """
from pybullet_envs.bullet.kukaGymEnv import KukaGymEnv
env = KukaGymEnv()
print(type(env.reset()).__name__, len(env.step([0, 0, 0])), env._maxSteps)
"""
    assert run(tmp_path, "0.26.2", script, hidden=True) == "ndarray 4 1000\n"
