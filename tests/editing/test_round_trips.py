"""Files that are read and written again have the same dynamics, to 1e-12."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from tests.editing.motion import assert_same_dynamics
from tests.mjcf_dynamics.dynamics_cases import DYNAMICS
from tests.mjcf_files.cases import ball, camera, compiled, driven, polygon, sensor, soft, tendon, term
from tests.rings import few

import carom
from carom import World
from carom.cli.command_line import main
from carom.cli.convert import convert
from carom.errors import DescriptionError

ROOT = Path(__file__).parents[2]
DATA = ROOT / "src" / "pybullet_data"
CASES = {
    f"{module.__name__.rpartition('.')[2]} {name}": text
    for module in (ball, camera, compiled, driven, polygon, sensor, soft, tendon, term)
    for table in vars(module).values()
    if isinstance(table, dict)
    for name, text in table.items()
    if isinstance(text, str) and "<mujoco" in text
} | {f"dynamics {name}": text for name, text in DYNAMICS.items()}
MJCFS = [path for path in sorted((DATA / "mjcf").glob("*.xml")) if path.stem != "humanoid_fixed"]
# Soft bodies, and links with moments that no body has.
APART = {"reduced_cube", "deform_cube", "reduced_torus", "torus_deform"}
ODD = {"TwoJointRobot_w_fixedJoints", "TwoJointRobot_wo_fixedJoints", "spherical_joint_limit"}
URDFS = [path for path in sorted(DATA.rglob("*.urdf")) if path.stem not in APART | ODD]
SHORT = [DATA / name for name in ("r2d2.urdf", "franka_panda/panda.urdf", "xarm/xarm6_with_gripper.urdf")]
NAMED = ("sensors", "actuators", "tendons", "sites", "cameras", "keyframes", "constraints")


def load(path):
    world = World()
    try:
        scene = world.load(path)
    except DescriptionError:
        pytest.skip("it cannot be loaded")
    world.gravity = (0.0, 0.0, -9.81)
    return scene


def assert_same_scene(first, second):
    assert_same_dynamics(first.bodies, second.bodies)
    for what in NAMED:
        ones, others = getattr(first, what), getattr(second, what)
        assert len(ones) == len(others), what
        if all("_" not in name for name in ones):
            # Names that the reader makes up have underscores.
            assert set(ones) == set(others), what
    assert first.options == second.options
    lost = [
        {(it.element, it.attributes, it.consequence) for it in scene.ignored.that_matter}
        for scene in (first, second)
    ]
    assert lost[0] == lost[1]


@pytest.mark.parametrize("name", few(list(CASES), 30))
def test_mjcf_files_are_written_as_they_are(name, tmp_path):
    source, target = tmp_path / "file.xml", tmp_path / "again" / "file.xml"
    source.write_text(CASES[name])
    scene = load(source)
    target.parent.mkdir()
    carom.read(source).write(target)
    assert_same_scene(scene, load(target))


@pytest.mark.parametrize("path", few(MJCFS, 5), ids=lambda path: path.stem)
def test_shipped_mjcf_files_are_written_as_they_are(path, tmp_path):
    scene = load(path)
    assert not carom.read(path).write(tmp_path / "file.xml")
    assert_same_scene(scene, load(tmp_path / "file.xml"))


@pytest.mark.parametrize(
    "path", [*SHORT, *few([it for it in URDFS if it not in SHORT], 5)], ids=lambda path: path.stem
)
def test_urdf_files_move_alike_as_mjcf(path, tmp_path):
    scene = load(path)
    description = carom.read(path)
    description.write(tmp_path / "file.xml")
    again = load(tmp_path / "file.xml")
    assert_same_dynamics(scene.bodies, again.bodies)
    for body in scene.bodies:
        for joint in body.joints:
            if joint.name in again.bodies[0].joints.names:
                other = again.bodies[0].joints[joint.name]
                assert other.damping == joint.damping
                assert other.limits == joint.limits
    # And back.
    description.write(tmp_path / "file.urdf")
    assert_same_dynamics(scene.bodies, load(tmp_path / "file.urdf").bodies)


ARM = """<mujoco><worldbody><body name="a" pos="0 0 1"><joint name="j" axis="0 1 0" range="-30 60"
 damping=".3" frictionloss=".2"/><geom type="capsule" size=".05" fromto="0 0 0 .5 0 .1"/>
 <body name="b" pos=".5 0 .1" euler="10 20 30"><joint name="k" type="slide" axis="1 0 1" range="0 .2"/>
 <joint name="l" pos="0 .1 0" axis="0 0 1"/><geom type="ellipsoid" size=".1 .2 .05"/></body></body>
