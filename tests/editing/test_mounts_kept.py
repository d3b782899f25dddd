"""Sites, sensors, cameras and rotors of SDF files in descriptions, and what is written of them."""

import numpy as np
import pytest

import carom
from carom import World

_LINKS = """<link name="l"><pose>0 0 1 0 0 0</pose><inertial><mass>2</mass></inertial>
<collision name="c"><geometry><box><size>.2 .2 .2</size></box></geometry></collision>
<sensor name="imu" type="imu"><pose>.1 0 0 0 0 .3</pose><update_rate>100</update_rate></sensor>
<sensor name="cam" type="camera"><pose>0 .1 0 0 .2 0</pose><camera><horizontal_fov>1.2</horizontal_fov>
<image><width>64</width><height>48</height></image></camera></sensor>
<sensor name="ray" type="ray"><pose>0 0 -.2 0 1.5707963267948966 0</pose><ray><range><max>{reach}</max>
</range></ray></sensor><sensor name="alt" type="altimeter"/><sensor name="mag" type="magnetometer"/>
<sensor name="nav" type="navsat"/><sensor name="touch" type="contact"/></link>
<link name="k"><pose>0 0 1.5 0 0 0</pose><inertial><mass>1</mass></inertial></link>
<joint name="j" type="revolute"><parent>l</parent><child>k</child><axis><xyz>0 1 0</xyz></axis>
<sensor name="ft" type="force_torque"/></joint>"""
MODEL = f'<sdf version="1.9"><model name="m">{_LINKS}</model></sdf>'
WORLD = f"""<sdf version="1.9"><world name="w"><gravity>0 0 -3</gravity><magnetic_field>1e-5 2e-5 3e-5
</magnetic_field><physics type="ode"><max_step_size>.004</max_step_size></physics>
<model name="one">{_LINKS}</model><model name="two"><pose>3 0 0 0 0 0</pose>{_LINKS}</model></world></sdf>"""
SENSORS = [
    "imu/acceleration", "imu/angular_velocity", "imu/orientation", "ray/distance", "alt/position",
    "alt/velocity", "mag/field", "nav/position", "nav/velocity", "touch/force", "ft/force", "ft/torque",
]  # fmt: skip


def written(tmp_path, text):
    """The file, and what its description writes as MJCF."""
    (tmp_path / "m.sdf").write_text(text)
    description = carom.read(tmp_path / "m.sdf")
    description.write(tmp_path / "m.xml")
    return tmp_path / "m.sdf", tmp_path / "m.xml", description


def readings(path, *, falls=True):
    with World() as world:
        scene = world.load(path)
        world.time_step = 0.002
        if falls:
            world.gravity = (0.0, 0.0, -9.81)
        world.step(100)
        return {name: np.array(sensor.read()) for name, sensor in scene.sensors.items()}, scene.cameras


def test_sensors_and_cameras_of_sdf_read_the_same_once_written_as_mjcf(tmp_path):
    source, target, description = written(tmp_path, MODEL.format(reach=100000))
    assert not [it for it in description.ignored.that_matter if it.element == "link/sensor" and it.count > 1]
    (before, cameras), (after, others) = readings(source), readings(target)
    assert list(before) == list(after) == SENSORS
    for name, value in before.items():
        np.testing.assert_allclose(after[name], value, atol=1e-9, err_msg=name)
    assert before["alt/velocity"][2] == pytest.approx(-1.962)
    assert list(cameras) == list(others) == ["cam"]
    np.testing.assert_allclose(others["cam"].frame.orientation, cameras["cam"].frame.orientation, atol=1e-12)
    assert others["cam"].field_of_view == pytest.approx(cameras["cam"].field_of_view)
    assert others["cam"].resolution == (64, 48)


def test_sensors_of_two_models_have_the_prefixes_of_these(tmp_path):
    _, target, _ = written(tmp_path, WORLD.format(reach=1000))
    with World() as world:
        scene = world.load(target)
        assert scene.options["gravity"] == (0.0, 0.0, -3.0)
        assert world.time_step == 0.004
        assert "two/imu/acceleration" in scene.sensors
        np.testing.assert_allclose(scene.sensors["two/alt/position"].read(), [3.0, 0.0, 1.0], atol=1e-12)
        np.testing.assert_allclose(scene.sensors["one/mag/field"].read(), [1e-5, 2e-5, 3e-5])


def test_what_mjcf_cannot_say_of_a_sensor_is_reported(tmp_path):
    text = MODEL.format(reach=5).replace(
        "<update_rate>",
        "<imu><angular_velocity><x><noise type='gaussian'><mean>.1</mean><stddev>.2</stddev></noise></x>"
        "</angular_velocity></imu><update_rate>",
    )
    _, _, description = written(tmp_path, text)
    told = {(it.attributes, it.consequence) for it in description.ignored if it.element == "sensor"}
    assert told == {
        (("noise",), "'imu/angular_velocity' has none"),
        (("bias",), "'imu/angular_velocity' has none"),
        (("reach",), "'ray/distance' sees farther"),
    }


def test_rotors_push_at_their_sites_once_written(tmp_path):
    rotor = """<plugin filename="gz-sim-multicopter-motor-model-system"
    name="gz::sim::systems::MulticopterMotorModel"><jointName>j</jointName><linkName>k</linkName>
    <turningDirection>ccw</turningDirection><maxRotVelocity>800</maxRotVelocity><motorConstant>1e-5
    </motorConstant><momentConstant>.01</momentConstant><motorType>velocity</motorType></plugin></model>"""
    source, target, _ = written(tmp_path, MODEL.format(reach=1000).replace("</model>", rotor))
    speeds = []
    for path in (source, target):
        with World() as world:
            scene = world.load(path)
            world.gravity = (0.0, 0.0, 0.0)
            world.time_step = 0.002
            (actuator,) = scene.actuators.values()
            actuator.control = 700.0
            world.step(50)
            speeds.append(scene[0].velocity.linear.tolist())
    assert max(map(abs, speeds[0])) > 0.01
    np.testing.assert_allclose(speeds[1], speeds[0], rtol=1e-6)
