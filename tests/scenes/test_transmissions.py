"""Transmissions of URDF files are motors behind a reduction, and rotors add to the inertia of joints."""

import pytest
from numpy.testing import assert_allclose

from carom import World

LINK = '<inertial><mass value="2"/><inertia ixx=".5" ixy="0" ixz="0" iyy=".5" iyz="0" izz=".25"/></inertial>'
SIMPLE = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="j"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
<actuator name="motor"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>"""


@pytest.fixture
def load(tmp_path):
    with World() as world:

        def load(rest="", in_joint="", shape="", **choices):
            (tmp_path / "file.urdf").write_text(
                f'<robot name="r" xmlns:drake="x"><link name="a">{LINK}</link>'
                f'<link name="b">{LINK}{shape}</link>'
                '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
                f'<limit lower="-9" upper="9" effort="100" velocity="9"/>{in_joint}</joint>{rest}</robot>'
            )
            return world.load(tmp_path / "file.urdf", fixed_base=True, **choices)

        yield load


def test_a_transmission_is_a_motor_with_a_gear(load):
    scene = load(SIMPLE, strict=True)
    motor = scene.actuators["motor"]
    assert (motor.joint.name, motor.gear, motor.force_range) == ("j", 50.0, (-2.0, 2.0))
    motor.control = 0.1
    scene.world.step(10)
    assert_allclose(motor.joint.velocity, 10 * 50 * 0.1 / 0.25 * scene.world.parameters.time_step, rtol=1e-12)
    motor.control = 7.0
    scene.world.step()
    assert motor.force == pytest.approx(2.0)


def test_without_a_reduction_the_motor_is_direct(load):
    scene = load(SIMPLE.replace("<mechanicalReduction>50</mechanicalReduction>", ""))
    assert scene.actuators["motor"].gear == 1.0


def test_other_transmissions_are_reported(load):
    scene = load(SIMPLE.replace("SimpleTransmission", "DifferentialTransmission"))
    assert not scene.actuators
    (lost,) = scene.ignored.that_matter
    assert lost.element == "robot/transmission"
    assert "simple transmissions" in lost.reason


def test_a_transmission_of_an_unknown_joint_is_reported(load):
    (lost,) = load(SIMPLE.replace('<joint name="j"', '<joint name="k"')).ignored.that_matter
    assert (lost.consequence, lost.reason) == ("nothing is driven by it", "there is no joint 'k'")


def test_rotors_add_to_the_inertia_of_joints(load):
    rotor = '<drake:rotor_inertia value="1e-4"/><drake:gear_ratio value="100"/>'
    scene = load(SIMPLE, rotor, strict=True)
    assert scene[0].joints["j"].armature == pytest.approx(1.0)
    scene.actuators["motor"].control = 1.0
    scene.world.step()
    assert_allclose(scene[0].joints["j"].velocity, 50 / 1.25 * scene.world.parameters.time_step, rtol=1e-12)


def test_capsules_of_drake_are_capsules(load):
    shape = '<collision><geometry><drake:capsule radius=".1" length=".5"/></geometry></collision>'
    (collision,) = load(shape=shape, strict=True)[0].spec.links[0].collisions
    assert (collision.geometry.radius, collision.geometry.length) == (0.1, 0.5)