</worldbody><equality><joint name="e" joint1="l" joint2="j" polycoef=".1 2 0 0 0"/></equality></mujoco>"""


def test_mjcf_becomes_urdf_where_that_can_say_it(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    lost = carom.read(tmp_path / "arm.xml").write(tmp_path / "arm.urdf")
    assert [(one.element, one.consequence) for one in lost] == [
        ("shape", "its facets are in its place, by their hull")
    ]
    first, second = load(tmp_path / "arm.xml"), load(tmp_path / "arm.urdf")
    assert_same_dynamics(first.bodies, second.bodies)
    for name in ("j", "k", "l"):
        one, other = first.bodies[0].joints[name], second.bodies[0].joints[name]
        assert one.limits == pytest.approx(other.limits, rel=1e-15)
        assert one.damping == other.damping
        assert one.friction_loss == other.friction_loss
    assert (tmp_path / "arm_meshes" / "b_0.obj").exists(), "an ellipsoid is a mesh"
    text = (tmp_path / "arm.urdf").read_text()
    assert '<mimic joint="j" multiplier="2.0" offset="0.1"/>' in text


FULL = """<mujoco><option gravity="0 0 -5"/><worldbody><geom type="plane" size="1 1 1"/>
<body name="a" pos="0 0 1" gravcomp="1"><joint name="j" axis="0 1 0" armature=".1" stiffness="2" ref="20"
 solreflimit=".1 1" range="-30 30"/><geom size=".1" contype="2" solref=".1 1"/>
 <site name="s"/><camera name="c"/>
 <body name="b" pos=".5 0 0"><joint name="ball" type="ball" range="0 30"/><geom size=".1"/></body></body>
<body name="free"><joint type="free" damping="1"/><geom size=".1"/></body></worldbody>
<contact><exclude body1="a" body2="free"/></contact>
<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="m" joint="j"/></actuator>
<sensor><clock name="k"/></sensor><equality><joint joint1="j" polycoef="0 1 2 0 0"/>
<weld body1="b" body2="free"/></equality><keyframe><key name="home"/></keyframe></mujoco>"""


def test_all_that_urdf_cannot_say_is_reported(tmp_path):
    (tmp_path / "full.xml").write_text(FULL)
    description = carom.read(tmp_path / "full.xml")
    with pytest.raises(DescriptionError, match=r"several robots fit; it holds 0 world \(world\), 1 a"):
        description.write(tmp_path / "full.urdf")
    lost = description.write(tmp_path / "full.urdf", model="a")
    assert {(it.element, it.attributes) for it in lost} >= {
        ("body of the world", ()), ("actuator", ()), ("sensor", ()), ("equality", ()), ("tendon", ()),
        ("site", ()), ("camera", ()), ("keyframe", ()), ("contact/exclude", ()), ("option", ()),
        ("joint", ("armature",)), ("joint", ("stiffness",)), ("joint", ("ref",)), ("joint", ("range",)),
        ("joint", ("type",)), ("joint", ("solreflimit",)), ("geom", ("solref",)), ("body", ("gravcomp",)),
        ("geom", ("contype", "conaffinity")), ("equality/joint", ()),
    }  # fmt: skip
    assert "world, free" in str(lost)
    lost = description.write(tmp_path / "free.urdf", model="free")
    assert ("joint", ("damping",)) in {(it.element, it.attributes) for it in lost}
    with pytest.raises(ValueError, match=r"ends in none of \.xml, \.mjcf, \.urdf, \.usd"):
        description.write(tmp_path / "full.step")
    with pytest.raises(ValueError, match="MJCF files have all robots"):
        description.write(tmp_path / "again.xml", model="a")


ROBOT = """<robot name="r"><link name="world"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0"
 izz="9"/></inertial>
 <collision><geometry><cylinder radius=".1" length=".4"/></geometry></collision>
 <contact><lateral_friction value=".3"/><stiffness value="5"/><damping value="1"/></contact></link>
