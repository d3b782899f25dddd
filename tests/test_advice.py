"""Errors that say what to do."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import carom.cli.command_line
import pybullet as p
import pybullet_data
from carom import World
from carom.errors import DescriptionError
from carom.suggestions import suggestion

ROOT = Path(__file__).parents[1]
CALL = r"p\.setAdditionalSearchPath\(pybullet_data\.getDataPath\(\)\)"


@pytest.fixture
def direct(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    from pybullet._clients.clients import Client

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Client, "latest_search_path", None)
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize(
    "load",
    [
        lambda: p.loadURDF("plane.urdf"),
        lambda: p.loadURDF("franka_panda/panda.urdf"),
        lambda: p.loadSDF("kiva_shelf/model.sdf"),
        lambda: p.loadMJCF("mjcf/ant.xml"),
        lambda: p.createCollisionShape(p.GEOM_MESH, fileName="duck.obj"),
        lambda: p.loadTexture("checker_blue.png"),
    ],
)
def test_a_file_that_is_shipped_says_how_to_find_it(direct, load: Callable[[], object]):
    with pytest.raises(p.error, match=f"pybullet_data has one: call {CALL} before"):
        load()


def test_a_misspelt_file_is_guessed(direct, tmp_path: Path):
    with pytest.raises(p.error, match=f"did you mean plane.urdf of pybullet_data\\? Then call {CALL}"):
        p.loadURDF("plan.urdf")
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    with pytest.raises(p.error, match=r"did you mean franka_panda/panda.urdf\?$"):
        p.loadURDF("franka_panda/pandas.urdf")
    (tmp_path / "my_robot.urdf").write_text("<robot/>")
    with pytest.raises(p.error, match=r"did you mean my_robot.urdf\?$"):
        p.loadURDF("my_robt.urdf")
    with pytest.raises(p.error, match=r"no such file: nothing_like_it.urdf$"):
        p.loadURDF("nothing_like_it.urdf")


def test_without_a_connection_the_message_says_to_call_connect():
    with pytest.raises(p.error, match=r"^Not connected to physics server\. .*call connect\(DIRECT\)"):
        p.stepSimulation()


def script(code: str) -> str:
    """What a script that fails prints."""
    environment = {"PYTHONPATH": str(ROOT / "src"), "PATH": "", "HOME": str(Path.home())}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=False
    )
    assert done.returncode == 1
    return done.stderr


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        ("p.loadURDF('x', usFixedBase=1)", "useFixedBase"),
        ("p.setJointMotorControl2(0, 0, 0, targetPositon=1)", "targetPosition"),
        ("p.createMultiBody(baseMas=1)", "baseMass"),
        ("carom.World().load_urdf('x', positon=(0, 0, 0))", "position"),
        ("carom.World(timestep=0.1)", "time_step"),
    ],
)
def test_a_misspelt_argument_is_guessed_when_a_script_fails(call: str, meant: str):
    output = script(f"import pybullet as p, carom; p.connect(p.DIRECT); {call}")
    assert output.rstrip().endswith(f"Did you mean '{meant}'?")


def test_a_misspelt_argument_is_guessed_in_notebooks():
    pytest.importorskip("IPython", reason="no notebooks here")
    # As the kernel of a notebook runs its cells.
    said = script(
        "import sys\n"
        "from IPython.core.interactiveshell import InteractiveShell\n"
        "shell = InteractiveShell.instance()\n"
        "shell.run_cell('import pybullet as p')\n"
        "shell.run_cell('p.loadURDF(1, usFixedBase=1)')\n"
        "shell.run_cell('1 + None')\n"
        "sys.exit(1)"
    )
    assert "Did you mean 'useFixedBase'?" in said
    assert said.count("Did you mean") == 1


def test_other_errors_are_printed_as_ever():
    assert script("import pybullet; 1 / 0").rstrip().endswith("ZeroDivisionError: division by zero")
    assert suggestion(TypeError("other() got an unexpected keyword argument 'x'")) is None


@pytest.fixture
def arm():
    world = World()
    return world.load_urdf("franka_panda/panda.urdf", fixed_base=True)


def test_the_modern_api_says_what_it_wants_and_what_it_got(arm):
    world = arm.world
    before = world.motor.copy()
    for wrong, message in (
        (lambda: arm.joints.set_position_targets([1, 2, 3]), r"targets .* 9 of them, not shape \(3,\)"),
        (lambda: arm.joints.set_velocity_targets([[1]]), r"targets .* 9 of them"),
        (lambda: arm.joints.set_torques([1, 2]), r"panda_joint1, panda_joint2"),
        (lambda: arm.joints.set_position_targets([0.0] * 9, gains=[1, 2]), r"gains must be one number or 9"),
        (lambda: arm.joints[0].set_position_target("far"), r"target must be a number .* not 'far'"),
        (lambda: arm.joints[0].set_torque([1, 2]), r"torque must be one number"),
        (lambda: setattr(world, "gravity", (0, 0)), r"gravity must have shape \(3,\), .*: it is \(0, 0\)"),
        (lambda: setattr(world, "gravity", 9.81), r"gravity must have shape \(3,\)"),
        (lambda: world.load_urdf("plane.urdf", (0, 0)), r"position must have shape \(3,\)"),
        (lambda: world.load_urdf("plane.urdf", orientation=(0, 0, 1)), r"orientation must have shape \(4,\)"),
    ):
        with pytest.raises(ValueError, match=message):
            wrong()
    assert (world.motor == before).all()
    assert len(world.bodies) == 1
    arm.joints.set_position_targets(0.5)


def test_worlds_and_the_command_line_find_shipped_files_by_name(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    world = World()
    assert world.load_urdf("cube_small.urdf").name == "cube.urdf"
    assert world.load_sdf("kiva_shelf/model.sdf")
    assert world.load_mjcf("mjcf/ant.xml")
    with pytest.raises(DescriptionError, match=r"did you mean cube_small.urdf\?"):
        world.load_urdf("cube_smal.urdf")
    for name in ("r2d2.urdf", "kiva_shelf/model.sdf", "mjcf/ant.xml"):
        assert carom.cli.command_line.main(["convert", name, "out.urdf"]) == 0
        assert (tmp_path / "out.urdf").is_file()
        (tmp_path / "out.urdf").unlink()
