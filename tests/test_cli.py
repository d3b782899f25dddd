import subprocess
import sys
from pathlib import Path

import pytest

from carom.cli.command_line import main
from carom.version import __version__

ROBOT = """<robot name="crane">
  <link name="mast">
    <inertial><mass value="10"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial>
  </link>
  <link name="jib">
    <inertial><origin xyz="0.5 0 0"/><mass value="2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.3"/></inertial>
    <collision><geometry><box size="1 0.2 0.2"/></geometry></collision>
  </link>
  <link name="plate"/>
  <joint name="slew" type="revolute">
    <parent link="mast"/><child link="jib"/><origin xyz="0 0 3"/><axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="2.5" effort="40" velocity="3"/><dynamics damping="0.7" friction="0.1"/>
  </joint>
  <joint name="weld" type="fixed"><parent link="jib"/><child link="plate"/><origin xyz="0 1 0"/></joint>
</robot>"""


@pytest.fixture
def robot_file(tmp_path: Path) -> Path:
    path = tmp_path / "crane.urdf"
    path.write_text(ROBOT)
    return path


def row(text: str, name: str) -> str:
    """The cells of the only line that has the name in its second column, one space between them."""
    (line,) = (line for line in text.splitlines() if line.split()[1:2] == [name])
    return " ".join(line.split())


def test_nothing_is_said_when_the_reader_has_had_enough():
    command = [sys.executable, "-m", "carom", "info", "cartpole.urdf"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as info:
        assert info.stdout is not None
        assert info.stderr is not None
        info.stdout.close()
        assert info.stderr.read() == ""


def test_info_prints_what_connects_the_links(robot_file, capsys):
    assert main(["info", str(robot_file)]) == 0
    output = capsys.readouterr().out
    assert output.startswith("crane: 3 links, 1 movable joint, floating base")
    assert row(output, "slew") == "0 slew revolute 0 0 1 -1.5 .. 2.5 40 3 0.7 0.1 mast"
    assert row(output, "weld") == "1 weld fixed jib"


def test_info_prints_masses_inertias_and_poses(robot_file, capsys):
    main(["info", str(robot_file)])
    output = capsys.readouterr().out
    assert row(output, "mast") == "-1 mast 10 1 2 3 0 0 0 0 0 0 0 0 0 1 0"
    assert row(output, "jib") == "0 jib 2 0.1 0.2 0.3 0.5 0 0 0 0 3 0 0 0 1 1"
    assert "0 1 3" in row(output, "plate")


def test_info_takes_inertia_from_the_collision_shapes_if_it_reads_as_pybullet_does(robot_file, capsys):
    main(["info", str(robot_file), "--as-pybullet"])
    shape = row(capsys.readouterr().out, "jib")
    main(["info", str(robot_file), "--as-pybullet", "--inertia-from-file"])
    assert shape != row(capsys.readouterr().out, "jib")


def test_info_scales_and_fixes_and_merges(robot_file, capsys):
    assert main(["info", str(robot_file), "--scale", "2", "--fixed-base", "--merge-fixed-links"]) == 0
    output = capsys.readouterr().out
    assert "fixed base" in output
    assert "plate" not in output
    assert "0 0 6" in row(output, "jib")


def test_info_reads_mjcf_and_sdf_as_well(capsys):
    assert main(["info", "mjcf/ant.xml"]) == 0
    assert "hip_1" in capsys.readouterr().out
    assert main(["info", "kuka_iiwa/model.sdf"]) == 0
    assert "lbr_iiwa_joint_7" in capsys.readouterr().out


def test_check_lists_what_is_not_simulated(robot_file, tmp_path, capsys):
    robot_file.write_text(ROBOT.replace('<robot name="crane">', '<robot name="crane"><transmission/>'))
    assert main(["check", str(robot_file), "cube_small.urdf"]) == 0
    output = capsys.readouterr().out
    assert f"{robot_file}: URDF, 1 body, 1 movable joint" in output
    assert "robot/transmission" in output
    assert "crane.urdf:1" in output
    assert "Nothing is ignored." in output
    assert main(["check", "--strict", str(robot_file)]) == 1
    assert main(["check", "--strict", "cube_small.urdf"]) == 0


def test_check_goes_on_after_a_file_that_cannot_be_used(tmp_path, capsys):
    (tmp_path / "page.xml").write_text("<html/>")
    assert main(["check", str(tmp_path / "page.xml"), "nowhere.urdf", "cube_small.urdf"]) == 1
    output, errors = capsys.readouterr()
    assert "cube_small.urdf: URDF" in output
    assert "its first element is <html>" in errors
    assert "no such file: nowhere.urdf" in errors


def test_info_finds_the_files_we_ship(capsys):
    assert main(["info", "franka_panda/panda.urdf"]) == 0
    assert "panda_joint7" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (None, "no such file"),
        ("", "crane.urdf"),
        ("<robot name='r'>", "crane.urdf"),
        ("<robot name='r'></robot>", "no links"),
        (ROBOT.replace('<child link="jib"/>', '<child link="nobody"/>'), "nobody"),
        (ROBOT.replace('"10"', '"heavy"'), "heavy"),
    ],
)
def test_a_file_that_cannot_be_used_is_one_line_on_stderr_and_exit_status_1(
    robot_file, content, complaint, capsys
):
    if content is None:
        robot_file.unlink()
    else:
        robot_file.write_text(content)
    assert main(["info", str(robot_file)]) == 1
    output, errors = capsys.readouterr()
    assert output == ""
    assert errors.startswith("carom: ")
    assert complaint in errors
    assert len(errors.splitlines()) == 1


def test_a_directory_is_no_robot_file(tmp_path, capsys):
    assert main(["info", str(tmp_path)]) == 1
    assert capsys.readouterr().err.startswith("carom: ")


@pytest.mark.parametrize("words", [[], ["dance"], ["info"], ["info", "a.urdf", "--scale", "-1"]])
def test_a_command_that_is_not_understood_exits_with_2(words, capsys):
    with pytest.raises(SystemExit) as stop:
        main(words)
    assert stop.value.code == 2
    assert "usage: carom" in capsys.readouterr().err


def test_version(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out.strip() == f"carom {__version__}"


def test_warmup_says_when_it_is_done(capsys):
    assert main(["warmup"]) == 0
    assert "kernels are ready" in capsys.readouterr().out


def test_check_takes_arguments_of_xacro(tmp_path, capsys):
    file = tmp_path / "r.xacro"
    file.write_text(
        '<robot name="r" xmlns:xacro="x"><xacro:arg name="two" default="false"/><link name="a"/>'
        '<xacro:if value="$(arg two)"><link name="b"/><joint name="j" type="continuous"><parent link="a"/>'
        '<child link="b"/></joint></xacro:if></robot>'
    )
    assert main(["check", str(file)]) == 0
    assert "0 movable joints" in capsys.readouterr().out
    assert main(["check", "--xacro-arg", "two=true", str(file)]) == 0
    assert "1 movable joint\n" in capsys.readouterr().out