<link name="b"><inertial><mass value="1"/><origin xyz="0 0 .1"/>
 <inertia ixx=".1" ixy=".01" ixz="0" iyy=".1" iyz="0" izz=".1"/></inertial></link><link name="c"/>
<joint name="j" type="revolute"><parent link="world"/><child link="a"/><origin xyz="0 0 1" rpy="0 .3 0"/>
 <axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="7" velocity="3"/>
 <dynamics damping=".2" friction=".1"/></joint>
<joint name="k" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><mimic joint="j"
 multiplier="2" offset=".5"/></joint>
<joint name="f" type="fixed"><parent link="b"/><child link="c"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="j">
<hardwareInterface>EffortJointInterface</hardwareInterface></joint><actuator name="motor">
<mechanicalReduction>3</mechanicalReduction></actuator></transmission></robot>"""


def test_a_urdf_file_says_all_this_as_mjcf(tmp_path):
    (tmp_path / "r.urdf").write_text(ROBOT)
    description = carom.read(tmp_path / "r.urdf")
    joint = description.joints["j"].attributes
    assert (joint["range"], joint["damping"], joint["frictionloss"]) == ("-1 2", "0.2", "0.1")
    assert joint["actuatorfrcrange"] == "-7 7"
    assert description.equalities["k"]["polycoef"] == "0.5 2 0 0 0"
    assert description.geoms == {}
    assert "world" not in description.bodies
    assert 'friction="0.3 0.005 0.0001"' in description.text()
    scene = World().load(description)
    assert scene.actuators["motor"].spec.gear == 3.0
    assert [body.name for body in scene] == ["world", "a"]
    said = {(it.element, it.attributes): it.consequence for it in description.ignored}
    assert said["link/inertial", ("inertia",)] == "the moments of 'a' are their mean, about all axes"
    assert ("link/contact", ("stiffness",)) in said
    assert ("joint/limit", ("velocity",)) in said
    fixed = carom.read(DATA / "r2d2.urdf", fixed_base=True)
    assert World().load(fixed).bodies[0].fixed_base


def test_the_command_converts_between_formats(tmp_path, capsys):
    (tmp_path / "r.urdf").write_text(ROBOT)
    assert main(["convert", str(tmp_path / "r.urdf"), str(tmp_path / "r.xml")]) == 0
    printed = capsys.readouterr().out
    assert "r.xml does not say all that" in printed
    assert "MJCF has other terms" in printed
    assert main(["convert", str(tmp_path / "r.xml"), str(tmp_path / "again.urdf"), "--model", "a"]) == 0
    assert main(["convert", str(tmp_path / "r.xml"), str(tmp_path / "again.xml")]) == 0
    assert capsys.readouterr().out.count("does not say all") == 1
    assert_same_dynamics(load(tmp_path / "r.xml").bodies, load(tmp_path / "again.xml").bodies)
    sdf = ROOT / "tests" / "formats" / "data" / "sdf" / "arm.sdf"
    convert(sdf, tmp_path / "arm.xml")
    assert_same_dynamics(load(sdf).bodies, load(tmp_path / "arm.xml").bodies)
    assert main(["convert", str(tmp_path / "r.xml"), str(tmp_path / "x.xml"), "--model", "a"]) == 1
    (tmp_path / "saved.world").write_bytes(b"\x89CAROM")
    assert main(["convert", str(tmp_path / "saved.world"), str(tmp_path / "x.xml")]) == 1


def test_usd_stages_become_mjcf(tmp_path):
    pytest.importorskip("pxr")
    convert(DATA / "kuka_iiwa" / "model.urdf", tmp_path / "arm.usda")
    convert(tmp_path / "arm.usda", tmp_path / "arm.xml")
    assert_same_dynamics(load(tmp_path / "arm.usda").bodies, load(tmp_path / "arm.xml").bodies)
    convert(tmp_path / "arm.xml", tmp_path / "back.usda")
    assert_same_dynamics(load(tmp_path / "arm.usda").bodies, load(tmp_path / "back.usda").bodies)


MUJOCO = Path(os.environ.get("CAROM_MUJOCO", ROOT / ".mujoco" / "bin" / "python"))
BY_MUJOCO = [
    *(f"compiled {name}" for name in ("tree", "copies", "balanced")), "driven general", "tendon spatial",
    "dynamics free body with armature", "dynamics ball with a slanting capsule",
]  # fmt: skip


@pytest.mark.skipif(not MUJOCO.exists(), reason="`make .mujoco/mujoco` installs MuJoCo for it")
def test_mujoco_reads_the_same_from_what_is_written(tmp_path):
    pairs = []
    stated = [name for name in BY_MUJOCO if name in CASES]
    assert len(stated) > 4
    for number, name in enumerate(stated):
        source = tmp_path / f"{number}.xml"
        source.write_text(CASES[name])
        pairs.append((source, tmp_path / f"{number}_again.xml"))
    for name in ("ant", "humanoid", "walker2d", "half_cheetah", "pusher"):
        pairs.append((DATA / "mjcf" / f"{name}.xml", tmp_path / f"{name}.xml"))
    for source, target in pairs:
        carom.read(source).write(target)
    for name in ("kuka_iiwa/model", "franka_panda/panda", "cartpole"):
        # MuJoCo's own reading of URDF leaves out what is fixed; Carom's is compared with what it writes.
        first, second = tmp_path / f"{Path(name).name}_1.xml", tmp_path / f"{Path(name).name}_2.xml"
        carom.read(DATA / f"{name}.urdf").write(first)
        carom.read(first).write(second)
        pairs.append((first, second))
    script = ROOT / "tests" / "editing" / "ask_mujoco_twice.py"
    names = json.dumps([[str(one), str(other)] for one, other in pairs])
    answer = subprocess.run([MUJOCO, script], input=names, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    found = json.loads(answer.stdout)
    assert len(found) == len(pairs)
    for (source, _), differences in zip(pairs, found, strict=True):
        assert max(differences.values()) < 1e-9, (source, differences)


@pytest.mark.skipif(not MUJOCO.exists(), reason="`make .mujoco/mujoco` installs MuJoCo for it")
def test_mujoco_moves_urdf_robots_as_carom_does(tmp_path):
    import numpy as np
    from tests.editing.motion import joints_of

    from carom import algorithms

    path = DATA / "kuka_iiwa" / "model.urdf"
    carom.read(path, fixed_base=True).write(tmp_path / "arm.xml")
    world = World()
    arm = world.load(path, fixed_base=True)[0]
    world.gravity = (0.0, 0.0, -9.81)
    rng = np.random.default_rng(5)
    positions, velocities = rng.normal(size=7), rng.normal(size=7)
    asked = json.dumps([[str(tmp_path / "arm.xml"), positions.tolist(), velocities.tolist()]])
    script = ROOT / "tests" / "editing" / "ask_mujoco_twice.py"
    answer = subprocess.run(
        [MUJOCO, script, "state"], input=asked, capture_output=True, text=True, check=True
    )
    matrix, bias = (np.array(each) for each in json.loads(answer.stdout)[0])
    assert len(joints_of(arm)) == 7
    np.testing.assert_allclose(algorithms.mass_matrix(arm, positions), matrix, rtol=0, atol=1e-9)
    np.testing.assert_allclose(algorithms.bias_forces(arm, positions, velocities), bias, rtol=0, atol=1e-9)
