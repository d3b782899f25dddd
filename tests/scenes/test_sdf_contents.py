"""What SDF files say about masses, surfaces, joints, sensors and plugins, and its defaults."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from carom import World
from carom.errors import DescriptionError
from carom.world.scene import Scene

UNIT = "<inertial/>"
HELD = '<joint name="held" type="fixed"><parent>world</parent><child>a</child></joint>'


def load(tmp_path: Path, inside: str, **options) -> Scene:
    file = tmp_path / "m.sdf"
    file.write_text(f'<sdf version="1.11"><model name="m">{inside}</model></sdf>')
    return World().load(file, **options)


def link(name: str, inside: str = UNIT, pose: str = "0 0 0 0 0 0") -> str:
    return f'<link name="{name}"><pose>{pose}</pose>{inside}</link>'


def joint(kind: str, inside: str = "", parent: str = "a", child: str = "b") -> str:
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<joint name="j" type="{kind}">{ends}{inside}</joint>'


def collision(shape: str, inside: str = "") -> str:
    return f'<collision name="c"><geometry>{shape}</geometry>{inside}</collision>'


@pytest.mark.parametrize(
    ("stated", "mass", "moments"),
    [
        ("<inertial/>", 1, (1, 1, 1)),
        ("<inertial><mass>3</mass></inertial>", 3, (1, 1, 1)),
        ("<inertial><inertia><iyy>0.9</iyy></inertia></inertial>", 1, (1, 0.9, 1)),
    ],
)
def test_inertia_that_is_not_stated_is_one(tmp_path: Path, stated: str, mass: float, moments):
    found = load(tmp_path, link("a", stated), strict=True)[0].dynamics(-1)
    assert found.mass == mass
    assert_allclose(sorted(found.inertia), sorted(moments), atol=1e-12)


SQUARE = "".join(f"<point>{x} {y}</point>" for x, y in ((0, 0), (2, 0), (2, 1), (0, 1)))


@pytest.mark.parametrize(
    ("shape", "volume", "moments"),
    [
        ("<box><size>1 2 3</size></box>", 6, (13 / 12, 10 / 12, 5 / 12)),
        ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", 8 * math.pi, (13 / 5, 10 / 5, 5 / 5)),
        ("<cone><radius>2</radius><length>3</length></cone>", 4 * math.pi, (0.9375, 0.9375, 1.2)),
        (f"<polyline>{SQUARE}<height>3</height></polyline>", 6, (10 / 12, 13 / 12, 5 / 12)),
    ],
)
def test_automatic_inertia(tmp_path: Path, shape: str, volume: float, moments):
    density = "<density>10</density>"
    inside = f'<inertial auto="true"/>{collision(shape, density)}'
    found = load(tmp_path, link("a", inside))[0].dynamics(-1)
    assert found.mass == pytest.approx(10 * volume, rel=1e-12)
    assert_allclose(sorted(found.inertia), sorted(10 * volume * np.array(moments)), rtol=1e-9)


def test_a_stated_mass_scales_automatic_inertia(tmp_path: Path):
    inside = f'<inertial auto="true"><mass>2</mass></inertial>{collision("<box/>")}'
    found = load(tmp_path, link("a", inside))[0].dynamics(-1)
    assert found.mass == 2
    assert_allclose(found.inertia, [2 / 6] * 3, rtol=1e-12)


def test_an_outline_collides_as_it_is(tmp_path: Path):
    """A ball falls into the notch of an L, which its hull would close."""
    corners = ((0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4))
    points = "".join(f"<point>{x} {y}</point>" for x, y in corners)
    outline = link("l", collision(f"<polyline>{points}<height>1</height></polyline>"))
    scene = load(tmp_path, f"<static>true</static>{outline}")
    ball = tmp_path / "ball.sdf"
    shape = collision("<sphere><radius>0.4</radius></sphere>")
    ball.write_text(f'<sdf version="1.9"><model name="b">{link("b", UNIT + shape)}</model></sdf>')
    (body,) = scene.world.load(ball, position=(2, 2.5, 0.5))
    scene.world.gravity = (0, -10, 0)
    scene.world.step(300)
    assert body.links[-1].pose.position[1] == pytest.approx(1.4, abs=0.01)


def test_terrain_of_an_image(tmp_path: Path):
    heights = np.zeros((5, 5), np.uint8)
    heights[:, 3:] = 255
    Image.fromarray(heights).save(tmp_path / "t.png")
    shape = "<heightmap><uri>t.png</uri><size>8 8 2</size></heightmap>"
    scene = load(tmp_path, f"<static>true</static>{link('l', collision(shape))}")
    for x, expected in ((-3, 0.0), (3, 2.0)):
        hit = scene.world.queries().ray_tuple((x, 0.5, 10.0), (x, 0.5, -10.0))
        assert hit[3][2] == pytest.approx(expected, abs=1e-6)


def test_surfaces(tmp_path: Path):
    friction = "<friction><ode><mu>0.3</mu><mu2>0.3</mu2></ode></friction>"
    bounce = "<bounce><restitution_coefficient>0.5</restitution_coefficient></bounce>"
    springs = "<contact><ode><kp>1e5</kp><kd>20</kd></ode></contact>"
    surface = f"<surface>{friction}{bounce}{springs}</surface>"
    stated = load(tmp_path, link("a", UNIT + collision("<box/>", surface)), strict=True)
    found = stated[0].dynamics(-1)
    assert (found.lateral_friction, found.restitution) == (0.3, 0.5)
    assert (found.contact_stiffness, found.contact_damping) == (1e5, 20)
    assert load(tmp_path, link("a", UNIT + collision("<box/>")))[0].dynamics(-1).lateral_friction == 1.0
    two = surface.replace("<mu2>0.3", "<mu2>0.4")
    scene = load(tmp_path, link("a", UNIT + collision("<box/>", two)))
    assert [it.consequence for it in scene.ignored] == ["<mu> is the friction in all directions"]
    endless = surface.replace("0.3", "-1")
    scene = load(tmp_path, link("a", UNIT + collision("<box/>", endless)))
    assert scene[0].dynamics(-1).lateral_friction == 1.0
    assert {it.consequence for it in scene.ignored} == {"friction is 1"}


def test_gravity_of_a_link(tmp_path: Path):
    scene = load(tmp_path, link("a", f"<gravity>false</gravity>{UNIT}"))
    scene.world.gravity = (0, 0, -10)
    scene.world.step(20)
    assert abs(scene[0].links[-1].pose.position[2]) < 1e-12


def test_a_joint_away_from_its_link_leaves_the_frame_of_the_link(tmp_path: Path):
    at = '<pose relative_to="__model__">0 0 1.5 0 0 0</pose><axis><xyz>0 1 0</xyz></axis>'
    scene = load(
        tmp_path, link("a", pose="0 0 1 0 0 0") + link("b", pose="0 0 1.2 0 0 0") + joint("revolute", at)
    )
    body = scene[0]
    assert_allclose([it.pose.position[2] for it in (body.links["a"], body.links["b"])], (1, 1.2), atol=1e-12)
    body.joints["j"].reset(math.pi / 2)
    assert_allclose(body.links["b"].pose.position, (-0.3, 0, 1.5), atol=1e-12)
    along = "<pose>0 0.7 0 0 0 0</pose><axis><xyz>0 1 0</xyz></axis>"
    names = [it.name for it in load(tmp_path, link("a") + link("b") + joint("revolute", along))[0].links]
    assert names == ["a", "b"]


def test_a_joint_with_two_axes(tmp_path: Path):
    dynamics = "<dynamics><damping>2</damping></dynamics>"
    axes = f"<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz>{dynamics}</axis2>"
    body = load(tmp_path, HELD + link("a") + link("b") + joint("universal", axes), strict=True)[0]
    assert body.joints["j@axis2"].damping == 2
    body.joints["j"].reset(0.4)
    body.joints["j@axis2"].reset(0.3)
    first = np.array((math.sin(0.2), 0, 0, math.cos(0.2)))
    second = np.array((0, math.sin(0.15), 0, math.cos(0.15)))
    product = (
        first[0] * second[3], first[3] * second[1], first[0] * second[1], first[3] * second[3],
    )  # fmt: skip
    assert_allclose(body.links["b"].pose.orientation, product, atol=1e-12)


@pytest.mark.parametrize(
    ("pitch", "expected"),
    [
        ("<screw_thread_pitch>0.5</screw_thread_pitch>", 0.5 / (2 * math.pi)),
        ("<thread_pitch>-4</thread_pitch>", 0.25),
    ],
)
def test_a_screw_goes_along_as_it_turns(tmp_path: Path, pitch: str, expected: float):
    parts = link("a") + link("b") + joint("screw", pitch + "<axis><xyz>0 0 1</xyz></axis>")
    body = load(tmp_path, HELD + parts, strict=True)[0]
    for _ in range(60):
        body.joints["j"].set_torque(1.0)
        body.world.step()
    turned = body.joints["j"].position
    assert turned > 0.01
    assert body.links["b"].pose.position[2] == pytest.approx(expected * turned, rel=1e-5)
    # The force moves a mass of 1 kg along and turns 1 kg m².
    time = 60 / 240
    assert turned == pytest.approx(0.5 * time * time / (1 + expected**2), rel=0.03)


def test_a_mimic(tmp_path: Path):
    follow = (
        '<mimic joint="j"><multiplier>2</multiplier><offset>1</offset><reference>0.25</reference></mimic>'
    )
    second = joint("revolute", f"<axis><xyz>0 0 1</xyz>{follow}</axis>", "b", "c").replace(
        '"j" type', '"k" type'
    )
    body = load(tmp_path, link("a") + link("b") + link("c") + joint("revolute") + second, strict=True)[0]
    assert body.joints["k"].position == pytest.approx(0.5)


SENSOR = '<sensor name="s" type="{}">{}</sensor>'


def test_an_inertial_measurement_unit(tmp_path: Path):
    noise = '<noise type="gaussian"><mean>0.5</mean><stddev>0</stddev></noise>'
    imu = f"<imu><angular_velocity><z>{noise}</z></angular_velocity></imu>"
    held = "<static>true</static>" + link("a", UNIT + SENSOR.format("imu", imu))
    scene = load(tmp_path, held, strict=True)
    scene.world.gravity = (0, 0, -9.8)
    scene.world.step(2)
    assert_allclose(scene.sensors["s/acceleration"].read(), (0, 0, 9.8), atol=1e-9)
    assert_allclose(scene.sensors["s/angular_velocity"].read(), (0, 0, 0.5), atol=1e-12)
    assert_allclose(scene.sensors["s/orientation"].read(), (0, 0, 0, 1), atol=1e-12)


def test_a_force_sensor_of_a_joint_and_a_contact_sensor(tmp_path: Path):
    way = "<force_torque><measure_direction>parent_to_child</measure_direction></force_torque>"
    hung = joint("fixed", SENSOR.format("force_torque", way))
    touching = UNIT + collision("<sphere><radius>0.5</radius></sphere>") + SENSOR.format("contact", "")
    scene = load(
        tmp_path, "<static>true</static>" + link("a") + link("b", touching.replace('"s"', '"t"')) + hung
    )
    scene.world.gravity = (0, 0, -10)
    scene.world.step(2)
    assert_allclose(scene.sensors["s/force"].read(), (0, 0, 10), atol=1e-9)
    assert scene.sensors["t/force"].read() == [0.0]


def test_a_range_finder_looks_along_its_ray(tmp_path: Path):
    angles = "<samples>1</samples><min_angle>1.5707963267948966</min_angle>"
    lidar = f"<lidar><scan><horizontal>{angles}</horizontal></scan><range><max>9</max></range></lidar>"
    wall = link("w", collision("<box><size>1 1 1</size></box>"), "0 4 0 0 0 0")
    scene = load(
        tmp_path, "<static>true</static>" + wall + link("a", UNIT + SENSOR.format("gpu_lidar", lidar))
    )
    scene.world.step()
    assert scene.sensors["s/distance"].read() == pytest.approx(3.5)
    many = lidar.replace("<samples>1", "<samples>640")
    scene = load(tmp_path, link("a", UNIT + SENSOR.format("gpu_lidar", many)))
    assert not scene.sensors
    assert [it.element for it in scene.ignored.that_matter] == ["link/sensor"]


def test_a_camera_looks_along_x(tmp_path: Path):
    image = "<image><width>64</width><height>32</height></image>"
    camera = f"<camera><horizontal_fov>1.5</horizontal_fov>{image}</camera>"
    wall = link("w", collision("<box><size>1 9 9</size></box>"), "4 0 0 0 0 0")
    inside = UNIT + SENSOR.format("depth_camera", camera)
    scene = load(tmp_path, "<static>true</static>" + wall + link("a", inside))
    it = scene.cameras["s"]
    assert it.resolution == (64, 32)
    assert it.field_of_view == pytest.approx(2 * math.degrees(math.atan(math.tan(0.75) / 2)))
    x, y, z, w = scene.camera("s").pose[1]
    # The axis z of the image, along which it looks, is x of the link.
    assert_allclose(
        (2 * (x * z + w * y), 2 * (y * z - w * x), w * w + z * z - x * x - y * y), (1, 0, 0), atol=1e-12
    )


def test_plugins_that_are_actuators(tmp_path: Path):
    servo = "<joint_name>j</joint_name><p_gain>30</p_gain><i_gain>0</i_gain><d_gain>2</d_gain>"
    servo += "<cmd_max>9</cmd_max>"
    plugins = f'<plugin filename="p" name="gz::sim::systems::JointPositionController">{servo}</plugin>'
    plugins += '<plugin filename="p" name="gz::sim::systems::Breadcrumbs"/>'
    scene = load(tmp_path, link("a") + link("b") + joint("revolute") + plugins)
    spec = scene.actuators["j"].spec
    assert (spec.gain, spec.bias) == ((30, 0, 0), (0, -30, -2))
    assert spec.force_range == (-math.inf, 9)
    assert [it.element for it in scene.ignored.that_matter] == ["model/plugin"]
    with pytest.raises(DescriptionError, match="there is no joint 'k'"):
        load(tmp_path, link("a") + plugins.replace(">j<", ">k<"))


def test_a_rotor_lifts_and_turns_against_its_direction(tmp_path: Path):
    values = "<jointName>j</jointName><linkName>b</linkName><turningDirection>ccw</turningDirection>"
    values += "<timeConstantUp>0</timeConstantUp><maxRotVelocity>100</maxRotVelocity>"
    values += "<motorConstant>0.001</motorConstant><momentConstant>0.1</momentConstant>"
    plugin = f'<plugin filename="p" name="gz::sim::systems::MulticopterMotorModel">{values}</plugin>'
    scene = load(tmp_path, link("a") + link("b") + joint("revolute") + plugin)
    rotor = scene.actuators["b"]
    assert rotor.spec.control_range == (0, pytest.approx(10))
    rotor.control = 4.0
    scene.world.gravity = (0, 0, 0)
    scene.world.step(24)
    # 4 N on 2 kg, and -0.4 N m on the 1 kg m² of the rotor, for 0.1 s.
    linear, angular = scene[0].links["b"].velocity
    assert_allclose((linear, angular), ((0, 0, 0.2), (0, 0, -0.04)), atol=1e-9)


def test_what_is_wrong_is_an_error(tmp_path: Path):
    with pytest.raises(DescriptionError, match="unknown joint type 'hinge'"):
        load(tmp_path, link("a") + link("b") + joint("hinge"))
    with pytest.raises(DescriptionError, match="needs six numbers"):
        load(tmp_path, link("a", pose="0 0 1"))
    with pytest.raises(DescriptionError, match="neither true nor false"):
        load(tmp_path, link("a") + "<static>yes</static>")
    with pytest.raises(DescriptionError, match="on the network"):
        load(tmp_path, link("a", collision("<mesh><uri>https://example.org/a.dae</uri></mesh>")))
