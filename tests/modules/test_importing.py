"""All that PyBullet's wheel lets one import can be imported; what is missing says so at its use.

`wheel_modules.txt` names the modules of PyBullet 3.2.7's distribution besides `pybullet`, and
`wheel_names.txt` the public functions, classes and constants of those that Carom has, but for scripts.
"""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import pybullet as p
from pybullet._absent import Absent

NAMES = Path(__file__).with_name("wheel_modules.txt").read_text(encoding="utf-8").split()
# They need a library that is not installed with Carom, nor with PyBullet.
NEED_PROTOBUF = "pybullet_envs.minitaur.envs.minitaur_logging"
# Run scripts that use only parts, as if Gymnasium were not installed.
WITHOUT_GYMNASIUM = "import sys; sys.modules['gymnasium'] = None\n"


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_every_module_of_the_wheel_can_be_imported() -> None:
    for name in NAMES:
        if not name.startswith(NEED_PROTOBUF):
            import_module(name)


def test_logs_of_the_minitaur_can_be_imported() -> None:
    pytest.importorskip("google.protobuf")
    for name in NAMES:
        if name.startswith(NEED_PROTOBUF):
            import_module(name)


def test_modules_have_the_names_that_they_have_in_the_wheel() -> None:
    listing = Path(__file__).with_name("wheel_names.txt").read_text(encoding="utf-8")
    missing = []
    for line in listing.splitlines():
        module, _, names = line.partition(": ")
        if not module.startswith(NEED_PROTOBUF):
            found = import_module(module)
            missing += [f"{module}.{name}" for name in names.split() if not hasattr(found, name)]
    assert not missing


def test_what_is_missing_says_so_when_it_is_used() -> None:
    laikago_v2 = import_module("pybullet_envs.minitaur.robots.laikago_v2")
    Laikago = laikago_v2.Laikago
    assert "second generation" in repr(Laikago)
    with pytest.raises(p.error, match=r"laikago_v2\.Laikago is not available"):
        Laikago(None)
    with pytest.raises(p.error, match="is not available"):

        class Mine(laikago_v2.Laikago):
            pass

    with pytest.raises(p.error, match="is not available"):
        _ = laikago_v2.NUM_MOTORS + 1
    with pytest.raises(p.error, match="is not available"):
        list(laikago_v2.MOTOR_NAMES)


def test_names_nobody_has_are_not_found() -> None:
    assert find_spec("pybullet_envs.agents.nobody") is None
    with pytest.raises(ModuleNotFoundError):
        import_module("pybullet_examples.nobody")


def test_absent_modules_can_be_inspected() -> None:
    module = import_module("pybullet_envs.agents.configs")
    assert module.__path__ == [] if hasattr(module, "__path__") else True
    assert not hasattr(module.anything, "__wrapped__")
    assert isinstance(module.anything, Absent)


def test_running_a_missing_example_says_so() -> None:
    command = [sys.executable, "-m", "pybullet_examples.jacobian"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert done.stderr.strip().endswith("Carom's own are in its documentation")


def test_robots_need_no_gymnasium() -> None:
    code = """
import pybullet as p, pybullet_data
from pybullet_envs.bullet import kuka, minitaur, racecar
from pybullet_envs import robot_locomotors, env_bases
p.connect(p.DIRECT)
print(p.getNumJoints(kuka.Kuka(pybullet_data.getDataPath()).kukaUid))
"""
    assert run(WITHOUT_GYMNASIUM + code) == "14"


def test_environments_say_that_they_need_gymnasium() -> None:
    code = """
from pybullet_envs.bullet.kukaGymEnv import KukaGymEnv
from pybullet_envs.robot_locomotors import Ant
for make in (KukaGymEnv, Ant):
    try:
        make()
    except ImportError as error:
        print(error.name, 'pip install' in str(error))
"""
    assert run(WITHOUT_GYMNASIUM + code).splitlines() == ["gymnasium True"] * 2


def test_parts_of_multiplayer_scenes_are_there() -> None:
    from pybullet_envs.robot_locomotors import get_cube, get_sphere
    from pybullet_envs.scene_stadium import MultiplayerStadiumScene
    from pybullet_utils.bullet_client import BulletClient

    class Robot:
        player_n = 2
        moved: tuple[float, ...] = ()

        def move_robot(self, *place: float) -> None:
            self.moved = place

    client, robot = BulletClient(p.DIRECT), Robot()
    scene = MultiplayerStadiumScene(client, 9.8, 0.0165 / 4, 4)
    scene.episode_restart(client)
    scene.actor_introduce(robot)
    assert robot.moved == (0, 1, 0)
    assert scene.multiplayer_robots == {2: robot}
    assert not scene.actor_is_active(robot)
    cube, ball = get_cube(client, 0, 0, 1), get_sphere(client, 1, 0, 1)
    assert client.getDynamicsInfo(cube.body, -1)[0] == 1.2
    assert list(ball.get_position()) == [1, 0, 1]
    client.disconnect()


def test_names_that_a_module_lacks_say_so_when_they_are_used() -> None:
    transformations = import_module("pybullet_utils.transformations")
    with pytest.raises(p.error, match=r"transformations\.Arcball is not available"):
        transformations.Arcball()
    with pytest.raises(AttributeError):
        _ = transformations.nothing


def test_environments_are_seeded_as_by_scripts_for_the_old_gym() -> None:
    pytest.importorskip("gymnasium")
    from pybullet_envs.gym_pendulum_envs import InvertedPendulumBulletEnv

    env = InvertedPendulumBulletEnv()
    assert env.seed(3) == [3]
    first, _ = env.reset()
    again, _ = env.reset(seed=3)
    assert list(first) == list(again)
    env.close()
